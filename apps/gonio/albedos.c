/* Albedos at some incidences: see albedos.h. */
#include "albedos.h"

#include <math.h>

const double tool_incidence_deg[TOOL_INCIDENCES] = {0.0, 30.0, 45.0, 60.0, 75.0, 85.0};

int tool_albedos_and_shares(const gonio_table *table,
                            double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                            double share[TOOL_INCIDENCES], double *largest)
{
    int where = 0;
    *largest = 0.0;
    for (int k = 0; k < TOOL_INCIDENCES; k++) {
        share[k] = gonio_table_albedo(table, tool_incidence_deg[k] * M_PI / 180.0, albedo[k]);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            if (albedo[k][c] > *largest) {
                *largest = albedo[k][c];
                where = k;
            }
        }
    }
    return where;
}

int tool_albedos(const gonio_table *table, double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                 double *largest)
{
    double share[TOOL_INCIDENCES];
    return tool_albedos_and_shares(table, albedo, share, largest);
}
