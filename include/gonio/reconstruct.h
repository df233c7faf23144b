/* Reconstruction: from a few readings to the whole BRDF, g = m + V_K c.
 *
 * With X the rows of V_K that the readings see and b_X the readings in the basis's log space:
 *   least-squares  c = argmin |X c - (b_X - m_X)| (Ali et al., eq. (5));
 *   ridge          c = S d, d = argmin |X S d - (b_X - m_X)|^2 + eta |d|^2 with the first
 *                  min(readings, K) components (Nielsen et al. 2015; Miandji et al. 2024).
 * Both are solved by QR with column pivoting.
 *   posterior      the posterior mean and standard deviation of g. The prior is a Gaussian mixture
 *                  around the columns of the database plus a smooth remainder (docs/method.md).
 *                  Works with any number of readings, one included. */
#ifndef GONIO_RECONSTRUCT_H
#define GONIO_RECONSTRUCT_H

#include <gonio/measurement.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_reconstruct_options {
    size_t size;        /* of this struct, which gonio_reconstruct_options_default sets */
    size_t components;  /* K; 0 for the plan's. If the plan states none: all of the basis, with
                         * ridge at most as many as readings */
    bool all_channels;  /* use all that was read, not only the planned channel of each direction */
    bool other_basis;   /* accept readings planned with another basis */
    const char *method; /* gonio_reconstruct_method_name; NULL for the plan's
                         * (gonio_plan_method_reconstruction). If the plan states none: posterior
                         * for a basis with mixtures, least-squares for any other */
    double eta;         /* of ridge, > 0; 0 for 40 */
    /* Of posterior only: */
    double noise;      /* standard deviation of a reading relative to its value; default 0.01 */
    double floor;      /* standard deviation of the additive noise, 1/sr; default 1e-5. Where a
                        * reading has a standard deviation of its own (measurement.h), that counts
                        * in place of noise and floor */
    double saturation; /* 1/sr; readings of this value or more are lower bounds; 0: none */
    bool deviation;    /* also compute the standard deviation of every cell */
    bool no_checks;    /* do not look for usual mistakes (gonio_interpretation) nor for a
                        * dark level (gonio_reconstruction.dark) */
    /* Of gonio_reconstruct_anisotropic and gonio_check_isotropy only: */
    int symmetry; /* turns of the sample, in a full one, that change nothing: 1, 2 (brushed metal,
                   * satin) or 4 (weaves); 0: found */
    /* Of gonio_reconstruct by posterior, of many at once, and of gonio_plan_next: half angles of
     * the apertures over which a reading is the mean, rad, from 0 (a point) to below pi/4. Where a
     * lobe is narrower than an aperture, its peak is read too low, and what is beside it too high;
     * this is undone. It takes several times as long, and usual mistakes and dark levels are not
     * looked for. */
    double source_aperture;
    double detector_aperture;
    /* Of posterior only: the directions over which gonio_reconstruction.predicted_e6 is expected,
     * but for those that were read; NULL or 0: the grid's bins, all over the hemispheres. */
    const gonio_pair *expected_at; /* [expected_count] */
    size_t expected_count;
} gonio_reconstruct_options;

GONIO_API void gonio_reconstruct_options_default_of(gonio_reconstruct_options *options,
                                                    size_t size);
static inline void gonio_reconstruct_options_default(gonio_reconstruct_options *options)
{
    gonio_reconstruct_options_default_of(options, sizeof *options);
}

/* Names and one-line descriptions of the methods; NULL past the last. */
GONIO_API const char *gonio_reconstruct_method_name(int index);
GONIO_API const char *gonio_reconstruct_method_summary(int index);

/* Whether a method is the usual one for a basis with mixtures; false for unknown names. */
GONIO_API bool gonio_reconstruct_method_suits_mixtures(const char *name);

typedef struct gonio_reconstruction {
    size_t components;
    size_t columns;          /* 1 for a joint basis; for a separate one as many as the readings have
                              * channels: 3 (R, G, B), or a spectrum's wavelengths */
    double *coefficients;    /* c, [columns][components] */
    size_t readings;         /* equations used, per column */
    double condition_number; /* kappa of X'X of the readings used; of S X'X S + eta I with ridge */
    double residual;         /* root mean square of X c - (b - m), log units */
    /* By posterior only, otherwise 0 and NULL: */
    double *field;       /* g in every row of the basis, [columns][rows] */
    double *deviation;   /* its standard deviation, [columns][rows], if asked for */
    double predicted_e6; /* the expected E6, per cent, over options->expected_at */
    double smoothness;   /* alpha: standard deviation of the remainder, log units */
    double surprise;     /* root mean square error of leave-one-out predictions of the readings, in
                          * standard deviations: 1 if the material is as the database expects */
    size_t outlying;     /* readings that the others contradict; they have almost no weight */
    size_t wavelengths;  /* 0 without wavelengths: R, G, B if there are three */
    double *wavelength;  /* [wavelengths], nm */
    const char *suspicion; /* the likeliest alternative of the interpretation; NULL without one */
    gonio_interpretation interpretation;
    double *dark; /* [columns], 1/sr: the dark level that the instrument subtracts in excess: it
                   * reads max(0, rho - dark/cos theta_i). The field is corrected for it. NULL if
                   * no reading is zero, if levels explain little, with an alternative, with
                   * no_checks, with a joint basis, and from rows */
    double database_share; /* of the BRDF that rests on the database alone: the share of the grid's
                            * bins with no reading nearer, in any channel, than the length over
                            * which materials vary smoothly (docs/method.md); NaN from rows */
    bool *contradicted; /* [count of the readings]: whether the others contradict a value of it, so
                         * that the value is outlying; NULL from rows. Of readings at the same
                         * directions only one is marked */
} gonio_reconstruction;

/* Predicts the BRDF at any directions from a reconstruction by posterior: value[channels] in 1/sr
 * and, unless `deviation` is NULL, the standard deviation of ln(1 + value/s), which needs
 * gonio_reconstruction.deviation. Returns false and writes nothing if the reconstruction is by
 * another method, or lacks the deviations requested. Threads may call it at the same time. */
GONIO_API bool gonio_reconstruction_predict(const gonio_basis *basis,
                                            const gonio_reconstruction *reconstruction,
                                            gonio_half_difference at, double *value,
                                            double *deviation);

/* Predicts what the instrument would read at the directions of `readings`, whose values are
 * replaced: the BRDF less gonio_reconstruction.dark / cos theta_i, at least 0. `readings` then has
 * as many channels as the reconstruction, and the standard deviations of the BRDF, 1/sr, if the
 * reconstruction has gonio_reconstruction.deviation. Errors: _MEMORY; _ARGUMENT for another method
 * than posterior. */
GONIO_API gonio_status gonio_reconstruction_predict_readings(
    gonio_context *context, const gonio_basis *basis, const gonio_reconstruction *reconstruction,
    gonio_readings *readings);

/* The standard deviations of g as a material, in place of rho/s: the numbers that a MERL table of
 * it holds are the deviations. Of spectra and of a single channel they are those of the colours
 * that a table has, with fully correlated errors of all wavelengths. The basis and the
 * reconstruction must outlive it. Errors: _MEMORY; _ARGUMENT if they were not asked for. */
GONIO_API gonio_status gonio_reconstruction_deviation_material(
    gonio_context *context, const gonio_basis *basis, const gonio_reconstruction *reconstruction,
    gonio_material **material);

/* Solves for the coefficients. options may be NULL. *reconstruction is the caller's; basis and
 * readings need not outlive it. The same on any number of threads. Errors: _UNDETERMINED if the
 * readings have fewer than K independent rows (the message says how many and what to do); _MISMATCH
 * if they were planned with another basis, or for more components than the basis has; _ARGUMENT
 * (options->components more than the basis has, an unknown method, a negative eta); _DATA (a
 * planned channel was not read). */
GONIO_API gonio_status gonio_reconstruct(gonio_context *context, const gonio_basis *basis,
                                         const gonio_readings *readings,
                                         const gonio_reconstruct_options *options,
                                         gonio_reconstruction **reconstruction);

/* The same by least squares for rows of the basis given by number, with b in the basis's log space:
 * c for columns x count values b[column][count]. Errors: _ARGUMENT (no rows, a row or components
 * that the basis does not have); _UNDETERMINED; _MEMORY. */
GONIO_API gonio_status gonio_reconstruct_rows(gonio_context *context, const gonio_basis *basis,
                                              size_t components, const size_t *rows, size_t count,
                                              const double *b,
                                              gonio_reconstruction **reconstruction);

/* The same by any method: options' components, method and eta count. method NULL: posterior for a
 * basis with mixtures, least-squares for any other. options may be NULL. Errors: the same, and
 * those of gonio_reconstruct. */
GONIO_API gonio_status gonio_reconstruct_rows_with(gonio_context *context, const gonio_basis *basis,
                                                   const gonio_reconstruct_options *options,
                                                   const size_t *rows, size_t count,
                                                   const double *b,
                                                   gonio_reconstruction **reconstruction);

/* Noise-free readings of a material at rows of the basis, in its log space. A cell's value is that
 * of database.h (for a bivariate cell the mean over phi_d). b[column][count] has one column for a
 * joint basis, and R, G, B for a separate one.
 * Errors: _ARGUMENT (no rows, a row that the basis does not have); _DATA if the material has no
 * data in a cell; _MEMORY; those of the material. */
GONIO_API gonio_status gonio_material_rows(gonio_context *context, const gonio_basis *basis,
                                           const gonio_material *material, const size_t *rows,
                                           size_t count, double *b);

/* Both at once, without files: a known material, read at rows of the basis (gonio_plan_rows) and
 * reconstructed. With options->all_channels every channel is read in the cells of the rows. options
 * may be NULL. The basis must outlive the result, the original need not. Errors: those of the
 * parts. */
GONIO_API gonio_status gonio_reconstruct_material(gonio_context *context, const gonio_basis *basis,
                                                  const gonio_material *original,
                                                  const size_t *rows, size_t count,
                                                  const gonio_reconstruct_options *options,
                                                  gonio_material **material);

/* Plans the next readings of a material, given the readings so far: the directions that leave the
 * least expected error under the posterior covariance, averaged over the channels. Both options may
 * be NULL. Of plan_options, the fields count, metric, candidates and target are used, as by the
 * method expected-error. Directions that were read are not proposed again. expected[] is the
 * expected E6 of this material, per cent. Usual mistakes and a dark level are looked for as in a
 * reconstruction; *interpretation is that of gonio_reconstruction. *expected_now is the expected E6
 * without another reading. If it is at most plan_options->target (above 0), *plan is NULL.
 * interpretation and expected_now may be NULL. Errors: those of gonio_reconstruct and
 * gonio_plan_create. */
GONIO_API gonio_status gonio_plan_next(gonio_context *context, const gonio_basis *basis,
                                       const gonio_readings *readings,
                                       const gonio_reconstruct_options *options,
                                       const gonio_plan_options *plan_options, double *expected_now,
                                       gonio_interpretation *interpretation, gonio_plan **plan);

GONIO_API void gonio_reconstruction_free(gonio_reconstruction **reconstruction);

/* The reconstructed BRDF as a material. Every valid bin of a cell has the cell's value; a cell that
 * the basis lacks has the value of the nearest cell. The basis must outlive the material; the
 * reconstruction need not. Errors: _MEMORY. */
GONIO_API gonio_status gonio_reconstruction_material(gonio_context *context,
                                                     const gonio_basis *basis,
                                                     const gonio_reconstruction *reconstruction,
                                                     const char *name, gonio_material **material);

/* The same in all channels of the reconstruction where they are wavelengths or a single one
 * (posterior), evaluated at any directions as gonio_reconstruction_predict; a table of R, G, B of
 * another one. The basis and the reconstruction must outlive the material. Errors: _MEMORY. */
GONIO_API gonio_status gonio_reconstruction_spectral_material(
    gonio_context *context, const gonio_basis *basis, const gonio_reconstruction *reconstruction,
    const char *name, gonio_material **material);

/* Solves for `count` materials and writes readings[k]'s reconstruction to paths[k] as a MERL table
 * (material.h), several at a time. Every table appears whole or not at all, and in order: if one
 * fails, the tables before it are written, it and those after it are not. Of several failures to
 * solve the first is reported. The bytes do not depend on the number of threads. Memory grows with
 * the number of threads, not with `count`. options may be NULL.
 * made: `count` pointers; on return, success or not, the reconstructions of the tables that are in
 * place, to be freed by the caller, and NULL for the others.
 * Errors: those of gonio_reconstruct; _IO; _MEMORY; _CANCELLED. */
GONIO_API gonio_status gonio_reconstruct_tables(gonio_context *context, const gonio_basis *basis,
                                                const gonio_readings *const *readings,
                                                const char *const *paths, size_t count,
                                                const gonio_reconstruct_options *options,
                                                gonio_reconstruction **made);

/* ---- anisotropic materials ---- */

/* A BRDF that depends on the azimuth of the half vector too, found from readings by what a basis of
 * isotropic materials teaches (docs/method.md, "Anisotropic materials"). */
typedef struct gonio_anisotropic_reconstruction gonio_anisotropic_reconstruction;

/* What readings say of a material's anisotropy. */
typedef struct gonio_anisotropy {
    double probability; /* that the material is anisotropic */
    double evidence;    /* ln of the odds of that */
    int symmetry;       /* of the likeliest anisotropic description: 1, 2 or 4 */
    double axis_ratio;  /* of its lobes' slopes, at least 1; 1 for one without long axes */
    double rotation;    /* azimuth of the grain, the short axis of slopes, [0, pi), radians */
    bool cannot_tell;   /* all readings are at one azimuth of the half vector */
    bool fibres;        /* along the grain, beneath the surface: axis_ratio is 1 */
} gonio_anisotropy;

/* A description. The view and its pointers belong to the reconstruction. */
typedef struct gonio_anisotropic_reconstruction_view {
    size_t channels;
    const double *wavelength; /* [channels], nm; NULL: R, G, B, or a single channel */
    size_t readings;          /* used, of the channel with most */
    size_t left_out;          /* of more than can be used, as many as these */
    size_t outlying;          /* readings that the others contradict */
    double predicted_e6;      /* the expected E6 over all directions and azimuths, per cent */
    gonio_anisotropy anisotropy;
} gonio_anisotropic_reconstruction_view;

/* Reconstructs from readings at pairs of directions whose azimuths count. The basis has separate
 * channels and the log mapping. options may be NULL; noise, floor, saturation, other_basis and
 * symmetry count. Usual mistakes and dark levels are not looked for: the checks take the material
 * for isotropic. A warning says so if the readings are all at one azimuth. *made is the caller's;
 * the basis must outlive it, the readings need not. The same on any number of threads. Errors:
 * those of gonio_reconstruct by posterior; _ARGUMENT (a joint basis, another symmetry). */
GONIO_API gonio_status gonio_reconstruct_anisotropic(gonio_context *context,
                                                     const gonio_basis *basis,
                                                     const gonio_readings *readings,
                                                     const gonio_reconstruct_options *options,
                                                     gonio_anisotropic_reconstruction **made);
GONIO_API void gonio_anisotropic_reconstruction_free(gonio_anisotropic_reconstruction **made);

GONIO_API const gonio_anisotropic_reconstruction_view *
gonio_anisotropic_reconstruction_describe(const gonio_anisotropic_reconstruction *made);

/* Predicts the BRDF at pairs of directions: value[count][channels] in 1/sr and, unless NULL,
 * deviation[count][channels], the standard deviation of ln(1 + value/s). Errors: _MEMORY,
 * _CANCELLED. */
GONIO_API gonio_status gonio_anisotropic_reconstruction_predict(
    gonio_context *context, const gonio_anisotropic_reconstruction *made, const gonio_pair *pairs,
    size_t count, double *value, double *deviation);

/* Replaces the values of readings by predictions, with their standard deviations in 1/sr. Errors:
 * the same. */
GONIO_API gonio_status gonio_anisotropic_reconstruction_predict_readings(
    gonio_context *context, const gonio_anisotropic_reconstruction *made, gonio_readings *readings);

/* The mean as a material: an anisotropic table (material.h) of 36 cells of phi_d, with as many
 * orders of phi_h as the hypotheses need. It has no phi_h, and is isotropic, if no hypothesis that
 * counts has. The reconstruction need not outlive it. Errors: _MEMORY, _CANCELLED, _ARGUMENT (more
 * channels than a table of 1 GiB has room for). */
GONIO_API gonio_status gonio_anisotropic_reconstruction_material(
    gonio_context *context, const gonio_anisotropic_reconstruction *made, const char *name,
    gonio_material **material);

/* What readings say of a material's anisotropy, and what they leave open. */
typedef struct gonio_isotropy_check {
    gonio_anisotropy anisotropy;
    double ratio_limit; /* ratios of axes above this are excluded with 95 per cent, if the material
                         * is an isotropic one stretched; infinite if none is */
    size_t more;        /* readings at other turns of the sample that would show a ratio of axes of
                         * 1.3, if the material is not said to be either with 95 per cent; 0 */
} gonio_isotropy_check;

/* Checks isotropy without a reconstruction. options as of gonio_reconstruct_anisotropic. Errors:
 * the same. */
GONIO_API gonio_status gonio_check_isotropy(gonio_context *context, const gonio_basis *basis,
                                            const gonio_readings *readings,
                                            const gonio_reconstruct_options *options,
                                            gonio_isotropy_check *check);

/* A material's own bivariate average (database.h) as a material: the lower bound of the error of
 * any bivariate method. The original must outlive it. Errors: _MEMORY. */
GONIO_API gonio_status gonio_bivariate_material(gonio_context *context,
                                                const gonio_material *original,
                                                gonio_material **material);

#ifdef __cplusplus
}
#endif
#endif
