/* The means of the results: see summary.h. */
#include "summary.h"

#include <math.h>
#include <stdlib.h>

/* ---- means ---- */

static void add(gonio_error *sum, gonio_error error)
{
    for (int m = 0; m < GONIO_MOST_METRICS; m++) {
        sum->value[m] += error.value[m];
    }
}

static gonio_error divided(gonio_error sum, size_t count)
{
    for (int m = 0; m < GONIO_MOST_METRICS; m++) {
        sum.value[m] /= (double)count;
    }
    return sum;
}

/* Over an array of errors; NaN if there are none. */
static gonio_error mean_of(const json_t *errors)
{
    gonio_error sum = {0};
    const size_t count = json_array_size(errors);
    for (size_t k = 0; k < count; k++) {
        add(&sum, gonio_i_json_error(json_array_get(errors, k)));
    }
    return divided(sum, count);
}

/* ---- the experiments ---- */

static gonio_status find_bivariate(gonio_context *context, const gonio_i_study *study,
                                   gonio_i_findings *f)
{
    const gonio_i_collection *c = &study->collection;
    gonio_status status = GONIO_OK;
    gonio_error sum = {0};
    f->bivariate = gonio_i_allocate(context, c->count, sizeof *f->bivariate);
    if (f->bivariate == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t m = 0; m < c->count && status == GONIO_OK; m++) {
        status = gonio_i_digest_compare(context, c->digest[m], c->mean[m], &f->bivariate[m]);
        add(&sum, f->bivariate[m]);
    }
    f->bivariate_mean = divided(sum, c->count);
    return status;
}

static gonio_status find_spectrum(gonio_context *context, const json_t *spectrum,
                                  gonio_i_findings *f)
{
    const json_t *variances = json_object_get(spectrum, "all");
    double sum = 0.0;
    f->cumulative_count = json_array_size(variances);
    f->cumulative = gonio_i_allocate(context, f->cumulative_count, sizeof *f->cumulative);
    if (f->cumulative == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < f->cumulative_count; k++) {
        sum += gonio_i_json_number(json_array_get(variances, k));
        f->cumulative[k] = sum;
    }
    for (size_t k = 0; k < f->cumulative_count; k++) {
        f->cumulative[k] /= sum;
    }
    return GONIO_OK;
}

/* Adds a split's piece with one number of components. */
static void add_grid_line(const gonio_i_study *study, const json_t *piece, size_t k,
                          gonio_i_findings *f)
{
    for (size_t l = 0; l < study->grid_samples; l++) {
        const size_t at = k * study->grid_samples + l;
        add(&f->grid[at], mean_of(json_array_get(json_object_get(piece, "errors"), l)));
        f->grid_condition[at] +=
            gonio_i_json_number(json_array_get(json_object_get(piece, "condition"), l));
    }
    add(&f->limit[k], mean_of(json_object_get(piece, "all")));
}

static gonio_status find_grid(gonio_context *context, const gonio_i_study *study,
                              const json_t *grid, gonio_i_findings *f)
{
    const size_t splits = study->splits.count;
    const size_t cells = study->grid_components * study->grid_samples;
    f->grid = gonio_i_allocate(context, cells, sizeof *f->grid);
    f->grid_condition = gonio_i_allocate(context, cells, sizeof *f->grid_condition);
    f->limit = gonio_i_allocate(context, study->grid_components, sizeof *f->limit);
    if (f->grid == NULL || f->grid_condition == NULL || f->limit == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < study->grid_components; k++) {
        for (size_t s = 0; s < splits; s++) {
            add_grid_line(study, json_array_get(json_array_get(grid, s), k), k, f);
        }
        f->limit[k] = divided(f->limit[k], splits);
    }
    for (size_t at = 0; at < cells; at++) {
        f->grid[at] = divided(f->grid[at], splits);
        f->grid_condition[at] /= (double)splits;
    }
    return GONIO_OK;
}

static gonio_status find_methods(gonio_context *context, const gonio_i_study *study,
                                 const json_t *methods, gonio_i_findings *f)
{
    const size_t splits = study->splits.count;
    const size_t count = gonio_i_methods(study);
    f->method = gonio_i_allocate(context, count, sizeof *f->method);
    f->method_split = gonio_i_allocate(context, count * splits, sizeof *f->method_split);
    f->method_condition = gonio_i_allocate(context, count, sizeof *f->method_condition);
    if (f->method == NULL || f->method_split == NULL || f->method_condition == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t m = 0; m < count; m++) {
        for (size_t s = 0; s < splits; s++) {
            const json_t *piece = json_array_get(json_array_get(methods, s), m);
            f->method_split[m * splits + s] = mean_of(json_object_get(piece, "errors"));
            add(&f->method[m], f->method_split[m * splits + s]);
            f->method_condition[m] +=
                gonio_i_json_number(json_object_get(piece, "condition")) / (double)splits;
        }
        f->method[m] = divided(f->method[m], splits);
    }
    return GONIO_OK;
}

static gonio_status find_left_out(gonio_context *context, const gonio_i_study *study,
                                  const json_t *left_out, gonio_i_findings *f)
{
    const size_t count = study->left_out_count;
    f->left_out = gonio_i_allocate(context, count * GONIO_I_LEFT_OUT_SERIES, sizeof *f->left_out);
    if (f->left_out == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t series = 0; series < GONIO_I_LEFT_OUT_SERIES; series++) {
        for (size_t k = 0; k < count; k++) {
            gonio_error *error = &f->left_out[k * GONIO_I_LEFT_OUT_SERIES + series];
            *error = gonio_i_json_error(
                json_array_get(json_object_get(json_array_get(left_out, k), "errors"), series));
            add(&f->left_out_mean[series], *error);
        }
        f->left_out_mean[series] = divided(f->left_out_mean[series], count);
    }
    return GONIO_OK;
}

/* ---- all ---- */

gonio_status gonio_i_find(gonio_context *context, const gonio_i_study *study,
                          const gonio_i_results *results, gonio_i_findings *findings)
{
    *findings = (gonio_i_findings){0};
    gonio_status status = find_bivariate(context, study, findings);
    if (status == GONIO_OK && results->spectrum != NULL) {
        status = find_spectrum(context, results->spectrum, findings);
    }
    if (status == GONIO_OK && results->grid != NULL) {
        status = find_grid(context, study, results->grid, findings);
    }
    if (status == GONIO_OK && results->methods != NULL) {
        status = find_methods(context, study, results->methods, findings);
    }
    if (status == GONIO_OK && results->left_out != NULL) {
        status = find_left_out(context, study, results->left_out, findings);
    }
    for (size_t q = 0; q < json_array_size(results->quoted); q++) {
        findings->quoted[q] =
            gonio_i_json_error(json_object_get(json_array_get(results->quoted, q), "error"));
    }
    return status;
}

void gonio_i_findings_free(gonio_i_findings *findings)
{
    free(findings->bivariate);
    free(findings->cumulative);
    free(findings->grid);
    free(findings->grid_condition);
    free(findings->limit);
    free(findings->method_split);
    free(findings->method);
    free(findings->method_condition);
    free(findings->left_out);
    *findings = (gonio_i_findings){0};
}

double gonio_i_grid_e6(const gonio_i_study *study, const gonio_i_findings *findings,
                       size_t components, size_t samples)
{
    for (size_t k = 0; findings->grid != NULL && k < study->grid_components; k++) {
        for (size_t l = 0; l < study->grid_samples; l++) {
            if (study->grid_component[k] == components && study->grid_sample[l] == samples) {
                return findings->grid[k * study->grid_samples + l].value[GONIO_E6];
            }
        }
    }
    return NAN;
}
