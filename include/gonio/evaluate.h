/* Evaluation: how far one BRDF is from another.
 *
 * Over the bins where both have data; c_i, c_o the cosines at the bin's centre:
 *   E6             100 sqrt(sum (g - g')^2 / sum g^2), g in log space; Ali et al., eq. (6)
 *   cube root      100 sqrt(sum (r - r')^2 / sum r^2), r = cbrt(rho c_i c_o); Fores et al. 2012
 *   log-relative   sqrt(mean ln^2((rho w + e)/(rho' w + e))), e = 0.001, w = clip(c_i c_o, 0.01,
 * 1); Nielsen et al. 2015 */
#ifndef GONIO_EVALUATE_H
#define GONIO_EVALUATE_H

#include <gonio/reconstruct.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_error {
    double e6;           /* per cent */
    double cube_root;    /* per cent */
    double log_relative; /* natural log units */
} gonio_error;

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
 * the same directions (gonio_readings_look_up), in all channels that both have. left_out[count], or
 * NULL: readings that do not count, for they were used. Errors: _MISMATCH (other numbers of
 * readings or channels), _DATA (nothing to compare). */
GONIO_API gonio_status gonio_compare_readings(gonio_context *context,
                                              const gonio_readings *reference,
                                              const gonio_readings *other, const bool *left_out,
                                              gonio_error *error, size_t *compared);

#ifdef __cplusplus
}
#endif
#endif
