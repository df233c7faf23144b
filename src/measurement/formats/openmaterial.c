/* Readings as ASAM OpenMATERIAL 3D (.xompt): JSON with rows of wavelength (m), theta_i, theta_o,
 * phi_o - phi_i (radians) and the BRDF (1/sr) in brdf.lookupTable. */
#include <math.h>

#include "../import.h"
#include "../long_table.h"
#include "format.h"
#include "json_text.h"

enum { WAVELENGTH, THETA_I, THETA_O, DIFFERENCE, BRDF, NUMBERS };

/* A wavelength in millionths of nm, in which wavelengths that differ by rounding only are equal. */
static double millionths_of_nm(double metres)
{
    return nearbyint(metres * 1e15) / 1e15;
}

static gonio_status add_row(const gonio_i_readings_file *file, const gonio_i_import *in,
                            const json_t *numbers, size_t row, gonio_i_long_table *table)
{
    double x[NUMBERS];
    const size_t count = json_array_size(numbers);
    for (size_t k = 0; k < NUMBERS; k++) {
        x[k] = gonio_i_json_double(json_array_get(numbers, k));
        if (count != NUMBERS || isnan(x[k])) {
            return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                                "%s: row %zu of lookupTable has %zu elements; five numbers are "
                                "expected: wavelength, theta_i, theta_o, phi_o - phi_i and BRDF",
                                file->path, row + 1, count);
        }
    }
    const gonio_i_long_row made = {.degrees = {gonio_i_import_degrees(in, x[THETA_I]), 0.0,
                                               gonio_i_import_degrees(in, x[THETA_O]),
                                               gonio_i_import_degrees(in, x[DIFFERENCE])},
                                   .wavelength = millionths_of_nm(x[WAVELENGTH]),
                                   .value = x[BRDF],
                                   .deviation = NAN,
                                   .line = row + 1};
    return gonio_i_long_table_add(table, &made);
}

static gonio_status read_rows(const gonio_i_readings_file *file, const json_t *root,
                              gonio_i_import *in)
{
    gonio_i_long_table table = {.context = file->context};
    const json_t *rows = gonio_i_json_member(gonio_i_json_member(root, "brdf"), "lookupTable");
    if (!json_is_array(rows)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: no brdf.lookupTable: an OpenMATERIAL file of another kind?",
                            file->path);
    }
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < json_array_size(rows) && status == GONIO_OK; k++) {
        status = add_row(file, in, json_array_get(rows, k), k, &table);
    }
    if (status == GONIO_OK) {
        status = gonio_i_long_table_import(&table, in);
    }
    gonio_i_long_table_free(&table);
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {
        .angles = GONIO_RADIANS, .values = GONIO_VALUE_BRDF, .wavelengths = GONIO_METRES};
    gonio_i_import in;
    json_t *root = gonio_i_json_parse(file);
    if (root == NULL) {
        return GONIO_ERROR_FORMAT;
    }
    gonio_i_import_begin(&in, file->context, readings, "an OpenMATERIAL lookup table", &stated);
    gonio_i_import_leniently(&in);
    const gonio_status status = read_rows(file, root, &in);
    json_decref(root);
    return gonio_i_import_end(&in, status);
}

static bool recognises(const char *text, size_t size)
{
    return gonio_i_json_has(text, size, "material_brdf_schema") ||
           gonio_i_json_has(text, size, "\"lookupTable\"") ||
           gonio_i_json_has(text, size, "\"openMaterial3dVersion\"");
}

const gonio_i_readings_format gonio_i_readings_openmaterial = {
    .word = "openmaterial", .name = "OpenMATERIAL", .recognises = recognises, .read = read};
