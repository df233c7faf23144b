/* The struct of a basis, shared by learning, files and look-ups. */
#ifndef GONIO_BASIS_INTERNAL_H
#define GONIO_BASIS_INTERNAL_H

#include <gonio/basis.h>

#include "../core/file_head.h"
#include "../core/safetensors.h"
#include "../database/layout.h"

struct gonio_basis {
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    bool without_mean;
    size_t materials;
    size_t mixtures; /* columns after those of the materials */
    size_t analytic; /* columns after the mixtures */
    char **names;
    uint64_t *fingerprints;
    size_t cells;
    int32_t *cell;
    size_t rows;
    size_t components;
    double *mean;
    const float *vectors;      /* [rows][components], in `kept` or in `file` */
    float *kept;               /* NULL where V is in a file */
    gonio_i_safetensors *file; /* NULL where V is in memory */
    size_t variance_count;
    double *variances;
    double *loadings;          /* NULL where a file has none */
    int32_t *parents;          /* [mixtures][2]; NULL without mixtures, or where a file has none */
    uint64_t fingerprint;      /* identifies the basis, the same on every processor */
    uint64_t vectors_checksum; /* of every bit of V */
    uint64_t checksum;         /* of every bit of cells, mean, V and variances */
    char *program;
    char *command;
    int32_t *position; /* of each cell of the grid: the position of the nearest in `cell` */
    gonio_basis_view view;
};

/* The name of a file's format; NULL if the file is no basis. */
const char *gonio_i_basis_format_of(const gonio_i_file *file);

/* Whether a file that is not recognised may be a damaged basis. */
bool gonio_i_basis_may_be(const gonio_i_file *file);

/* Whether a file is HDF5, as bases of an older gonio are. */
bool gonio_i_basis_is_hdf5(const gonio_i_file *file);

/* Whether the beginning of a file names the format. */
bool gonio_i_basis_is_marked(const gonio_i_file *file);

/* The names of the formats that are read; NULL past the last. */
const char *gonio_i_basis_format_name(int index);

/* Allocates all arrays of a basis except V, zeroed; NULL after a message. */
gonio_basis *gonio_i_basis_allocate(gonio_context *context, size_t materials, size_t mixtures,
                                    size_t analytic, size_t cells, gonio_channel_model channels,
                                    size_t components, size_t variance_count);

/* The first part of gonio_basis_learn: a basis without V, and V ([rows][components]) in double
 * precision. */
gonio_status gonio_i_basis_learn_exact(gonio_context *context, const gonio_database *database,
                                       const gonio_basis_options *options, gonio_basis **basis,
                                       double **vectors);

/* Rounds V ([rows][components], from gonio_i_allocate) to single precision and puts it into the
 * basis, which owns it in any case. So a basis in memory equals its file. Errors: _MEMORY. */
gonio_status gonio_i_basis_keep_vectors(gonio_context *context, gonio_basis *basis,
                                        double *vectors);

/* The last step of creation, when V is set: the fingerprint, the checksum, the map of nearest cells
 * and the view. */
gonio_status gonio_i_basis_finish(gonio_context *context, gonio_basis *basis);

/* Reads a basis file of an older gonio. Errors: as gonio_basis_read. */
gonio_status gonio_i_basis_read_hdf5(gonio_context *context, const char *path, gonio_basis **basis);

/* XXH3, 64 bits. Errors: _MEMORY. */
gonio_status gonio_i_basis_hash(gonio_context *context, const void *data, size_t size,
                                uint64_t *value);

/* Checks a basis from a file of any format: cells ascend, numbers are plausible, V and W are
 * orthonormal, V has its checksum, parents are measured columns. Messages name `path`. Errors:
 * _FORMAT, _MEMORY. */
gonio_status gonio_i_basis_check(gonio_context *context, const char *path,
                                 const gonio_basis *basis);

size_t gonio_i_basis_row_count(size_t cells, gonio_channel_model channels);
size_t gonio_i_basis_columns(const gonio_basis *basis);

/* The columns of the materials, which come first. */
static inline size_t gonio_i_measured_columns(const gonio_basis_view *view)
{
    return view->columns - view->mixtures - view->analytic;
}

/* The weights of columns in learning, on average 1: half for measured ones and half for mixtures,
 * less the share of analytic ones (analytic.h). */
typedef struct gonio_i_column_weights {
    double measured;
    double mixture;
    double analytic;
} gonio_i_column_weights;

gonio_i_column_weights gonio_i_weights_of_columns(size_t measured, size_t mixtures,
                                                  size_t analytic);

/* gonio_basis_rows without its checks. */
void gonio_i_basis_rows(const gonio_basis *basis, size_t first, size_t count, size_t components,
                        double *values);

/* gonio_basis_row_at without its checks. */
void gonio_i_basis_row_at(const gonio_basis *basis, gonio_half_difference coordinates, int channel,
                          size_t components, double *mean, double *row);

/* The singular value S_k, k below view->variance_count. */
double gonio_i_singular_value(const gonio_basis_view *view, size_t k);

/* The dot product of c and the first `components` values of a row of V. */
double gonio_i_basis_dot(const gonio_basis *basis, size_t row, const double *c, size_t components);

/* The cell of a row. */
static inline int32_t gonio_i_row_cell(const gonio_basis_view *view, size_t row)
{
    return view->cell[gonio_i_position_of(view->channels, row)];
}

/* The number of valid bins of a row's cell. */
int gonio_i_row_bins(const gonio_basis_view *view, size_t row);

/* The direction that represents a row (phi_d = 90 degrees if bivariate), and the row's channel
 * (joint) or 0. */
gonio_half_difference gonio_i_row_coordinates(const gonio_basis_view *view, size_t row,
                                              int *channel);

/* A row and its weight in an interpolation. */
typedef struct gonio_i_row_weight {
    size_t row;
    double weight; /* >= 0; the weights add up to 1 */
} gonio_i_row_weight;

/* The rows that a reading in one channel at a direction observes. Returns their number. */
int gonio_i_rows_around(const gonio_basis *basis, gonio_half_difference at, int channel,
                        gonio_i_row_weight around[GONIO_I_MOST_POINTS]);

/* Finds the nearest cell for each cell of the grid. A part of _finish that may be called before it.
 */
gonio_status gonio_i_basis_map_cells(gonio_context *context, gonio_basis *basis);

#endif
