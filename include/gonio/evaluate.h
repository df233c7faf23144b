/* Evaluation: how far one BRDF is from another, by every metric of metric.h, over the bins where
 * both have data. */
#ifndef GONIO_EVALUATE_H
#define GONIO_EVALUATE_H

#include <gonio/metric.h>
#include <gonio/reconstruct.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_comparison {
    gonio_error all;                     /* over all channels */
    gonio_error channel[GONIO_CHANNELS]; /* each alone */
    int64_t bins;                        /* compared */
    int64_t missing;                     /* bins with data in the reference but not in the other */
} gonio_comparison;

/* Compares a material with a reference. Independent of the number of threads.
 * Errors: _DATA if no bin has data in both, or the reference is black; those of the sources. */
GONIO_API gonio_status gonio_compare(gonio_context *context, const gonio_material *reference,
                                     const gonio_material *other, gonio_comparison *comparison);

/* The same errors over readings: of reference reading k and of reading k of the other, which is at
 * the same directions (gonio_readings_look_up, gonio_measure_material) and in the same channels
 * (gonio_readings_share_channels), wherever both have a value. left_out[count], or NULL: readings
 * that do not count, for they were used. Errors: _MISMATCH (other numbers of readings or channels,
 * other wavelengths), _DATA (nothing to compare). *compared: how many readings count. */
GONIO_API gonio_status gonio_compare_readings(gonio_context *context,
                                              const gonio_readings *reference,
                                              const gonio_readings *other, const bool *left_out,
                                              gonio_error *error, size_t *compared);

#ifdef __cplusplus
}
#endif
#endif
