/* The interactive page: the data of its template. docs/report-page.md has the format. */
#ifndef GONIO_PAGE_PAGE_H
#define GONIO_PAGE_PAGE_H

#include <gonio/page.h>
#include <jansson.h>

#include "../core/core.h"

/* The template, from viewer/; empty if it was not built. */
extern const char gonio_i_web_template[];
extern const char gonio_i_web_template_end[];

/* The text that the template has in place of the data. */
#define GONIO_I_WEB_PLACE "<!--gonio-data-->"

/* A table packed for the page: text of `size` characters (base64), values in steps of `step`. */
typedef struct gonio_i_web_table {
    char *text; /* released with free() */
    size_t size;
    double step;
} gonio_i_web_table;

/* Which numbers of a table are packed. */
typedef enum gonio_i_web_kind {
    GONIO_I_WEB_LOG,      /* rho as g = ln(1 + rho/s_c) */
    GONIO_I_WEB_DEVIATION /* standard deviations of g, as they are */
} gonio_i_web_kind;

/* Packs values[90][3][90][180] (material.h) into at most `budget` bytes before base64, in the
 * finest of the steps 1/2048, 1/1024 ... that fits. Errors: _MEMORY, _CANCELLED. */
gonio_status gonio_i_web_pack(gonio_context *context, const double *values, gonio_i_web_kind kind,
                              size_t budget, gonio_i_web_table *packed);

/* Whether the page shows a material at each azimuth of the sample: anisotropic ones. */
bool gonio_i_web_turns(const gonio_material *material);

/* Packs the plane of incidence (phi_d = 0) of such a material at all azimuths of the half vector,
 * which take the place of phi_d: [theta_h][channel][theta_d][phi_h], 180 bins of a whole turn.
 * Errors: _MEMORY, _CANCELLED, those of the material. */
gonio_status gonio_i_web_pack_turns(gonio_context *context, const gonio_material *material,
                                    size_t budget, gonio_i_web_table *packed);

/* A material's name, format and values at a few directions. The page checks its own look-ups by
 * these: rows of [theta_h, theta_d, phi_d, R, G, B]. NULL when out of memory. */
json_t *gonio_i_web_material(const gonio_material *material, const gonio_table *table, double step);

/* The description of each error: key, title, unit, digits, summary. */
json_t *gonio_i_web_metric(const gonio_metric_view *metric);

/* Errors of all channels and of each. */
json_t *gonio_i_web_comparison(const gonio_comparison *comparison);

/* What readings are compared with; NULL for nothing. */
typedef struct gonio_i_web_known {
    const gonio_material *material;
    const gonio_table *table; /* of the material */
} gonio_i_web_known;

/* Readings in measuring order, with what the original and the reconstruction hold there: their
 * tables, or what an anisotropic material holds at that azimuth. */
json_t *gonio_i_web_readings(const gonio_readings *readings, gonio_i_web_known reference,
                             gonio_i_web_known reconstruction);

/* The tables of a folder that `gonio reproduce` left: {"fig2a": {"columns": [...], "rows":
 * [[...]], "metrics": [...]}, ...}, metrics being those whose keys are columns. Errors: _IO,
 * _FORMAT, _DATA (none of them, or columns missing), _MEMORY. */
gonio_status gonio_i_web_figures(gonio_context *context, const char *folder, json_t **figures);

#endif
