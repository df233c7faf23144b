/* The picture of what an instrument reaches: see reach_figure.h. */
#include "reach_figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "figures/figure.h"

enum {
    PANELS = 4,
    RINGS = 18,
    SPOKES = 36,
    MOST_CANDIDATES = 8000,
    MOST_OF_PANEL = RINGS * 2 * (RINGS + 1)
};

#define DEGREE (M_PI / 180.0)

typedef struct panel {
    char name[64];
    double theta;
    size_t count;
    gonio_pair pair[MOST_OF_PANEL];
} panel;

/* The polar angles of the light that can be read: level[], ascending. Settings are sorted by them.
 */
static size_t find_levels(const gonio_setting *setting, size_t count, double *level)
{
    size_t levels = 0;
    for (size_t k = 0; k < count; k++) {
        const double theta = setting[k].pair.incident.theta;
        if (levels == 0 || theta > level[levels - 1] + 0.5 * DEGREE) {
            level[levels++] = theta;
        }
    }
    return levels;
}

static double nearest_level(const double *level, size_t count, double wish)
{
    double best = level[0];
    for (size_t k = 1; k < count; k++) {
        best = fabs(level[k] - wish) < fabs(best - wish) ? level[k] : best;
    }
    return best;
}

/* Directions of the detector on rings and spokes that can be read. The sample is isotropic. */
static void fill_panel(const gonio_instrument *instrument, double theta, panel *p)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_setting one;
    p->theta = theta;
    p->count = 0;
    snprintf(p->name, sizeof p->name, "theta_i = %.4g degrees", theta / DEGREE);
    for (int ring = 0; ring < RINGS; ring++) {
        const int spokes = ring == 0 ? 1 : 2 * (ring + 1);
        for (int spoke = 0; spoke < spokes; spoke++) {
            const gonio_pair pair = {
                {theta, 0.0}, {ring * 90.0 / RINGS * DEGREE, spoke * 360.0 / spokes * DEGREE}};
            if (gonio_instrument_settings(instrument, pair, freedom, &one, 1) > 0) {
                p->pair[p->count++] = pair;
            }
        }
    }
}

/* A panel for each of a few levels, otherwise for those nearest to four angles. */
static size_t fill_panels(const gonio_instrument *instrument, const double *level, size_t levels,
                          panel *p)
{
    static const double wishes[PANELS] = {10.0, 30.0, 50.0, 70.0};
    size_t panels = 0;
    for (size_t k = 0; k < PANELS; k++) {
        const double theta = levels > PANELS ? nearest_level(level, levels, wishes[k] * DEGREE)
                                             : level[k < levels ? k : levels - 1];
        if (panels == 0 || theta > p[panels - 1].theta) {
            fill_panel(instrument, theta, &p[panels++]);
        }
    }
    return panels;
}

static gonio_status draw(gonio_context *context, const gonio_instrument *instrument, const panel *p,
                         size_t count, const char *folder)
{
    gonio_i_panel panels[PANELS];
    gonio_i_figures figures = {.folder = folder};
    for (size_t k = 0; k < count; k++) {
        panels[k] = (gonio_i_panel){p[k].name, p[k].count, p[k].pair};
    }
    const gonio_i_directions figure = {.name = "reach",
                                       .title = gonio_instrument_describe(instrument)->name,
                                       .projection = GONIO_I_EQUAL_ANGLE,
                                       .count = count,
                                       .panels = panels};
    return gonio_i_figure_directions(context, &figures, &figure);
}

gonio_status reach_figure(gonio_context *context, const gonio_instrument *instrument,
                          const char *folder)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_setting *setting = NULL;
    size_t count = 0;
    gonio_status status = gonio_instrument_candidates(context, instrument, freedom, MOST_CANDIDATES,
                                                      &setting, &count);
    panel *p = calloc(PANELS, sizeof *p);
    double *level = calloc(count + 1, sizeof *level);
    if (status == GONIO_OK && (p == NULL || level == NULL)) {
        status = GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        const size_t levels = find_levels(setting, count, level);
        status = draw(context, instrument, p, fill_panels(instrument, level, levels, p), folder);
    }
    free(p);
    free(level);
    free(setting);
    return status;
}
