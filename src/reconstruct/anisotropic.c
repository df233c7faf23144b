/* Anisotropic reconstruction: from readings to columns, their posterior (posterior/anisotropic.h),
 * and what it says at pairs of directions. */
#include "../posterior/anisotropic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../measurement/readings.h"
#include "anisotropic.h"
#include "../posterior/leave_one_out.h"
#include "../posterior/parallel_for.h"
#include "method.h"
#include "posterior_method.h"

struct gonio_anisotropic_reconstruction {
    gonio_anisotropic_reconstruction_view view;
    gonio_i_prior *prior;
    gonio_i_anisotropic *estimate;
    double *wavelength; /* [channels] or NULL */
    double *scale;      /* [channels]: s */
    double norm;        /* root of the mean square of g */
};

/* ---- readings to columns ---- */

/* Readings as columns, with what belongs to them. */
typedef struct task {
    gonio_context *context;
    const gonio_basis *basis;
    const gonio_readings *readings;
    const gonio_reconstruct_options *options;
    gonio_i_prior *prior;
    gonio_i_columns columns;
    size_t left_out;
    gonio_i_oriented_columns oriented;
} task;

static gonio_status check(const task *t)
{
    const gonio_readings_view *view = gonio_readings_describe(t->readings);
    const gonio_basis_view *basis = gonio_basis_describe(t->basis);
    const int symmetry = t->options->symmetry;
    if (basis->channels == GONIO_JOINT) {
        return gonio_i_fail(t->context, GONIO_ERROR_ARGUMENT,
                            "anisotropic materials need a basis of separate channels (gonio learn "
                            "--channels separate)");
    }
    if (symmetry != 0 && symmetry != 1 && symmetry != 2 && symmetry != 4) {
        return gonio_i_fail(t->context, GONIO_ERROR_ARGUMENT, "a symmetry is 1, 2 or 4, not %d",
                            symmetry);
    }
    if (view->basis != 0 && view->basis != basis->fingerprint && !t->options->other_basis) {
        return gonio_i_fail(t->context, GONIO_ERROR_MISMATCH,
                            "%s: planned with another basis; give that basis, or accept this one "
                            "with --other-basis",
                            view->path);
    }
    return gonio_i_reconstruct_check(t->context, &gonio_i_posterior_method, t->basis, t->readings,
                                     t->options);
}

/* Leaves out readings, evenly, where there are more than the estimate can be made of. */
static void thin(task *t)
{
    const size_t most = gonio_i_anisotropic_most_readings(t->columns.count);
    for (size_t k = 0; k < t->columns.count; k++) {
        gonio_i_column *column = &t->columns.column[k];
        const size_t before = column->count;
        column->count = gonio_i_thin(column, most, column->observation);
        const size_t less = before - column->count;
        t->left_out = less > t->left_out ? less : t->left_out;
    }
    if (t->left_out > 0) {
        gonio_i_note(t->context,
                     "%s: of very many readings %zu of each channel are used, evenly spaced",
                     gonio_readings_describe(t->readings)->path, most);
    }
}

static gonio_status begin(task *t)
{
    const gonio_i_noise noise = gonio_i_posterior_noise(t->options);
    gonio_status status = check(t);
    if (status == GONIO_OK) {
        status = gonio_i_columns_create(t->context, gonio_basis_describe(t->basis), t->readings,
                                        &noise, &t->columns);
    }
    if (status == GONIO_OK) {
        status = gonio_i_columns_check(t->context, &t->columns, t->readings);
    }
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(t->context, t->basis, &t->prior);
    }
    if (status == GONIO_OK) {
        thin(t);
        t->oriented = (gonio_i_oriented_columns){t->prior, t->readings->pair, t->columns.column,
                                                 t->columns.count, t->options->symmetry};
    }
    return status;
}

static void end(task *t)
{
    gonio_i_columns_free(&t->columns);
    gonio_i_prior_free(&t->prior);
}

/* ---- what is found ---- */

/* Where the stretch moves half vectors away from the normal most, the lobe is narrowest: slopes are
 * small along the grain, whose azimuth is that of the stretch. */
gonio_anisotropy gonio_i_anisotropy_of(const gonio_i_stretches *stretches)
{
    const gonio_i_stretch *s = &stretches->likeliest;
    return (gonio_anisotropy){.probability = 1.0 / (1.0 + exp(-stretches->odds)),
                              .evidence = stretches->odds,
                              .symmetry = s->symmetry,
                              .axis_ratio = s->fibres ? 1.0 : exp(s->log_ratio),
                              .rotation = s->log_ratio > 0.0 ? s->rotation : 0.0,
                              .fibres = s->fibres};
}

/* ---- the grain by the predicted lobe ---- */

enum { LOBE_THETAS = 4, LOBE_PHIS = 4 };

/* The sum of what is predicted for half vectors at one azimuth, near enough to the normal for a
 * lobe. scratch: that of the estimate and a value of each column. */
static double brightness_at(const gonio_anisotropic_reconstruction *made, double phi_h,
                            double *scratch)
{
    double *g = scratch + gonio_i_anisotropic_scratch(made->estimate);
    double sum = 0.0;
    for (int k = 0; k < LOBE_THETAS * LOBE_PHIS; k++) {
        const double theta_h = (k % LOBE_THETAS + 1) * M_PI / 18.0; /* 10 .. 40 degrees */
        const int turn = k / LOBE_THETAS;
        const double phi_d = turn * M_PI / LOBE_PHIS;
        const gonio_i_oriented here = {{theta_h, M_PI / 9.0, phi_d}, phi_h};
        gonio_i_anisotropic_at(made->estimate, here, scratch, g, NULL);
        for (size_t c = 0; c < made->view.channels; c++) {
            sum += g[c];
        }
    }
    return sum;
}

/* Kappa can explain what a small ratio of the axes does not, even a lobe that is longer along the
 * azimuth of the stretch than across it. The grain is then a quarter turn from there. */
static gonio_status turn_grain(const task *t, gonio_anisotropic_reconstruction *made)
{
    gonio_anisotropy *a = &made->view.anisotropy;
    const size_t size = gonio_i_anisotropic_scratch(made->estimate) + made->view.channels;
    double *scratch = gonio_i_allocate(t->context, size, sizeof *scratch);
    if (scratch == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const double quarter = 0.5 * M_PI;
    if (a->axis_ratio > 1.0 && brightness_at(made, a->rotation, scratch) >
                                   brightness_at(made, a->rotation + quarter, scratch)) {
        a->rotation += a->rotation < quarter ? quarter : -quarter;
    }
    free(scratch);
    return GONIO_OK;
}

static gonio_status describe(const task *t, gonio_anisotropic_reconstruction *made)
{
    const gonio_readings_view *readings = gonio_readings_describe(t->readings);
    gonio_anisotropic_reconstruction_view *view = &made->view;
    *view = (gonio_anisotropic_reconstruction_view){
        .channels = t->columns.count,
        .left_out = t->left_out,
        .outlying = gonio_i_anisotropic_outlying(made->estimate)};
    view->anisotropy = gonio_i_anisotropy_of(gonio_i_anisotropic_stretches(made->estimate));
    view->anisotropy.cannot_tell = gonio_i_azimuths_are_same(&t->oriented);
    made->scale = gonio_i_allocate(t->context, view->channels, sizeof *made->scale);
    made->wavelength = gonio_i_allocate(t->context, view->channels, sizeof *made->wavelength);
    if (made->scale == NULL || made->wavelength == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < view->channels; c++) {
        const size_t count = t->columns.column[c].count;
        view->readings = count > view->readings ? count : view->readings;
        made->scale[c] = gonio_readings_scale(t->readings, c);
        made->wavelength[c] = readings->wavelength != NULL ? readings->wavelength[c] : 0.0;
    }
    view->wavelength = readings->wavelength != NULL ? made->wavelength : NULL;
    const gonio_status status = turn_grain(t, made);
    return status == GONIO_OK ? gonio_i_anisotropic_expect(t->context, made->estimate,
                                                           &view->predicted_e6, &made->norm)
                              : status;
}

static void warn(const task *t, const gonio_anisotropy *a)
{
    if (a->cannot_tell) {
        gonio_i_warn(t->context,
                     "%s: all readings are at one azimuth of the half vector, so that they cannot "
                     "tell how the material depends on it: add readings with the sample turned by "
                     "45, 90 and 135 degrees, or plan with --anisotropic",
                     gonio_readings_describe(t->readings)->path);
    }
}

gonio_status gonio_reconstruct_anisotropic(gonio_context *context, const gonio_basis *basis,
                                           const gonio_readings *readings,
                                           const gonio_reconstruct_options *options,
                                           gonio_anisotropic_reconstruction **made)
{
    gonio_reconstruct_options how;
    task t = {.context = context, .basis = basis, .readings = readings, .options = &how};
    gonio_anisotropic_reconstruction *a = gonio_i_allocate(context, 1, sizeof *a);
    gonio_status status = a == NULL
                              ? GONIO_ERROR_MEMORY
                              : GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = begin(&t);
    }
    if (status == GONIO_OK) {
        status = gonio_i_anisotropic_find(context, &t.oriented, &a->estimate);
    }
    if (status == GONIO_OK) {
        status = describe(&t, a);
    }
    if (status == GONIO_OK) {
        warn(&t, &a->view.anisotropy);
        a->prior = t.prior;
        t.prior = NULL;
        *made = a;
    } else {
        gonio_anisotropic_reconstruction_free(&a);
    }
    end(&t);
    return status;
}

void gonio_anisotropic_reconstruction_free(gonio_anisotropic_reconstruction **made)
{
    if (made == NULL || *made == NULL) {
        return;
    }
    gonio_i_anisotropic_free(&(*made)->estimate);
    gonio_i_prior_free(&(*made)->prior);
    free((*made)->wavelength);
    free((*made)->scale);
    free(*made);
    *made = NULL;
}

const gonio_anisotropic_reconstruction_view *
gonio_anisotropic_reconstruction_describe(const gonio_anisotropic_reconstruction *made)
{
    return &made->view;
}

const gonio_i_anisotropic *
gonio_i_anisotropic_estimate(const gonio_anisotropic_reconstruction *made, const double **scale)
{
    *scale = made->scale;
    return made->estimate;
}

void gonio_i_anisotropic_weighed(const gonio_anisotropic_reconstruction *made,
                                 gonio_i_weighed_stretches *weighed)
{
    const gonio_i_stretches *stretches = gonio_i_anisotropic_stretches(made->estimate);
    *weighed = (gonio_i_weighed_stretches){.count = stretches->count, .norm = made->norm};
    for (size_t k = 0; k < stretches->count; k++) {
        weighed->stretch[k] = stretches->hypothesis[k].stretch;
        weighed->weight[k] = stretches->hypothesis[k].weight;
    }
}

/* ---- prediction ---- */

enum { BLOCK = 64 };

typedef struct prediction {
    const gonio_anisotropic_reconstruction *made;
    const gonio_pair *pairs;
    size_t count;
    double *value;
    double *deviation; /* or NULL */
} prediction;

/* scratch: of the estimate, then [2][channels]. */
static void predict_one(const prediction *p, size_t k, double *scratch)
{
    const size_t channels = p->made->view.channels;
    double *g = scratch + gonio_i_anisotropic_scratch(p->made->estimate);
    double *variance = p->deviation != NULL ? g + channels : NULL;
    gonio_i_anisotropic_at(p->made->estimate, gonio_i_oriented_of(p->pairs[k]), scratch, g,
                           variance);
    for (size_t c = 0; c < channels; c++) {
        p->value[k * channels + c] = p->made->scale[c] * expm1(fmax(g[c], 0.0));
        if (variance != NULL) {
            p->deviation[k * channels + c] = gonio_i_anisotropic_band(variance[c]);
        }
    }
}

static gonio_status predict_block(void *data, gonio_context *context, size_t block)
{
    const prediction *p = data;
    const size_t size = gonio_i_anisotropic_scratch(p->made->estimate) + 2 * p->made->view.channels;
    double *scratch = gonio_i_allocate(context, size, sizeof *scratch);
    if (scratch == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = block * BLOCK; k < p->count && k < (block + 1) * BLOCK; k++) {
        predict_one(p, k, scratch);
    }
    free(scratch);
    return GONIO_OK;
}

gonio_status gonio_anisotropic_reconstruction_predict(gonio_context *context,
                                                      const gonio_anisotropic_reconstruction *made,
                                                      const gonio_pair *pairs, size_t count,
                                                      double *value, double *deviation)
{
    prediction p = {made, pairs, count, value, deviation};
    const size_t blocks = (count + BLOCK - 1) / BLOCK;
    gonio_i_steps steps = {.task = "predicting", .all = blocks};
    return gonio_i_parallel_for(context, &steps, blocks, predict_block, &p);
}

gonio_status gonio_anisotropic_reconstruction_predict_readings(
    gonio_context *context, const gonio_anisotropic_reconstruction *made, gonio_readings *readings)
{
    const size_t channels = made->view.channels;
    const size_t count = readings->count;
    double *value = gonio_i_allocate(context, 2 * count * channels, sizeof *value);
    if (value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double *deviation = value + count * channels;
    gonio_status status = gonio_anisotropic_reconstruction_predict(context, made, readings->pair,
                                                                   count, value, deviation);
    for (size_t k = 0; k < count * channels && status == GONIO_OK; k++) {
        deviation[k] *= value[k] + made->scale[k % channels];
    }
    if (status == GONIO_OK) {
        status = gonio_readings_set_values(context, readings, channels, made->view.wavelength,
                                           value, NULL);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_set_deviations(context, readings, deviation);
    }
    free(value);
    return status;
}

/* ---- isotropy ---- */

/* Ratios of axes that are compared, and the chance at which one is left out. */
enum { RATIOS = 12 };
static const double LARGEST_LOG_RATIO = 1.8;
static const double CHANCE = 0.05;

/* ln of the odds that 95 per cent are; the ratio that more readings should show. */
static const double CERTAIN = 2.94;
static const double SHOWN_RATIO = 1.3;
enum { MOST_MORE = 500 };

/* The largest ratio that the readings do not exclude. Ratios and the isotropic material are as
 * likely before. */
static double largest_left(const double *log_ratios, const double *odds)
{
    double most = 0.0;
    for (size_t k = 0; k < RATIOS; k++) {
        most = fmax(most, odds[k]);
    }
    double sum = exp(-most);
    for (size_t k = 0; k < RATIOS; k++) {
        sum += exp(odds[k] - most) / RATIOS;
    }
    double above = 0.0;
    size_t k = RATIOS;
    while (k > 0 && above + exp(odds[k - 1] - most) / RATIOS < CHANCE * sum) {
        k--;
        above += exp(odds[k] - most) / RATIOS;
    }
    return k == RATIOS ? INFINITY : k > 0 ? exp(log_ratios[k - 1]) : 1.0;
}

static gonio_status limit_ratio(const task *t, double *limit)
{
    double log_ratios[RATIOS];
    double odds[RATIOS];
    for (size_t k = 0; k < RATIOS; k++) {
        log_ratios[k] = LARGEST_LOG_RATIO * (double)(k + 1) / RATIOS;
    }
    const gonio_status status =
        gonio_i_stretches_compare_ratios(t->context, &t->oriented, log_ratios, RATIOS, odds);
    if (status == GONIO_OK) {
        *limit = largest_left(log_ratios, odds);
    }
    return status;
}

static gonio_status count_more(const task *t, double evidence, size_t *more)
{
    double gain = 0.0;
    *more = 0;
    if (fabs(evidence) >= CERTAIN) {
        return GONIO_OK;
    }
    const gonio_status status =
        gonio_i_stretches_expect_gain(t->context, &t->oriented, log(SHOWN_RATIO), &gain);
    if (status == GONIO_OK) {
        const double needed = ceil((CERTAIN + fmax(-evidence, 0.0)) / fmax(gain, 1e-6));
        *more = (size_t)fmin(needed, MOST_MORE);
    }
    return status;
}

gonio_status gonio_check_isotropy(gonio_context *context, const gonio_basis *basis,
                                  const gonio_readings *readings,
                                  const gonio_reconstruct_options *options,
                                  gonio_isotropy_check *check)
{
    gonio_reconstruct_options how;
    task t = {.context = context, .basis = basis, .readings = readings, .options = &how};
    gonio_isotropy_check found = {0};
    gonio_i_stretches stretches;
    gonio_status status = GONIO_I_TAKE(context, gonio_reconstruct_options, options, &how);
    if (status == GONIO_OK) {
        status = begin(&t);
    }
    if (status == GONIO_OK) {
        status = gonio_i_stretches_weigh(context, &t.oriented, &stretches);
    }
    if (status == GONIO_OK) {
        found.anisotropy = gonio_i_anisotropy_of(&stretches);
        found.anisotropy.cannot_tell = gonio_i_azimuths_are_same(&t.oriented);
        status = limit_ratio(&t, &found.ratio_limit);
    }
    if (status == GONIO_OK) {
        status = count_more(&t, found.anisotropy.evidence, &found.more);
    }
    if (status == GONIO_OK) {
        *check = found;
    }
    end(&t);
    return status;
}
