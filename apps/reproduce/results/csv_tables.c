/* All raw numbers as CSV: see csv_tables.h. */
#include "csv_tables.h"

#include <math.h>
#include <stdlib.h>

#include "../experiments/renderings.h"
#include "../run/run_folder.h"
#include "../figures/figure_writer.h"
#include "../run/text_file.h"
#include "reported_errors.h"

typedef struct tables {
    const gonio_i_study *study;
    const gonio_i_results *results;
    const gonio_i_findings *findings;
} tables;

const char *gonio_i_series_name(const gonio_i_study *study, size_t series, char text[32])
{
    if (series == GONIO_I_ALL_SAMPLES) {
        return "all samples";
    }
    if (series == GONIO_I_BIVARIATE_ITSELF) {
        return "bivariate";
    }
    snprintf(text, 32, "%zu samples", study->chosen[series].samples);
    return text;
}

/* ---- cells ---- */

static void put_name(FILE *f, const gonio_i_study *study, size_t material)
{
    gonio_i_put_cell(f, gonio_i_name_of(&study->collection, material));
    fputc(',', f);
}

/* A line for each test material of a split; `start` begins each. */
static void put_tests(FILE *f, const gonio_i_study *study, size_t split, const char *start,
                      double condition, const json_t *errors)
{
    for (size_t k = 0; k < json_array_size(errors); k++) {
        fputs(start, f);
        put_name(f, study, study->splits.split[split].test[k]);
        gonio_i_put_number(f, condition);
        fputc(',', f);
        gonio_i_put_error(f, gonio_i_json_error(json_array_get(errors, k)));
    }
}

/* ---- tables ---- */

static void put_splits(const tables *t, FILE *f)
{
    fputs("split,part,material\n", f);
    for (size_t s = 0; s < t->study->splits.count; s++) {
        const gonio_i_split *split = &t->study->splits.split[s];
        for (size_t k = 0; k < split->basis_count + split->test_count; k++) {
            const bool basis = k < split->basis_count;
            fprintf(f, "%zu,%s,", s + 1, basis ? "basis" : "test");
            gonio_i_put_cell(
                f, gonio_i_name_of(&t->study->collection,
                                   basis ? split->basis[k] : split->test[k - split->basis_count]));
            fputc('\n', f);
        }
    }
}

static void put_bivariate(const tables *t, FILE *f)
{
    fputs("material,", f);
    gonio_i_put_error_columns(f);
    for (size_t m = 0; m < t->study->collection.count; m++) {
        put_name(f, t->study, m);
        gonio_i_put_error(f, t->findings->bivariate[m]);
    }
}

static void put_variances(FILE *f, const char *of, const json_t *variances)
{
    double total = 0.0;
    double sum = 0.0;
    for (size_t k = 0; k < json_array_size(variances); k++) {
        total += gonio_i_json_number(json_array_get(variances, k));
    }
    for (size_t k = 0; k < json_array_size(variances); k++) {
        const double variance = gonio_i_json_number(json_array_get(variances, k));
        sum += variance;
        fprintf(f, "%s,%zu,", of, k + 1);
        gonio_i_put_number(f, variance);
        fputc(',', f);
        gonio_i_put_number(f, sum / total);
        fputc('\n', f);
    }
}

static void put_spectrum(const tables *t, FILE *f)
{
    const json_t *splits = json_object_get(t->results->spectrum, "splits");
    fputs("basis_of,component,variance,cumulative\n", f);
    put_variances(f, "all", json_object_get(t->results->spectrum, "all"));
    for (size_t s = 0; s < json_array_size(splits); s++) {
        char name[32];
        snprintf(name, sizeof name, "split %zu", s + 1);
        put_variances(f, name, json_array_get(splits, s));
    }
}

static void put_convergence(const tables *t, FILE *f)
{
    const json_t *starts = json_object_get(t->results->convergence, "starts");
    fputs("start,swap,condition_number\n", f);
    for (size_t s = 0; s < json_array_size(starts); s++) {
        const json_t *steps = json_array_get(starts, s);
        for (size_t k = 0; k < json_array_size(steps); k++) {
            fprintf(f, "%zu,%zu,", s + 1, k);
            gonio_i_put_number(f, gonio_i_json_number(json_array_get(steps, k)));
            fputc('\n', f);
        }
    }
}

static void put_grid_line(const tables *t, FILE *f, size_t split, size_t k)
{
    const json_t *piece = json_array_get(json_array_get(t->results->grid, split), k);
    char start[96];
    for (size_t l = 0; l < t->study->grid_samples; l++) {
        snprintf(start, sizeof start, "%zu,%zu,%zu,", split + 1, t->study->grid_component[k],
                 t->study->grid_sample[l]);
        put_tests(f, t->study, split, start,
                  gonio_i_json_number(json_array_get(json_object_get(piece, "condition"), l)),
                  json_array_get(json_object_get(piece, "errors"), l));
    }
    snprintf(start, sizeof start, "%zu,%zu,all,", split + 1, t->study->grid_component[k]);
    put_tests(f, t->study, split, start, 1.0, json_object_get(piece, "all"));
}

static void put_grid(const tables *t, FILE *f)
{
    fputs("split,components,samples,material,condition_number,", f);
    gonio_i_put_error_columns(f);
    for (size_t s = 0; s < t->study->splits.count; s++) {
        for (size_t k = 0; k < t->study->grid_components; k++) {
            put_grid_line(t, f, s, k);
        }
    }
}

static void put_grid_means(const tables *t, FILE *f)
{
    const gonio_i_study *study = t->study;
    fputs("components,samples,condition_number,", f);
    gonio_i_put_error_columns(f);
    for (size_t k = 0; k < study->grid_components; k++) {
        for (size_t l = 0; l < study->grid_samples; l++) {
            const size_t at = k * study->grid_samples + l;
            if (study->grid_sample[l] >= study->grid_component[k]) {
                fprintf(f, "%zu,%zu,", study->grid_component[k], study->grid_sample[l]);
                gonio_i_put_number(f, t->findings->grid_condition[at]);
                fputc(',', f);
                gonio_i_put_error(f, t->findings->grid[at]);
            }
        }
        fprintf(f, "%zu,all,1,", study->grid_component[k]);
        gonio_i_put_error(f, t->findings->limit[k]);
    }
}

static void put_methods(const tables *t, FILE *f)
{
    fputs("method,components,samples,split,material,condition_number,", f);
    gonio_i_put_error_columns(f);
    for (size_t m = 0; m < gonio_i_methods(t->study); m++) {
        const gonio_i_method_entry *method = gonio_i_method_at(m);
        const gonio_i_size size = gonio_i_method_size(t->study, method);
        for (size_t s = 0; s < t->study->splits.count; s++) {
            const json_t *piece = json_array_get(json_array_get(t->results->methods, s), m);
            char start[160];
            snprintf(start, sizeof start, "%s,%zu,%zu,%zu,", method->label, size.components,
                     size.samples, s + 1);
            put_tests(f, t->study, s, start,
                      gonio_i_json_number(json_object_get(piece, "condition")),
                      json_object_get(piece, "errors"));
        }
    }
}

static void put_direction(FILE *f, const json_t *entry)
{
    fprintf(f, "%d,%c", (int)json_integer_value(json_array_get(entry, 0)),
            "RGB"[json_integer_value(json_array_get(entry, 1))]);
    for (size_t k = 2; k < 6; k++) {
        fprintf(f, ",%.9f", gonio_i_json_number(json_array_get(entry, k)) * 180.0 / M_PI);
    }
    fputc('\n', f);
}

static void put_directions(const tables *t, FILE *f)
{
    fputs("components,samples,cell,channel,theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n", f);
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        const json_t *entries =
            json_object_get(json_array_get(t->results->directions, c), "entries");
        for (size_t k = 0; k < json_array_size(entries); k++) {
            fprintf(f, "%zu,%zu,", t->study->chosen[c].components, t->study->chosen[c].samples);
            put_direction(f, json_array_get(entries, k));
        }
    }
}

static void put_left_out(const tables *t, FILE *f)
{
    fputs("material,reconstructed_from,components,condition_number,", f);
    gonio_i_put_error_columns(f);
    for (size_t k = 0; k < t->study->left_out_count; k++) {
        const json_t *conditions =
            json_object_get(json_array_get(t->results->left_out, k), "condition");
        for (size_t s = 0; s < GONIO_I_LEFT_OUT_SERIES; s++) {
            char text[32];
            const size_t size = s < GONIO_I_CHOSEN ? s : GONIO_I_CHOSEN - 1;
            put_name(f, t->study, t->study->left_out[k]);
            fprintf(f, "%s,", gonio_i_series_name(t->study, s, text));
            if (s != GONIO_I_BIVARIATE_ITSELF) {
                fprintf(f, "%zu", t->study->chosen[size].components);
            }
            fputc(',', f);
            if (s < GONIO_I_CHOSEN) {
                gonio_i_put_number(f, gonio_i_json_number(json_array_get(conditions, s)));
            }
            fputc(',', f);
            gonio_i_put_error(f, t->findings->left_out[k * GONIO_I_LEFT_OUT_SERIES + s]);
        }
    }
    const gonio_i_size size = gonio_i_quoted_size(t->study->collection.count - 1);
    for (size_t q = 0; q < t->study->quoted_count; q++) {
        put_name(f, t->study, t->study->quoted[q].material);
        fprintf(f, "%s,%zu,", gonio_i_quoted_method()->name, size.components);
        gonio_i_put_number(f, gonio_i_json_number(json_object_get(
                                  json_array_get(t->results->quoted, q), "condition")));
        fputc(',', f);
        gonio_i_put_error(f, t->findings->quoted[q]);
    }
}

static void put_rendered(const tables *t, FILE *f)
{
    gonio_i_put_renderings(f, t->study, GONIO_I_RENDERED, t->results->rendered);
}

static void put_lit(const tables *t, FILE *f)
{
    gonio_i_put_renderings(f, t->study, GONIO_I_LIT, t->results->lit);
}

/* ---- files ---- */

static const struct {
    const char *name;
    int experiment; /* -1: always */
    void (*put)(const tables *t, FILE *f);
} files[] = {
    {"splits.csv", -1, put_splits},
    {"bivariate.csv", -1, put_bivariate},
    {"fig2a.csv", GONIO_I_SPECTRUM, put_spectrum},
    {"fig2b.csv", GONIO_I_CONVERGENCE, put_convergence},
    {"fig3a.csv", GONIO_I_GRID, put_grid},
    {"fig3a-means.csv", GONIO_I_GRID, put_grid_means},
    {"fig3b.csv", GONIO_I_METHODS, put_methods},
    {"fig4.csv", GONIO_I_DIRECTIONS, put_directions},
    {"fig5.csv", GONIO_I_LEFT_OUT, put_left_out},
    {"fig6.csv", GONIO_I_RENDERED, put_rendered},
    {"fig7.csv", GONIO_I_LIT, put_lit},
};

gonio_status gonio_i_write_tables(gonio_context *context, const gonio_i_study *study,
                                  const gonio_i_results *results, const gonio_i_findings *findings,
                                  const char *folder)
{
    const tables t = {study, results, findings};
    gonio_status status = gonio_i_make_folder(context, folder);
    for (size_t k = 0; k < sizeof files / sizeof *files && status == GONIO_OK; k++) {
        gonio_i_text text;
        if (files[k].experiment >= 0 && !study->wanted[files[k].experiment]) {
            continue;
        }
        status = gonio_i_text_begin(context, &text);
        if (status == GONIO_OK) {
            files[k].put(&t, text.stream);
            status = gonio_i_text_end(context, &text, folder, files[k].name, GONIO_OK);
        }
    }
    return status;
}
