/* Sums over bins and the errors that are ratios of them: see metrics.h. */
#include "metrics.h"

void gonio_i_error_add(gonio_i_error_sums *total, const gonio_i_error_sums *part)
{
    total->log_difference += part->log_difference;
    total->log_reference += part->log_reference;
    total->cube_difference += part->cube_difference;
    total->cube_reference += part->cube_reference;
    total->ratio += part->ratio;
}

gonio_error gonio_i_error_of(const gonio_i_error_sums *sums, double values)
{
    return (gonio_error){
        .e6 = 100.0 * sqrt(sums->log_difference / sums->log_reference),
        .cube_root = 100.0 * sqrt(sums->cube_difference / sums->cube_reference),
        .log_relative = sqrt(sums->ratio / values),
    };
}
