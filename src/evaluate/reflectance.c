/* The directional-hemispherical reflectance at any incidence: see evaluate.h.
 *
 * The hemisphere is cut into panels of theta_o and phi_o that become narrower towards the mirror
 * direction, each with Gauss-Legendre points in sin^2 theta_o and phi_o. The projected solid angle
 * is half the product of these two, so that the reflectance of a Lambertian material is exact. */
#include <math.h>
#include <stdlib.h>

#include <gonio/evaluate.h>

#include "../core/core.h"

enum { POINTS = 5, EDGES = 10, MOST_EDGES = 2 * EDGES + 3 };

/* Gauss-Legendre on (0, 1). */
static const double point[POINTS] = {0.04691007703066800, 0.23076534494715845, 0.5,
                                     0.76923465505284155, 0.95308992296933200};
static const double share[POINTS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                     0.23931433524968324, 0.11846344252809454};

/* Distances of the panels' edges from the mirror direction, degrees. */
static const double distance[EDGES] = {0.0, 0.1, 0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

/* The ends of panels of an angle that has its middle at `centre`: edge[MOST_EDGES], ascending,
 * radians. Returns how many. */
static size_t make_edges(double low, double high, double centre, double *edge)
{
    size_t count = 0;
    edge[count++] = low;
    for (int k = -(EDGES - 1); k < EDGES; k++) {
        const double at = centre + copysign(distance[abs(k)], k) * M_PI / 180.0;
        if (at > edge[count - 1] + 1e-9 && at < high - 1e-9) {
            edge[count++] = at;
        }
    }
    edge[count++] = high;
    return count;
}

/* Points and weights of an angle; square: in sin^2 of it, halved. Returns how many. */
static size_t make_points(const double *edge, size_t edges, bool square, double *at, double *weight)
{
    size_t count = 0;
    for (size_t k = 0; k + 1 < edges; k++) {
        const double low = square ? pow(sin(edge[k]), 2) : edge[k];
        const double high = square ? pow(sin(edge[k + 1]), 2) : edge[k + 1];
        for (int p = 0; p < POINTS; p++) {
            const double value = low + point[p] * (high - low);
            at[count] = square ? asin(sqrt(fmin(value, 1.0))) : value;
            weight[count++] = share[p] * (high - low) * (square ? 0.5 : 1.0);
        }
    }
    return count;
}

gonio_status gonio_reflectance_directions(gonio_context *context, double theta_i, gonio_pair **pair,
                                          double **weight, size_t *count)
{
    double edge[MOST_EDGES];
    double theta[MOST_EDGES * POINTS];
    double phi[MOST_EDGES * POINTS];
    double of_theta[MOST_EDGES * POINTS];
    double of_phi[MOST_EDGES * POINTS];
    if (!(theta_i >= 0.0 && theta_i < M_PI / 2.0)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a reflectance is of light from 0 to below 90 degrees, not %g",
                            theta_i * 180.0 / M_PI);
    }
    const size_t rings =
        make_points(edge, make_edges(0.0, M_PI / 2.0, theta_i, edge), true, theta, of_theta);
    const size_t spokes =
        make_points(edge, make_edges(0.0, 2.0 * M_PI, M_PI, edge), false, phi, of_phi);
    gonio_pair *pairs = gonio_i_allocate(context, rings * spokes, sizeof *pairs);
    double *weights = gonio_i_allocate(context, rings * spokes, sizeof *weights);
    if (pairs == NULL || weights == NULL) {
        free(pairs);
        free(weights);
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < rings * spokes; k++) {
        pairs[k] = (gonio_pair){{theta_i, 0.0}, {theta[k / spokes], phi[k % spokes]}};
        weights[k] = of_theta[k / spokes] * of_phi[k % spokes];
    }
    *pair = pairs;
    *weight = weights;
    *count = rings * spokes;
    return GONIO_OK;
}

/* ---- of a material ---- */

static void add_up(const double *values, const double *weight, size_t count, size_t channels,
                   double *reflectance, double *with_data)
{
    *with_data = 0.0;
    for (size_t c = 0; c < channels; c++) {
        reflectance[c] = 0.0;
    }
    for (size_t k = 0; k < count; k++) {
        for (size_t c = 0; c < channels; c++) {
            const double value = values[k * channels + c];
            reflectance[c] += isnan(value) ? 0.0 : weight[k] * value;
        }
        *with_data += isnan(values[k * channels]) ? 0.0 : weight[k] / M_PI;
    }
    for (size_t c = 0; c < channels; c++) {
        reflectance[c] = *with_data > 0.0 ? reflectance[c] : NAN;
    }
}

gonio_status gonio_material_reflectance(gonio_context *context, const gonio_material *material,
                                        double theta_i, double *reflectance, double *with_data)
{
    const size_t channels = gonio_material_describe(material)->channels;
    gonio_pair *pair = NULL;
    double *weight = NULL;
    double *values = NULL;
    size_t count = 0;
    gonio_status status = gonio_reflectance_directions(context, theta_i, &pair, &weight, &count);
    if (status == GONIO_OK) {
        values = gonio_i_allocate(context, count * channels, sizeof *values);
        status = values == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    if (status == GONIO_OK) {
        status = gonio_material_evaluate(context, material, pair, count, values);
    }
    if (status == GONIO_OK) {
        add_up(values, weight, count, channels, reflectance, with_data);
    }
    free(pair);
    free(weight);
    free(values);
    return status;
}

/* ---- of a reconstruction ---- */

/* Scale s of a channel in log space, as gonio_readings_scale. */
static double scale_of(const gonio_reconstruction *r, size_t channels, size_t channel)
{
    const bool colours = r->wavelengths == 0 && channels == GONIO_CHANNELS;
    return gonio_log_scale(colours ? (int)channel : GONIO_CHANNELS);
}

static void add_prediction(const gonio_basis *basis, const gonio_reconstruction *r, gonio_pair pair,
                           double weight, size_t channels, double *value, double *spread,
                           double *reflectance, double *deviation)
{
    gonio_reconstruction_predict(basis, r, gonio_half_difference_from_pair(pair), value, spread);
    for (size_t c = 0; c < channels; c++) {
        reflectance[c] += weight * value[c];
        if (spread != NULL) {
            deviation[c] += weight * (value[c] + scale_of(r, channels, c)) * spread[c];
        }
    }
}

gonio_status gonio_reconstruction_reflectance(gonio_context *context, const gonio_basis *basis,
                                              const gonio_reconstruction *r, double theta_i,
                                              double *reflectance, double *deviation)
{
    gonio_pair *pair = NULL;
    double *weight = NULL;
    size_t count = 0;
    const bool joint = gonio_basis_describe(basis)->channels == GONIO_JOINT;
    const size_t channels = joint ? GONIO_CHANNELS : r->columns;
    if (r->field == NULL || (deviation != NULL && r->deviation == NULL)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "the reflectance of a reconstruction needs one by posterior, and "
                            "deviations if its own is wanted");
    }
    double *value = gonio_i_allocate(context, channels, sizeof *value);
    double *spread = gonio_i_allocate(context, channels, sizeof *spread);
    gonio_status status = value == NULL || spread == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    if (status == GONIO_OK) {
        status = gonio_reflectance_directions(context, theta_i, &pair, &weight, &count);
    }
    for (size_t c = 0; c < channels && status == GONIO_OK; c++) {
        reflectance[c] = 0.0;
        if (deviation != NULL) {
            deviation[c] = 0.0;
        }
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        add_prediction(basis, r, pair[k], weight[k], channels, value,
                       deviation != NULL ? spread : NULL, reflectance, deviation);
    }
    free(pair);
    free(weight);
    free(value);
    free(spread);
    return status;
}
