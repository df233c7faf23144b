/* Outliers and bounds that have no say: gonio_i_fit_settle of fit.h. */
#include <math.h>
#include <stdlib.h>

#include "fit.h"
#include "fit_inverse.h"

/* A reading is an outlier if its prediction error exceeds this number of standard deviations. The
 * unit is the median error of the readings, or the model's standard deviation if that is larger.
 * One in 16,000 of a Gaussian exceeds it. With many readings, more right ones have large errors,
 * and wrong ones stand out more. So the threshold grows with the sixth root of their number. */
static const double OUTLYING = 4.0;
static const double MOST_OUTLYING = 6.0;
static const double FEW = 40.0;

static double outlying_from(size_t n)
{
    return fmin(OUTLYING * pow(fmax((double)n / FEW, 1.0), 1.0 / 6.0), MOST_OUTLYING);
}

/* The variance of an outlier, in squares of its difference: it has hardly any weight. */
static const double WIDENING = 100.0;

enum { MOST_ROUNDS = 20 };

/* Prediction errors of the readings, for gonio_i_fit_settle. */
typedef struct judgement {
    double *difference; /* [n] */
    double *variance;   /* [n] */
    double *deviations; /* [n]: scratch */
    bool *outlying;     /* [n] */
} judgement;

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The standard deviation of a Gaussian with the median of the prediction errors, at least 1. A
 * material that the prior describes badly is predicted badly everywhere. That is no reason to set
 * all its readings aside. */
static double usual_deviation(const gonio_i_fit *e, const judgement *j)
{
    for (size_t i = 0; i < e->n; i++) {
        j->deviations[i] = fabs(j->difference[i]) / sqrt(j->variance[i]);
    }
    qsort(j->deviations, e->n, sizeof *j->deviations, compare_numbers);
    return fmax(1.0, j->deviations[e->n / 2] / 0.6745);
}

/* A bound that the prediction from the other readings satisfies has no information. */
static bool judge_bounds(gonio_i_fit *e, const judgement *j)
{
    bool changed = false;
    for (size_t i = 0; i < e->n; i++) {
        /* difference: reading less its leave-one-out prediction; for one left out, less the
         * prediction of the model. */
        const bool kept = e->bound[i] != 0 && e->bound[i] * j->difference[i] < 0.0;
        changed = changed || kept != e->left_out[i];
        e->left_out[i] = kept;
    }
    return changed;
}

/* The worst outliers get a variance to match. Only a few are changed at a time, because a wrong
 * reading makes its neighbours look wrong. */
static bool judge_readings(gonio_i_fit *e, const judgement *j)
{
    const size_t most = 1 + e->n / 40;
    const double usual = usual_deviation(e, j);
    size_t found = 0;
    for (; found < most; found++) {
        size_t worst = e->n;
        double largest = outlying_from(e->n) * usual;
        for (size_t i = 0; i < e->n; i++) {
            const double deviations = fabs(j->difference[i]) / sqrt(j->variance[i]);
            if (!j->outlying[i] && !e->left_out[i] && deviations > largest) {
                largest = deviations;
                worst = i;
            }
        }
        if (worst == e->n) {
            break;
        }
        j->outlying[worst] = true;
        e->variance[worst] = WIDENING * j->difference[worst] * j->difference[worst];
    }
    return found > 0;
}

/* One round: what changes by the predictions as they are. */
static gonio_status settle_once(gonio_i_fit *e, bool judge_outliers, const judgement *j,
                                bool *changed)
{
    gonio_status status = gonio_i_fit_leave_one_out(e, j->difference, j->variance);
    if (status == GONIO_OK) {
        const bool bounds = judge_bounds(e, j);
        *changed = (judge_outliers && judge_readings(e, j)) || bounds;
    }
    if (status == GONIO_OK && *changed) {
        status =
            e->inverse != NULL ? gonio_i_fit_inverse_solve(e) : gonio_i_fit_solve(e, &e->model);
    }
    return status;
}

static gonio_status begin_judgement(const gonio_i_fit *e, judgement *j)
{
    *j = (judgement){gonio_i_allocate(e->context, e->n, sizeof *j->difference),
                     gonio_i_allocate(e->context, e->n, sizeof *j->variance),
                     gonio_i_allocate(e->context, e->n, sizeof *j->deviations),
                     gonio_i_allocate(e->context, e->n, sizeof *j->outlying)};
    const bool done = j->difference && j->variance && j->deviations && j->outlying;
    return done ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static void end_judgement(judgement *j)
{
    free(j->difference);
    free(j->variance);
    free(j->deviations);
    free(j->outlying);
}

gonio_status gonio_i_fit_settle(gonio_i_fit *e, bool judge_outliers, size_t *outlying)
{
    judgement j;
    gonio_status status = begin_judgement(e, &j);
    bool changed = true;
    for (int round = 0; round < MOST_ROUNDS && changed && status == GONIO_OK; round++) {
        status = settle_once(e, judge_outliers, &j, &changed);
    }
    *outlying = 0;
    for (size_t i = 0; i < e->n && status == GONIO_OK; i++) {
        *outlying += j.outlying[i];
    }
    end_judgement(&j);
    return status;
}
