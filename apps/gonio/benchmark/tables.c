/* The numbers of a benchmark as files: see tables.h. */
#include "tables.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "figures/figure_writer.h"
#include "run/run_folder.h"
#include "run/text_file.h"
#include "core/core.h"

/* What a table is made of. */
typedef struct content {
    const benchmark_rows *rows;
    const benchmark_summary *summary;
} content;

static void put_text(FILE *f, const char *text)
{
    gonio_i_put_cell(f, text);
    fputc(',', f);
}

static void put(FILE *f, double value)
{
    fputc(',', f);
    if (isfinite(value)) {
        gonio_i_put_number(f, value);
    }
}

static void put_metric_names(FILE *f)
{
    const gonio_metric_view *metric = NULL;
    for (int m = 0; (metric = gonio_metric_describe(m)) != NULL; m++) {
        fprintf(f, ",%s", metric->key);
    }
}

static void put_errors(FILE *f, const gonio_error *error)
{
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        put(f, error->value[m]);
    }
}

/* ---- rows ---- */

static void put_row_start(FILE *f, const benchmark_row *r)
{
    put_text(f, r->subject->set);
    put_text(f, r->subject->name);
    put_text(f, r->lesson->name);
    put_text(f, r->ways->name);
    put_text(f, r->method);
    fprintf(f, "%zu,%zu", r->draw, r->n);
}

static const char row_start[] = "set,material,learned_from,directions,method,draw,n";

static void put_trials(const content *c, FILE *f)
{
    fprintf(f, "%s,read,compared", row_start);
    put_metric_names(f);
    fputs(",expected_e6_percent,expected_here_percent,inside_95,psnr_db,delta_e_itp\n", f);
    for (size_t k = 0; k < c->rows->count; k++) {
        const benchmark_row *r = &c->rows->row[k];
        put_row_start(f, r);
        fprintf(f, ",%zu,%zu", r->read, r->values);
        put_errors(f, &r->error);
        put(f, r->expected);
        put(f, r->expected_here);
        put(f, r->inside);
        put(f, r->psnr);
        put(f, r->delta_e_itp);
        fputc('\n', f);
    }
}

static void put_times(const content *c, FILE *f)
{
    fprintf(f, "%s,seconds\n", row_start);
    for (size_t k = 0; k < c->rows->count; k++) {
        put_row_start(f, &c->rows->row[k]);
        put(f, c->rows->row[k].seconds);
        fputc('\n', f);
    }
}

/* ---- means ---- */

static void put_honesty(FILE *f, const benchmark_honesty *h)
{
    put(f, h->ratio);
    put(f, h->within);
    put(f, h->correlation);
}

static void put_means(const content *c, FILE *f)
{
    fputs("set,directions,method,n,trials,failed", f);
    put_metric_names(f);
    fputs(",worst_e6_percent,inside_95,psnr_db,delta_e_itp,true_by_expected,within_2_expected,"
          "correlation_expected,true_by_expected_here,within_2_expected_here,"
          "correlation_expected_here,lost_to_a_simple_method,lost_to_all_simple_methods,worse_if_"
          "repeated\n",
          f);
    for (size_t k = 0; k < c->summary->count; k++) {
        const benchmark_mean *m = &c->summary->mean[k];
        put_text(f, m->set);
        put_text(f, m->ways->name);
        put_text(f, m->method);
        fprintf(f, "%zu,%zu,%zu", m->n, m->rows, m->failed);
        put_errors(f, &m->error);
        put(f, m->worst_e6);
        put(f, m->inside);
        put(f, m->psnr);
        put(f, m->delta_e_itp);
        put_honesty(f, &m->expected);
        put_honesty(f, &m->here);
        put(f, m->lost_any);
        put(f, m->lost_all);
        put(f, m->worse_repeated);
        fputc('\n', f);
    }
}

/* ---- JSON ---- */

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *honesty_json(const benchmark_honesty *h)
{
    return json_pack("{s:I, s:o, s:o, s:o}", "trials", (json_int_t)h->rows, "true_by_stated",
                     number(h->ratio), "within_2", number(h->within), "correlation",
                     number(h->correlation));
}

static json_t *mean_json(const benchmark_mean *m)
{
    json_t *errors = json_object();
    const gonio_metric_view *metric = NULL;
    for (int i = 0; (metric = gonio_metric_describe(i)) != NULL; i++) {
        json_object_set_new(errors, metric->key, number(m->error.value[i]));
    }
    return json_pack(
        "{s:s, s:s, s:s, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "set",
        m->set, "directions", m->ways->name, "method", m->method, "n", (json_int_t)m->n, "trials",
        (json_int_t)m->rows, "failed", (json_int_t)m->failed, "errors", errors, "worst_e6_percent",
        number(m->worst_e6), "inside_95", number(m->inside), "psnr_db", number(m->psnr),
        "delta_e_itp", number(m->delta_e_itp), "expected", honesty_json(&m->expected),
        "expected_here", honesty_json(&m->here), "lost_to_a_simple_method", number(m->lost_any),
        "lost_to_all_simple_methods", number(m->lost_all), "worse_if_repeated",
        number(m->worse_repeated));
}

static gonio_status write_json(gonio_context *context, const benchmark_setting *setting,
                               const benchmark_summary *summary, const char *folder)
{
    json_t *means = json_array();
    for (size_t k = 0; k < summary->count; k++) {
        json_array_append_new(means, mean_json(&summary->mean[k]));
    }
    json_t *whole = json_pack(
        "{s:s, s:o, s:o}", "gonio", gonio_version(), "setting",
        json_pack("{s:I, s:f, s:I, s:f, s:f, s:f, s:I, s:I}", "candidates",
                  (json_int_t)setting->candidates, "reach_deg", setting->reach * 180.0 / M_PI,
                  "draws", (json_int_t)setting->draws, "noise", setting->noise, "floor_per_sr",
                  setting->floor, "outliers", setting->outliers, "batch",
                  (json_int_t)setting->batch, "seed", (json_int_t)setting->seed),
        "means", means);
    char *text = json_dumps(whole, JSON_INDENT(1) | JSON_REAL_PRECISION(10));
    char *path = gonio_i_format("%s/results.json", folder);
    const gonio_status status = text != NULL && path != NULL
                                    ? gonio_i_write_text(context, path, text)
                                    : gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    free(text);
    free(path);
    json_decref(whole);
    return status;
}

/* ---- files ---- */

static const struct {
    const char *name;
    void (*put)(const content *c, FILE *f);
} files[] = {{"trials.csv", put_trials}, {"means.csv", put_means}, {"times.csv", put_times}};

static gonio_status write_files(gonio_context *context, const content *c, const char *folder)
{
    gonio_status status = gonio_i_make_folder(context, folder);
    for (size_t k = 0; k < sizeof files / sizeof *files && status == GONIO_OK; k++) {
        gonio_i_text text;
        status = gonio_i_text_begin(context, &text);
        if (status == GONIO_OK) {
            files[k].put(c, text.stream);
            status = gonio_i_text_end(context, &text, folder, files[k].name, GONIO_OK);
        }
    }
    return status;
}

gonio_status benchmark_write_tables(gonio_context *context, const benchmark_setting *setting,
                                    const benchmark_rows *rows, const benchmark_summary *summary,
                                    const char *folder)
{
    const content c = {rows, summary};
    char *tables = gonio_i_format("%s/tables", folder);
    gonio_status status = tables != NULL ? write_files(context, &c, tables) : GONIO_ERROR_MEMORY;
    free(tables);
    return status == GONIO_OK ? write_json(context, setting, summary, folder) : status;
}
