/* Starts of the condition-number search: see starting_rows.h. */
#include "starting_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

/* Step 1 of the paper: rows drawn at random. */
static gonio_status random_start(const gonio_i_selection_problem *p, int restart, size_t *chosen)
{
    return gonio_i_random_choice(p, 2 * (uint64_t)restart, chosen);
}

/* ---- QR with pivoting, over and over ---- */

/* Chooses K rows, each the farthest from the span of the earlier ones. `rest` holds the rows and is
 * overwritten; rows that are taken are zero in it. */
static gonio_status take_spanning_rows(const gonio_i_selection_problem *p, double *rest,
                                       size_t count, size_t *chosen)
{
    gonio_status status = GONIO_OK;
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        status = gonio_i_take_farthest(p->context, rest, p->rows, p->components, j, &chosen[j]);
    }
    return status;
}

static void copy_rows(const gonio_i_selection_problem *p, double *copy)
{
    for (size_t row = 0; row < p->rows; row++) {
        memcpy(copy + row * p->components, gonio_i_row(p, row), p->components * sizeof *copy);
    }
}

static gonio_status qr_start(const gonio_i_selection_problem *p, int restart, size_t *chosen)
{
    (void)restart;
    const size_t k = p->components;
    double *rest = gonio_i_allocate(p->context, p->rows * k, sizeof *rest);
    if (rest == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    for (size_t done = 0; done < p->count && status == GONIO_OK; done += k) {
        copy_rows(p, rest);
        for (size_t j = 0; j < done; j++) {
            memset(rest + chosen[j] * k, 0, k * sizeof *rest);
        }
        const size_t count = p->count - done < k ? p->count - done : k;
        status = take_spanning_rows(p, rest, count, chosen + done);
    }
    free(rest);
    return status;
}

/* ---- greedy volume ---- */

/* The state of the greedy choice. Choosing u multiplies det G by 1 + score_u, score_u = u' G^-1 u.
 */
typedef struct volume {
    const gonio_i_selection_problem *problem;
    double *inverse; /* G^-1, [K][K] */
    double *score;   /* [rows]; -1 for rows taken */
    double *image;   /* [K]: G^-1 u of the new row */
} volume;

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = 0; k < n; k++) {
        sum += a[k] * b[k];
    }
    return sum;
}

static void apply(const volume *v, const double *u, double *image)
{
    const size_t k = v->problem->components;
    for (size_t a = 0; a < k; a++) {
        image[a] = dot(v->inverse + a * k, u, k);
    }
}

/* Adds uu' to G: G^-1 -= (G^-1 u)(G^-1 u)'/(1 + u'G^-1 u), and the scores likewise. */
static void add_row(volume *v, size_t row)
{
    const gonio_i_selection_problem *p = v->problem;
    const size_t k = p->components;
    apply(v, gonio_i_row(p, row), v->image);
    const double scale = 1.0 / (1.0 + dot(gonio_i_row(p, row), v->image, k));
    v->score[row] = -1.0;
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
    for (size_t u = 0; u < p->rows; u++) {
        const double along = dot(gonio_i_row(p, u), v->image, k);
        v->score[u] -= v->score[u] < 0.0 ? 0.0 : fmin(scale * along * along, v->score[u]);
    }
    for (size_t a = 0; a < k; a++) {
        for (size_t b = 0; b < k; b++) {
            v->inverse[a * k + b] -= scale * v->image[a] * v->image[b];
        }
    }
}

/* G^-1 and the scores for the first K rows of the choice. */
static gonio_status start_volume(volume *v, const size_t *chosen)
{
    const gonio_i_selection_problem *p = v->problem;
    const size_t k = p->components;
    gonio_status status =
        gonio_i_inverse_gram(p->context, p->vectors, p->stride, k, chosen, k, v->inverse);
    for (size_t u = 0; u < p->rows && status == GONIO_OK; u++) {
        apply(v, gonio_i_row(p, u), v->image);
        v->score[u] = dot(gonio_i_row(p, u), v->image, k);
    }
    for (size_t j = 0; j < k; j++) {
        v->score[chosen[j]] = -1.0;
    }
    return status;
}

static size_t largest_score(const volume *v)
{
    size_t best = 0;
    for (size_t u = 1; u < v->problem->rows; u++) {
        best = v->score[u] > v->score[best] ? u : best;
    }
    return best;
}

static gonio_status grow_volume(volume *v, size_t *chosen)
{
    const gonio_i_selection_problem *p = v->problem;
    gonio_i_selection_problem first = *p;
    first.count = p->components;
    gonio_status status = qr_start(&first, 0, chosen);
    if (status == GONIO_OK) {
        status = start_volume(v, chosen);
    }
    for (size_t j = p->components; j < p->count && status == GONIO_OK; j++) {
        chosen[j] = largest_score(v);
        add_row(v, chosen[j]);
    }
    return status;
}

/* K rows by QR with pivoting, then one at a time the row that multiplies det(X'X) most. */
static gonio_status volume_start(const gonio_i_selection_problem *p, int restart, size_t *chosen)
{
    (void)restart;
    const size_t k = p->components;
    volume v = {.problem = p,
                .inverse = gonio_i_allocate(p->context, k * k, sizeof *v.inverse),
                .score = gonio_i_allocate(p->context, p->rows, sizeof *v.score),
                .image = gonio_i_allocate(p->context, k, sizeof *v.image)};
    const bool ready = v.inverse != NULL && v.score != NULL && v.image != NULL;
    const gonio_status status = ready ? grow_volume(&v, chosen) : GONIO_ERROR_MEMORY;
    free(v.inverse);
    free(v.score);
    free(v.image);
    return status;
}

/* ---- the table ---- */

static const gonio_i_start starts[] = {
    {"random", "rows drawn at random (the paper's)", random_start},
    {"qr", "QR with row pivoting, over and over", qr_start},
    {"volume", "the rows that make det(X'X) largest, one after another", volume_start},
};

enum { STARTS = sizeof starts / sizeof *starts, SPANNING = 1 };

const char *gonio_plan_start_name(int index)
{
    return index >= 0 && index < STARTS ? starts[index].name : NULL;
}

const char *gonio_plan_start_summary(int index)
{
    return index >= 0 && index < STARTS ? starts[index].summary : NULL;
}

const gonio_i_start *gonio_i_find_start(const char *name)
{
    for (int k = 0; k < STARTS; k++) {
        if (strcmp(starts[k].name, name) == 0) {
            return &starts[k];
        }
    }
    return NULL;
}

const gonio_i_start *gonio_i_spanning_start(void)
{
    return &starts[SPANNING];
}
