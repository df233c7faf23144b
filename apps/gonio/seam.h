/* The seam of a table: the change from the last bin of phi_d to the first. */
#ifndef GONIO_SEAM_H
#define GONIO_SEAM_H

#include <gonio/gonio.h>

/* Mean steps of g = ln(1 + rho/s) between neighbouring bins of phi_d. phi_d = 180 degrees is the
 * same as 0, so the last bin and the first are neighbours too. A table made from a BRDF that is not
 * reciprocal jumps there. */
typedef struct tool_seam {
    double across;    /* between the last bin and the first; 0 without data */
    double elsewhere; /* between the others */
} tool_seam;

/* The mean steps over the cells (theta_h, theta_d) with data in all bins of phi_d. */
tool_seam tool_find_seam(const gonio_table *table);

/* Whether the jump is far above the other steps, and above rounding. */
bool tool_seam_shows(const tool_seam *seam);

#endif
