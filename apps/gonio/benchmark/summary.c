/* Means of what the trials found: see summary.h. */
#include "summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/core.h"

const char benchmark_all_sets[] = "all";

void benchmark_summary_free(benchmark_summary *summary)
{
    free(summary->mean);
    free(summary->set);
    *summary = (benchmark_summary){0};
}

/* ---- which means there are ---- */

static gonio_status list_sets(gonio_context *context, const benchmark_rows *rows,
                              benchmark_summary *summary)
{
    summary->set = gonio_i_allocate(context, rows->count + 2, sizeof *summary->set);
    if (summary->set == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < rows->count; k++) {
        bool known = false;
        for (size_t i = 0; i < summary->sets; i++) {
            known = known || strcmp(summary->set[i], rows->row[k].subject->set) == 0;
        }
        if (!known) {
            summary->set[summary->sets++] = rows->row[k].subject->set;
        }
    }
    if (summary->sets > 1) {
        summary->set[summary->sets++] = benchmark_all_sets;
    }
    return GONIO_OK;
}

static bool is_of(const benchmark_mean *m, const benchmark_row *row)
{
    return (m->set == benchmark_all_sets || strcmp(m->set, row->subject->set) == 0) &&
           m->ways == row->ways && m->n == row->n && strcmp(m->method, row->method) == 0;
}

static void add_mean(const benchmark_row *row, const char *set, benchmark_summary *summary)
{
    const benchmark_mean new = {
        .set = set, .ways = row->ways, .method = row->method, .simple = row->simple, .n = row->n};
    if (set != benchmark_all_sets && strcmp(set, row->subject->set) != 0) {
        return;
    }
    for (size_t k = 0; k < summary->count; k++) {
        if (summary->mean[k].set == set && is_of(&summary->mean[k], row)) {
            return;
        }
    }
    summary->mean[summary->count++] = new;
}

/* By way, simple methods last, n; equal places keep their order by `place`. */
static int compare_means(const void *a, const void *b)
{
    const benchmark_mean *p = a;
    const benchmark_mean *q = b;
    if (p->ways != q->ways) {
        return p->ways < q->ways ? -1 : 1;
    }
    if (p->simple != q->simple) {
        return p->simple ? 1 : -1;
    }
    const int methods = strcmp(p->method, q->method);
    return methods != 0 ? methods : (p->n > q->n) - (p->n < q->n);
}

/* At most a mean a row and set. */
static gonio_status list_means(gonio_context *context, const benchmark_rows *rows,
                               benchmark_summary *summary)
{
    summary->mean = gonio_i_allocate(context, 2 * rows->count + 1, sizeof *summary->mean);
    if (summary->mean == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t s = 0; s < summary->sets; s++) {
        const size_t first = summary->count;
        for (size_t k = 0; k < rows->count; k++) {
            add_mean(&rows->row[k], summary->set[s], summary);
        }
        qsort(summary->mean + first, summary->count - first, sizeof *summary->mean, compare_means);
    }
    return GONIO_OK;
}

/* ---- sums ---- */

/* A mean while numbers are added; NaN does not count. */
typedef struct average {
    double sum;
    size_t count;
} average;

static void add(average *a, double value)
{
    if (!isnan(value)) {
        a->sum += value;
        a->count++;
    }
}

static double mean_of(const average *a)
{
    return a->count > 0 ? a->sum / (double)a->count : NAN;
}

/* Sums over logarithms of stated (x) and true (y) errors. */
typedef struct pairs {
    size_t count, within;
    double x, y, xx, yy, xy;
} pairs;

static void add_pair(pairs *p, double stated, double true_error)
{
    if (!(stated > 0.0 && true_error > 0.0)) {
        return;
    }
    const double x = log(stated);
    const double y = log(true_error);
    p->count++;
    p->within += fabs(y - x) <= M_LN2;
    p->x += x;
    p->y += y;
    p->xx += x * x;
    p->yy += y * y;
    p->xy += x * y;
}

static benchmark_honesty honesty_of(const pairs *p)
{
    const double n = (double)p->count;
    const double vx = n * p->xx - p->x * p->x;
    const double vy = n * p->yy - p->y * p->y;
    if (p->count == 0) {
        return (benchmark_honesty){0, NAN, NAN, NAN};
    }
    return (benchmark_honesty){
        p->count, exp((p->y - p->x) / n), (double)p->within / n,
        p->count > 2 && vx > 0.0 && vy > 0.0 ? (n * p->xy - p->x * p->y) / sqrt(vx * vy) : NAN};
}

static bool same_readings(const benchmark_row *a, const benchmark_row *b)
{
    return a->subject == b->subject && a->lesson == b->lesson && a->ways == b->ways &&
           a->draw == b->draw && a->n == b->n;
}

/* Whether simple methods have smaller errors from the same readings as row k; rows of the same
 * readings are neighbours. False if there are no such methods. */
static bool find_losses(const benchmark_rows *rows, size_t k, bool *any, bool *all)
{
    const benchmark_row *row = &rows->row[k];
    size_t first = k;
    size_t simple = 0;
    size_t better = 0;
    while (first > 0 && same_readings(&rows->row[first - 1], row)) {
        first--;
    }
    for (size_t i = first; i < rows->count && same_readings(&rows->row[i], row); i++) {
        const double other = rows->row[i].error.value[GONIO_E6];
        if (rows->row[i].simple && !isnan(other)) {
            simple++;
            better += !(row->error.value[GONIO_E6] <= other);
        }
    }
    *any = better > 0;
    *all = better == simple;
    return simple > 0;
}

/* The E6 of the same method from the same directions, each read once; NaN if there is none. The
 * first n directions of a draw are the same for both ways. */
static double e6_read_once(const benchmark_rows *rows, const benchmark_row *repeated)
{
    const benchmark_directions *once = benchmark_directions_at(benchmark_directions_find("random"));
    double e6 = NAN;
    for (size_t k = 0; k < rows->count && isnan(e6); k++) {
        const benchmark_row *r = &rows->row[k];
        if (r->ways == once && r->subject == repeated->subject && r->lesson == repeated->lesson &&
            r->draw == repeated->draw && r->n == repeated->n &&
            strcmp(r->method, repeated->method) == 0) {
            e6 = r->error.value[GONIO_E6];
        }
    }
    return e6;
}

/* ---- a mean ---- */

typedef struct totals {
    average error[GONIO_MOST_METRICS];
    average inside, psnr, delta_e_itp, seconds, lost_any, lost_all, worse_repeated;
    pairs expected, here;
} totals;

static void add_row(const benchmark_rows *rows, size_t k, totals *t, benchmark_mean *m)
{
    const benchmark_row *row = &rows->row[k];
    const double e6 = row->error.value[GONIO_E6];
    bool any = false;
    bool all = false;
    m->rows++;
    m->failed += isnan(e6);
    m->worst_e6 = m->rows == 1 ? e6 : fmax(m->worst_e6, e6);
    for (int i = 0; i < GONIO_MOST_METRICS; i++) {
        add(&t->error[i], row->error.value[i]);
    }
    add(&t->inside, row->inside);
    add(&t->psnr, row->psnr);
    add(&t->delta_e_itp, row->delta_e_itp);
    add(&t->seconds, row->seconds);
    add_pair(&t->expected, row->expected, e6);
    add_pair(&t->here, row->expected_here, e6);
    if (!m->simple && find_losses(rows, k, &any, &all)) {
        add(&t->lost_any, any);
        add(&t->lost_all, all);
    }
    if (row->ways->repeats > 0) {
        const double once = e6_read_once(rows, row);
        add(&t->worse_repeated, isnan(once) || isnan(e6) ? NAN : e6 > 1.01 * once);
    }
}

static void finish(const totals *t, benchmark_mean *m)
{
    for (int i = 0; i < GONIO_MOST_METRICS; i++) {
        m->error.value[i] = mean_of(&t->error[i]);
    }
    m->inside = mean_of(&t->inside);
    m->psnr = mean_of(&t->psnr);
    m->delta_e_itp = mean_of(&t->delta_e_itp);
    m->seconds = mean_of(&t->seconds);
    m->lost_any = mean_of(&t->lost_any);
    m->lost_all = mean_of(&t->lost_all);
    m->worse_repeated = mean_of(&t->worse_repeated);
    m->expected = honesty_of(&t->expected);
    m->here = honesty_of(&t->here);
}

gonio_status benchmark_summarise(gonio_context *context, const benchmark_rows *rows,
                                 benchmark_summary *summary)
{
    *summary = (benchmark_summary){0};
    gonio_status status = list_sets(context, rows, summary);
    if (status == GONIO_OK) {
        status = list_means(context, rows, summary);
    }
    for (size_t i = 0; i < summary->count && status == GONIO_OK; i++) {
        totals t = {0};
        for (size_t k = 0; k < rows->count; k++) {
            if (is_of(&summary->mean[i], &rows->row[k])) {
                add_row(rows, k, &t, &summary->mean[i]);
            }
        }
        finish(&t, &summary->mean[i]);
    }
    return status;
}
