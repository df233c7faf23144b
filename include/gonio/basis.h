/* A basis: the mean and the principal components of a database, in its log space.
 *
 * H - m = V S W' (Ali et al., section 3.6). m is the mean column. If a basis is learned without
 * mean, m is 0, or in the relative mapping ln((median + e)/e) with the median of rho w over the
 * columns, so that H - m = ln((rho w + e)/(median + e)). V is rows x components, orthonormal,
 * stored row by row: the K values of a row are contiguous. A reading observes one row. Rows are
 * numbered as in database.h: joint, row = 3 x (position of the cell) + channel; separate, row =
 * position of the cell. The k-th component's sign makes its largest entry positive. V is in single
 * precision, in memory and in files, so that a basis gives the same results before and after it is
 * written. All else is in double precision. */
#ifndef GONIO_BASIS_H
#define GONIO_BASIS_H

#include <gonio/database.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gonio_basis gonio_basis;

/* Mixtures. A hundred materials do not cover all coatings, blends and finishes. A mixture is a
 * computed column, made of two measured columns that are drawn at random:
 *
 *     g = ln(1 + u (e^a - 1) + (1 - u) (e^b - 1)),   u uniform in (0, 1),
 *
 * a weighted sum of reflectances. a and b are the two columns with wider or narrower lobes, and
 * with grazing effects (Fresnel reflection, shadowing) that begin earlier or later:
 *
 *     a(theta_h, theta_d) = column(theta_h / f, 90 degrees (theta_d / 90 degrees)^t),
 *
 * where ln f and ln t are normal with standard deviations 0.3 and 0.25. All mixtures together have
 * the weight of all measured columns: m is the mean of the two groups' means, and every column of
 * H - m is multiplied by the square root of its weight (on average 1).
 *
 * Analytic columns are those of random analytic materials (atlas.h). All together have a share of
 * 5 %; measured columns and mixtures share the rest. So the basis spans materials unlike the
 * database's, too: of real tables of another instrument, errors are 7 to 22 % smaller
 * (docs/experiments.md). Where the grid has phi_d, each material is elongated across the plane of
 * incidence, as samples are that pass for isotropic (docs/method.md). */
enum { GONIO_DEFAULT_MIXTURES = 1000, GONIO_MIXTURE_COMPONENTS = 300 };

enum { GONIO_DEFAULT_COMPONENTS = 45 };

/* Number of mixtures: GONIO_DEFAULT_MIXTURES on the sectored grid with separate channels, the log
 * mapping and a mean; none otherwise. */
#define GONIO_USUAL_MIXTURES SIZE_MAX

/* Number of analytic materials: GONIO_DEFAULT_ANALYTIC beside the usual mixtures if there are some;
 * none otherwise. */
#define GONIO_USUAL_ANALYTIC SIZE_MAX

enum { GONIO_DEFAULT_ANALYTIC = 200 };

typedef struct gonio_basis_options {
    size_t size;          /* of this struct, which gonio_basis_options_default sets */
    size_t components;    /* K; 0 for 300 with mixtures, 45 without, or as many as there are;
                           * without mean all of them */
    const size_t *subset; /* learn from these materials of the database only; NULL for all */
    size_t subset_count;
    bool without_mean; /* components of H itself; all of them span the materials */
    size_t mixtures;   /* computed columns beside the measured ones; GONIO_USUAL_MIXTURES by
                        * default */
    uint64_t seed;     /* of the mixtures */
    size_t analytic;   /* random materials beside the measured ones; GONIO_USUAL_ANALYTIC by
                        * default; at most GONIO_ATLAS_RANDOM_COUNT */
} gonio_basis_options;

GONIO_API void gonio_basis_options_default_of(gonio_basis_options *options, size_t size);
static inline void gonio_basis_options_default(gonio_basis_options *options)
{
    gonio_basis_options_default_of(options, sizeof *options);
}

/* Learns a basis by the Gram matrix of the columns, summed over tiles of rows in double precision.
 * Before V is rounded to single precision, max |V'V - I| is at most 1e-11: otherwise V is
 * orthonormalised again (Cholesky QR). The result does not depend on the number
 * of threads. Memory: the basis, and a few MB a thread.
 * options may be NULL. *basis is the caller's; the database need not outlive it.
 * Errors: _ARGUMENT if K > columns - 1 (without mean, > columns), for mixtures of another kind of
 * database, for analytic materials without a mean and for a material of the subset that it does not
 * have; _DATA if the columns span fewer than K dimensions; _MEMORY; those of
 * gonio_database_read_rows. */
GONIO_API gonio_status gonio_basis_learn(gonio_context *context, const gonio_database *database,
                                         const gonio_basis_options *options, gonio_basis **basis);

/* How a basis is learned from materials. Set one by a function below, then change fields. */
typedef struct gonio_recipe {
    size_t size; /* of this struct, which the functions below set */
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    bool without_mean;   /* as in gonio_basis_options, as are the next three */
    size_t components;   /* 0 by default */
    size_t mixtures;     /* GONIO_USUAL_MIXTURES by default */
    uint64_t seed;       /* of the mixtures; 0 by default */
    const char *scratch; /* folder for scratch files; NULL for $TMPDIR or /tmp */
    size_t analytic;     /* GONIO_USUAL_ANALYTIC by default */
} gonio_recipe;

/* The default recipe: sectored, separate, 1000 mixtures, 200 analytic materials, 300 components. */
GONIO_API void gonio_recipe_default_of(gonio_recipe *recipe, size_t size);
static inline void gonio_recipe_default(gonio_recipe *recipe)
{
    gonio_recipe_default_of(recipe, sizeof *recipe);
}

/* The paper's: bivariate, joint, no mixtures, 45 components. */
GONIO_API void gonio_recipe_paper_of(gonio_recipe *recipe, size_t size);
static inline void gonio_recipe_paper(gonio_recipe *recipe)
{
    gonio_recipe_paper_of(recipe, sizeof *recipe);
}

/* The usual recipe of a grid: separate channels if it is sectored, joint channels otherwise. The
 * two recipes above are those of the sectored and the bivariate grid. */
GONIO_API void gonio_recipe_for_grid_of(gonio_recipe *recipe, size_t size,
                                        gonio_representation representation);
static inline void gonio_recipe_for_grid(gonio_recipe *recipe, gonio_representation representation)
{
    gonio_recipe_for_grid_of(recipe, sizeof *recipe, representation);
}

/* Learns a basis from the materials at paths[count] (as gonio_material_open takes them), in their
 * order. recipe may be NULL for the default one. *basis is the caller's. The result does not depend
 * on the number of threads. Errors: _ARGUMENT (a recipe that was not set by one of the functions
 * above); those of gonio_database_create and gonio_basis_learn. */
GONIO_API gonio_status gonio_learn(gonio_context *context, const char *const *paths, size_t count,
                                   const gonio_recipe *recipe, gonio_basis **basis);

GONIO_API void gonio_basis_free(gonio_basis **basis);

/* Writes a basis as a safetensors file (layout: docs/basis-file.md); command is kept in it for the
 * record and may be NULL. The file appears whole or not at all. Errors: _IO, _MEMORY. */
GONIO_API gonio_status gonio_basis_write(gonio_context *context, const gonio_basis *basis,
                                         const char *command, const char *path);

/* Reads a basis file and checks it: shapes, plausible values, orthonormality, checksums. V stays in
 * the file, which is mapped without a lock until the basis is freed. Meanwhile the file may be
 * replaced, as gonio_basis_write does, but it must not be changed or truncated.
 * Errors: _IO; _FORMAT for another kind of file, missing or mis-shaped arrays, damage; _MEMORY. */
GONIO_API gonio_status gonio_basis_read(gonio_context *context, const char *path,
                                        gonio_basis **basis);

/* Converts a basis file of an older gonio, which is HDF5, to the present format, with the same
 * checks. The record of the command that learned it is kept. A damaged file of that kind may crash
 * the HDF5 library: convert only files that you trust. Errors: those of reading and writing. */
GONIO_API gonio_status gonio_basis_convert(gonio_context *context, const char *input,
                                           const char *output);

/* The contents of a basis. The view and its pointers belong to the basis. */
typedef struct gonio_basis_view {
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    bool without_mean;
    size_t materials;
    size_t mixtures;
    size_t columns; /* materials, or 3 x materials if separate; plus mixtures, plus analytic */
    const char *const *names;
    const uint64_t *fingerprints; /* of the materials */
    size_t cells;
    const int32_t *cell; /* [cells], database.h */
    size_t rows;
    size_t components;
    const double *mean;      /* m, [rows]; V: gonio_basis_rows */
    size_t variance_count;   /* all of them, not only the first `components` */
    const double *variances; /* lambda_k = S_k^2/(columns - 1), descending */
    const double *loadings;  /* W, [columns][components], orthonormal; NULL in files without */
    const int32_t *parents;  /* [mixtures][2]: the columns of each mixture; NULL without */
    uint64_t fingerprint;    /* of the cells, the materials' names and the leading variances to six
                              * digits: the same for a basis that is learned on another processor */
    uint64_t checksum;       /* of every bit of cells, mean, V and variances */
    const char *program;     /* "gonio 0.1.0" that learned it */
    const char *command;     /* "" if unknown */
    size_t analytic;         /* columns of random analytic materials, which come last */
} gonio_basis_view;

GONIO_API const gonio_basis_view *gonio_basis_describe(const gonio_basis *basis);

/* Rows first .. first + count - 1 of V, the first `components` values of each:
 * values[count][components]. Threads may call it at the same time. Errors: _ARGUMENT for rows or
 * components that the basis does not have. */
GONIO_API gonio_status gonio_basis_rows(gonio_context *context, const gonio_basis *basis,
                                        size_t first, size_t count, size_t components,
                                        double *values);

/* S_k, k from 0; 0 from variance_count on. */
GONIO_API double gonio_basis_singular_value(const gonio_basis *basis, size_t k);

/* The sum of the first k variances over the sum of all (Fig. 2(a) of the paper); 1 for k past the
 * last. */
GONIO_API double gonio_basis_cumulative_variance(const gonio_basis *basis, size_t k);

/* Finds the cell of the basis that represents a cell of the grid: the cell itself, or the nearest
 * one in index space if the database had no data there (lowest index on ties). cell is theta_d + 90
 * theta_h, or a bin's index for a full basis. Returns the position in view.cell, or the number of
 * cells if `cell` is outside the grid. */
GONIO_API size_t gonio_basis_position(const gonio_basis *basis, int32_t cell);

/* The row that a reading in one channel at any directions observes: the mean, and the first
 * `components` values in row. It is interpolated between cell centres, bilinear in (sqrt theta_h,
 * theta_d), with a full basis trilinear and periodic in phi_d. At a cell's centre it is the cell's
 * own row. A separate basis ignores the channel. Returns false and writes nothing for a channel of
 * a joint basis outside 0 .. 2, or for more components than the basis has. */
GONIO_API bool gonio_basis_row_at(const gonio_basis *basis, gonio_half_difference coordinates,
                                  int channel, size_t components, double *mean, double *row);

#ifdef __cplusplus
}
#endif
#endif
