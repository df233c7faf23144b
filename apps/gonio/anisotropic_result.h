/* gonio reconstruct --anisotropic: materials that change as the sample turns. */
#ifndef GONIO_ANISOTROPIC_RESULT_H
#define GONIO_ANISOTROPIC_RESULT_H

#include <jansson.h>

#include "write_options.h"

typedef struct anisotropic_task {
    const gonio_basis *basis;
    const gonio_reconstruct_options *how;
    const write_options *write;
    const gonio_write_options *format; /* of write */
    const char *predict_at;            /* a file of directions; NULL: the material is written */
} anisotropic_task;

/* Reconstructs from readings, writes `output` and reports: a line, or an object appended to
 * `results`. */
gonio_status anisotropic_result_write(tool *t, const anisotropic_task *task,
                                      const gonio_readings *readings, const char *output,
                                      json_t *results);

/* The members of `a` in an object, which is released with json_decref; NULL out of memory. */
json_t *anisotropy_json(const gonio_anisotropy *a);

/* "grain at 30 degrees, slopes 2.4 times as large across it", for results in words. */
void print_anisotropy(const gonio_anisotropy *a);

/* Checks --symmetry. Returns false after an error message. */
bool anisotropic_check_symmetry(const tool *t, int symmetry);

#define SYMMETRY_OPTION(variable)                                                                  \
    {                                                                                              \
        "symmetry", '\0', POPT_ARG_INT, variable, 0,                                               \
            "Turns of the sample, in a full one, that change nothing: 1, 2 (brushed metal, satin)" \
            " or 4 (weaves); default: found",                                                      \
            "N"                                                                                    \
    }

#endif
