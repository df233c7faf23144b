/* The page for a browser: what was measured and reconstructed, interactive, in one file. */
#ifndef GONIO_PAGE_H
#define GONIO_PAGE_H

#include <gonio/render.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The content of a page. All pointers stay the caller's and may be NULL, but reference or folder is
 * needed. A reconstruction needs a reference. */
typedef struct gonio_page_content {
    size_t size; /* sizeof(gonio_page_content) */
    const gonio_material *reference;
    const gonio_material *reconstruction; /* shown beside the reference */
    /* A table whose stored numbers are the standard deviations of g = ln(1 + rho/s) of the
     * reconstruction, bin by bin: a MERL file, read by gonio_material_open. */
    const gonio_material *deviation;
    const gonio_readings *readings; /* in measuring order; values are not needed */
    const char *folder;             /* of gonio_reproduce: its tables become charts */
} gonio_page_content;

/* Whether the library was built with the page, which needs Node.js. */
GONIO_API bool gonio_page_is_built(void);

/* Writes a page for a browser: one file of less than 6 MB that needs nothing else and no network.
 * Tables are stored in steps of 1/2048 of g, or coarser steps if noise makes them too large; the
 * page states the step. The file appears whole or not at all. Errors: _IO, also if the library was
 * built without the page (which needs Node.js); _ARGUMENT for nothing to show, a reconstruction
 * without a reference, deviations without a reconstruction; _DATA and _FORMAT for a folder without
 * tables, or with others; those of gonio_compare and of the materials; _MEMORY; _CANCELLED. */
GONIO_API gonio_status gonio_page_write(gonio_context *context, const gonio_page_content *content,
                                        const char *path);

#ifdef __cplusplus
}
#endif
#endif
