/* libFuzzer on plans: whatever the bytes are, a file is refused with one message or is a plan that
 * the simulated instrument measures. The size says the material's channels and the noise. */
#include "fuzz.h"

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const size_t channels = *(const size_t *)self;
    (void)context;
    for (size_t k = 0; k < count * channels; k++) {
        values[k] = 0.1 + cos(pairs[k / channels].incident.theta);
    }
    return GONIO_OK;
}

static gonio_material *make_material(size_t *channels)
{
    static const double wavelength[4] = {400.0, 500.0, 600.0, 700.0};
    gonio_material *material = NULL;
    const gonio_material_source source = {.size = sizeof source,
                                          .evaluate = evaluate,
                                          .self = channels,
                                          .channels = *channels,
                                          .wavelength = *channels == 4 ? wavelength : NULL};
    check(gonio_material_create(NULL, "made", "made", &source, &material) == GONIO_OK,
          "a material is made");
    return material;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    char written[128];
    size_t channels = size % 3 == 0 ? 1 : size % 3 == 1 ? 3 : 4;
    const gonio_readings_options any = {
        .size = sizeof any, .average_repeats = size % 2 == 0, .negative_to_zero = true};
    const gonio_instrument_options instrument = {
        .size = sizeof instrument, .noise = 0.01 * (double)(size % 5), .outliers = 0.1};
    gonio_readings *plan = NULL;
    fuzz_path(path, "plan.csv");
    fuzz_path(written, "measured.csv");
    fuzz_write(path, data, size);
    gonio_status status = gonio_readings_read(context, path, &any, &plan);
    check_status(status);
    if (status == GONIO_OK) {
        gonio_material *material = make_material(&channels);
        status = gonio_measure_material(context, plan, material, &instrument);
        check_status(status);
        gonio_material_free(&material);
    }
    if (status == GONIO_OK) {
        check_status(gonio_readings_write(context, plan, "a command", written));
        unlink(written);
    }
    gonio_readings_free(&plan);
    unlink(path);
    return 0;
}
