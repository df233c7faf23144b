/* Albedos at some incidences. */
#ifndef GONIO_ALBEDOS_H
#define GONIO_ALBEDOS_H

#include <gonio/gonio.h>

/* The incidences at which albedos are computed: theta_i in degrees. */
enum { TOOL_INCIDENCES = 6 };
extern const double tool_incidence_deg[TOOL_INCIDENCES];

/* The albedos at these incidences, NaN without data. *largest: the largest of any channel. Returns
 * the index of its incidence. */
int tool_albedos(const gonio_table *table, double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                 double *largest);

/* The same, with the share of the hemisphere that has data (gonio_table_albedo). */
int tool_albedos_and_shares(const gonio_table *table,
                            double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                            double share[TOOL_INCIDENCES], double *largest);

#endif
