/* Choices for anisotropic materials: see azimuth_choices.h.
 *
 * Given    pairs of directions, and stretches with weights u
 * Returned p->f[rows][p->components], p->f p->f' = C to within LEFT of every variance,
 *          C = (1 - share + share kappa) sum_s u_s f_s f_s' + alpha^2 kappa k,
 *          f_s the prior's rows where stretch s takes the half vectors; and after readings R the
 *          covariance I - f_R' (f_R f_R' + sigma^2 I)^-1 f_R
 * Method   Cholesky with pivoting on the largest variance left (Higham 2002, sec. 10.3); columns of
 *          C are computed when they are needed */
#include "azimuth_choices.h"

#include <math.h>
#include <stdlib.h>

#include "../linalg/linalg.h"

/* Standard deviation of a reading, log units, beside a remainder. */
static const double NOISE = 0.05;

/* Of the isotropic covariance. */
static const double SHARE = 0.2;
enum { SYMMETRY = 2 };

/* Variance that the factor may omit. */
static const double LEFT = 1e-4;

/* Pairs nearer than this, radians, are the same. */
static const double SAME = 1e-3;

enum { MOST_RANK = 500, MOST_COMPONENTS = 150, RATIOS = 3, ROTATIONS = 4 };
enum { MOST_STRETCHES = 1 + RATIOS * ROTATIONS + GONIO_I_MOST_HYPOTHESES };

/* Before readings: ratios of axes, each with the azimuths of the grain alike, and how much of the
 * covariance is that of isotropic lobes. */
static const double LOG_RATIOS[RATIOS] = {0.5, 1.0, 1.6};
static const double FOR_ISOTROPIC = 0.2;

/* The weight of these where something is known. */
static const double UNKNOWN = 0.2;

typedef struct weighed_stretch {
    gonio_i_stretch stretch;
    double weight;
} weighed_stretch;

/* What the covariance is made of. */
typedef struct maker {
    gonio_i_choices *p;
    gonio_i_oriented *place; /* [rows] */
    size_t stretches;
    weighed_stretch stretch[MOST_STRETCHES];
    size_t each;                    /* components of a stretch that count */
    size_t length;                  /* stretches times each */
    float *f;                       /* [rows][length]: u^(1/2) f of every stretch */
    gonio_i_place *seen;            /* [rows]: of the unstretched half vectors */
    gonio_i_azimuth_point *azimuth; /* [rows] */
    double *left;                   /* [rows]: variance not yet in the factor */
} maker;

GONIO_I_VECTORISED static double dot(const float *a, const float *b, size_t n)
{
    float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return (double)sum;
}

/* ---- stretches ---- */

static void add_stretch(maker *m, gonio_i_stretch stretch, double weight)
{
    if (m->stretches < MOST_STRETCHES) {
        m->stretch[m->stretches++] = (weighed_stretch){stretch, weight};
    }
}

static void list_stretches(maker *m)
{
    const gonio_i_known *known = m->p->known;
    const double any = known != NULL ? UNKNOWN : 1.0;
    add_stretch(m, (gonio_i_stretch){0}, any * FOR_ISOTROPIC);
    for (size_t k = 0; k < (size_t)RATIOS * ROTATIONS; k++) {
        const gonio_i_stretch stretch = {.log_ratio = LOG_RATIOS[k / ROTATIONS],
                                         .rotation = M_PI * (double)(k % ROTATIONS) / ROTATIONS};
        add_stretch(m, stretch, any * (1.0 - FOR_ISOTROPIC) / (RATIOS * ROTATIONS));
    }
    for (size_t k = 0; known != NULL && k < known->stretches; k++) {
        add_stretch(m, known->stretch[k], (1.0 - any) * known->stretch_weight[k]);
    }
}

/* ---- rows ---- */

static bool is_same_direction(gonio_angles a, gonio_angles b)
{
    const double across = remainder(a.phi - b.phi, 2.0 * M_PI) * sin(a.theta);
    return hypot(a.theta - b.theta, across) < SAME;
}

static bool was_read(const gonio_i_known *known, gonio_pair pair)
{
    bool read = false;
    for (size_t k = 0; known != NULL && k < known->count && !read; k++) {
        read = is_same_direction(pair.incident, known->pair[k].incident) &&
               is_same_direction(pair.outgoing, known->pair[k].outgoing);
    }
    return read;
}

/* The pairs: listed or drawn, then those that were read. */
static void list_pairs(maker *m, const gonio_plan_options *options, size_t choices)
{
    gonio_i_choices *p = m->p;
    if (options->candidates == NULL) {
        gonio_i_oriented_sample(options->seed, choices, m->place);
    }
    for (size_t k = 0; k < p->rows; k++) {
        const bool choice = k < choices;
        if (choice && options->candidates == NULL) {
            p->pair[k] = gonio_i_oriented_pair(m->place[k]);
        } else {
            p->pair[k] = choice ? options->candidates[k] : p->known->pair[k - choices];
            m->place[k] = gonio_i_oriented_of(p->pair[k]);
        }
        p->at[k] = m->place[k].at;
        p->loss[k] = choice ? 1.0 : 0.0;
        p->allowed[k] = choice && !was_read(p->known, p->pair[k]);
    }
}

/* f: scratch, [K]. */
static void fill_row(maker *m, size_t row, double *f)
{
    const gonio_i_choices *p = m->p;
    const gonio_i_stretch turning = {.symmetry = SYMMETRY};
    m->seen[row] = gonio_i_place_of(p->at[row]);
    m->azimuth[row] = gonio_i_azimuth_of(&turning, m->place[row]);
    for (size_t s = 0; s < m->stretches; s++) {
        const double root = sqrt(m->stretch[s].weight);
        double mean = 0.0;
        gonio_i_prior_at(p->prior, gonio_i_stretch_apply(&m->stretch[s].stretch, m->place[row]), 0,
                         &mean, f);
        p->mean[row] += m->stretch[s].weight * mean;
        for (size_t k = 0; k < m->each; k++) {
            m->f[row * m->length + s * m->each + k] = (float)(root * f[k]);
        }
    }
}

static gonio_status fill_rows(maker *m)
{
    const gonio_i_choices *p = m->p;
    bool failed = false;
#pragma omp parallel num_threads(gonio_context_threads(p->context))
    {
        double *f = gonio_i_allocate(p->context, p->prior->components, sizeof *f);
        if (f == NULL) {
#pragma omp atomic write
            failed = true;
        }
#pragma omp for schedule(static)
        for (size_t row = 0; row < p->rows; row++) {
            if (f != NULL) {
                fill_row(m, row, f);
            }
        }
        free(f);
    }
    return failed ? GONIO_ERROR_MEMORY : GONIO_OK;
}

/* ---- the factor ---- */

static double covariance(const maker *m, size_t a, size_t b)
{
    const double kernel = gonio_i_azimuth_kernel(m->azimuth[a], m->azimuth[b]);
    const double known = dot(m->f + a * m->length, m->f + b * m->length, m->length);
    return (1.0 - SHARE + SHARE * kernel) * known +
           kernel * gonio_i_planned_remainder(&m->seen[a], &m->seen[b]);
}

static size_t largest(const double *values, size_t count)
{
    size_t most = 0;
    for (size_t i = 1; i < count; i++) {
        most = values[i] > values[most] ? i : most;
    }
    return most;
}

static gonio_status factorise(maker *m)
{
    gonio_i_choices *p = m->p;
    const size_t most = p->components;
    gonio_status status = GONIO_OK;
    for (size_t i = 0; i < p->rows; i++) {
        m->left[i] = covariance(m, i, i);
    }
    for (size_t rank = 0; rank < most && status == GONIO_OK; rank++) {
        const size_t pivot = largest(m->left, p->rows);
        if (m->left[pivot] < LEFT) {
            break;
        }
        const double root = sqrt(m->left[pivot]);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(p->context))
        for (size_t i = 0; i < p->rows; i++) {
            const double seen = dot(p->f + i * most, p->f + pivot * most, rank);
            const float entry = (float)((covariance(m, i, pivot) - seen) / root);
            p->f[i * most + rank] = entry;
            m->left[i] -= (double)entry * (double)entry;
        }
        m->left[pivot] = 0.0;
        status = gonio_i_progress(p->context, "planning", 0.0);
    }
    return status;
}

/* ---- all of it ---- */

static gonio_status allocate(maker *m)
{
    gonio_i_choices *p = m->p;
    gonio_context *c = p->context;
    m->place = gonio_i_allocate(c, p->rows, sizeof *m->place);
    m->f = gonio_i_allocate(c, p->rows * m->length, sizeof *m->f);
    m->seen = gonio_i_allocate(c, p->rows, sizeof *m->seen);
    m->azimuth = gonio_i_allocate(c, p->rows, sizeof *m->azimuth);
    m->left = gonio_i_allocate(c, p->rows, sizeof *m->left);
    p->pair = gonio_i_allocate(c, p->rows, sizeof *p->pair);
    const bool done = m->place && m->f && m->seen && m->azimuth && m->left && p->pair;
    return done ? gonio_i_choices_allocate(p) : GONIO_ERROR_MEMORY;
}

static void release(maker *m)
{
    free(m->place);
    free(m->f);
    free(m->seen);
    free(m->azimuth);
    free(m->left);
}

gonio_status gonio_i_choices_of_azimuths(gonio_i_choices *p, const gonio_plan_options *options)
{
    const size_t choices =
        options->candidates != NULL ? options->candidate_count : GONIO_I_AZIMUTH_CHOICES;
    const size_t all = p->prior->components;
    maker m = {.p = p, .each = all < MOST_COMPONENTS ? all : MOST_COMPONENTS};
    if (choices > GONIO_I_MOST_AZIMUTH_CHOICES) {
        return gonio_i_fail(p->context, GONIO_ERROR_ARGUMENT,
                            "%zu candidates for an anisotropic material are more than %d; leave "
                            "some out",
                            choices, GONIO_I_MOST_AZIMUTH_CHOICES);
    }
    list_stretches(&m);
    m.length = m.stretches * m.each;
    p->rows = choices + (p->known != NULL ? p->known->count : 0);
    p->components = p->rows < MOST_RANK ? p->rows : MOST_RANK;
    p->noise = NOISE;
    gonio_status status = allocate(&m);
    if (status == GONIO_OK) {
        list_pairs(&m, options, choices);
        status = fill_rows(&m);
    }
    if (status == GONIO_OK) {
        status = factorise(&m);
    }
    if (status == GONIO_OK && p->known != NULL) {
        status = gonio_i_choices_after_readings(p);
    }
    release(&m);
    return status;
}
