/* Writing the inputs that fuzz targets begin with. */
#ifndef FUZZ_SEEDS_H
#define FUZZ_SEEDS_H

#include <stddef.h>

/* The path of an input; its folder is made. */
void seed_path(char path[4096], const char *target, const char *name);
void seed_bytes(const char *target, const char *name, const void *data, size_t size);
void seed_text(const char *target, const char *name, const char *text);

/* Of targets readings and plan; material; hdf; image and mesh; instrument and run. */
void seed_readings(void);
void seed_materials(void);
void seed_hdf(void);
void seed_scenes(void);
void seed_rigs(void);

#endif
