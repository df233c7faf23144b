/* Directions as an in-plane goniometer reads them: two incidences, the detector turned in steps. */
#ifndef GONIO_BENCHMARK_INCIDENCES_H
#define GONIO_BENCHMARK_INCIDENCES_H

#include "directions.h"

/* In the plane of incidence to 1 degree, the viewer on the mirror's side or on the light's. */
bool benchmark_is_in_plane(const gonio_pair *pair);

/* n directions in the plane of incidence, half of them at each of two incidences, evenly spread
 * over the detector's angles. Of scattered readings every draw takes another pair of the file's
 * incidences, as long as there is one; of tables the incidences are drawn. Fewer where the file has
 * not two incidences with so many. Errors: _MEMORY. */
gonio_status benchmark_choose_two_incidences(gonio_context *context, const benchmark_choosing *with,
                                             size_t n, benchmark_pairs *chosen);

#endif
