/* BSDF-XML files, as WINDOW and Radiance write them: the reflection of one side, in a Klems basis
 * or as a tensor tree.
 *
 * WindowElement/Optical/Layer/DataDefinition holds AngleBasis, rings of patches; WavelengthData a
 * block for each wavelength and direction, with ScatteringData, means of the BRDF over pairs of
 * patches in 1/sr: a row an outgoing patch and a column an incident one, or the other way round
 * where IncidentDataStructure is Rows. The front is read, the back where there is none. Channels:
 * CIE-X, Visible and CIE-Z become R, G, B; wavelengths in numbers stay wavelengths; otherwise
 * Visible, or the first. ScatteringDataType does not tell reflection from transmission. Trees
 * (TensorTree3 and 4, tensor_tree.h) are read of Visible and of wavelengths. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../../core/core.h"
#include "../../core/number.h"
#include "../colour.h"
#include "bsdf_xml_parse.h"
#include "format.h"

/* ---- the material ---- */

typedef struct xml_brdf {
    gonio_i_tensor_tree **tree; /* [channels]; NULL of matrices */
    bool isotropic;
    gonio_i_klems incident;
    gonio_i_klems outgoing;
    size_t incidents; /* patches */
    size_t outgoings;
    size_t channels;
    double *wavelength; /* [channels], nm; NULL for colours or grey */
    double *value;      /* [incidents][outgoings][channels] */
} xml_brdf;

static void release(void *self)
{
    xml_brdf *k = self;
    for (size_t c = 0; k->tree != NULL && c < k->channels; c++) {
        gonio_i_tensor_tree_free(k->tree[c]);
    }
    free(k->tree);
    free(k->wavelength);
    free(k->value);
    free(k);
}

static void look_up_trees(const xml_brdf *k, gonio_pair pair, double *values)
{
    for (size_t c = 0; c < k->channels; c++) {
        values[c] = gonio_i_tensor_tree_value(k->tree[c], pair);
    }
}

static void look_up_patches(const xml_brdf *k, gonio_pair pair, double *values)
{
    const size_t in = gonio_i_klems_patch(&k->incident, pair.incident, true);
    const size_t out = gonio_i_klems_patch(&k->outgoing, pair.outgoing, false);
    const bool inside = in < k->incidents && out < k->outgoings;
    for (size_t c = 0; c < k->channels; c++) {
        values[c] = inside ? k->value[(in * k->outgoings + out) * k->channels + c] : NAN;
    }
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const xml_brdf *k = self;
    (void)context;
    for (size_t n = 0; n < count; n++) {
        (k->tree != NULL ? look_up_trees : look_up_patches)(k, pairs[n], values + n * k->channels);
    }
    return GONIO_OK;
}

/* ---- choosing what to read ---- */

typedef struct reader {
    gonio_context *context;
    const char *path;
    gonio_i_xml xml;
} reader;

static bool starts_with(const char *text, const char *start)
{
    return strncasecmp(text, start, strlen(start)) == 0;
}

/* The chosen blocks, a channel each. */
typedef struct choice {
    const char *side; /* "Reflection Front" or "Reflection Back" */
    size_t channels;
    const gonio_i_xml_block *channel[GONIO_I_XML_BLOCKS];
    bool colours; /* channels are X, Y, Z */
    bool spectral;
} choice;

static const gonio_i_xml_block *find_block(const reader *in, const char *side,
                                           const char *wavelength)
{
    for (size_t k = 0; k < in->xml.blocks; k++) {
        if (strcasecmp(in->xml.block[k].direction, side) == 0 &&
            (wavelength == NULL || strcasecmp(in->xml.block[k].wavelength, wavelength) == 0)) {
            return &in->xml.block[k];
        }
    }
    return NULL;
}

/* In nm; NAN if it is no number. */
static double wavelength_of(const gonio_i_xml_block *b)
{
    char *end = NULL;
    const double value = strtod(b->wavelength, &end);
    const bool micro = starts_with(b->unit, "Micro") || starts_with(b->unit, "um");
    const bool number = end != b->wavelength && *end == '\0' && value > 0.0 && isfinite(value);
    return number && !starts_with(b->unit, "Integral") ? value * (micro ? 1000.0 : 1.0) : NAN;
}

static void choose_wavelengths(const reader *in, choice *c)
{
    for (size_t k = 0; k < in->xml.blocks; k++) {
        const gonio_i_xml_block *b = &in->xml.block[k];
        if (strcasecmp(b->direction, c->side) == 0 && !isnan(wavelength_of(b))) {
            c->channel[c->channels++] = b;
        }
    }
    c->spectral = c->channels > 0;
}

static bool choose(const reader *in, choice *c)
{
    static const char *const sides[] = {"Reflection Front", "Reflection Back"};
    for (int k = 0; k < 2 && c->side == NULL; k++) {
        c->side = find_block(in, sides[k], NULL) != NULL ? sides[k] : NULL;
    }
    if (c->side == NULL) {
        return false;
    }
    const gonio_i_xml_block *visible = find_block(in, c->side, "Visible");
    const gonio_i_xml_block *x = find_block(in, c->side, "CIE-X");
    const gonio_i_xml_block *y = find_block(in, c->side, "CIE-Y");
    const gonio_i_xml_block *z = find_block(in, c->side, "CIE-Z");
    y = y != NULL ? y : visible;
    c->colours = x != NULL && y != NULL && z != NULL && gonio_i_xml_dimensions(&in->xml) == 0;
    if (c->colours) {
        c->channels = 3;
        c->channel[0] = x;
        c->channel[1] = y;
        c->channel[2] = z;
        return true;
    }
    choose_wavelengths(in, c);
    if (!c->spectral) {
        c->channels = 1;
        c->channel[0] = visible != NULL ? visible : find_block(in, c->side, NULL);
    }
    return true;
}

/* ---- from blocks to the material ---- */

static gonio_status find_basis(const reader *in, const char *name, gonio_i_klems *basis)
{
    for (size_t k = 0; k < in->xml.bases; k++) {
        if (strcmp(in->xml.basis[k].name, name) == 0 && in->xml.basis[k].rings > 0) {
            *basis = in->xml.basis[k];
            return GONIO_OK;
        }
    }
    const gonio_i_klems *known = gonio_i_klems_named(name);
    if (known == NULL) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                            "%s: the angle basis '%s' is not defined", in->path, name);
    }
    *basis = *known;
    return GONIO_OK;
}

static gonio_status check_basis(const reader *in, const gonio_i_klems *basis)
{
    for (size_t k = 0; k < basis->rings; k++) {
        if (basis->patches[k] == 0 || basis->bound[k + 1] <= basis->bound[k]) {
            return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                                "%s: the rings of the angle basis '%s' do not ascend, or one has "
                                "no patches",
                                in->path, basis->name);
        }
    }
    if (gonio_i_klems_patches(basis) > GONIO_I_XML_PATCHES) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                            "%s: the angle basis '%s' has more than %d patches", in->path,
                            basis->name, GONIO_I_XML_PATCHES);
    }
    return GONIO_OK;
}

static void fill_values(const choice *c, bool columns, xml_brdf *k)
{
    for (size_t in = 0; in < k->incidents; in++) {
        for (size_t out = 0; out < k->outgoings; out++) {
            double *to = k->value + (in * k->outgoings + out) * k->channels;
            const size_t at = columns ? out * k->incidents + in : in * k->outgoings + out;
            for (size_t n = 0; n < k->channels; n++) {
                to[n] = c->channel[n]->value[at];
            }
            if (c->colours) {
                const double xyz[3] = {to[0], to[1], to[2]};
                gonio_i_xyz_to_rgb(xyz, to);
            }
        }
    }
}

static gonio_status check_blocks(const reader *in, const choice *c, const xml_brdf *k)
{
    for (size_t n = 0; n < c->channels; n++) {
        const gonio_i_xml_block *b = c->channel[n];
        if (b->value == NULL || strcmp(b->column, c->channel[0]->column) != 0 ||
            strcmp(b->row, c->channel[0]->row) != 0 || b->count != k->incidents * k->outgoings) {
            return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                                "%s: %s %s has %zu numbers; its angle bases need %zu x %zu",
                                in->path, b->direction, b->wavelength, b->count, k->incidents,
                                k->outgoings);
        }
    }
    return GONIO_OK;
}

static gonio_status keep_wavelengths(const reader *in, const choice *c, xml_brdf *k)
{
    if (!c->spectral) {
        return GONIO_OK;
    }
    k->wavelength = gonio_i_allocate(in->context, c->channels, sizeof *k->wavelength);
    for (size_t n = 0; n < c->channels && k->wavelength != NULL; n++) {
        k->wavelength[n] = wavelength_of(c->channel[n]);
    }
    return k->wavelength != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status read_bases(const reader *in, const choice *c, bool columns, xml_brdf *k)
{
    const gonio_i_xml_block *b = c->channel[0];
    gonio_status status = find_basis(in, columns ? b->column : b->row, &k->incident);
    if (status == GONIO_OK) {
        status = find_basis(in, columns ? b->row : b->column, &k->outgoing);
    }
    if (status == GONIO_OK) {
        status = check_basis(in, &k->incident);
    }
    if (status == GONIO_OK) {
        status = check_basis(in, &k->outgoing);
    }
    k->incidents = gonio_i_klems_patches(&k->incident);
    k->outgoings = gonio_i_klems_patches(&k->outgoing);
    return status;
}

static gonio_status take_matrices(const reader *in, const choice *c, xml_brdf *k)
{
    const bool columns = starts_with(in->xml.structure, "Columns");
    if (!columns && !starts_with(in->xml.structure, "Rows")) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                            "%s: the data structure '%s'; gonio reads matrices (Columns, Rows) and "
                            "tensor trees (TensorTree3, TensorTree4)",
                            in->path, in->xml.structure);
    }
    gonio_status status = read_bases(in, c, columns, k);
    if (status == GONIO_OK) {
        status = check_blocks(in, c, k);
    }
    if (status != GONIO_OK) {
        return status;
    }
    k->value =
        gonio_i_allocate(in->context, k->incidents * k->outgoings * k->channels, sizeof *k->value);
    if (k->value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    fill_values(c, columns, k);
    return GONIO_OK;
}

/* Moves the trees from the blocks to the material. */
static gonio_status take_trees(reader *in, const choice *c, xml_brdf *k)
{
    k->tree = gonio_i_allocate(in->context, c->channels, sizeof *k->tree);
    if (k->tree == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t n = 0; n < c->channels; n++) {
        gonio_i_xml_block *b = &in->xml.block[c->channel[n] - in->xml.block];
        if (b->tree == NULL) {
            return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: %s is named after its data",
                                in->path, in->xml.structure);
        }
        k->tree[n] = b->tree;
        b->tree = NULL;
    }
    k->isotropic = gonio_i_xml_dimensions(&in->xml) == 3;
    return GONIO_OK;
}

static gonio_status make_material(reader *in, const choice *c, xml_brdf *k)
{
    k->channels = c->channels;
    const gonio_status status = keep_wavelengths(in, c, k);
    if (status != GONIO_OK) {
        return status;
    }
    return gonio_i_xml_dimensions(&in->xml) > 0 ? take_trees(in, c, k) : take_matrices(in, c, k);
}

static char *describe(const choice *c, const xml_brdf *k)
{
    char channels[GONIO_I_KLEMS_NAME + 32];
    if (c->spectral) {
        snprintf(channels, sizeof channels, "%zu wavelengths", k->channels);
    } else {
        snprintf(channels, sizeof channels, "%s",
                 c->colours ? "CIE X, Y, Z" : c->channel[0]->wavelength);
    }
    return k->tree != NULL ? gonio_i_format("BSDF-XML %s, tensor tree of %d dimensions, %s",
                                            c->side, k->isotropic ? 3 : 4, channels)
                           : gonio_i_format("BSDF-XML %s, %s, %zu x %zu patches, %s", c->side,
                                            k->incident.name, k->incidents, k->outgoings, channels);
}

static gonio_status read_xml(reader *in, choice *c, xml_brdf *k, char **description)
{
    gonio_status status = gonio_i_xml_read(in->context, in->path, &in->xml);
    if (status != GONIO_OK) {
        return status;
    }
    if (!choose(in, c)) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                            "%s: no reflection data; gonio does not read transmission", in->path);
    }
    status = make_material(in, c, k);
    if (status == GONIO_OK) {
        *description = describe(c, k);
    }
    return status;
}

static gonio_status open_xml(gonio_context *context, const gonio_i_file *file,
                             gonio_material_source *source, char **description)
{
    reader *in = gonio_i_allocate(context, 1, sizeof *in);
    choice *c = gonio_i_allocate(context, 1, sizeof *c);
    xml_brdf *k = gonio_i_allocate(context, 1, sizeof *k);
    gonio_i_plain_numbers plain;
    gonio_status status = GONIO_ERROR_MEMORY;
    if (in != NULL && c != NULL && k != NULL && gonio_i_plain_numbers_begin(&plain)) {
        in->context = context;
        in->path = file->path;
        status = read_xml(in, c, k, description);
        gonio_i_plain_numbers_end(&plain);
    }
    if (in != NULL) {
        gonio_i_xml_free(&in->xml);
    }
    free(in);
    free(c);
    if (status != GONIO_OK) {
        if (k != NULL) {
            release(k);
        }
        return status;
    }
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = k,
                                      .channels = k->channels,
                                      .wavelength = k->wavelength,
                                      .anisotropic = !k->isotropic};
    return GONIO_OK;
}

static bool recognises(const gonio_i_file *file)
{
    return memmem(file->head, file->head_size, "<WindowElement", 14) != NULL ||
           memmem(file->head, file->head_size, ":WindowElement", 14) != NULL;
}

const gonio_i_format_reader gonio_i_bsdf_xml_reader = {
    .name = "BSDF-XML", .recognises = recognises, .open = open_xml};
