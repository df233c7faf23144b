/* A plan as an instrument makes it: see plan_tour.h. */
#include "plan_tour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "duration.h"
#include "figures/figure.h"
#include "json_output.h"
#include "nearest_setting.h"
#include "plan_axes.h"

static const double DEGREE = M_PI / 180.0;

/* ---- settings ---- */

static void complain(tool *t, const gonio_instrument *instrument, const char *path,
                     const gonio_readings_view *plan, size_t first, size_t missing)
{
    const gonio_pair pair = plan->pair[first];
    char text[512];
    snprintf(text, sizeof text,
             "%s:%zu: the instrument %s cannot read theta_i %.4g, phi_i %.4g, theta_o %.4g, phi_o "
             "%.4g (%s), nor %zu others of %zu",
             path, plan->line[first], gonio_instrument_describe(instrument)->path,
             pair.incident.theta / DEGREE, pair.incident.phi / DEGREE, pair.outgoing.theta / DEGREE,
             pair.outgoing.phi / DEGREE, nearest_obstacle(instrument, pair), missing - 1,
             plan->count);
    tool_say(&t->messages, GONIO_MESSAGE_ERROR, text);
}

/* The settings that are reached soonest, one after another. */
static gonio_status find_nearest(tool *t, const gonio_instrument *instrument, const char *path,
                                 plan_tour *tour)
{
    const gonio_readings_view *plan = gonio_readings_describe(tour->plan);
    gonio_setting at;
    size_t first = 0;
    size_t missing = 0;
    gonio_instrument_home(instrument, &at);
    for (size_t k = 0; k < plan->count; k++) {
        if (nearest_setting(instrument, plan->pair[k], &at, &tour->setting[k])) {
            at = tour->setting[k];
        } else {
            first = missing++ == 0 ? k : first;
        }
    }
    if (missing > 0) {
        complain(t, instrument, path, plan, first, missing);
    }
    return missing == 0 ? GONIO_OK : GONIO_ERROR_MISMATCH;
}

/* Positions of the file hold as far as the instrument can take them and they read the angles. */
static void take_positions(const gonio_instrument *instrument, const gonio_setting *stated,
                           plan_tour *tour)
{
    const gonio_readings_view *plan = gonio_readings_describe(tour->plan);
    for (size_t k = 0; k < plan->count; k++) {
        if (!plan_axes_agree(&stated[k], plan->pair[k])) {
            tour->line = tour->unlike++ == 0 ? plan->line[k] : tour->line;
        } else if (gonio_instrument_obstacle(instrument, &stated[k]) == NULL) {
            tour->setting[k] = stated[k];
        }
    }
}

/* ---- times ---- */

static void find_times(const gonio_instrument *instrument, plan_tour *tour)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    gonio_setting at;
    gonio_instrument_home(instrument, &at);
    tour->duration = gonio_instrument_schedule(instrument, tour->setting, tour->count, tour->time);
    for (size_t k = 0; k < tour->count; k++) {
        const gonio_setting *next = &tour->setting[k];
        const double whole = gonio_instrument_travel(instrument, &at, next);
        at.pair.incident.theta = next->pair.incident.theta;
        const double move = gonio_instrument_travel(instrument, &at, next);
        tour->moves += move;
        tour->incidence_changes += whole - move;
        tour->changes += whole > move;
        at = *next;
    }
    tour->exposures = view->exposure * (double)tour->count;
    tour->references =
        fmax(tour->duration - tour->exposures - tour->moves - tour->incidence_changes, 0.0);
}

gonio_status plan_tour_make(tool *t, const gonio_instrument *instrument, const gonio_readings *plan,
                            const char *path, plan_tour *tour)
{
    bool found = false;
    const size_t count = gonio_readings_describe(plan)->count;
    gonio_setting *stated = calloc(count, sizeof *stated);
    *tour = (plan_tour){.plan = plan,
                        .count = count,
                        .setting = calloc(count, sizeof *tour->setting),
                        .time = calloc(count, sizeof *tour->time)};
    gonio_status status = stated != NULL && tour->setting != NULL && tour->time != NULL
                              ? find_nearest(t, instrument, path, tour)
                              : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = plan_axes_read(t->context, instrument, plan, path, stated, &found);
    }
    if (status == GONIO_OK) {
        if (found) {
            take_positions(instrument, stated, tour);
        }
        find_times(instrument, tour);
    }
    free(stated);
    return status;
}

void plan_tour_free(plan_tour *tour)
{
    free(tour->setting);
    free(tour->time);
    *tour = (plan_tour){0};
}

/* ---- words ---- */

static void print_part(FILE *stream, const char *before, double seconds, const char *what)
{
    if (seconds > 0.0) {
        fputs(before, stream);
        tool_print_duration(stream, seconds);
        fputs(what, stream);
    }
}

void plan_tour_print(tool *t, FILE *stream, const char *path, const plan_tour *tour)
{
    char changes[64];
    fprintf(stream, "%s: %zu reading%s in ", path, tour->count, tool_plural(tour->count));
    tool_print_duration(stream, tour->duration);
    print_part(stream, ": ", tour->exposures, " of exposures");
    print_part(stream, ", ", tour->moves, " of moves");
    snprintf(changes, sizeof changes, " of %zu change%s of incidence", tour->changes,
             tool_plural(tour->changes));
    print_part(stream, ", ", tour->incidence_changes, changes);
    print_part(stream, ", ", tour->references, " of references");
    fputc('\n', stream);
    if (tour->unlike > 0) {
        char text[256];
        snprintf(text, sizeof text,
                 "%s:%zu: the positions of the axes do not read the angles of this line, and of "
                 "%zu others; was the plan edited? Plan again, or delete the columns axis_*",
                 path, tour->line, tour->unlike - 1);
        tool_say(&t->messages, GONIO_MESSAGE_WARNING, text);
    }
}

json_t *plan_tour_json(const char *path, const plan_tour *tour)
{
    return json_pack("{s:o, s:I, s:f, s:f, s:f, s:f, s:I, s:f, s:I}", "plan", tool_json_text(path),
                     "readings", (json_int_t)tour->count, "duration_s", tour->duration,
                     "exposures_s", tour->exposures, "moves_s", tour->moves, "incidence_changes_s",
                     tour->incidence_changes, "incidence_changes", (json_int_t)tour->changes,
                     "references_s", tour->references, "axes_unlike_angles",
                     (json_int_t)tour->unlike);
}

/* ---- the picture ---- */

/* The positions of an axis over time, two points for each reading: it stands while it reads. */
static void fill_curve(const gonio_instrument_view *view, const plan_tour *tour, size_t axis,
                       double *x, double *y)
{
    for (size_t k = 0; k < tour->count; k++) {
        x[2 * k] = (tour->time[k] - view->exposure) / 60.0;
        x[2 * k + 1] = tour->time[k] / 60.0;
        y[2 * k] = tour->setting[k].axis[axis] / DEGREE + 0.0;
        y[2 * k + 1] = y[2 * k];
    }
}

static bool moves(const plan_tour *tour, size_t axis)
{
    bool other = false;
    for (size_t k = 1; k < tour->count; k++) {
        other = other || tour->setting[k].axis[axis] != tour->setting[0].axis[axis];
    }
    return other;
}

gonio_status plan_tour_draw(gonio_context *context, const gonio_instrument *instrument,
                            const plan_tour *tour, const char *folder)
{
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    gonio_i_figures figures = {.folder = folder};
    gonio_i_curve curves[GONIO_MOST_AXES];
    const size_t points = 2 * tour->count;
    double *values = calloc(2 * GONIO_MOST_AXES * points, sizeof *values);
    size_t count = 0;
    for (size_t k = 0; k < view->axes && values != NULL; k++) {
        double *x = values + 2 * k * points;
        if (moves(tour, k)) {
            fill_curve(view, tour, k, x, x + points);
            curves[count++] = (gonio_i_curve){
                .name = view->axis[k].name, .count = points, .x = x, .y = x + points};
        }
    }
    const gonio_i_curves figure = {
        .name = "tour",
        .title = view->name,
        .x = {.name = "time", .unit = "min", .high = tour->duration / 60.0},
        .y = {.name = "position of the axis", .unit = "degrees"},
        .count = count,
        .curves = curves,
        .dots = true};
    const gonio_status status = values == NULL ? GONIO_ERROR_MEMORY
                                : count == 0   ? GONIO_OK
                                               : gonio_i_figure_curves(context, &figures, &figure);
    free(values);
    return status;
}
