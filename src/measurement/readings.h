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
};

/* Fills first_same for readings in any order. */
gonio_status gonio_i_readings_group(gonio_context *context, const gonio_reading *reading,
                                    size_t count, size_t *first_same);

#endif
