/* Albedos at some incidences. */
#ifndef GONIO_ALBEDOS_H
#define GONIO_ALBEDOS_H

#include <gonio/gonio.h>

/* Where albedos are taken: theta_i in degrees. */
enum { TOOL_INCIDENCES = 6 };
extern const double tool_incidence_deg[TOOL_INCIDENCES];

/* The albedos there, NaN where there are no data; returns the index of the incidence with the
 * largest of any channel, which goes to *largest. */
int tool_albedos(const gonio_table *table, double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                 double *largest);

/* The same, with the shares of the hemisphere that have data, as gonio_table_albedo returns. */
int tool_albedos_and_shares(const gonio_table *table,
                            double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                            double share[TOOL_INCIDENCES], double *largest);

#endif
