/* The seam of a table: how much it changes from the last bin of phi_d to the first. */
#ifndef GONIO_SEAM_H
#define GONIO_SEAM_H

#include <gonio/gonio.h>

/* Mean steps of g = ln(1 + rho/s) between neighbouring bins of phi_d. phi_d of 180 degrees is that
 * of 0, so the last bin and the first are neighbours too; a table that was made from what is not
 * reciprocal jumps there. */
typedef struct tool_seam {
    double there;     /* between the last bin and the first; 0 without data */
    double elsewhere; /* between the others */
} tool_seam;

/* Over the cells of theta_h and theta_d with data in all bins of phi_d. */
tool_seam tool_find_seam(const gonio_table *table);

/* Whether the jump is far above the other steps, and above rounding. */
bool tool_seam_shows(const tool_seam *seam);

#endif
