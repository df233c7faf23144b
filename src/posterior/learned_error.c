/* The error to expect, learned from the database: see learned_error.h. */
#include "folds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../linalg/linalg.h"

enum { FEATURES = 4 };

/* Of the regression, for features of deviation 1: beside some 240 columns. */
static const double RIDGE = 10.0;

/* What keeps logarithms of squares, in deviations, and of spreads, in log units, finite. */
static const double LEAST_SQUARE = 0.01;
static const double LEAST_SPREAD = 0.1;

/* A feature that is the same of all columns says nothing: of one reading, how they differ. */
static const double LEAST_DEVIATION = 1e-3;

/* A column of the database that was left out: what its readings look like, and what was found. */
typedef struct lesson {
    double feature[FEATURES];
    double square; /* of its error */
} lesson;

/* ---- lessons ---- */

/* How much of a say a reading has: 1 if exact, next to 0 if it is set aside. */
static double say_of(const gonio_i_fit *e, const gonio_i_fold *f, size_t i)
{
    const double prior = f->covariance[i * e->n + i];
    return prior / (prior + gonio_i_fit_noise(e, i));
}

/* g of a reading: the mean of the database is put back. */
static double value_of(const gonio_i_fit *e, const gonio_i_fold *f, const double *y, size_t i)
{
    return e->sites->mean[i] + f->mean_seen[i] + y[i];
}

/* y: readings less the fold's mean; solved: S^-1 y; diagonal: of S^-1. */
static void find_features(const gonio_i_fit *e, const gonio_i_fold *f, const double *y,
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

static gonio_status begin_solver(const gonio_i_fit *e, const gonio_i_fold *f, solver *s)
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
static void read_column(const gonio_i_fit *e, const gonio_i_folds *folds, const gonio_i_fold *f,
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
static gonio_status expand_squares(const gonio_i_fit *e, const gonio_i_fold *f, size_t count,
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
                                  const gonio_i_fold *f, size_t count, const column_scratch *s)
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
                                 const gonio_i_fold *f, size_t count, const column_scratch *s)
{
    return f->square != NULL ? expand_squares(e, f, count, s) : square_errors(x, e, f, count, s);
}

/* Lessons from the columns that fold k leaves out, added to what is there. */
static gonio_status learn_fold(const gonio_i_folds *folds, const gonio_i_fit *e, size_t k,
                               const column_scratch *s, lesson *lessons, size_t *count)
{
    const gonio_i_learned_error *x = folds->of;
    const gonio_i_fold *f = &folds->fold[k];
    const size_t columns = gonio_i_folds_list(x, k, s->column);
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
    const size_t most = gonio_i_folds_most(x);
    column_scratch s = {gonio_i_allocate(e->context, most, sizeof *s.column),
                        gonio_i_allocate(e->context, most * e->n, sizeof *s.y),
                        gonio_i_allocate(e->context, most * e->n, sizeof *s.solved),
                        gonio_i_allocate(e->context, most * x->components, sizeof *s.error),
                        gonio_i_allocate(e->context, most * x->components, sizeof *s.turned),
                        gonio_i_allocate(e->context, most, sizeof *s.square)};
    const bool done = s.column && s.y && s.solved && s.error && s.turned && s.square;
    gonio_status status = done ? GONIO_OK : GONIO_ERROR_MEMORY;
    size_t count = 0;
    for (size_t k = 0; k < GONIO_I_FOLDS && status == GONIO_OK; k++) {
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
    const gonio_i_fold *f = &folds->fold[GONIO_I_FOLDS];
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
