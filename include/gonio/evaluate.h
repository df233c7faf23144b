/* Evaluation: errors of a BRDF relative to another by every metric of metric.h, over the bins where
 * both have data; and what readings contain. */
#ifndef GONIO_EVALUATE_H
#define GONIO_EVALUATE_H

#include <gonio/metric.h>
#include <gonio/reconstruct.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_comparison {
    gonio_error all;                     /* over all channels */
    gonio_error channel[GONIO_CHANNELS]; /* each alone */
    int64_t bins;                        /* compared; or directions, see gonio_compare */
    int64_t missing;                     /* bins with data in the reference but not in the other */
} gonio_comparison;

/* Compares a material with a reference, over the bins of the grid. If one of them is anisotropic,
 * over directions that depend on phi_h too: those of every fifth bin of phi_d at 12 azimuths, which
 * are others in each bin. Independent of the number of threads.
 * Errors: _DATA if no bin has data in both, or the reference is black; those of the sources. */
GONIO_API gonio_status gonio_compare(gonio_context *context, const gonio_material *reference,
                                     const gonio_material *other, gonio_comparison *comparison);

/* The same errors over readings. Reading k of both is at the same directions
 * (gonio_readings_look_up, gonio_measure_material) and in the same channels
 * (gonio_readings_share_channels). Values that are missing in one of them do not count.
 * left_out[count], or NULL: readings that do not count, because they were used. *compared: the
 * number of readings that count. Errors: _MISMATCH (different numbers of readings or channels,
 * different wavelengths), _DATA (nothing to compare). */
GONIO_API gonio_status gonio_compare_readings(gonio_context *context,
                                              const gonio_readings *reference,
                                              const gonio_readings *other, const bool *left_out,
                                              gonio_error *error, size_t *compared);

/* ---- energy ---- */

/* Directions of the detector for light from theta_i at phi_i = 0, and weights: the sum of weight
 * times BRDF is the directional-hemispherical reflectance. Directions are denser about the mirror
 * direction; that of a Lambertian material is exact. Both arrays are the caller's, to be freed by
 * free(). Errors: _ARGUMENT for theta_i outside [0, pi/2); _MEMORY. */
GONIO_API gonio_status gonio_reflectance_directions(gonio_context *context, double theta_i,
                                                    gonio_pair **pair, double **weight,
                                                    size_t *count);

/* The directional-hemispherical reflectance (albedo) of a material: reflectance[channels] as
 * gonio_material_describe says. Directions without data count as black; NaN if there are none with.
 * *with_data: the share of the hemisphere with data, weighted by the cosine, in the first channel.
 * Errors: as above, and those of the material. */
GONIO_API gonio_status gonio_material_reflectance(gonio_context *context,
                                                  const gonio_material *material, double theta_i,
                                                  double *reflectance, double *with_data);

/* The same of a reconstruction by posterior, with its standard deviation: reflectance[channels] and
 * deviation[channels], channels as gonio_reconstruction_predict. The errors of all directions are
 * taken as fully correlated, so that the deviation is rather too large. deviation may be NULL;
 * otherwise the reconstruction has to have deviations. Errors: as above. */
GONIO_API gonio_status gonio_reconstruction_reflectance(gonio_context *context,
                                                        const gonio_basis *basis,
                                                        const gonio_reconstruction *reconstruction,
                                                        double theta_i, double *reflectance,
                                                        double *deviation);

/* ---- what readings contain ---- */

/* Values of one channel, 1/sr; NaN if there are none. */
typedef struct gonio_channel_survey {
    size_t read;   /* readings with a value here */
    size_t zero;   /* number of values that are 0 */
    double least;  /* above 0, if any is */
    double median; /* of all */
    double most;
} gonio_channel_survey;

/* The readings with values at one polar angle of the light, to 0.1 degrees. */
typedef struct gonio_incidence {
    double theta_i; /* radians */
    size_t count;
    double covered; /* share of the hemisphere, weighted by cos(theta_o), within 10 degrees of a
                     * reading or its mirror image; 0 where nothing was integrated */
    double peak;    /* largest share of a single reading in an albedo; above 1/4 a peak is too
                     * narrow for these readings, and the albedo is uncertain */
    const double *albedo; /* [channels]: of that part, the rest taken as black; NULL for few
                           * readings or many incidences */
} gonio_incidence;

enum { GONIO_MOST_OUTLIERS = 16 };

/* The contents of readings. */
typedef struct gonio_survey {
    size_t measured;               /* readings with a value */
    size_t empty;                  /* values that are missing, of all readings and channels */
    gonio_channel_survey *channel; /* [channels] */
    double theta_i[2];             /* least and most, radians */
    double theta_o[2];
    double theta_h[2];
    size_t in_plane;            /* readings in the plane of incidence, to 1 degree */
    size_t incidences;          /* polar angles of the light */
    gonio_incidence *incidence; /* [incidences], ascending */
    double *albedos;            /* what incidence[].albedo points to */
    size_t repeats;             /* readings at the same angles as an earlier one, and their */
    double repeats_percent;     /* root mean square difference relative to the mean */
    size_t reciprocal_pairs; /* of readings with light and viewer exchanged, and their difference;
                                of the first ones if tens of thousands have the same polar angles */
    double reciprocity_percent;
    size_t turned_pairs;   /* of readings at the same angles and other turns of the sample; the */
    double turned_percent; /* median difference of these: large of anisotropic materials */
    size_t outliers;       /* readings 8 times above or below all of their nearest
                            * neighbours, which agree to a factor of 3 */
    size_t outlier[GONIO_MOST_OUTLIERS]; /* the first of them */
} gonio_survey;

/* Surveys readings: ranges, coverage, albedo if it can be integrated, repeats, reciprocity,
 * outliers. With more than three channels, outliers are searched in the first, the middle and the
 * last. Errors: _MEMORY. */
GONIO_API gonio_status gonio_readings_survey(gonio_context *context, const gonio_readings *readings,
                                             gonio_survey **survey);
GONIO_API void gonio_survey_free(gonio_survey **survey);

#ifdef __cplusplus
}
#endif
#endif
