/* How the columns of angles of a row give its two directions: see csv_geometry.h. */
#include "csv_geometry.h"

#include <math.h>
#include <string.h>

#include <gonio/measurement.h>

#include "../import.h"

static const double DEGREE = M_PI / 180.0;

/* A cosine of a phase angle may be beyond what is possible by this, from rounded angles. */
static const double ROUNDED = 5e-3;

static const char *take_four(int mirror, const double *cell, double degrees[4])
{
    (void)mirror;
    memcpy(degrees, cell, 4 * sizeof *degrees);
    return NULL;
}

static const char *take_phi_o(int mirror, const double *cell, double degrees[4])
{
    take_four(mirror, cell, degrees);
    degrees[3] = degrees[1] + cell[GONIO_I_AZIMUTH_DIFFERENCE];
    return NULL;
}

static const char *take_phi_i(int mirror, const double *cell, double degrees[4])
{
    take_four(mirror, cell, degrees);
    degrees[1] = degrees[3] - cell[GONIO_I_AZIMUTH_DIFFERENCE];
    return NULL;
}

/* Without a word on it the detector is on the mirror's side where it has the sign of theta_i. */
static const char *take_plane(int mirror, const double *cell, double degrees[4])
{
    take_four(mirror, cell, degrees);
    degrees[3] = mirror == GONIO_AS_STATED ? 180.0 : 0.0;
    return mirror == GONIO_AS_STATED && degrees[0] < 0.0
               ? "theta_i below zero without azimuths: --as mirror=180 says that light and mirror "
                 "direction have opposite signs, --as mirror=0 that they have the same"
               : NULL;
}

static const char *take_from_specular(int mirror, const double *cell, double off, double degrees[4])
{
    take_four(mirror, cell, degrees);
    degrees[0] = fabs(degrees[0]);
    degrees[2] = gonio_i_import_rounded(degrees[0] + off);
    degrees[3] = degrees[1] + (mirror == GONIO_MIRROR_0 ? 0.0 : 180.0);
    return NULL;
}

static const char *take_from_the_normal(int mirror, const double *cell, double degrees[4])
{
    return take_from_specular(mirror, cell, cell[GONIO_I_FROM_SPECULAR], degrees);
}

static const char *take_towards_light(int mirror, const double *cell, double degrees[4])
{
    return take_from_specular(mirror, cell, -cell[GONIO_I_ASPECULAR], degrees);
}

/* cos g = cos i cos o + sin i sin o cos phi. */
static const char *take_phase(int mirror, const double *cell, double degrees[4])
{
    take_four(mirror, cell, degrees);
    const double i = degrees[0] * DEGREE;
    const double o = degrees[2] * DEGREE;
    const double rest = cos(cell[GONIO_I_PHASE] * DEGREE) - cos(i) * cos(o);
    const double across = sin(i) * sin(o);
    if (fabs(rest) > fabs(across) + ROUNDED) {
        return "the phase angle is impossible between these directions";
    }
    const double cosine = across != 0.0 ? fmin(fmax(rest / across, -1.0), 1.0) : 1.0;
    degrees[3] = gonio_i_import_rounded(acos(cosine) / DEGREE);
    return NULL;
}

static const char *take_half(int mirror, const double *cell, double degrees[4])
{
    (void)mirror;
    const gonio_pair pair = gonio_pair_from_half_difference(
        (gonio_half_difference){cell[GONIO_I_THETA_H] * DEGREE, cell[GONIO_I_THETA_D] * DEGREE,
                                cell[GONIO_I_PHI_D] * DEGREE});
    degrees[0] = gonio_i_import_rounded(pair.incident.theta / DEGREE);
    degrees[1] = gonio_i_import_rounded(pair.incident.phi / DEGREE) + cell[GONIO_I_PHI_H];
    degrees[2] = gonio_i_import_rounded(pair.outgoing.theta / DEGREE);
    degrees[3] = gonio_i_import_rounded(pair.outgoing.phi / DEGREE) + cell[GONIO_I_PHI_H];
    return NULL;
}

static bool take_vector(const double *v, double *theta, double *phi)
{
    const double across = hypot(v[0], v[1]);
    *theta = gonio_i_import_rounded(atan2(across, v[2]) / DEGREE);
    const double turned = across > 0.0 ? atan2(v[1], v[0]) / DEGREE : 0.0;
    *phi = gonio_i_import_rounded(turned < 0.0 ? turned + 360.0 : turned);
    return across > 0.0 || v[2] != 0.0;
}

static const char *take_vectors(int mirror, const double *cell, double degrees[4])
{
    (void)mirror;
    const double *v = cell + GONIO_I_VECTORS;
    return take_vector(v, &degrees[0], &degrees[1]) && take_vector(v + 3, &degrees[2], &degrees[3])
               ? NULL
               : "0, 0, 0 is no direction";
}

/* Differences that no direction has are below the horizon. */
static const char *take_difference(int mirror, const double *cell, double difference,
                                   double degrees[4])
{
    take_four(mirror, cell, degrees);
    const double sine = sin(degrees[0] * DEGREE) + difference;
    degrees[2] = fabs(sine) < 1.0 ? gonio_i_import_rounded(asin(sine) / DEGREE) : 90.0;
    degrees[3] = degrees[1] + (mirror == GONIO_MIRROR_0 ? 0.0 : 180.0);
    return degrees[0] < 0.0 ? "theta_i below zero beside beta - beta0: give it above zero" : NULL;
}

static const char *take_sines(int mirror, const double *cell, double degrees[4])
{
    return take_difference(mirror, cell, cell[GONIO_I_BETA], degrees);
}

/* Both sides are the same only of light from the normal. */
static const char *take_size_of_sines(int mirror, const double *cell, double degrees[4])
{
    const char *problem = take_difference(mirror, cell, fabs(cell[GONIO_I_BETA_SIZE]), degrees);
    return problem != NULL ? problem
           : degrees[0] == 0.0
               ? NULL
               : "|beta - beta0| does not say on which side of the mirror direction the detector "
                 "is; give beta-beta0 with its sign, above zero farther from the normal";
}

static const char *take_named(int mirror, const double *cell, double degrees[4])
{
    take_four(mirror, cell, degrees);
    degrees[3] = mirror == GONIO_MIRROR_0 ? 0.0 : 180.0;
    return NULL;
}

static const struct {
    const char *words;
    const char *(*take)(int mirror, const double *cell, double degrees[4]);
} geometries[] = {
    [GONIO_I_FOUR_ANGLES] = {"", take_four},
    [GONIO_I_DIFFERENCE_GIVES_PHI_O] = {"", take_phi_o},
    [GONIO_I_DIFFERENCE_GIVES_PHI_I] = {"", take_phi_i},
    [GONIO_I_IN_PLANE] = {", in the plane, equal signs on the mirror's side", take_plane},
    [GONIO_I_FROM_THE_NORMAL] =
        {", from the mirror direction in the plane, positive away from the normal",
         take_from_the_normal},
    [GONIO_I_TOWARDS_LIGHT] =
        {", from the mirror direction in the plane, positive towards the light",
         take_towards_light},
    [GONIO_I_PHASE_ANGLE] = {", azimuths from the angle between light and detector", take_phase},
    [GONIO_I_HALF_DIFFERENCE] = {", of the half and the difference vector", take_half},
    [GONIO_I_SINES] = {", sin theta_o - sin theta_i in the plane, positive away from the normal",
                       take_sines},
    [GONIO_I_SIZE_OF_SINES] = {", in the plane at normal incidence", take_size_of_sines},
    [GONIO_I_UNIT_VECTORS] = {", directions as vectors", take_vectors},
    [GONIO_I_NAMED_DIRECTIONS] = {", in the plane, the light first, aspecular angles towards it",
                                  take_named},
};

const char *gonio_i_geometry_words(gonio_i_geometry geometry, int mirror)
{
    return geometry == GONIO_I_IN_PLANE && mirror == GONIO_MIRROR_180
               ? ", in the plane, opposite signs on the mirror's side"
               : geometries[geometry].words;
}

const char *gonio_i_geometry_take(gonio_i_geometry geometry, int mirror, const double *cell,
                                  double degrees[4])
{
    return geometries[geometry].take(mirror, cell, degrees);
}
