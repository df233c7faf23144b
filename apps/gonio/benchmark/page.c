/* The page of a benchmark: see page.h. */
#include "page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "curves.h"
#include "run/text_file.h"
#include "core/core.h"

typedef struct page {
    FILE *f;
    const benchmark_setting *setting;
    const benchmark_rows *rows;
    const benchmark_summary *summary;
} page;

static void put(FILE *f, double value, int digits)
{
    if (isfinite(value)) {
        fprintf(f, " %.*f |", digits, value);
    } else {
        fputs(" |", f);
    }
}

static void put_headings(FILE *f, const char *first, const char *const *words, size_t count)
{
    fprintf(f, "\n| %s |", first);
    for (size_t k = 0; k < count; k++) {
        fprintf(f, " %s |", words[k]);
    }
    fputs("\n| --- |", f);
    for (size_t k = 0; k < count; k++) {
        fputs(" --- |", f);
    }
    fputc('\n', f);
}

/* ---- the setting ---- */

static void put_setting(const page *p)
{
    const benchmark_setting *s = p->setting;
    fputs("# Benchmark\n\n"
          "BRDFs from n readings. docs/benchmark.md states the rules. tables/trials.csv has every "
          "trial, tables/means.csv and results.json all means.\n\n",
          p->f);
    if (s->candidates > 0) {
        fprintf(p->f,
                "- Tables: directions among %zu random ones, both polar angles below %g degrees; "
                "errors over the bins below.\n",
                s->candidates, s->reach * 180.0 / M_PI);
    } else {
        fprintf(p->f, "- Tables: any directions; errors over the bins below %g degrees.\n",
                s->reach * 180.0 / M_PI);
    }
    fputs("- Scattered readings: directions among the file's own, the others predicted.\n", p->f);
    if (s->noise > 0.0 || s->floor > 0.0 || s->outliers > 0.0) {
        fprintf(p->f,
                "- Readings of tables: noise %g %%, floor %g 1/sr, %g %% of directions wrong.\n",
                100.0 * s->noise, s->floor, 100.0 * s->outliers);
    }
}

/* ---- errors by n ---- */

static const benchmark_mean *find_mean(const benchmark_summary *summary, const benchmark_mean *like,
                                       size_t n)
{
    const benchmark_mean *found = NULL;
    for (size_t k = 0; k < summary->count && found == NULL; k++) {
        const benchmark_mean *m = &summary->mean[k];
        if (m->set == like->set && m->ways == like->ways && m->n == n &&
            strcmp(m->method, like->method) == 0) {
            found = m;
        }
    }
    return found;
}

/* The first mean of each set, way and method stands for its row. */
static bool begins_row(const benchmark_summary *summary, size_t k)
{
    const benchmark_mean *m = &summary->mean[k];
    const benchmark_mean *before = k > 0 ? m - 1 : NULL;
    return before == NULL || before->set != m->set || before->ways != m->ways ||
           strcmp(before->method, m->method) != 0;
}

static void put_line(const page *p, const benchmark_mean *like,
                     void (*put_mean)(FILE *f, const benchmark_mean *m))
{
    fprintf(p->f, "| %s, %s |", like->ways->name, like->method);
    for (size_t k = 0; k < p->setting->sizes; k++) {
        const benchmark_mean *m = find_mean(p->summary, like, p->setting->size[k]);
        if (m != NULL && m->failed < m->rows) {
            put_mean(p->f, m);
        } else {
            fputs(" |", p->f);
        }
    }
    fputc('\n', p->f);
}

/* A table with a line for each way and method, a column for each n. */
static void put_table(const page *p, const char *set, bool (*shown)(const benchmark_mean *m),
                      void (*put_mean)(FILE *f, const benchmark_mean *m))
{
    char text[BENCHMARK_MOST_SIZES][24];
    const char *words[BENCHMARK_MOST_SIZES];
    for (size_t k = 0; k < p->setting->sizes; k++) {
        snprintf(text[k], sizeof text[k], "%zu", p->setting->size[k]);
        words[k] = text[k];
    }
    put_headings(p->f, "directions, method", words, p->setting->sizes);
    for (size_t k = 0; k < p->summary->count; k++) {
        const benchmark_mean *m = &p->summary->mean[k];
        if (m->set == set && begins_row(p->summary, k) && shown(m)) {
            put_line(p, m, put_mean);
        }
    }
}

static bool any_mean(const benchmark_mean *m)
{
    (void)m;
    return true;
}

static bool is_not_simple(const benchmark_mean *m)
{
    return !m->simple;
}

static void put_errors(FILE *f, const benchmark_mean *m)
{
    fprintf(f, " %.2f / %.1f / %.3f |", m->error.value[GONIO_E6], m->error.value[GONIO_CUBE_ROOT],
            m->error.value[GONIO_LOG_RELATIVE_ERROR]);
}

static void put_rendered(FILE *f, const benchmark_mean *m)
{
    if (isfinite(m->psnr)) {
        fprintf(f, " %.1f / %.2f |", m->psnr, m->delta_e_itp);
    } else {
        fputs(" |", f);
    }
}

static void put_lost(FILE *f, const benchmark_mean *m)
{
    if (isfinite(m->lost_any)) {
        fprintf(f, " %.0f / %.0f |", 100.0 * m->lost_any, 100.0 * m->lost_all);
    } else {
        fputs(" |", f);
    }
}

static void put_honesty(FILE *f, const benchmark_mean *m)
{
    if (m->expected.rows == 0) {
        fputs(" |", f);
        return;
    }
    fprintf(f, " %.2f / %.0f", m->expected.ratio, 100.0 * m->expected.within);
    fprintf(f, isfinite(m->expected.correlation) ? " / %.2f" : " / -", m->expected.correlation);
    fprintf(f, isfinite(m->inside) ? " / %.0f |" : " / - |", 100.0 * m->inside);
}

static void put_repeated(FILE *f, const benchmark_mean *m)
{
    if (isfinite(m->worse_repeated)) {
        fprintf(f, " %.0f |", 100.0 * m->worse_repeated);
    } else {
        fputs(" |", f);
    }
}

static bool is_repeated(const benchmark_mean *m)
{
    return isfinite(m->worse_repeated);
}

static bool any_repeated(const page *p, const char *set)
{
    bool any = false;
    for (size_t k = 0; k < p->summary->count; k++) {
        any = any || (p->summary->mean[k].set == set && is_repeated(&p->summary->mean[k]));
    }
    return any;
}

static bool any_rendered(const page *p, const char *set)
{
    bool any = false;
    for (size_t k = 0; k < p->summary->count; k++) {
        any = any || (p->summary->mean[k].set == set && isfinite(p->summary->mean[k].psnr));
    }
    return any;
}

/* ---- materials ---- */

/* The n of the list of materials: 40 or the next smaller one. */
static size_t shown_size(const benchmark_setting *s)
{
    size_t shown = s->size[0];
    for (size_t k = 0; k < s->sizes; k++) {
        shown = s->size[k] <= 40 ? s->size[k] : shown;
    }
    return shown;
}

/* The mean E6 of a subject over draws and lessons; NaN for none. */
static double subject_e6(const page *p, const benchmark_subject *subject,
                         const benchmark_mean *like, size_t n)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t k = 0; k < p->rows->count; k++) {
        const benchmark_row *r = &p->rows->row[k];
        if (r->subject == subject && r->ways == like->ways && r->n == n &&
            strcmp(r->method, like->method) == 0 && !isnan(r->error.value[GONIO_E6])) {
            sum += r->error.value[GONIO_E6];
            count++;
        }
    }
    return count > 0 ? sum / (double)count : NAN;
}

static bool is_first_of_subject(const benchmark_rows *rows, size_t k)
{
    bool first = true;
    for (size_t i = 0; i < k && first; i++) {
        first = rows->row[i].subject != rows->row[k].subject;
    }
    return first;
}

static void put_subject(const page *p, const benchmark_subject *subject, const char *set, size_t n)
{
    fprintf(p->f, "| %s |", subject->name);
    for (size_t i = 0; i < p->summary->count; i++) {
        if (p->summary->mean[i].set == set && begins_row(p->summary, i)) {
            put(p->f, subject_e6(p, subject, &p->summary->mean[i], n), 2);
        }
    }
    fputc('\n', p->f);
}

enum { MOST_COLUMNS = 64 };

static void put_subjects(const page *p, const char *set)
{
    const size_t n = shown_size(p->setting);
    char text[MOST_COLUMNS][64];
    const char *words[MOST_COLUMNS];
    size_t count = 0;
    for (size_t k = 0; k < p->summary->count && count < MOST_COLUMNS; k++) {
        const benchmark_mean *m = &p->summary->mean[k];
        if (m->set == set && begins_row(p->summary, k)) {
            snprintf(text[count], sizeof text[count], "%s, %s", m->ways->name, m->method);
            words[count] = text[count];
            count++;
        }
    }
    fprintf(p->f, "\nE6 %% of each material from %zu directions:\n", n);
    put_headings(p->f, "material", words, count);
    for (size_t k = 0; k < p->rows->count; k++) {
        const benchmark_subject *subject = p->rows->row[k].subject;
        if (strcmp(subject->set, set) == 0 && is_first_of_subject(p->rows, k)) {
            put_subject(p, subject, set, n);
        }
    }
}

/* ---- the page ---- */

static void put_set(const page *p, size_t number)
{
    const char *set = p->summary->set[number];
    fprintf(p->f, "\n## %s\n\n", set);
    if (benchmark_has_curves(p->summary)) {
        fprintf(p->f, "![E6 against directions](figures/e6-%zu.png)\n\n", number + 1);
    }
    fputs("Mean E6 % / cube-root error % / log-relative error, by directions read:\n", p->f);
    put_table(p, set, any_mean, put_errors);
    fputs("\nTrue over expected E6, share within a factor of 2 in per cent, correlation of their "
          "logarithms, share of true values inside the 95 % bands in per cent:\n",
          p->f);
    put_table(p, set, is_not_simple, put_honesty);
    fputs("\nTrials lost to a simple method / to all of them, per cent:\n", p->f);
    put_table(p, set, is_not_simple, put_lost);
    if (any_repeated(p, set)) {
        fputs("\nTrials that a repeated direction makes worse, per cent:\n", p->f);
        put_table(p, set, is_repeated, put_repeated);
    }
    if (any_rendered(p, set)) {
        fputs("\nRendered, PSNR dB / mean Delta E_ITP:\n", p->f);
        put_table(p, set, any_mean, put_rendered);
    }
    if (set != benchmark_all_sets) {
        put_subjects(p, set);
    }
}

gonio_status benchmark_write_page(gonio_context *context, const benchmark_setting *setting,
                                  const benchmark_rows *rows, const benchmark_summary *summary,
                                  const char *folder)
{
    gonio_i_text text;
    gonio_status status = benchmark_draw_curves(context, summary, folder);
    if (status == GONIO_OK) {
        status = gonio_i_text_begin(context, &text);
    }
    if (status != GONIO_OK) {
        return status;
    }
    const page p = {text.stream, setting, rows, summary};
    put_setting(&p);
    for (size_t k = 0; k < summary->sets; k++) {
        put_set(&p, k);
    }
    return gonio_i_text_end(context, &text, folder, "report.md", GONIO_OK);
}
