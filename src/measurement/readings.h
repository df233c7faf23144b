/* The inside of readings, shared by files and the instrument. */
#ifndef GONIO_READINGS_INTERNAL_H
#define GONIO_READINGS_INTERNAL_H

#include <gonio/measurement.h>

#include "../core/core.h"
#include "../core/csv.h"

struct gonio_readings {
    char *path;
    gonio_i_csv *csv; /* the whole file, other columns included */
    size_t count;
    gonio_reading *reading;
    size_t *first_same; /* [count]: the first reading with the same directions */
    uint64_t basis;
    size_t components;
    size_t wavelengths; /* 0: R, G, B */
    double *wavelength; /* [wavelengths] */
    double *spectrum;   /* [count][wavelengths] */
};

/* Whether a file is scattered readings as text; and its table, with columns as in a CSV file. */
bool gonio_i_scattered_probe(const char *path);
gonio_status gonio_i_scattered_read(gonio_context *context, const char *path, gonio_i_csv **csv);

/* Room for a spectrum of these wavelengths in every reading; what was there is dropped. */
gonio_status gonio_i_readings_set_wavelengths(gonio_context *context, gonio_readings *readings,
                                              const double *wavelength, size_t count);

/* Fills first_same for readings in any order. */
gonio_status gonio_i_readings_group(gonio_context *context, const gonio_reading *reading,
                                    size_t count, size_t *first_same);

#endif
