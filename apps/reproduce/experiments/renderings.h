/* Fig. 6 and Fig. 7: renderings of materials and of their reconstructions from few readings, each
 * with a basis of all other materials. */
#ifndef GONIO_REPRODUCE_RENDERINGS_H
#define GONIO_REPRODUCE_RENDERINGS_H

#include <stdio.h>

#include "computations.h"

/* The number of pieces of an experiment (GONIO_I_RENDERED or GONIO_I_LIT): one for each row and
 * each column after the first of its picture. */
size_t gonio_i_renderings(const gonio_i_study *study, gonio_i_experiment experiment);
char *gonio_i_rendering_name(const gonio_i_study *study, gonio_i_experiment experiment,
                             size_t index);
double gonio_i_rendering_cost(const gonio_i_study *study, gonio_i_experiment experiment,
                              size_t index);

/* {"condition": number, "e6_percent": number, "psnr_db": number, "delta_e_itp": number,
 * "original": image, "image": image}, images as hexadecimal digits. */
gonio_status gonio_i_compute_rendering(const gonio_i_study *study, gonio_context *context,
                                       gonio_i_experiment experiment, size_t index, json_t *result);

/* Checks a result that was read from a file; see kept_results.h. */
bool gonio_i_accept_rendering(const gonio_i_study *study, const gonio_i_piece *p,
                              const json_t *result, char *complaint);

/* Draws fig6.png or fig7.png in a folder; a library without the renderer draws none. `pieces`: the
 * array of results. */
gonio_status gonio_i_draw_renderings(gonio_context *context, const gonio_i_study *study,
                                     gonio_i_experiment experiment, const json_t *pieces,
                                     const char *folder);

/* The same as rows of CSV. */
void gonio_i_put_renderings(FILE *f, const gonio_i_study *study, gonio_i_experiment experiment,
                            const json_t *pieces);

#endif
