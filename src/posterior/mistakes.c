/* Usual mistakes in readings: see mistakes.h.
 *
 * Each usual mistake is a hypothesis: the readings' density under the prior if they were made with
 * it, against that of the readings as they are (their evidences: MacKay 1992). */
#include "mistakes.h"

#include <math.h>
#include <stdlib.h>

#include "leave_one_out.h"

/* A factor of pi alone is not among the hypotheses: materials differ by more than that. */

/* How much likelier a mistake has to make the readings: e^30. */
static const double CONVINCING = 30.0;

/* Of the remainder, log units: some; and much, which the readings as they are may have too, so that
 * an unusual material is not taken for a mistake. With peaks, as those of a mirror are higher than
 * any in the database. */
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
    {{.factor = 1.0, .turn = from_radians}, "the angles are in radians; write them in degrees"},
    {{.factor = 1.0, .turn = from_elevation},
     "theta is measured from the surface; give 90 degrees less theta"},
    {{.factor = 1.0, .turn = from_mirror},
     "phi_o is measured from the mirror direction; add 180 degrees to it"},
};

enum { HYPOTHESES = sizeof hypotheses / sizeof *hypotheses };

/* Whether the directions exist under a hypothesis. */
static bool is_possible(const gonio_readings_view *view, const gonio_i_transform *transform)
{
    for (size_t k = 0; k < view->count && transform->turn != NULL; k++) {
        const gonio_pair turned = transform->turn(view->pair[k]);
        const double largest = fmax(turned.incident.theta, turned.outgoing.theta);
        const double least = fmin(turned.incident.theta, turned.outgoing.theta);
        if (!(largest < M_PI / 2.0 && least >= 0.0)) {
            return false;
        }
    }
    return true;
}

/* ln of the density of the values under a transform and with a remainder of size alpha; of
 * MOST_TRIED of a column, scaled. */
static gonio_status weigh(gonio_context *context, const gonio_i_prior *prior,
                          const gonio_readings *readings, const gonio_i_noise *noise,
                          const gonio_i_transform *transform, double alpha, double *evidence)
{
    gonio_i_columns columns;
    gonio_status status =
        gonio_i_columns_create(context, &prior->view, readings, noise, transform, &columns);
    const size_t tried = columns.count < MOST_COLUMNS ? columns.count : MOST_COLUMNS;
    *evidence = 0.0;
    for (size_t k = 0; k < tried && status == GONIO_OK; k++) {
        const size_t index = k * columns.count / tried;
        gonio_i_column *column = &columns.column[index];
        const size_t all = column->count;
        double mine = 0.0;
        if (all == 0) {
            continue;
        }
        column->count = gonio_i_thin(column, MOST_TRIED, column->observation);
        status = gonio_i_posterior_evidence(context, prior, column, alpha, PEAK, &mine);
        const double share = (double)column->count / (double)all;
        *evidence += mine + share * gonio_i_transform_logarithm(readings, index, noise, transform);
    }
    gonio_i_columns_free(&columns);
    return status;
}

gonio_status gonio_i_mistake_find(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_readings *readings, const gonio_i_noise *noise,
                                  const double *dark, const char **mistake)
{
    const gonio_i_transform as_it_is = {.factor = 1.0, .dark = dark};
    const gonio_readings_view view = gonio_readings_describe(readings);
    double best = 0.0;
    double here = 0.0;
    *mistake = NULL;
    if (prior->view.channels == GONIO_JOINT) {
        return GONIO_OK; /* its columns hold all channels: nothing to compare one by one */
    }
    double unusual = 0.0;
    gonio_status status = weigh(context, prior, readings, noise, &as_it_is, SOME, &here);
    if (status == GONIO_OK) {
        status = weigh(context, prior, readings, noise, &as_it_is, MUCH, &unusual);
    }
    best = fmax(here + CONVINCING, unusual);
    for (int k = 0; k < HYPOTHESES && status == GONIO_OK; k++) {
        double evidence = 0.0;
        if (is_possible(&view, &hypotheses[k].transform)) {
            status =
                weigh(context, prior, readings, noise, &hypotheses[k].transform, SOME, &evidence);
            if (status == GONIO_OK && evidence > best) {
                best = evidence;
                *mistake = hypotheses[k].name;
            }
        }
    }
    return status;
}
