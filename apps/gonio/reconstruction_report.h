/* What gonio reconstruct says of its results: a line and notes, or JSON. */
#ifndef GONIO_RECONSTRUCTION_REPORT_H
#define GONIO_RECONSTRUCTION_REPORT_H

#include "reflectances.h"

/* Reports results: lines with notes, or objects appended to `results` unless it is NULL. NULL in
 * `made` stands for one that was not made. at: of --albedo-at. Errors: _MEMORY, those of
 * tool_reflectances_of_reconstruction, of the last that has any. */
gonio_status reconstruction_report(const tool *t, const tool_reflectances *at,
                                   const gonio_basis *basis, gonio_reconstruction *const *made,
                                   char *const *outputs, size_t count, json_t *results);

#endif
