/* The prior of anisotropic materials, made from what a basis says of isotropic ones.
 *
 * Facets of a brushed or woven surface have slopes that are larger across the grain than along it.
 * So contours of an anisotropic lobe are ellipses of slopes where those of an isotropic lobe are
 * circles. A stretch takes a half vector of an anisotropic material to one of an isotropic
 * material,
 *
 *     tan theta_h' = tan theta_h (r cos^2(phi_h - psi) + sin^2(phi_h - psi) / r)^(1/2),
 *
 * with the ratio r of the axes and the azimuth psi of the grain. The area of slopes stays the
 * same. The isotropic prior is then evaluated at (theta_h', theta_d, phi_d).
 *
 * What this leaves open differs from one azimuth of the half vector to another. Covariances of the
 * isotropic prior are multiplied by
 *
 *     1 - share + share kappa,   kappa = exp(-|q - q'|^2/2),
 *     q = t (cos n phi_h', sin n phi_h'),   t = (sin theta_h')^(1/2) / LENGTH,
 *
 * those of the remainder by kappa. phi_h' is the azimuth of the stretched half vector, counted from
 * the grain: tan phi_h' = tan (phi_h - psi) / r. n is the symmetry: the number of turns of the
 * sample that change nothing. t becomes 0 towards the mirror direction, where the half vector has
 * no azimuth.
 *
 * A mirrored stretch has the grain for a plane of symmetry: half vectors to either side of it are
 * alike, with |sin n phi_h'| in q.
 *
 * Slopes have a density P. That of facets, which a lobe is proportional to, is P / cos^4 theta_h:
 * where only P is stretched, the values of the isotropic material are multiplied by
 *
 *     cos^4 theta_h' / cos^4 theta_h.
 *
 * Stretches are tried with this factor (facets) and without, as not all that is anisotropic
 * consists of facets.
 *
 * Fibres beneath a smooth surface reflect into a cone around them (Marschner et al. 2005): what
 * they add depends on the sum of the two directions along the fibre, and is at any place on that
 * axis if they are tilted out of the surface. So half vectors are not stretched. Instead
 *
 *     q = (r^(1/2) s_u, r^(-1/2) |s_v|) / LENGTH and theta_d / DEPTH,
 *
 * with the sum s of the directions along the grain, u, and across it, v; and the smooth part of
 * the remainder is kappa alone. */
#ifndef GONIO_STRETCH_H
#define GONIO_STRETCH_H

#include "prior.h"

/* Half/difference coordinates with the azimuth of the half vector, radians. */
typedef struct gonio_i_oriented {
    gonio_half_difference at;
    double phi_h; /* 0 where theta_h = 0 */
} gonio_i_oriented;

gonio_i_oriented gonio_i_oriented_of(gonio_pair pair);

/* Places drawn from the bins of the grid whose directions are above the horizon, all azimuths of
 * the half vector alike: place[count], the same for the same seed. */
void gonio_i_oriented_sample(uint64_t seed, size_t count, gonio_i_oriented *place);

/* The other way. One of the directions may come out below the horizon. */
gonio_pair gonio_i_oriented_pair(gonio_i_oriented here);

typedef struct gonio_i_stretch {
    double log_ratio; /* ln r, 0 or more; 0: isotropic lobes */
    double rotation;  /* psi, radians */
    double share;     /* of the isotropic covariance that depends on phi_h; 0 .. 1 */
    int symmetry;     /* n: 1, 2 or 4; 0: kappa is 1, with share 0 the isotropic prior */
    bool mirrored;    /* psi is the azimuth of a plane of symmetry: |sin| in q */
    bool facets;      /* values are multiplied by the ratio of the densities of facets */
    bool fibres;      /* q is that of fibres; with symmetry 2 it has |s_u| */
} gonio_i_stretch;

/* Stretches that readings leave open, at most. */
enum { GONIO_I_MOST_HYPOTHESES = 12 };

bool gonio_i_stretch_is_isotropic(const gonio_i_stretch *stretch);

/* Where the isotropic prior is evaluated. */
gonio_half_difference gonio_i_stretch_apply(const gonio_i_stretch *stretch, gonio_i_oriented here);

/* ln of what the isotropic material's values are multiplied by there; 0 but for facets. */
double gonio_i_stretch_log_factor(const gonio_i_stretch *stretch, gonio_i_oriented here);

/* The logarithm of brightness g (ln(1 + value/scale)) once values are multiplied by the factor, and
 * its derivative by g. */
double gonio_i_multiplied(double g, double log_factor, double *slope);

/* q. */
typedef struct gonio_i_azimuth_point {
    double x;
    double y;
    double depth; /* of theta_d; 0 but for fibres */
} gonio_i_azimuth_point;

gonio_i_azimuth_point gonio_i_azimuth_of(const gonio_i_stretch *stretch, gonio_i_oriented here);

/* kappa. */
double gonio_i_azimuth_kernel(gonio_i_azimuth_point a, gonio_i_azimuth_point b);

/* What kappa is multiplied by in the remainder: k, or for fibres k without its smooth part, plus 1.
 */
double gonio_i_stretch_remainder(const gonio_i_stretch *stretch, const gonio_i_place *a,
                                 const gonio_i_place *b, double peak, double retro);

#endif
