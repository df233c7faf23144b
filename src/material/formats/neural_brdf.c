/* Neural BRDFs (Sztrajman et al. 2021): Keras weights in HDF5 of a network 6-21-21-3 that maps
 * (h, d) to ln(1 + rho). Layer names vary from file to file. So the reader follows the attributes.
 */
#include "format.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/hdf_read.h"
#include "../../core/vector_math.h"
#include "../../direction/grid.h"

enum { INPUTS = 6, HIDDEN = 21, LAYERS = 3, PHI = GONIO_PHI_D_BINS, LANES = 8, PADDED = 184 };
enum { MOST_LAYERS = 64 }; /* with those that have no weights */

static const size_t widths[LAYERS + 1] = {INPUTS, HIDDEN, HIDDEN, GONIO_CHANNELS};

typedef struct network {
    double kernel[LAYERS][HIDDEN][HIDDEN]; /* [layer][from][to] */
    double bias[LAYERS][HIDDEN];
} network;

static bool recognises(const gonio_i_file *file)
{
    static const unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
    return file->head_size >= sizeof signature &&
           memcmp(file->head, signature, sizeof signature) == 0;
}

/* Eight bins as one value (an extension of gcc and clang). */
typedef double lane_vector __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t lane_mask __attribute__((vector_size(LANES * sizeof(int64_t))));

/* out[j] = bias_j + sum_k kernel_kj in[k] for eight bins: a layer's sums stay in registers. Inlined
 * with constant sizes. */
__attribute__((always_inline)) static inline void apply_layer(const network *net, int layer,
                                                              size_t inputs, size_t outputs,
                                                              const lane_vector in[restrict HIDDEN],
                                                              lane_vector out[restrict HIDDEN])
{
    lane_vector sum[HIDDEN];
    const lane_vector zero = {0.0};
    for (size_t j = 0; j < outputs; j++) {
        sum[j] = zero + net->bias[layer][j];
    }
    for (size_t k = 0; k < inputs; k++) {
        for (size_t j = 0; j < outputs; j++) {
            sum[j] += in[k] * net->kernel[layer][k][j];
        }
    }
    for (size_t j = 0; j < outputs; j++) {
        const lane_mask positive = layer < LAYERS - 1 ? sum[j] > zero : ~(lane_mask)zero;
        out[j] = (lane_vector)((lane_mask)sum[j] & positive);
    }
}

/* y[channel][phi] of the bins of one theta_d, from their inputs. */
GONIO_I_VECTORISED static void apply_network(const network *net, double in[INPUTS][PADDED],
                                             double y[GONIO_CHANNELS][PADDED])
{
    for (size_t p = 0; p < PADDED; p += LANES) {
        lane_vector a[HIDDEN];
        lane_vector b[HIDDEN];
        for (size_t k = 0; k < INPUTS; k++) {
            memcpy(&a[k], &in[k][p], sizeof a[k]);
        }
        apply_layer(net, 0, INPUTS, HIDDEN, a, b);
        apply_layer(net, 1, HIDDEN, HIDDEN, b, a);
        apply_layer(net, 2, HIDDEN, GONIO_CHANNELS, a, b);
        for (size_t c = 0; c < GONIO_CHANNELS; c++) {
            memcpy(&y[c][p], &b[c], sizeof b[c]);
        }
    }
}

/* h and d at the centres of the bins of one theta_d, phi_h = 0. */
static void fill_inputs(int theta_h, int theta_d, const double cos_phi[PHI],
                        const double sin_phi[PHI], double in[INPUTS][PADDED])
{
    const gonio_half_difference c = gonio_bin_centre((gonio_bin){theta_h, theta_d, 0});
    const double sin_h = sin(c.theta_h);
    const double cos_h = cos(c.theta_h);
    const double sin_d = sin(c.theta_d);
    const double cos_d = cos(c.theta_d);
    for (int p = 0; p < PHI; p++) {
        in[0][p] = sin_h;
        in[1][p] = 0.0;
        in[2][p] = cos_h;
        in[3][p] = sin_d * cos_phi[p];
        in[4][p] = sin_d * sin_phi[p];
        in[5][p] = cos_d;
    }
}

/* rho = exp(y) - 1, clamped at 0, in the valid bins. It is finite even for weights that overflow.
 */
static void store_row(int theta_h, int theta_d, double y[GONIO_CHANNELS][PADDED], double *rho)
{
    const double largest = 600.0;
    double value[PHI];
    for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
        for (int p = 0; p < PHI; p++) {
            const double positive = y[channel][p] > 0.0 ? y[channel][p] : 0.0;
            value[p] = positive < largest ? positive : largest;
        }
        gonio_i_expm1(PHI, value, value);
        double *row = rho + channel * GONIO_SLAB_BINS + (size_t)theta_d * PHI;
        const int first = gonio_i_first_valid_phi(theta_h, theta_d);
        for (int p = 0; p < PHI; p++) {
            row[p] = p >= first && p < PHI - first ? value[p] : -1.0;
        }
    }
}

static gonio_status read_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    double in[INPUTS][PADDED] = {{0.0}};
    double y[GONIO_CHANNELS][PADDED];
    double cos_phi[PHI];
    double sin_phi[PHI];
    for (int p = 0; p < PHI; p++) {
        const double phi_d = gonio_bin_centre((gonio_bin){0, 0, p}).phi_d;
        cos_phi[p] = cos(phi_d);
        sin_phi[p] = sin(phi_d);
    }
    for (int theta_d = 0; theta_d < GONIO_THETA_D_BINS; theta_d++) {
        fill_inputs(theta_h, theta_d, cos_phi, sin_phi, in);
        apply_network(self, in, y);
        store_row(theta_h, theta_d, y, rho);
    }
    return GONIO_OK;
}

static bool is_kernel(const char *name)
{
    return strstr(name, "kernel") != NULL;
}

/* Reads one weight dataset. Returns NULL, or a text that says what is wrong. */
static const char *read_weights(gonio_i_hdf_object group, const char *name, int layer, network *net)
{
    const bool kernel = is_kernel(name);
    const int rank = kernel ? 2 : 1;
    size_t shape[2] = {0, 0};
    void *data = NULL;
    const char *problem = gonio_i_hdf_read_array(group, name, rank, HIDDEN * HIDDEN,
                                                 GONIO_I_HDF_DOUBLE, &data, shape);
    if (problem != NULL) {
        return problem;
    }
    const size_t from = kernel ? widths[layer] : 1;
    const size_t to = widths[layer + 1];
    const bool fits = kernel ? shape[0] == from && shape[1] == to : shape[0] == to;
    for (size_t k = 0; fits && k < from * to; k++) {
        const double weight = ((const double *)data)[k];
        if (!isfinite(weight)) {
            problem = "holds a number that is not finite";
        }
        if (kernel) {
            net->kernel[layer][k / to][k % to] = weight;
        } else {
            net->bias[layer][k] = weight;
        }
    }
    free(data);
    return fits ? problem : "has a wrong shape (a 6-21-21-3 network is expected)";
}

/* Reads the weights of one layer's group; counts the layer only if it has any. */
static gonio_status read_layer(gonio_context *context, const char *path, gonio_i_hdf_object root,
                               const char *layer_name, int *layer, network *net)
{
    gonio_i_hdf_object group;
    char **names = NULL;
    size_t count = 0;
    gonio_status status = GONIO_OK;
    if (!gonio_i_hdf_find(root, layer_name, &group) ||
        !gonio_i_hdf_read_strings(group, "weight_names", &names, &count)) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: layer '%s' has no attribute 'weight_names'", path, layer_name);
    } else if (count > 0 &&
               (*layer >= LAYERS || count != 2 || is_kernel(names[0]) == is_kernel(names[1]))) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: layer '%s': a network of 3 dense layers (6-21-21-3) is expected",
                              path, layer_name);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        const char *problem = read_weights(group, names[k], *layer, net);
        if (problem != NULL) {
            status = gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: dataset '%s/%s' %s", path,
                                  layer_name, names[k], problem);
        }
    }
    *layer += count > 0 ? 1 : 0;
    free(names);
    return status;
}

static gonio_status read_layers(gonio_context *context, const char *path, gonio_i_hdf_object root,
                                network *net)
{
    char **layers = NULL;
    size_t count = 0;
    if (!gonio_i_hdf_read_strings(root, "layer_names", &layers, &count)) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: an HDF5 file, but not a neural BRDF: it has no attribute "
                            "'layer_names'",
                            path);
    }
    gonio_status status = GONIO_OK;
    int layer = 0;
    for (size_t k = 0; k < count && k <= MOST_LAYERS && status == GONIO_OK; k++) {
        status = read_layer(context, path, root, layers[k], &layer, net);
    }
    free(layers);
    if (status == GONIO_OK && (layer != LAYERS || count > MOST_LAYERS)) {
        status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                              "%s: a network of %d dense layers where 3 (6-21-21-3) are expected",
                              path, layer);
    }
    return status;
}

static gonio_status read_network(gonio_context *context, const char *path, network *net)
{
    gonio_i_hdf_file *file = gonio_i_hdf_open(path);
    if (file == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: cannot be opened as HDF5: damaged or truncated", path);
    }
    /* Some files nest everything in a group. */
    gonio_i_hdf_object root = gonio_i_hdf_root(file);
    (void)gonio_i_hdf_find(root, "model_weights", &root);
    const gonio_status status = read_layers(context, path, root, net);
    gonio_i_hdf_close(file);
    return status;
}

static gonio_status open_network(gonio_context *context, const gonio_i_file *file,
                                 gonio_material_source *source, char **description)
{
    network *net = gonio_i_allocate(context, 1, sizeof *net);
    if (net == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = read_network(context, file->path, net);
    if (status != GONIO_OK) {
        free(net);
        return status;
    }
    *description = strdup("neural BRDF 6-21-21-3");
    *source = (gonio_material_source){.read_slab = read_slab, .release = free, .self = net};
    return GONIO_OK;
}

const gonio_i_format_reader gonio_i_neural_reader = {
    .name = "neural BRDF .h5", .recognises = recognises, .open = open_network};
