/* The interpretation of readings: see interpret.h. */
#include "interpret.h"

#include <stdlib.h>

#include "dark_level.h"
#include "../measurement/readings.h"
#include "mistakes.h"
#include "stretches.h"
#include "unmeasured.h"

/* Turned readings of isotropic materials differ by a few per cent, and by much only in the few that
 * are at a narrow peak. */
static const double ANISOTROPIC = 0.25;

/* ln of the odds from which a material is said to be anisotropic: isotropic ones stay below. */
static const double EVIDENT = 5.0;

/* Wrong azimuths explain what anisotropy explains if its margin is larger by this. Of 40
 * readings with wrong azimuths it was 4.6 times the evidence and more, of right ones 1.4 times. */
static const double FAR_BETTER = 2.5;

enum { ENOUGH_TURNED = 5, ENOUGH_READINGS = 10 };

static gonio_status look_at_turned(gonio_context *context, const gonio_readings *readings,
                                   gonio_interpretation *i)
{
    const gonio_status status =
        gonio_i_readings_compare_turned(context, readings, &i->turned_pairs, &i->turned);
    i->anisotropic = i->turned_pairs >= ENOUGH_TURNED && i->turned > ANISOTROPIC;
    return status;
}

/* Corrects the columns for a dark level, or takes the correction back without one. */
static void correct(const gonio_readings *readings, const gonio_i_noise *noise, const double *dark,
                    gonio_i_columns *columns)
{
    const gonio_i_transform transform = {.factor = 1.0, .dark = dark};
    for (size_t k = 0; k < columns->count; k++) {
        gonio_i_column_transform(readings, noise, &transform, &columns->column[k]);
    }
}

/* A dark level, and readings of nothing, which are not what it leaves. If there are such readings,
 * the level is found again without them. Corrects the columns for the level. */
static gonio_status find_zeros(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, gonio_interpretation *interpretation,
                               double **dark)
{
    gonio_status status = gonio_i_dark_level_find(context, prior, readings, noise, columns, dark);
    if (status == GONIO_OK) {
        correct(readings, noise, *dark, columns);
        status = gonio_i_unmeasured_leave_out(context, prior, readings, columns, interpretation);
    }
    if (status == GONIO_OK && *dark != NULL && interpretation->unmeasured > 0) {
        free(*dark);
        *dark = NULL;
        correct(readings, noise, NULL, columns);
        status = gonio_i_dark_level_find(context, prior, readings, noise, columns, dark);
        correct(readings, noise, *dark, columns);
    }
    return status;
}

/* Anisotropy by evidence, of readings at several azimuths of the half vector. */
static gonio_status weigh_anisotropy(gonio_context *context, const gonio_i_prior *prior,
                                     const gonio_readings *readings, const gonio_i_columns *columns,
                                     gonio_interpretation *i)
{
    const gonio_i_oriented_columns oriented = {prior, readings->pair, columns->column,
                                               columns->count, 0};
    const bool separate = prior->view->channels != GONIO_JOINT;
    if (!separate || readings->count < ENOUGH_READINGS || gonio_i_azimuths_are_same(&oriented)) {
        return GONIO_OK;
    }
    const gonio_status status =
        gonio_i_stretches_notice(context, &oriented, &i->anisotropy_evidence);
    i->anisotropic = i->anisotropic || i->anisotropy_evidence > EVIDENT;
    return status;
}

/* The evidence that is left if directions are changed as a mistake does. */
static gonio_status weigh_changed(gonio_context *context, const gonio_i_prior *prior,
                                  const gonio_readings *readings, const gonio_i_columns *columns,
                                  gonio_i_change change, double *evidence)
{
    gonio_pair *pair = gonio_i_allocate(context, readings->count, sizeof *pair);
    if (pair == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < readings->count; k++) {
        pair[k] = change(readings->pair[k]);
    }
    const gonio_i_oriented_columns oriented = {prior, pair, columns->column, columns->count, 0};
    const gonio_status status = gonio_i_stretches_notice(context, &oriented, evidence);
    free(pair);
    return status;
}

/* Whether a mistake leaves all polar angles as they are. */
static bool is_of_azimuths(const gonio_readings *readings, gonio_i_change change)
{
    bool same = change != NULL;
    for (size_t k = 0; k < readings->count && same; k++) {
        const gonio_pair pair = readings->pair[k];
        const gonio_pair changed = change(pair);
        same = changed.incident.theta == pair.incident.theta &&
               changed.outgoing.theta == pair.outgoing.theta;
    }
    return same;
}

/* Both wrong azimuths and anisotropy explain readings at several turns that do not fit. Azimuths
 * are wrong if that explains far more, and leaves the material isotropic; then it is all. */
static gonio_status decide(gonio_context *context, const gonio_i_prior *prior,
                           const gonio_readings *readings, const gonio_i_columns *columns,
                           gonio_interpretation *i)
{
    gonio_status status = GONIO_OK;
    size_t kept = 0;
    for (size_t k = 0; k < i->alternatives && status == GONIO_OK; k++) {
        const gonio_i_change change = gonio_i_mistake_change(i->alternative[k].mistake);
        const bool azimuths = is_of_azimuths(readings, change);
        double evidence = 0.0;
        if (azimuths) {
            status = weigh_changed(context, prior, readings, columns, change, &evidence);
        }
        if (!azimuths || (evidence <= EVIDENT &&
                          i->alternative[k].margin > FAR_BETTER * i->anisotropy_evidence)) {
            i->anisotropic = i->anisotropic && !azimuths;
            i->alternative[kept++] = i->alternative[k];
        }
    }
    i->alternatives = kept;
    return status;
}

gonio_status gonio_i_interpret(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, gonio_interpretation *interpretation,
                               double **dark)
{
    *interpretation = (gonio_interpretation){0};
    gonio_status status = look_at_turned(context, readings, interpretation);
    if (status == GONIO_OK) {
        status = find_zeros(context, prior, readings, noise, columns, interpretation, dark);
    }
    if (status == GONIO_OK) {
        status =
            gonio_i_mistakes_find(context, prior, readings, noise, columns, *dark, interpretation);
    }
    if (interpretation->alternatives > 0 && *dark != NULL) {
        free(*dark); /* the level was of readings with a mistake */
        *dark = NULL;
        correct(readings, noise, NULL, columns);
    }
    if (status == GONIO_OK) {
        status = weigh_anisotropy(context, prior, readings, columns, interpretation);
    }
    return status == GONIO_OK && interpretation->anisotropic &&
                   interpretation->anisotropy_evidence > EVIDENT
               ? decide(context, prior, readings, columns, interpretation)
               : status;
}
