/* Reconstruction: from a few readings to the whole BRDF, g = m + V_K c.
 *
 * With X the rows of V_K that the readings see and b_X the readings in the basis's log space:
 *   least-squares  c = argmin |X c - (b_X - m_X)| (Ali et al., eq. (5));
 *   ridge          c = S d, d = argmin |X S d - (b_X - m_X)|^2 + eta |d|^2 with the first
 *                  min(readings, K) components (Nielsen et al. 2015; Miandji et al. 2024).
 * Both are solved by QR with column pivoting.
 *   posterior      the mean of what the database and the readings say together, with its deviation:
 *                  a Gaussian mixture around the columns of the database and a smooth remainder
 *                  (docs/accuracy.md). Works with any number of readings, one included. */
#ifndef GONIO_RECONSTRUCT_H
#define GONIO_RECONSTRUCT_H

#include <gonio/measurement.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_reconstruct_options {
    size_t size;        /* of this struct, which gonio_reconstruct_options_default sets */
    size_t components;  /* K; 0 for the plan's, or if it states none as many as the basis has, with
                         * ridge no more than there are readings */
    bool all_channels;  /* use all that was read, not only the planned channel of each direction */
    bool other_basis;   /* accept readings planned with another basis */
    const char *method; /* gonio_reconstruct_method_name; NULL for what belongs to the plan
                         * (gonio_plan_method_reconstruction); if it states none, posterior for a
                         * basis with mixtures and least-squares for any other */
    double eta;         /* of ridge, > 0; 0 for 40 */
    /* Of posterior only: */
    double noise;      /* standard deviation of a reading relative to its value; default 0.01 */
    double floor;      /* standard deviation of the additive noise, 1/sr; default 1e-5. Where a
                        * reading has a standard deviation of its own (measurement.h), that counts
                        * in place of noise and floor */
    double saturation; /* readings of this value or more, 1/sr, mean at least it; 0: none */
    bool deviation;    /* find the standard deviation of every cell too */
    bool no_checks;    /* do not look for usual mistakes (gonio_reconstruction.suspicion) nor for a
                        * dark level (gonio_reconstruction.dark) */
} gonio_reconstruct_options;

GONIO_API void gonio_reconstruct_options_default(gonio_reconstruct_options *options);

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
    double predicted_e6; /* the E6 to expect, per cent */
    double smoothness;   /* alpha: how far the remainder goes from the database, log units */
    double surprise;     /* root mean square of what the others say of each reading, in deviations:
                          * 1 where the material is as the database expects */
    size_t outlying;     /* readings that the others contradict; they hardly count */
    size_t wavelengths;  /* 0 without wavelengths: R, G, B if there are three */
    double *wavelength;  /* [wavelengths], nm */
    const char *suspicion; /* what would explain the readings far better than what they say they
                            * are ("the values include the cosine of theta_o"), static; NULL if
                            * nothing */
    double *dark; /* [columns], 1/sr: what the instrument seems to subtract too much; it reads
                   * max(0, rho - dark/cos theta_i) of rho. The field is the material's, without it.
                   * NULL where no reading is zero, where levels explain little, with a suspicion,
                   * with no_checks, with a joint basis and from rows */
} gonio_reconstruction;

/* What a reconstruction by posterior says of the material at any directions: value[channels] in
 * 1/sr, and, unless it is NULL, the standard deviation of ln(1 + value/s) (needs
 * gonio_reconstruction.deviation). False, and nothing is written, if it is not one by posterior or
 * has no deviations that are asked for. Threads may call it at the same time. */
GONIO_API bool gonio_reconstruction_predict(const gonio_basis *basis,
                                            const gonio_reconstruction *reconstruction,
                                            gonio_half_difference at, double *value,
                                            double *deviation);

/* What the instrument would read at all directions of `readings`, whose values are replaced: the
 * same, less gonio_reconstruction.dark / cos theta_i, and no less than 0; as many channels as the
 * reconstruction has. Errors: _MEMORY; _ARGUMENT if it is not one by posterior. */
GONIO_API gonio_status gonio_reconstruction_predict_readings(
    gonio_context *context, const gonio_basis *basis, const gonio_reconstruction *reconstruction,
    gonio_readings *readings);

/* The standard deviations of g as a material, in place of rho/s: the numbers that a MERL table of
 * it holds are the deviations. Of spectra and of a single channel they are those of the colours
 * that a table has, the errors of all wavelengths taken as going together. The basis and the
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

/* What an instrument without noise would read of a material at rows of the basis, in its log space:
 * a cell's value is that of database.h (of a bivariate cell the mean over phi_d).
 * b[column][count]: of a joint basis one column; of a separate one R, G, B.
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

/* What to read next of a material of which something was read: the directions that leave the least
 * expected error given what the readings say it is like (the covariance of the posterior, averaged
 * over the channels). Both options may be NULL. plan_options: count, metric, candidates and target
 * count, as for the method expected-error; readings that were made are not proposed again, and
 * expected[] is per cent of this material. A dark level and usual mistakes are looked for as in a
 * reconstruction: *suspicion is gonio_reconstruction.suspicion. *expected_now: the E6 to expect
 * without another reading; if it is at most plan_options->target (above 0), there is nothing
 * to read and *plan is NULL. suspicion and expected_now may be NULL. Errors: those of
 * gonio_reconstruct and gonio_plan_create. */
GONIO_API gonio_status gonio_plan_next(gonio_context *context, const gonio_basis *basis,
                                       const gonio_readings *readings,
                                       const gonio_reconstruct_options *options,
                                       const gonio_plan_options *plan_options, double *expected_now,
                                       const char **suspicion, gonio_plan **plan);

GONIO_API void gonio_reconstruction_free(gonio_reconstruction **reconstruction);

/* The reconstructed BRDF as a material: every valid bin of a cell has the cell's value, cells that
 * the basis lacks that of their nearest. The basis must outlive the material; the reconstruction
 * need not. Errors: _MEMORY. */
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
 * (material.h), several at a time. Every table appears whole or not at all, and after those before
 * it: if one fails, those before it are in place, it and those after it are not. Of several
 * failures of solving the first is told. The bytes do not depend on the number of threads; memory
 * does, not on `count`. options may be NULL.
 * made: `count` pointers; on return, success or not, the reconstructions of the tables that are in
 * place, to be freed by the caller, and NULL for the others.
 * Errors: those of gonio_reconstruct; _IO; _MEMORY; _CANCELLED. */
GONIO_API gonio_status gonio_reconstruct_tables(gonio_context *context, const gonio_basis *basis,
                                                const gonio_readings *const *readings,
                                                const char *const *paths, size_t count,
                                                const gonio_reconstruct_options *options,
                                                gonio_reconstruction **made);

/* A material's own bivariate average (database.h) as a material: the best any bivariate method can
 * do. The original must outlive it. Errors: _MEMORY. */
GONIO_API gonio_status gonio_bivariate_material(gonio_context *context,
                                                const gonio_material *original,
                                                gonio_material **material);

#ifdef __cplusplus
}
#endif
#endif
