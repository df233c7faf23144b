/* Usual mistakes in readings: see mistakes.h.
 *
 * Each usual mistake is a hypothesis: the readings' density under the prior if they were made with
 * it, against that of the readings as they are (their evidences: MacKay 1992). */
#include "mistakes.h"

#include <math.h>
#include <stdlib.h>

#include "parallel_for.h"
#include "leave_one_out.h"

/* A factor of pi alone is not among the hypotheses: materials differ by more than that. */

/* The log likelihood ratio from which a mistake is reported. */
static const double CONVINCING = 30.0;

/* alpha of the remainder, log units. The readings without a mistake may also have the larger one,
 * so that an unusual material is not taken for a mistake. Narrow peaks are included, because those
 * of a mirror are higher than any in the database. */
static const double SOME = 0.25;
static const double MUCH = 0.5;
static const double PEAK = 8.0;

enum { MOST_TRIED = 64, MOST_COLUMNS = 3 };

static double to_radians(double degrees_taken_for_radians)
{
    return degrees_taken_for_radians * 180.0 / M_PI;
}

static gonio_pair from_radians(gonio_pair p)
{
    return (gonio_pair){{to_radians(p.incident.theta), to_radians(p.incident.phi)},
                        {to_radians(p.outgoing.theta), to_radians(p.outgoing.phi)}};
}

static gonio_pair from_elevation(gonio_pair p)
{
    return (gonio_pair){{M_PI / 2.0 - p.incident.theta, p.incident.phi},
                        {M_PI / 2.0 - p.outgoing.theta, p.outgoing.phi}};
}

static gonio_pair from_mirror(gonio_pair p)
{
    return (gonio_pair){p.incident, {p.outgoing.theta, p.outgoing.phi + M_PI}};
}

static const struct hypothesis {
    gonio_i_transform transform;
    const char *name;
} hypotheses[] = {
    {{.factor = 1.0, .by_cosine = true},
     "the values include the cosine of theta_o; divide them by it"},
    {{.factor = 0.01}, "the values are in per cent; divide them by 100"},
    {{.factor = 0.01 / M_PI},
     "the values are reflectance factors in per cent; divide them by 100 pi"},
    {{.factor = 1.0, .merl = true},
     "the values are numbers of a MERL file; multiply them by (1, 1.15, 1.66)/1500"},
    {{.factor = 1.0, .change = from_radians}, "the angles are in radians; write them in degrees"},
    {{.factor = 1.0, .change = from_elevation},
     "theta is measured from the surface; give 90 degrees less theta"},
    {{.factor = 1.0, .change = from_mirror},
     "phi_o is measured from the mirror direction; add 180 degrees to it"},
};

enum { HYPOTHESES = sizeof hypotheses / sizeof *hypotheses };

/* Whether the directions exist under a hypothesis. */
static bool is_possible(const gonio_readings_view *view, const gonio_i_transform *transform)
{
    for (size_t k = 0; k < view->count && transform->change != NULL; k++) {
        const gonio_pair changed = transform->change(view->pair[k]);
        const double largest = fmax(changed.incident.theta, changed.outgoing.theta);
        const double least = fmin(changed.incident.theta, changed.outgoing.theta);
        if (!(largest < M_PI / 2.0 && least >= 0.0)) {
            return false;
        }
    }
    return true;
}

/* The readings on which hypotheses are tried: MOST_TRIED readings of a few columns. */
typedef struct trial {
    gonio_context *context;
    const gonio_i_prior *prior;
    const gonio_readings *readings;
    const gonio_i_noise *noise;
    size_t count;
    size_t channel[MOST_COLUMNS];
    double share[MOST_COLUMNS]; /* of the column's readings */
    gonio_i_column column[MOST_COLUMNS];
    gonio_i_sites *sites[MOST_COLUMNS]; /* of the directions as they are read */
} trial;

static gonio_status begin(trial *t, const gonio_i_columns *columns)
{
    gonio_status status = GONIO_OK;
    const size_t tried = columns->count < MOST_COLUMNS ? columns->count : MOST_COLUMNS;
    for (size_t k = 0; k < tried && status == GONIO_OK; k++) {
        const size_t channel = k * columns->count / tried;
        const gonio_i_column *all = &columns->column[channel];
        if (all->count > 0) {
            gonio_i_column *thinned = &t->column[t->count];
            status = gonio_i_thin_copy(t->context, all, MOST_TRIED, thinned);
            t->channel[t->count] = channel;
            t->share[t->count++] = (double)thinned->count / (double)all->count;
        }
    }
    return status == GONIO_OK
               ? gonio_i_sites_share(t->context, t->prior, t->column, t->count, t->sites)
               : status;
}

static void end(trial *t)
{
    gonio_i_sites_release(t->sites, t->count);
    for (size_t k = 0; k < t->count; k++) {
        free(t->column[k].observation);
    }
}

/* One model of the columns, with the sites that they have now. */
typedef struct weighing {
    const trial *t;
    gonio_i_sites *const *sites;
    double alpha;
    double evidence[MOST_COLUMNS];
} weighing;

static gonio_status weigh_column(void *data, gonio_context *context, size_t k)
{
    weighing *w = data;
    return gonio_i_fit_evidence(context, w->sites[k], &w->t->column[k], w->alpha, PEAK,
                                &w->evidence[k]);
}

static gonio_status weigh_columns(const trial *t, gonio_i_sites *const *sites,
                                  const gonio_i_transform *transform, double alpha,
                                  double *evidence)
{
    weighing w = {.t = t, .sites = sites, .alpha = alpha};
    gonio_i_steps steps = {.task = NULL};
    const gonio_status status =
        gonio_i_parallel_for(t->context, &steps, t->count, weigh_column, &w);
    *evidence = 0.0;
    for (size_t k = 0; k < t->count && status == GONIO_OK; k++) {
        *evidence +=
            w.evidence[k] + t->share[k] * gonio_i_transform_logarithm(t->readings, t->channel[k],
                                                                      t->noise, transform);
    }
    return status;
}

/* ln of the density of the values under a transform and with a remainder of size alpha, scaled from
 * the readings that are tried to all. Only directions that change need other sites. */
static gonio_status weigh(trial *t, const gonio_i_transform *transform, double alpha,
                          double *evidence)
{
    for (size_t k = 0; k < t->count; k++) {
        gonio_i_column_transform(t->readings, t->noise, transform, &t->column[k]);
    }
    if (transform->change == NULL) {
        return weigh_columns(t, t->sites, transform, alpha, evidence);
    }
    gonio_i_sites *changed[MOST_COLUMNS] = {NULL};
    gonio_status status = gonio_i_sites_share(t->context, t->prior, t->column, t->count, changed);
    if (status == GONIO_OK) {
        status = weigh_columns(t, changed, transform, alpha, evidence);
    }
    gonio_i_sites_release(changed, t->count);
    return status;
}

static gonio_status try_hypotheses(trial *t, const double *dark, const char **mistake)
{
    const gonio_i_transform as_it_is = {.factor = 1.0, .dark = dark};
    const gonio_readings_view *view = gonio_readings_describe(t->readings);
    double here = 0.0;
    double unusual = 0.0;
    gonio_status status = weigh(t, &as_it_is, SOME, &here);
    if (status == GONIO_OK) {
        status = weigh(t, &as_it_is, MUCH, &unusual);
    }
    double best = fmax(here + CONVINCING, unusual);
    for (int k = 0; k < HYPOTHESES && status == GONIO_OK; k++) {
        double evidence = 0.0;
        if (is_possible(view, &hypotheses[k].transform)) {
            status = weigh(t, &hypotheses[k].transform, SOME, &evidence);
            if (status == GONIO_OK && evidence > best) {
                best = evidence;
                *mistake = hypotheses[k].name;
            }
        }
    }
    return status;
}

gonio_status gonio_i_mistake_find(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_readings *readings, const gonio_i_noise *noise,
                                  const gonio_i_columns *columns, const double *dark,
                                  const char **mistake)
{
    trial t = {.context = context, .prior = prior, .readings = readings, .noise = noise};
    *mistake = NULL;
    if (prior->view->channels == GONIO_JOINT) {
        return GONIO_OK; /* the only column holds all channels */
    }
    gonio_status status = begin(&t, columns);
    if (status == GONIO_OK) {
        status = try_hypotheses(&t, dark, mistake);
    }
    end(&t);
    return status;
}
