/* The page that compares the results with the paper's, and the same for programs. */
#ifndef GONIO_REPRODUCE_MARKDOWN_H
#define GONIO_REPRODUCE_MARKDOWN_H

#include "claims.h"

/* Writes FOLDER/report.md. Errors: _IO, _MEMORY. */
gonio_status gonio_i_write_page(gonio_context *context, const gonio_i_study *study,
                                const gonio_i_findings *findings, const gonio_i_claims *claims,
                                const char *folder);

/* Writes FOLDER/results.json. Errors: _IO, _MEMORY. */
gonio_status gonio_i_write_results(gonio_context *context, const gonio_i_study *study,
                                   const gonio_i_findings *findings, const gonio_i_claims *claims,
                                   const char *folder);

#endif
