/* A database: many materials on one grid, in log space, as the observation matrix H.
 *
 * Log space is one of two mappings g = ln(1 + rho/s):
 *   log       s = (1, 1.15, 1.66)/1500 1/sr for R, G, B: ln(1 + x) of the numbers a MERL file
 *             stores (Ali et al.);
 *   relative  s = e/w, e = 0.001, w = cos theta_i cos theta_o clipped to 0.01 .. 1, so that
 *             g = ln((rho w + e)/e) (Nielsen et al. 2015: theirs, ln((rho w + e)/(median + e)),
 *             differs by a constant in each row, which basis.h subtracts).
 *
 * Representation: bivariate (Romeiro et al. 2008), where a cell (theta_h, theta_d) holds the mean
 * of g over its phi_d bins with data; full, where every bin is a cell of its own; or sectored,
 * where a cell (theta_h, theta_d, sector) holds the mean over the bins with data of one of 12
 * sectors of phi_d, 15 degrees each. Sectored has nearly the detail of the full grid with a
 * fifteenth of its rows: it leaves out 0.4 % E6 of the neural MERL materials, bivariate 1.5 %.
 *
 * Channel model: joint (Ali et al.), where a column is a material and the rows are (cell, channel),
 * channel fastest; or separate, where each channel of each material is a column (R, G, B of the
 * first material, then the next) and the rows are cells.
 *
 * The matrix is kept out of core, in unlinked scratch files, so that memory does not grow with
 * the number of materials; each material is read once. It is kept as float32, whose relative error
 * of 6e-8 is far below the noise of measured materials. A cell that has no data in one or more of
 * the materials is left out of the matrix. */
#ifndef GONIO_DATABASE_H
#define GONIO_DATABASE_H

#include <gonio/material.h>

#ifdef __cplusplus
extern "C" {
#endif

/* s_c, 1/sr, for channel 0, 1, 2; 1/1500 for any other, here and in the functions below. */
GONIO_API double gonio_log_scale(int channel);

/* g = ln(1 + rho/s_c); and back, rho = s_c (e^g - 1), clamped at 0. */
GONIO_API double gonio_log_from_brdf(double rho, int channel);
GONIO_API double gonio_brdf_from_log(double g, int channel);

typedef enum gonio_mapping { GONIO_LOG = 0, GONIO_LOG_RELATIVE = 1 } gonio_mapping;

/* "log" and "relative"; NULL for any other value. And back: false for any other name. */
GONIO_API const char *gonio_mapping_name(gonio_mapping mapping);
GONIO_API bool gonio_mapping_parse(const char *name, gonio_mapping *mapping);

/* s of a mapping at a direction, 1/sr. */
GONIO_API double gonio_mapping_scale(gonio_mapping mapping, int channel, gonio_half_difference at);

/* g = ln(1 + rho/s); and back, rho = s (e^g - 1), clamped at 0. */
GONIO_API double gonio_mapped_from_brdf(gonio_mapping mapping, double rho, int channel,
                                        gonio_half_difference at);
GONIO_API double gonio_brdf_from_mapped(gonio_mapping mapping, double g, int channel,
                                        gonio_half_difference at);

/* The scale of each bin of a slab: scale[theta_d][phi_d], s at its centre. */
GONIO_API void gonio_slab_scale(gonio_mapping mapping, int channel, int theta_h, double *scale);

typedef enum gonio_representation {
    GONIO_BIVARIATE = 0,
    GONIO_FULL = 1,
    GONIO_SECTORED = 2
} gonio_representation;

/* "bivariate", "full" and "sectored"; NULL for any other value. And back: false for any other name.
 */
GONIO_API const char *gonio_representation_name(gonio_representation representation);
GONIO_API bool gonio_representation_parse(const char *name, gonio_representation *representation);

/* The number of cells of the whole grid in a representation, including those that never hold data;
 * 0 for any other value. */
GONIO_API int32_t gonio_grid_cells(gonio_representation representation);

/* The bin in the middle of a cell's phi_d bins; phi_d bin 0 of a bivariate cell. All indices are -1
 * for a cell outside the grid or an unknown representation. */
GONIO_API gonio_bin gonio_cell_bin(gonio_representation representation, int32_t cell);

/* The cell that a bin lies in; -1 for a bin outside the grid or an unknown representation. */
GONIO_API int32_t gonio_cell_of_bin(gonio_representation representation, gonio_bin bin);

typedef enum gonio_channel_model { GONIO_JOINT = 0, GONIO_SEPARATE = 1 } gonio_channel_model;

/* "joint" and "separate"; NULL for any other value. And back: false for any other name. */
GONIO_API const char *gonio_channel_model_name(gonio_channel_model channels);
GONIO_API bool gonio_channel_model_parse(const char *name, gonio_channel_model *channels);

/* Bivariate statistics of one slab in log space, by theta_d. */
typedef struct gonio_slab_statistics {
    int count[GONIO_THETA_D_BINS]; /* phi_d bins with data */
    double mean[GONIO_THETA_D_BINS][GONIO_CHANNELS];
    double scatter[GONIO_THETA_D_BINS][GONIO_CHANNELS]; /* sum of (g - mean)^2 */
} gonio_slab_statistics;

/* Marks the bins of a slab (material.h) that count: data[theta_d][phi_d], true if the bin is valid
 * (direction.h) and holds data. */
GONIO_API void gonio_slab_mask(int theta_h, const double *rho, bool *data);

/* Converts a slab to log space, g[channel][theta_d][phi_d]; g is 0 without data. g == rho is
 * allowed.
 */
GONIO_API void gonio_slab_to_log(const double *rho, double *g);

/* The same for either mapping. */
GONIO_API void gonio_slab_to_mapped(gonio_mapping mapping, int theta_h, const double *rho,
                                    double *g);

/* Reduces a slab in log space to its bivariate statistics over the bins that count; mean and
 * scatter are 0 where count is. */
GONIO_API void gonio_slab_reduce(const double *g, const bool *data,
                                 gonio_slab_statistics *statistics);

typedef struct gonio_database gonio_database;

typedef struct gonio_database_options {
    size_t size; /* of this struct, which gonio_database_options_default sets */
    gonio_representation representation;
    gonio_channel_model channels;
    const char *scratch; /* folder for the scratch files; NULL for $TMPDIR or /tmp */
    gonio_mapping mapping;
} gonio_database_options;

/* Sectored, separate, log. */
GONIO_API void gonio_database_options_default_of(gonio_database_options *options, size_t size);
static inline void gonio_database_options_default(gonio_database_options *options)
{
    gonio_database_options_default_of(options, sizeof *options);
}

/* Reads the materials at the given paths (as gonio_material_open takes them), several at a time.
 * The order of the columns is that of the paths, whatever the number of threads.
 * options may be NULL. *database is the caller's.
 * Errors: _ARGUMENT for no paths, an unknown representation, channel model or mapping, and
 * for sectors with the relative mapping; those of gonio_material_open and
 * _read_slab; _DATA if a material has no data at all, if two have the same name, or if no cell has
 * data in all of them; _IO for the scratch files. */
GONIO_API gonio_status gonio_database_create(gonio_context *context, const char *const *paths,
                                             size_t count, const gonio_database_options *options,
                                             gonio_database **database);

/* The same from materials that are open or in memory. The columns have their names. Several threads
 * read at a time, each its own material. The materials stay the caller's and are not needed
 * afterwards. Errors: as gonio_database_create, except those of gonio_material_open. */
GONIO_API gonio_status gonio_database_create_from_materials(gonio_context *context,
                                                            const gonio_material *const *materials,
                                                            size_t count,
                                                            const gonio_database_options *options,
                                                            gonio_database **database);

GONIO_API void gonio_database_free(gonio_database **database);

/* The contents of a database. The view and its pointers belong to the database. */
typedef struct gonio_database_view {
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    size_t materials;
    const char *const *names;     /* [materials] */
    const uint64_t *fingerprints; /* [materials], material.h */
    size_t columns;               /* materials, or 3 x materials if separate */
    size_t cells;                 /* cells with data in every material */
    const int32_t *cell; /* [cells], ascending; bivariate theta_d + 90 theta_h; full a bin's
                          * index; sectored sector + 12 (theta_d + 90 theta_h) */
    size_t rows;         /* 3 x cells if joint, cells if separate */
} gonio_database_view;

GONIO_API const gonio_database_view *gonio_database_describe(const gonio_database *database);

/* Reads rows first .. first + count - 1 of H into block[column][count] (column-major), for the
 * columns of the given materials (indices into names) in that order; subset NULL for all materials.
 * Threads may call it at the same time. Errors: _ARGUMENT (rows outside the matrix, an unknown
 * material of the subset), _IO, _MEMORY. */
GONIO_API gonio_status gonio_database_read_rows(gonio_context *context,
                                                const gonio_database *database, size_t first,
                                                size_t count, const size_t *subset,
                                                size_t subset_count, double *block);

#ifdef __cplusplus
}
#endif
#endif
