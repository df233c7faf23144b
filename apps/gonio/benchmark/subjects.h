/* What is tested: materials, which can be read anywhere (tables), and files of scattered readings.
 */
#ifndef GONIO_BENCHMARK_SUBJECTS_H
#define GONIO_BENCHMARK_SUBJECTS_H

#include <gonio/gonio.h>

typedef struct benchmark_subject {
    char *set;      /* the argument that it was found in: its base name */
    char *name;     /* in the set */
    char *path;     /* as gonio_material_open or gonio_readings_read takes it */
    int sample;     /* of a file of several samples; 0: the only one */
    bool scattered; /* readings; otherwise a material */
    uint64_t hash;  /* of the file's bytes, or of the name of a built-in material */
} benchmark_subject;

typedef struct benchmark_subjects {
    size_t count;
    benchmark_subject *subject;
} benchmark_subjects;

/* The materials and readings in each argument: of a folder and the folders in it by name, of a file
 * of several samples all, of "atlas:" the built-in materials. `how` says by `as` and
 * `instrument` what numbers of readings stand for. Files of a folder that are neither, cannot be
 * read, have no values or are anisotropic tables are left out, which is noted. The list is to be
 * freed in any case. Errors: _IO, _FORMAT, _DATA (of an argument that is a file, or a folder with
 * nothing to test); _MEMORY. */
gonio_status benchmark_subjects_find(gonio_context *context, const char *const *arguments,
                                     size_t count, const gonio_readings_options *how,
                                     benchmark_subjects *list);
void benchmark_subjects_free(benchmark_subjects *list);

/* Reads a file of readings as it is tested: repeats averaged, negative values taken as 0, channels
 * without values dropped. Errors: those of gonio_readings_read. */
gonio_status benchmark_readings_open(gonio_context *context, const char *path, int sample,
                                     const gonio_readings_options *how, gonio_readings **readings);

/* A hash of a file's bytes; of a path that is no file, of the path. */
uint64_t benchmark_hash(const char *path);

#endif
