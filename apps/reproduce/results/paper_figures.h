/* The paper's figures, drawn from the results of the experiments. */
#ifndef GONIO_REPRODUCE_PAPER_FIGURES_H
#define GONIO_REPRODUCE_PAPER_FIGURES_H

#include "summary.h"

/* Draws those of the wanted experiments into a folder: fig2a, fig2b, fig3a, fig3a-curves, fig3b,
 * fig4, fig5, fig6, fig7. Errors: those of figure.h. */
gonio_status gonio_i_draw(gonio_context *context, const gonio_i_study *study,
                          const gonio_i_results *results, const gonio_i_findings *findings,
                          const char *folder);

#endif
