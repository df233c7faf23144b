/* libFuzzer on materials of any format but HDF5, which is another target's: whatever the bytes are,
 * a file is refused with one message or is a material whose values are BRDFs or none. */
#include "fuzz.h"

enum { PAIRS = 24, MOST_CHANNELS = 16 };

static void check_values(const double *values, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        check(isnan(values[k]) || (isfinite(values[k]) && values[k] >= 0.0),
              "a value is none or a BRDF");
    }
}

/* At the pole, at mirror directions, in the plane, near and below the horizon, anywhere. */
static void evaluate(gonio_context *context, const gonio_material *material)
{
    static const double theta[] = {0.0, 1e-9, 0.4, 1.0, 1.39, 1.5707963, 1.6};
    const size_t channels = gonio_material_describe(material)->channels;
    double *values = calloc(PAIRS * channels, sizeof *values);
    gonio_pair pair[PAIRS];
    check(values != NULL, "memory");
    for (int k = 0; k < PAIRS; k++) {
        pair[k] = (gonio_pair){{theta[k % 7], 0.9 * (k % 5) - 1.0},
                               {theta[k / 4 % 7], 0.9 * (k % 5) - 1.0 + M_PI * (k % 3)}};
    }
    const gonio_status status = gonio_material_evaluate(context, material, pair, PAIRS, values);
    check_status(status);
    if (status == GONIO_OK) {
        check_values(values, PAIRS * channels);
    }
    free(values);
}

static void read_slab(gonio_context *context, const gonio_material *material, unsigned which)
{
    static double rho[GONIO_SLAB_VALUES];
    check_status(gonio_material_read_slab(context, material, (int)(which % 90), rho));
    for (size_t k = 0; k < GONIO_SLAB_BINS; k++) {
        const double value[3] = {rho[k], rho[k + GONIO_SLAB_BINS], rho[k + 2 * GONIO_SLAB_BINS]};
        const bool none = value[0] == -1.0 && value[1] == -1.0 && value[2] == -1.0;
        check(none || (value[0] >= 0.0 && value[1] >= 0.0 && value[2] >= 0.0 &&
                       isfinite(value[0] + value[1] + value[2])),
              "a bin has values or none");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_material *material = NULL;
    if (size >= 4 && memcmp(data, "\x89HDF", 4) == 0) {
        return -1;
    }
    fuzz_path(path, "material");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_material_open(context, path, &material);
    check_status(status);
    unlink(path);
    if (status != GONIO_OK) {
        return 0;
    }
    const gonio_material_view *view = gonio_material_describe(material);
    check(view->channels > 0 && *view->name != '\0' && *view->format != '\0', "it is described");
    evaluate(context, material);
    if (data[size - 1] % 16 == 0 && view->channels <= MOST_CHANNELS && !view->anisotropic) {
        read_slab(context, material, data[size / 2]);
    }
    gonio_material_free(&material);
    return 0;
}
