/* The error to expect, learned from the database: see learned_error.h. */
#include "learned_error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/random.h"
#include "../linalg/linalg.h"

enum {
    FOLDS = 10, /* parts of the database that are left out in turn */
    FEW_MATERIALS = 10,
    FEATURES = 4,
};

/* Of the regression, for features of deviation 1: beside some 240 columns. */
static const double RIDGE = 10.0;

/* What keeps logarithms of squares, in deviations, and of spreads, in log units, finite. */
static const double LEAST_SQUARE = 0.01;
static const double LEAST_SPREAD = 0.1;

/* A feature that is the same of all columns says nothing: of one reading, how they differ. */
static const double LEAST_DEVIATION = 1e-3;

/* The Gaussian of the columns that are not left out, at the readings. */
typedef struct fold {
    double *mean_seen;  /* [n] */
    double *mean;       /* [K] */
    double *covariance; /* [n][n], without noise */
    double *cross;      /* [n][K]: of the readings and z */
    /* Of the columns that it leaves out, in their order, with a = z - mean, M the metric and C the
     * cross covariance: a M a', a M C' and C M C'. NULL for the last fold, and where n > K, as more
     * work than they save. */
    double *square;       /* [left out] */
    double *mixed;        /* [left out][n] */
    double *cross_square; /* [n][n] */
} fold;

struct gonio_i_learned_error {
    const gonio_i_prior *prior;
    size_t components;
    size_t measured; /* columns of materials */
    size_t each;     /* columns of a material */
    double *metric;  /* [K][K]: mean over the bins of f' f */
};

struct gonio_i_folds {
    const gonio_i_learned_error *of;
    const gonio_i_sites *sites;
    fold fold[FOLDS + 1]; /* the last one leaves out nothing */
    double *noise;        /* [measured][n]: of variance 1, the same every time */
};

/* A column of the database that was left out: what its readings look like, and what was found. */
typedef struct lesson {
    double feature[FEATURES];
    double square; /* of its error */
} lesson;

static bool can_tell(const gonio_i_prior *prior)
{
    const gonio_basis_view *view = prior->view;
    return prior->samples > 0 && view->materials >= FEW_MATERIALS &&
           (view->mixtures == 0 || view->parents != NULL);
}

/* Mean of f' f over the bins, from a sample of rows. */
static gonio_status find_metric(gonio_context *context, gonio_i_learned_error *x)
{
    const gonio_basis_view *view = x->prior->view;
    const size_t step = gonio_i_sample_step(view->rows);
    const size_t count = (view->rows + step - 1) / step;
    double *rows = gonio_i_allocate(context, count * x->components, sizeof *rows);
    if (rows == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double all = 0.0;
    for (size_t i = 0; i < count; i++) {
        double *row = rows + i * x->components;
        const double bins = gonio_i_row_bins(view, i * step);
        gonio_i_prior_row(x->prior, i * step, row);
        for (size_t k = 0; k < x->components; k++) {
            row[k] *= sqrt(bins);
        }
        all += bins;
    }
    const gonio_status status =
        gonio_i_gram_rows(context, rows, count, x->components, x->components, x->metric);
    for (size_t k = 0; k < x->components * x->components && status == GONIO_OK; k++) {
        x->metric[k] /= all;
    }
    free(rows);
    return status;
}

gonio_status gonio_i_learned_error_create(gonio_context *context, const gonio_i_prior *prior,
                                          gonio_i_learned_error **learned)
{
    *learned = NULL;
    if (!can_tell(prior)) {
        return GONIO_OK;
    }
    gonio_i_learned_error *x = gonio_i_allocate(context, 1, sizeof *x);
    if (x == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    x->prior = prior;
    x->components = prior->components;
    x->measured = prior->samples - prior->view->mixtures;
    x->each = x->measured / prior->view->materials;
    x->metric = gonio_i_allocate(context, x->components * x->components, sizeof *x->metric);
    const gonio_status status = x->metric == NULL ? GONIO_ERROR_MEMORY : find_metric(context, x);
    if (status != GONIO_OK) {
        gonio_i_learned_error_free(&x);
    }
    *learned = x;
    return status;
}

void gonio_i_learned_error_free(gonio_i_learned_error **learned)
{
    if (learned == NULL || *learned == NULL) {
        return;
    }
    free((*learned)->metric);
    free(*learned);
    *learned = NULL;
}

/* ---- leaving out ---- */

static bool is_of_fold(const gonio_i_learned_error *x, size_t measured, size_t k)
{
    return measured / x->each % FOLDS == k;
}

/* Whether fold k leaves a column out: none is by the last one. */
static bool is_left_out(const gonio_i_learned_error *x, size_t column, size_t k)
{
    if (column < x->measured) {
        return is_of_fold(x, column, k);
    }
    const int32_t *parent = x->prior->view->parents + 2 * (column - x->measured);
    return is_of_fold(x, (size_t)parent[0], k) || is_of_fold(x, (size_t)parent[1], k);
}

/* The share of each column in fold k: 0 for those left out. */
static void share_out(const gonio_i_learned_error *x, size_t k, double *share)
{
    double all = 0.0;
    for (size_t j = 0; j < x->prior->samples; j++) {
        share[j] = is_left_out(x, j, k) ? 0.0 : x->prior->share[j];
        all += share[j];
    }
    for (size_t j = 0; j < x->prior->samples; j++) {
        share[j] /= all;
    }
}

/* from[samples][n], less its mean, times the root of the share, row after row; mean[n]. */
static void centre(const double *from, const double *share, size_t samples, size_t n, double *mean,
                   double *to)
{
    for (size_t j = 0; j < samples; j++) {
        for (size_t i = 0; i < n; i++) {
            mean[i] += share[j] * from[j * n + i];
        }
    }
    for (size_t j = 0; j < samples; j++) {
        const double root = sqrt(share[j]);
        for (size_t i = 0; i < n; i++) {
            to[j * n + i] = root * (from[j * n + i] - mean[i]);
        }
    }
}

/* What folds are made with: every column, centred. */
typedef struct fold_scratch {
    double *share; /* [samples] */
    double *seen;  /* [samples][n] */
    double *z;     /* [samples][K] */
} fold_scratch;

static gonio_status fill_fold(gonio_context *context, gonio_i_folds *folds, size_t k,
                              const fold_scratch *s)
{
    fold *f = &folds->fold[k];
    const gonio_i_learned_error *x = folds->of;
    const gonio_i_sites *sites = folds->sites;
    const size_t n = sites->n;
    const size_t samples = x->prior->samples;
    f->mean_seen = gonio_i_allocate(context, n, sizeof *f->mean_seen);
    f->mean = gonio_i_allocate(context, x->components, sizeof *f->mean);
    f->covariance = gonio_i_allocate(context, n * n, sizeof *f->covariance);
    f->cross = gonio_i_allocate(context, n * x->components, sizeof *f->cross);
    if (f->mean_seen == NULL || f->mean == NULL || f->covariance == NULL || f->cross == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    share_out(x, k, s->share);
    centre(sites->seen, s->share, samples, n, f->mean_seen, s->seen);
    centre(x->prior->sample, s->share, samples, x->components, f->mean, s->z);
    const gonio_status status = gonio_i_gram_rows(context, s->seen, samples, n, n, f->covariance);
    return status == GONIO_OK ? gonio_i_product_columns(context, s->seen, n, samples, s->z,
                                                        x->components, f->cross)
                              : status;
}

/* The columns of materials that fold k leaves out; column: room for all of them. */
static size_t list_left_out(const gonio_i_learned_error *x, size_t k, size_t *column)
{
    size_t count = 0;
    for (size_t j = 0; j < x->measured; j++) {
        if (is_of_fold(x, j, k)) {
            column[count++] = j;
        }
    }
    return count;
}

static size_t most_left_out(const gonio_i_learned_error *x)
{
    return (x->prior->view->materials / FOLDS + 1) * x->each;
}

/* What find_errors needs: away, moved: scratch of [columns][K]; cross: of [n][K]. */
static gonio_status fill_products(gonio_context *context, const gonio_i_learned_error *x, size_t n,
                                  const size_t *column, size_t count, double *away, double *moved,
                                  double *cross, fold *f)
{
    const size_t k = x->components;
    for (size_t j = 0; j < count * k; j++) {
        away[j] = x->prior->sample[column[j / k] * k + j % k] - f->mean[j % k];
    }
    gonio_status status = gonio_i_product(context, away, count, k, x->metric, k, moved);
    if (status == GONIO_OK) {
        status = gonio_i_product(context, f->cross, n, k, x->metric, k, cross);
    }
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, moved, count, k, f->cross, n, f->mixed, n);
    }
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(context, cross, n, k, f->cross, n, f->cross_square, n);
    }
    for (size_t j = 0; j < count; j++) {
        f->square[j] = gonio_i_dot(away + j * k, moved + j * k, k);
    }
    return status;
}

static gonio_status fill_left_out(gonio_context *context, gonio_i_folds *folds, size_t k)
{
    fold *f = &folds->fold[k];
    const gonio_i_learned_error *x = folds->of;
    const size_t n = folds->sites->n;
    const size_t most = most_left_out(x);
    size_t *column = gonio_i_allocate(context, most, sizeof *column);
    double *room = gonio_i_allocate(context, (2 * most + n) * x->components, sizeof *room);
    f->square = gonio_i_allocate(context, most, sizeof *f->square);
    f->mixed = gonio_i_allocate(context, most * n, sizeof *f->mixed);
    f->cross_square = gonio_i_allocate(context, n * n, sizeof *f->cross_square);
    const bool done = column && room && f->square && f->mixed && f->cross_square;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (done) {
        double *moved = room + most * x->components;
        status = fill_products(context, x, n, column, list_left_out(x, k, column), room, moved,
                               moved + most * x->components, f);
    }
    free(column);
    free(room);
    return status;
}

static gonio_status draw_noise(gonio_context *context, gonio_i_folds *folds)
{
    const size_t n = folds->sites->n;
    folds->noise = gonio_i_allocate(context, folds->of->measured * n, sizeof *folds->noise);
    if (folds->noise == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t j = 0; j < folds->of->measured; j++) {
        gonio_i_random random;
        gonio_i_random_seed(&random, 0, j);
        for (size_t i = 0; i < n; i++) {
            folds->noise[j * n + i] = gonio_i_random_normal(&random);
        }
    }
    return GONIO_OK;
}

static gonio_status fill_folds(gonio_context *context, gonio_i_folds *folds)
{
    const gonio_i_learned_error *x = folds->of;
    const size_t samples = x->prior->samples;
    fold_scratch s = {gonio_i_allocate(context, samples, sizeof *s.share),
                      gonio_i_allocate(context, samples * folds->sites->n, sizeof *s.seen),
                      gonio_i_allocate(context, samples * x->components, sizeof *s.z)};
    gonio_status status = s.share == NULL || s.seen == NULL || s.z == NULL
                              ? GONIO_ERROR_MEMORY
                              : draw_noise(context, folds);
    for (size_t k = 0; k <= FOLDS && status == GONIO_OK; k++) {
        status = fill_fold(context, folds, k, &s);
        if (status == GONIO_OK && k < FOLDS && folds->sites->n <= x->components) {
            status = fill_left_out(context, folds, k);
        }
    }
    free(s.share);
    free(s.seen);
    free(s.z);
    return status;
}

gonio_status gonio_i_folds_create(gonio_context *context, const gonio_i_learned_error *learned,
                                  const gonio_i_sites *sites, gonio_i_folds **folds)
{
    *folds = NULL;
    gonio_i_folds *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->of = learned;
    made->sites = sites;
    const gonio_status status = fill_folds(context, made);
    if (status != GONIO_OK) {
        gonio_i_folds_free(&made);
    }
    *folds = made;
    return status;
}

void gonio_i_folds_free(gonio_i_folds **folds)
{
    if (folds == NULL || *folds == NULL) {
        return;
    }
    for (size_t k = 0; k <= FOLDS; k++) {
        free((*folds)->fold[k].mean_seen);
        free((*folds)->fold[k].mean);
        free((*folds)->fold[k].covariance);
        free((*folds)->fold[k].cross);
        free((*folds)->fold[k].square);
        free((*folds)->fold[k].mixed);
        free((*folds)->fold[k].cross_square);
    }
    free((*folds)->noise);
    free(*folds);
    *folds = NULL;
}

/* ---- lessons ---- */

/* How much of a say a reading has: 1 if exact, next to 0 if it is set aside. */
static double say_of(const gonio_i_fit *e, const fold *f, size_t i)
{
    const double prior = f->covariance[i * e->n + i];
    return prior / (prior + gonio_i_fit_noise(e, i));
}

/* g of a reading: the mean of the database is put back. */
static double value_of(const gonio_i_fit *e, const fold *f, const double *y, size_t i)
{
    return e->sites->mean[i] + f->mean_seen[i] + y[i];
}

/* y: readings less the fold's mean; solved: S^-1 y; diagonal: of S^-1. */
static void find_features(const gonio_i_fit *e, const fold *f, const double *y,
                          const double *solved, const double *diagonal, double *feature)
{
    double all = 1e-9;
    double surprise = 0.0;
    double distance = 0.0;
    double mean = 0.0;
    double square = 0.0;
    for (size_t i = 0; i < e->n; i++) {
        const double say = say_of(e, f, i);
        all += say;
        surprise += say * solved[i] * solved[i] / diagonal[i];
        distance += y[i] * solved[i];
        mean += say * value_of(e, f, y, i);
    }
    mean /= all;
    for (size_t i = 0; i < e->n; i++) {
        const double off = value_of(e, f, y, i) - mean;
        square += say_of(e, f, i) * off * off;
    }
    feature[0] = log(surprise / all + LEAST_SQUARE); /* of each reading to the others */
    feature[1] = log(distance / all + LEAST_SQUARE); /* Mahalanobis' */
    feature[2] = mean;
    feature[3] = log(sqrt(square / all) + LEAST_SPREAD);
}

/* S = L L' of a fold, and the diagonal of S^-1. */
typedef struct solver {
    double *lower;
    double *diagonal;
} solver;

static gonio_status begin_solver(const gonio_i_fit *e, const fold *f, solver *s)
{
    const size_t n = e->n;
    s->lower = gonio_i_allocate(e->context, n * n, sizeof *s->lower);
    s->diagonal = gonio_i_allocate(e->context, n, sizeof *s->diagonal);
    if (s->lower == NULL || s->diagonal == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(s->lower, f->covariance, n * n * sizeof *s->lower);
    for (size_t i = 0; i < n; i++) {
        s->lower[i * n + i] += gonio_i_fit_noise(e, i);
    }
    const gonio_status status = gonio_i_cholesky(e->context, s->lower, n);
    return status == GONIO_OK ? gonio_i_inverse_diagonal(e->context, s->lower, n, s->diagonal)
                              : status;
}

static void end_solver(solver *s)
{
    free(s->lower);
    free(s->diagonal);
}

static void solve(const solver *s, size_t count, size_t n, double *y)
{
    gonio_i_divide_triangle(y, count, n, s->lower);
    gonio_i_divide_lower(y, count, n, s->lower);
}

/* What is read of a measured column, less the fold's mean: with noise, the same every time, but of
 * readings that have no say; saturated where the material is. */
static void read_column(const gonio_i_fit *e, const gonio_i_folds *folds, const fold *f,
                        size_t column, double *y)
{
    const double *noise = folds->noise + column * e->n;
    const double *values = e->sites->seen + column * e->n;
    for (size_t i = 0; i < e->n; i++) {
        const double off = sqrt(gonio_i_fit_noise(e, i)) * noise[i];
        const double seen = values[i] + say_of(e, f, i) * off;
        const bool saturated = e->bound[i] > 0 && !e->left_out[i];
        y[i] = (saturated ? fmin(seen, e->y[i]) : seen) - f->mean_seen[i];
    }
}

/* Scratch for the columns of a fold. */
typedef struct column_scratch {
    size_t *column;
    double *y;      /* [columns][n] */
    double *solved; /* [columns][n] */
    double *error;  /* [columns][K]: of z; not used where a fold has products */
    double *turned; /* [columns][K]: times the metric; or [columns][n]: times C M C' */
    double *square; /* [columns]: of the error, by the metric */
} column_scratch;

/* The error of z is a - s C, with s solved: its square from the fold's products. */
static gonio_status expand_squares(const gonio_i_fit *e, const fold *f, size_t count,
                                   const column_scratch *s)
{
    const size_t n = e->n;
    const gonio_status status =
        gonio_i_product(e->context, s->solved, count, n, f->cross_square, n, s->turned);
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        const double *solved = s->solved + j * n;
        s->square[j] = f->square[j] - 2.0 * gonio_i_dot(solved, f->mixed + j * n, n) +
                       gonio_i_dot(solved, s->turned + j * n, n);
    }
    return status;
}

/* The same from the errors themselves. */
static gonio_status square_errors(const gonio_i_learned_error *x, const gonio_i_fit *e,
                                  const fold *f, size_t count, const column_scratch *s)
{
    const size_t k = x->components;
    gonio_status status =
        gonio_i_product(e->context, s->solved, count, e->n, f->cross, k, s->error);
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        const double *z = x->prior->sample + s->column[j] * k;
        for (size_t i = 0; i < k; i++) {
            s->error[j * k + i] = z[i] - f->mean[i] - s->error[j * k + i];
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_product(e->context, s->error, count, k, x->metric, k, s->turned);
    }
    for (size_t j = 0; j < count && status == GONIO_OK; j++) {
        s->square[j] = gonio_i_dot(s->error + j * k, s->turned + j * k, k);
    }
    return status;
}

/* Squares of what is off in z of the columns, once they are solved. */
static gonio_status find_squares(const gonio_i_learned_error *x, const gonio_i_fit *e,
                                 const fold *f, size_t count, const column_scratch *s)
{
    return f->square != NULL ? expand_squares(e, f, count, s) : square_errors(x, e, f, count, s);
}

/* Lessons from the columns that fold k leaves out, added to what is there. */
static gonio_status learn_fold(const gonio_i_folds *folds, const gonio_i_fit *e, size_t k,
                               const column_scratch *s, lesson *lessons, size_t *count)
{
    const gonio_i_learned_error *x = folds->of;
    const fold *f = &folds->fold[k];
    const size_t columns = list_left_out(x, k, s->column);
    for (size_t j = 0; j < columns; j++) {
        read_column(e, folds, f, s->column[j], s->y + j * e->n);
    }
    memcpy(s->solved, s->y, columns * e->n * sizeof *s->y);
    solver with = {0};
    gonio_status status = begin_solver(e, f, &with);
    if (status == GONIO_OK) {
        solve(&with, columns, e->n, s->solved);
        status = find_squares(x, e, f, columns, s);
    }
    for (size_t j = 0; j < columns && status == GONIO_OK; j++) {
        lesson *l = &lessons[(*count)++];
        find_features(e, f, s->y + j * e->n, s->solved + j * e->n, with.diagonal, l->feature);
        l->square = fmax(s->square[j], 0.0);
    }
    end_solver(&with);
    return status;
}

static gonio_status learn_folds(const gonio_i_folds *folds, const gonio_i_fit *e, lesson *lessons)
{
    const gonio_i_learned_error *x = folds->of;
    const size_t most = most_left_out(x);
    column_scratch s = {gonio_i_allocate(e->context, most, sizeof *s.column),
                        gonio_i_allocate(e->context, most * e->n, sizeof *s.y),
                        gonio_i_allocate(e->context, most * e->n, sizeof *s.solved),
                        gonio_i_allocate(e->context, most * x->components, sizeof *s.error),
                        gonio_i_allocate(e->context, most * x->components, sizeof *s.turned),
                        gonio_i_allocate(e->context, most, sizeof *s.square)};
    const bool done = s.column && s.y && s.solved && s.error && s.turned && s.square;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    size_t count = 0;
    for (size_t k = 0; k < FOLDS && status == GONIO_OK; k++) {
        status = learn_fold(folds, e, k, &s, lessons, &count);
    }
    free(s.column);
    free(s.y);
    free(s.solved);
    free(s.error);
    free(s.turned);
    free(s.square);
    return status;
}

/* The features of the readings themselves. */
static gonio_status look(const gonio_i_folds *folds, const gonio_i_fit *e, double *feature)
{
    const fold *f = &folds->fold[FOLDS];
    double *y = gonio_i_allocate(e->context, 2 * e->n, sizeof *y);
    solver with = {0};
    gonio_status status = y == NULL ? GONIO_ERROR_MEMORY : begin_solver(e, f, &with);
    if (status == GONIO_OK) {
        for (size_t i = 0; i < e->n; i++) {
            y[i] = e->y[i] - f->mean_seen[i];
            y[e->n + i] = y[i];
        }
        solve(&with, 1, e->n, y + e->n);
        find_features(e, f, y, y + e->n, with.diagonal, feature);
    }
    end_solver(&with);
    free(y);
    return status;
}

/* ---- regression ---- */

typedef struct scaling {
    double mean[FEATURES];
    double deviation[FEATURES];
} scaling;

static scaling scale_of(const lesson *lessons, size_t count)
{
    scaling s = {0};
    for (int k = 0; k < FEATURES; k++) {
        double square = 0.0;
        for (size_t j = 0; j < count; j++) {
            s.mean[k] += lessons[j].feature[k] / (double)count;
            square += lessons[j].feature[k] * lessons[j].feature[k] / (double)count;
        }
        s.deviation[k] = fmax(sqrt(fmax(square - s.mean[k] * s.mean[k], 0.0)), LEAST_DEVIATION);
    }
    return s;
}

static void fill_row(const scaling *s, const double *feature, double *row)
{
    row[FEATURES] = 1.0;
    for (int k = 0; k < FEATURES; k++) {
        row[k] = (feature[k] - s->mean[k]) / s->deviation[k];
    }
}

static double fit_of(const double *row, const double *slope)
{
    return gonio_i_dot(row, slope, FEATURES + 1);
}

/* The ridge is FEATURES equations more, slope = 0 each. */
static gonio_status regress(gonio_context *context, const lesson *lessons, size_t count,
                            const double *feature, double *square)
{
    enum { UNKNOWNS = FEATURES + 1 };
    const scaling s = scale_of(lessons, count);
    const size_t equations = count + FEATURES;
    double *a = gonio_i_allocate(context, equations * UNKNOWNS, sizeof *a);
    double *b = gonio_i_allocate(context, equations, sizeof *b);
    double slope[UNKNOWNS] = {0};
    double row[UNKNOWNS];
    double condition = 0.0;
    size_t rank = 0;
    gonio_status status = a == NULL || b == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        for (size_t j = 0; j < count; j++) {
            fill_row(&s, lessons[j].feature, a + j * UNKNOWNS);
            b[j] = log(lessons[j].square + 1e-12);
        }
        for (size_t k = 0; k < FEATURES; k++) {
            a[(count + k) * UNKNOWNS + k] = sqrt(RIDGE);
        }
        status =
            gonio_i_least_squares(context, a, equations, UNKNOWNS, b, 1, slope, &rank, &condition);
    }
    if (status == GONIO_OK && rank < UNKNOWNS) {
        status = gonio_i_fail(context, GONIO_ERROR_NUMERICAL,
                              "the error to expect cannot be learned from the basis");
    }
    if (status == GONIO_OK) {
        double smearing = 0.0;
        for (size_t j = 0; j < count; j++) {
            fill_row(&s, lessons[j].feature, row);
            smearing += exp(0.5 * (b[j] - fit_of(row, slope))) / (double)count;
        }
        fill_row(&s, feature, row);
        *square = smearing * smearing * exp(fit_of(row, slope));
    }
    free(a);
    free(b);
    return status;
}

gonio_status gonio_i_learned_error_find(const gonio_i_folds *folds, const gonio_i_fit *e,
                                        double *square)
{
    const size_t measured = folds->of->measured;
    double feature[FEATURES];
    lesson *lessons = gonio_i_allocate(e->context, measured, sizeof *lessons);
    gonio_status status = lessons == NULL ? GONIO_ERROR_MEMORY : learn_folds(folds, e, lessons);
    if (status == GONIO_OK) {
        status = look(folds, e, feature);
    }
    if (status == GONIO_OK) {
        status = regress(e->context, lessons, measured, feature, square);
    }
    free(lessons);
    return status;
}
