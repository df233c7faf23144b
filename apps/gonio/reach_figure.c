/* The picture of what an instrument reaches: see reach_figure.h. */
#include "reach_figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "figures/figure.h"

enum {
    PANELS = 4,
    RINGS = 45,
    SPOKES = 120,
    CELLS = RINGS * SPOKES,
    MOST_REGIONS = 16,
    MOST_CANDIDATES = 8000
};

#define DEGREE (M_PI / 180.0)

/* Readings of a plan are shown beside the direction of the light that is nearest, if it is within:
 */
static const double BESIDE = 10.0 * DEGREE;
static const double SAME_LEVEL = 0.5 * DEGREE;

typedef struct panel {
    char name[64];
    double theta;
    int region[CELLS];
    size_t count;
    gonio_angles *point;
} panel;

typedef struct picture {
    const gonio_instrument *instrument;
    const char *obstacle[MOST_REGIONS]; /* "": none */
    char name[MOST_REGIONS][96];        /* of the region */
    const char *region[MOST_REGIONS];   /* the names */
    size_t regions;
    const char *points; /* what the dots are; NULL: none */
    size_t panels;
    panel panel[PANELS];
} picture;

/* ---- panels ---- */

/* The polar angles of the light that can be read: level[], ascending. Settings are sorted by them.
 */
static size_t find_levels(const gonio_setting *setting, size_t count, double *level)
{
    size_t levels = 0;
    for (size_t k = 0; k < count; k++) {
        const double theta = setting[k].pair.incident.theta;
        if (levels == 0 || theta > level[levels - 1] + SAME_LEVEL) {
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

static bool is_axis(const gonio_instrument *instrument, const char *obstacle)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    bool found = false;
    for (size_t k = 0; k < view->axes; k++) {
        found = found || strcmp(view->axis[k].name, obstacle) == 0;
    }
    return found;
}

static bool is_limit(const gonio_instrument *instrument, const char *obstacle)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    bool found = false;
    for (size_t k = 0; k < view->limits; k++) {
        found = found || strcmp(view->limit[k].quantity, obstacle) == 0;
    }
    return found;
}

static void name_region(const gonio_instrument *instrument, const char *obstacle, char *name,
                        size_t size)
{
    const char *before = is_axis(instrument, obstacle)    ? "range of "
                         : is_limit(instrument, obstacle) ? "limit of "
                                                          : "";
    snprintf(name, size, "%s%s", before, *obstacle == '\0' ? "can be read" : obstacle);
}

/* The number of a region; a new one if there is room. */
static int region_of(picture *p, const char *obstacle)
{
    size_t k = 0;
    while (k < p->regions && strcmp(p->obstacle[k], obstacle) != 0) {
        k++;
    }
    if (k == p->regions && k < MOST_REGIONS) {
        p->obstacle[k] = obstacle;
        p->region[k] = p->name[k];
        name_region(p->instrument, obstacle, p->name[k], sizeof p->name[k]);
        p->regions++;
    }
    return (int)(k < MOST_REGIONS ? k : MOST_REGIONS - 1);
}

/* Cells around directions of the detector. The sample is isotropic. */
static void fill_panel(picture *p, double theta, panel *made)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    made->theta = theta;
    made->count = 0;
    snprintf(made->name, sizeof made->name, "theta_i = %.3g degrees", theta / DEGREE);
    for (int k = 0; k < CELLS; k++) {
        const int ring = k / SPOKES;
        const gonio_pair pair = {
            {theta, 0.0},
            {(ring + 0.5) * 90.0 / RINGS * DEGREE, k % SPOKES * 360.0 / SPOKES * DEGREE}};
        const char *obstacle = gonio_instrument_region_obstacle(p->instrument, pair, freedom);
        made->region[k] = region_of(p, obstacle != NULL ? obstacle : "");
    }
}

/* A panel for each of a few levels, otherwise for those nearest to four angles. */
static void fill_panels(picture *p, const double *level, size_t levels)
{
    static const double wishes[PANELS] = {10.0, 30.0, 50.0, 70.0};
    region_of(p, "");
    for (size_t k = 0; k < PANELS; k++) {
        const double theta = levels > PANELS ? nearest_level(level, levels, wishes[k] * DEGREE)
                                             : level[k < levels ? k : levels - 1];
        if (p->panels == 0 || theta > p->panel[p->panels - 1].theta) {
            fill_panel(p, theta, &p->panel[p->panels]);
            p->panels++;
        }
    }
}

/* ---- dots ---- */

/* The panel whose light is nearest; NULL if that is further than `within`. */
static panel *panel_of(picture *p, double theta, double within)
{
    panel *best = NULL;
    for (size_t k = 0; k < p->panels; k++) {
        const double away = fabs(p->panel[k].theta - theta);
        if (away <= within && (best == NULL || away < fabs(best->theta - theta))) {
            best = &p->panel[k];
        }
    }
    return best;
}

static gonio_status add_point(picture *p, gonio_pair pair, double within)
{
    panel *to = panel_of(p, pair.incident.theta, within);
    gonio_angles *more = to != NULL ? reallocarray(to->point, to->count + 1, sizeof *more) : NULL;
    if (to == NULL) {
        return GONIO_OK;
    }
    if (more == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    to->point = more;
    to->point[to->count++] =
        (gonio_angles){pair.outgoing.theta, pair.outgoing.phi - pair.incident.phi};
    return GONIO_OK;
}

/* The readings of a plan; of a table of directions, which no cell meets, all that can be read. */
static gonio_status add_points(picture *p, const gonio_readings *plan, const gonio_setting *setting,
                               size_t count)
{
    gonio_status status = GONIO_OK;
    if (plan != NULL) {
        const gonio_readings_view *view = gonio_readings_describe(plan);
        p->points = "readings of the plan, theta_i within 10 degrees";
        for (size_t k = 0; k < view->count && status == GONIO_OK; k++) {
            status = add_point(p, view->pair[k], BESIDE);
        }
    } else if (gonio_instrument_describe(p->instrument)->directions > 0) {
        p->points = "a direction of the table";
        for (size_t k = 0; k < count && status == GONIO_OK; k++) {
            status = add_point(p, setting[k].pair, SAME_LEVEL);
        }
    }
    return status;
}

/* ---- the figure ---- */

static gonio_status draw(gonio_context *context, const picture *p, const char *folder)
{
    gonio_i_region_panel panels[PANELS];
    gonio_i_figures figures = {.folder = folder};
    for (size_t k = 0; k < p->panels; k++) {
        const panel *one = &p->panel[k];
        panels[k] = (gonio_i_region_panel){
            one->name, {one->theta, 0.0}, one->region, one->count, one->point};
    }
    const gonio_i_regions figure = {.name = "reach",
                                    .title = gonio_instrument_describe(p->instrument)->name,
                                    .rings = RINGS,
                                    .spokes = SPOKES,
                                    .regions = p->regions,
                                    .region = p->region,
                                    .points = p->points,
                                    .count = p->panels,
                                    .panels = panels};
    return gonio_i_figure_regions(context, &figures, &figure);
}

gonio_status reach_figure(gonio_context *context, const gonio_instrument *instrument,
                          const gonio_readings *plan, const char *folder)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_setting *setting = NULL;
    size_t count = 0;
    gonio_status status = gonio_instrument_candidates(context, instrument, freedom, MOST_CANDIDATES,
                                                      &setting, &count);
    picture *p = calloc(1, sizeof *p);
    double *level = calloc(count + 1, sizeof *level);
    if (status == GONIO_OK && (p == NULL || level == NULL)) {
        status = GONIO_ERROR_MEMORY;
    }
    if (status == GONIO_OK) {
        p->instrument = instrument;
        fill_panels(p, level, find_levels(setting, count, level));
        status = add_points(p, plan, setting, count);
    }
    if (status == GONIO_OK) {
        status = draw(context, p, folder);
    }
    for (size_t k = 0; p != NULL && k < p->panels; k++) {
        free(p->panel[k].point);
    }
    free(p);
    free(level);
    free(setting);
    return status;
}
