/* The paper's figures: see paper_figures.h. */
#include "paper_figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../figures/figure.h"
#include "../experiments/renderings.h"
#include "csv_tables.h"

typedef struct drawer {
    gonio_context *context;
    gonio_i_figures figures;
    const gonio_i_study *study;
    const gonio_i_results *results;
    const gonio_i_findings *findings;
} drawer;

static const gonio_i_axis e6_axis = {.name = "mean error E6", .unit = "%"};

static void free_texts(char **texts, size_t count)
{
    for (size_t k = 0; texts != NULL && k < count; k++) {
        free(texts[k]);
    }
    free(texts);
}

/* ---- curves whose points are the caller's numbers ---- */

/* Room for `count` curves of up to `most` points. */
typedef struct curve_set {
    size_t count, most;
    gonio_i_curve *curve;
    char **name;
    double *x, *y, *low, *high; /* [count][most] */
} curve_set;

static gonio_status make_curves(gonio_context *context, size_t count, size_t most, curve_set *set)
{
    *set = (curve_set){.count = count, .most = most};
    set->curve = gonio_i_allocate(context, count, sizeof *set->curve);
    set->name = gonio_i_allocate(context, count, sizeof(char *));
    set->x = gonio_i_allocate(context, 4 * count * most, sizeof *set->x);
    if (set->curve == NULL || set->name == NULL || set->x == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    set->y = set->x + count * most;
    set->low = set->y + count * most;
    set->high = set->low + count * most;
    for (size_t k = 0; k < count; k++) {
        set->curve[k].x = set->x + k * most;
        set->curve[k].y = set->y + k * most;
    }
    return GONIO_OK;
}

static void free_curves(curve_set *set)
{
    free_texts(set->name, set->count);
    free(set->curve);
    free(set->x);
}

static void add_point(curve_set *set, size_t curve, double x, double y)
{
    const size_t at = curve * set->most + set->curve[curve].count++;
    set->x[at] = x;
    set->y[at] = y;
}

/* To the last point. */
static void add_interval(curve_set *set, size_t curve, double low, double high)
{
    const size_t at = curve * set->most + set->curve[curve].count - 1;
    set->low[at] = low;
    set->high[at] = high;
    set->curve[curve].low = set->low + curve * set->most;
    set->curve[curve].high = set->high + curve * set->most;
}

static void name_curve(curve_set *set, size_t curve, char *name)
{
    set->name[curve] = name;
    set->curve[curve].name = name;
}

static gonio_status draw_curves(drawer *d, const curve_set *set, gonio_i_curves figure)
{
    figure.count = set->count;
    figure.curves = set->curve;
    return gonio_i_figure_curves(d->context, &d->figures, &figure);
}

/* ---- Fig. 2 ---- */

enum { MOST_SHOWN = 60 };

static void add_cumulative(curve_set *set, size_t curve, const json_t *variances)
{
    const size_t count = json_array_size(variances);
    double total = 0.0;
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        total += gonio_i_json_number(json_array_get(variances, k));
    }
    for (size_t k = 0; k < count && k < MOST_SHOWN; k++) {
        sum += gonio_i_json_number(json_array_get(variances, k));
        add_point(set, curve, (double)(k + 1), 100.0 * sum / total);
    }
}

static gonio_status draw_spectrum(drawer *d)
{
    const json_t *splits = json_object_get(d->results->spectrum, "splits");
    const size_t count = json_array_size(splits);
    curve_set set;
    gonio_status status = make_curves(d->context, count + 1, MOST_SHOWN, &set);
    if (status == GONIO_OK) {
        for (size_t s = 0; s < count; s++) {
            add_cumulative(&set, s, json_array_get(splits, s));
            set.curve[s].faint = true;
        }
        name_curve(&set, 0, strdup("the basis of each split"));
        add_cumulative(&set, count, json_object_get(d->results->spectrum, "all"));
        name_curve(&set, count, strdup("all materials"));
        status = draw_curves(d, &set,
                             (gonio_i_curves){.name = "fig2a",
                                              .x = {.name = "components"},
                                              .y = {.name = "variance explained", .unit = "%"}});
    }
    free_curves(&set);
    return status;
}

static size_t longest(const json_t *lists)
{
    size_t most = 1;
    for (size_t k = 0; k < json_array_size(lists); k++) {
        const size_t size = json_array_size(json_array_get(lists, k));
        most = size > most ? size : most;
    }
    return most;
}

static gonio_status draw_convergence(drawer *d)
{
    const json_t *starts = json_object_get(d->results->convergence, "starts");
    const size_t count = json_array_size(starts);
    curve_set set;
    gonio_status status = make_curves(d->context, count, longest(starts), &set);
    if (status == GONIO_OK) {
        for (size_t s = 0; s < count; s++) {
            const json_t *steps = json_array_get(starts, s);
            for (size_t k = 0; k < json_array_size(steps); k++) {
                add_point(&set, s, (double)k, gonio_i_json_number(json_array_get(steps, k)));
            }
            name_curve(&set, s, gonio_i_format("start %zu", s + 1));
        }
        status =
            draw_curves(d, &set,
                        (gonio_i_curves){.name = "fig2b",
                                         .x = {.name = "rows swapped"},
                                         .y = {.name = "condition number", .logarithmic = true}});
    }
    free_curves(&set);
    return status;
}

/* ---- Fig. 3(a) ---- */

/* What is worse than this many times the best cell is shown as that: the cells with as many samples
 * as components would leave no colours for the others. */
static const double worst_shown = 2.0;

static double least_of(const double *values, size_t count)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < count; k++) {
        least = fmin(least, values[k]);
    }
    return least;
}

enum { MOST_LEVELS = 8 };

/* Numbers of two digits, closer together near the best. */
static size_t choose_levels(double least, double level[MOST_LEVELS])
{
    static const double above[MOST_LEVELS] = {1.02, 1.05, 1.1, 1.17, 1.25, 1.4, 1.6, 1.8};
    const double digit = pow(10.0, floor(log10(least)) - 1.0);
    size_t count = 0;
    for (size_t k = 0; k < MOST_LEVELS; k++) {
        const double next = digit * ceil(least * above[k] / digit);
        if (count == 0 || next > level[count - 1] + 0.5 * digit) {
            level[count++] = next;
        }
    }
    return count;
}

static size_t add_marks(const gonio_i_study *study, gonio_i_mark *mark, char **name)
{
    size_t count = 0;
    for (size_t c = 0; c < GONIO_I_CHOSEN && !study->cut; c++) {
        const gonio_i_size size = study->chosen[c];
        name[count] = gonio_i_format("%zu, %zu", size.components, size.samples);
        mark[count] = (gonio_i_mark){(double)size.samples, (double)size.components,
                                     name[count] != NULL ? name[count] : ""};
        count++;
    }
    return count;
}

/* values[L][K]. */
static gonio_status draw_map_of(drawer *d, const double *x, const double *y, double *values)
{
    const gonio_i_study *study = d->study;
    const size_t cells = study->grid_components * study->grid_samples;
    const double least = least_of(values, cells);
    char *name[GONIO_I_CHOSEN] = {NULL};
    gonio_i_mark mark[GONIO_I_CHOSEN];
    double level[MOST_LEVELS];
    for (size_t k = 0; k < cells; k++) {
        values[k] = values[k] > worst_shown * least ? worst_shown * least : values[k];
    }
    char *value = gonio_i_format("mean error E6 (the darkest: %.1f or more)", worst_shown * least);
    const gonio_i_map figure = {.name = "fig3a",
                                .x = {.name = "samples"},
                                .y = {.name = "components"},
                                .value = {.name = value != NULL ? value : "mean error E6",
                                          .unit = "%",
                                          .low = least,
                                          .high = worst_shown * least},
                                .columns = study->grid_samples,
                                .rows = study->grid_components,
                                .at_x = x,
                                .at_y = y,
                                .values = values,
                                .levels = choose_levels(least, level),
                                .level = level,
                                .marks = add_marks(study, mark, name),
                                .mark = mark};
    const gonio_status status = gonio_i_figure_map(d->context, &d->figures, &figure);
    free(value);
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        free(name[c]);
    }
    return status;
}

static gonio_status draw_map(drawer *d)
{
    const gonio_i_study *study = d->study;
    double x[GONIO_I_MOST_GRID];
    double y[GONIO_I_MOST_GRID];
    double values[GONIO_I_MOST_GRID * GONIO_I_MOST_GRID];
    for (size_t l = 0; l < study->grid_samples; l++) {
        x[l] = (double)study->grid_sample[l];
        for (size_t k = 0; k < study->grid_components; k++) {
            y[k] = (double)study->grid_component[k];
            values[l * study->grid_components + k] =
                d->findings->grid[k * study->grid_samples + l].value[GONIO_E6];
        }
    }
    return draw_map_of(d, x, y, values);
}

/* The grid's lines against the samples, with what all rows would give. */
static gonio_status draw_lines(drawer *d)
{
    const gonio_i_study *study = d->study;
    const size_t count = study->grid_components;
    double *all = gonio_i_allocate(d->context, count * study->grid_samples, sizeof *all);
    curve_set set;
    gonio_status status = make_curves(d->context, count, study->grid_samples, &set);
    status = all == NULL ? GONIO_ERROR_MEMORY : status;
    if (status == GONIO_OK) {
        for (size_t k = 0; k < count; k++) {
            const size_t components = study->grid_component[k];
            bool chosen = false;
            for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
                chosen = chosen || study->chosen[c].components == components;
            }
            for (size_t l = 0; l < study->grid_samples; l++) {
                const size_t at = k * study->grid_samples + l;
                all[at] = d->findings->grid[at].value[GONIO_E6];
                if (study->grid_sample[l] >= components) {
                    add_point(&set, k, (double)study->grid_sample[l], all[at]);
                }
            }
            set.curve[k].faint = !chosen;
            if (chosen) {
                name_curve(&set, k,
                           gonio_i_format("%zu components (all rows: %.2f %%)", components,
                                          d->findings->limit[k].value[GONIO_E6]));
            }
        }
        const double least = least_of(all, count * study->grid_samples);
        status = draw_curves(d, &set,
                             (gonio_i_curves){.name = "fig3a-curves",
                                              .x = {.name = "samples"},
                                              .y = {.name = "mean error E6",
                                                    .unit = "%",
                                                    .low = 0.9 * least,
                                                    .high = worst_shown * least}});
    }
    free(all);
    free_curves(&set);
    return status;
}

static gonio_status draw_grid(drawer *d)
{
    const gonio_status status = draw_map(d);
    return status == GONIO_OK ? draw_lines(d) : status;
}

/* ---- Fig. 3(b) ---- */

/* The curve of a method's label; a new one if there is none yet. */
static size_t curve_of(curve_set *set, size_t *used, const char *label)
{
    for (size_t k = 0; k < *used; k++) {
        if (strcmp(set->name[k], label) == 0) {
            return k;
        }
    }
    name_curve(set, *used, strdup(label));
    return (*used)++;
}

/* The standard deviation of a method's split means. */
static double deviation(const drawer *d, size_t method)
{
    const size_t splits = d->study->splits.count;
    double squares = 0.0;
    for (size_t s = 0; s < splits; s++) {
        squares += pow(d->findings->method_split[method * splits + s].value[GONIO_E6] -
                           d->findings->method[method].value[GONIO_E6],
                       2.0);
    }
    return splits > 1 ? sqrt(squares / (double)(splits - 1)) : 0.0;
}

static gonio_status draw_methods(drawer *d)
{
    const size_t count = gonio_i_methods(d->study);
    size_t used = 0;
    double least = HUGE_VAL;
    double most = 0.0;
    curve_set set;
    gonio_status status = make_curves(d->context, count, count, &set);
    if (status == GONIO_OK) {
        for (size_t m = 0; m < count; m++) {
            const gonio_i_method_entry *method = gonio_i_method_at(m);
            const gonio_i_size size = gonio_i_method_size(d->study, method);
            const double e6 = d->findings->method[m].value[GONIO_E6];
            const size_t curve = curve_of(&set, &used, method->label);
            least = fmin(least, (double)size.samples);
            most = fmax(most, (double)size.samples);
            add_point(&set, curve, (double)size.samples, e6);
            add_interval(&set, curve, e6 - deviation(d, m), e6 + deviation(d, m));
        }
        const size_t unused = set.count - used;
        set.count = used;
        status = draw_curves(d, &set,
                             (gonio_i_curves){.name = "fig3b",
                                              .x = {.name = "samples",
                                                    .logarithmic = most > 300,
                                                    .low = 0.8 * least,
                                                    .high = 1.1 * most},
                                              .y = e6_axis,
                                              .intervals = GONIO_I_ERROR_BARS,
                                              .apart = most > 300 ? 1.02 : 2.0});
        set.count = used + unused;
    }
    free_curves(&set);
    return status;
}

/* ---- Fig. 4 ---- */

static gonio_pair pair_of(const json_t *entry)
{
    double angle[4];
    for (size_t k = 0; k < 4; k++) {
        angle[k] = gonio_i_json_number(json_array_get(entry, 2 + k));
    }
    return (gonio_pair){{angle[0], angle[1]}, {angle[2], angle[3]}};
}

/* The first and the last of the chosen sizes, as in the paper. */
static gonio_status draw_directions(drawer *d)
{
    static const size_t shown[2] = {0, GONIO_I_CHOSEN - 1};
    gonio_i_panel panel[2];
    char *name[2] = {NULL, NULL};
    gonio_pair *pairs[2] = {NULL, NULL};
    gonio_status status = GONIO_OK;
    for (size_t p = 0; p < 2 && status == GONIO_OK; p++) {
        const gonio_i_size size = d->study->chosen[shown[p]];
        const json_t *entries =
            json_object_get(json_array_get(d->results->directions, shown[p]), "entries");
        const size_t count = json_array_size(entries);
        name[p] = gonio_i_format("%zu samples, %zu components", size.samples, size.components);
        pairs[p] = gonio_i_allocate(d->context, count, sizeof *pairs[p]);
        status = name[p] != NULL && pairs[p] != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
        for (size_t k = 0; k < count && status == GONIO_OK; k++) {
            pairs[p][k] = pair_of(json_array_get(entries, k));
        }
        panel[p] = (gonio_i_panel){name[p], count, pairs[p]};
    }
    if (status == GONIO_OK) {
        const gonio_i_directions figure = {
            .name = "fig4", .projection = GONIO_I_EQUAL_ANGLE, .count = 2, .panels = panel};
        status = gonio_i_figure_directions(d->context, &d->figures, &figure);
    }
    for (size_t p = 0; p < 2; p++) {
        free(name[p]);
        free(pairs[p]);
    }
    return status;
}

/* ---- Fig. 5 ---- */

static gonio_status draw_left_out_of(drawer *d, const char **material, double *values)
{
    const size_t count = d->study->left_out_count;
    gonio_i_series series[GONIO_I_LEFT_OUT_SERIES];
    char text[GONIO_I_LEFT_OUT_SERIES][32];
    double least = HUGE_VAL;
    double most = 0.0;
    for (size_t k = 0; k < count; k++) {
        material[k] = gonio_i_name_of(&d->study->collection, d->study->left_out[k]);
    }
    for (size_t s = 0; s < GONIO_I_LEFT_OUT_SERIES; s++) {
        for (size_t k = 0; k < count; k++) {
            const double e6 =
                d->findings->left_out[k * GONIO_I_LEFT_OUT_SERIES + s].value[GONIO_E6];
            values[s * count + k] = e6;
            least = fmin(least, e6);
            most = fmax(most, e6);
        }
        series[s] = (gonio_i_series){gonio_i_series_name(d->study, s, text[s]), values + s * count};
    }
    const gonio_i_categories figure = {.name = "fig5",
                                       .kind = "material",
                                       .y = {.name = "error E6",
                                             .unit = "%",
                                             .logarithmic = true,
                                             .low = 0.9 * least,
                                             .high = 1.1 * most},
                                       .categories = count,
                                       .category = material,
                                       .count = GONIO_I_LEFT_OUT_SERIES,
                                       .series = series,
                                       .sorted_by = GONIO_I_CHOSEN - 1};
    return gonio_i_figure_categories(d->context, &d->figures, &figure);
}

static gonio_status draw_left_out(drawer *d)
{
    const size_t count = d->study->left_out_count;
    const char **material = gonio_i_allocate(d->context, count, sizeof(char *));
    double *values = gonio_i_allocate(d->context, GONIO_I_LEFT_OUT_SERIES * count, sizeof *values);
    const gonio_status status = material != NULL && values != NULL
                                    ? draw_left_out_of(d, material, values)
                                    : GONIO_ERROR_MEMORY;
    free(material);
    free(values);
    return status;
}

static gonio_status draw_rendered(drawer *d)
{
    return gonio_i_draw_renderings(d->context, d->study, GONIO_I_RENDERED, d->results->rendered,
                                   d->figures.folder);
}

static gonio_status draw_lit(drawer *d)
{
    return gonio_i_draw_renderings(d->context, d->study, GONIO_I_LIT, d->results->lit,
                                   d->figures.folder);
}

/* ---- all ---- */

gonio_status gonio_i_draw(gonio_context *context, const gonio_i_study *study,
                          const gonio_i_results *results, const gonio_i_findings *findings,
                          const char *folder)
{
    static gonio_status (*const draw[GONIO_I_EXPERIMENTS])(drawer *) = {
        draw_spectrum,   draw_convergence, draw_grid,     draw_methods,
        draw_directions, draw_left_out,    draw_rendered, draw_lit};
    drawer d = {context, {.folder = folder}, study, results, findings};
    gonio_status status = GONIO_OK;
    for (int k = 0; k < GONIO_I_EXPERIMENTS && status == GONIO_OK; k++) {
        status = study->wanted[k] ? draw[k](&d) : GONIO_OK;
    }
    return status;
}
