/* libFuzzer on the whole chain, from readings to the reconstruction and the next plan, with arrays
 * of any size and value: readings are refused with one message or lead to finite numbers. */
#include "fuzz.h"

#include "small_basis.h"

enum { BASES = 2, MOST_READINGS = 24, MOST_CHANNELS = 4 };

typedef struct arrays {
    size_t count, channels;
    gonio_pair pair[MOST_READINGS];
    int planned[MOST_READINGS];
    double wavelength[MOST_CHANNELS];
    double value[MOST_READINGS * MOST_CHANNELS];
    double deviation[MOST_READINGS * MOST_CHANNELS];
} arrays;

static gonio_readings *make_readings(gonio_context *context, fuzz_bytes *b)
{
    static arrays a;
    const unsigned flags = fuzz_byte(b);
    const gonio_readings_options how = {
        .size = sizeof how, .average_repeats = flags % 2 != 0, .negative_to_zero = flags / 2 % 2};
    gonio_readings *readings = NULL;
    a.count = fuzz_byte(b) % (MOST_READINGS + 1);
    a.channels = flags / 4 % 4 == 0 ? fuzz_byte(b) % (MOST_CHANNELS + 1) : 3;
    for (size_t k = 0; k < MOST_CHANNELS; k++) {
        a.wavelength[k] = 400.0 + 100.0 * (double)k + fuzz_number(b);
    }
    for (size_t k = 0; k < a.count; k++) {
        a.pair[k] =
            (gonio_pair){{fuzz_number(b), fuzz_number(b)}, {fuzz_number(b), fuzz_number(b)}};
        a.planned[k] = flags / 16 % 2 ? (int)(fuzz_byte(b) % 6) - 2 : GONIO_ALL_CHANNELS;
    }
    for (size_t k = 0; k < a.count * a.channels; k++) {
        a.value[k] = fuzz_number(b);
        a.deviation[k] = flags / 32 % 2 ? fuzz_number(b) : NAN;
    }
    const gonio_readings_arrays given = {.size = sizeof given,
                                         .count = a.count,
                                         .channels = a.channels,
                                         .pair = a.pair,
                                         .planned = flags / 64 % 2 ? a.planned : NULL,
                                         .wavelength = flags / 4 % 4 == 0 ? a.wavelength : NULL,
                                         .value = a.value,
                                         .deviation = flags / 32 % 2 ? a.deviation : NULL};
    check_status(gonio_readings_create(context, &given, &how, &readings));
    return readings;
}

static void choose(fuzz_bytes *b, gonio_reconstruct_options *how)
{
    static const char *const methods[] = {NULL, "posterior", "least-squares", "ridge"};
    const unsigned flags = fuzz_byte(b);
    gonio_reconstruct_options_default(how);
    how->method = methods[flags % 4];
    how->all_channels = flags / 4 % 2;
    how->other_basis = true;
    how->deviation = flags / 8 % 2;
    how->no_checks = flags / 16 % 2;
    how->components = flags / 32 % 4;
    if (flags / 128 != 0) {
        how->noise = fuzz_number(b);
        how->floor = fuzz_number(b);
        how->saturation = fuzz_number(b);
        how->eta = fuzz_number(b);
    }
}

static void check_finite(const double *values, size_t count)
{
    for (size_t k = 0; values != NULL && k < count; k++) {
        check(isfinite(values[k]), "a result is finite");
    }
}

static void check_material(gonio_context *context, const gonio_basis *basis,
                           const gonio_reconstruction *made)
{
    static const gonio_pair pair[2] = {{{0.0, 0.0}, {0.0, 0.0}}, {{0.5, 0.1}, {0.6, 3.0}}};
    double value[2 * MOST_CHANNELS];
    gonio_material *material = NULL;
    check_status(gonio_reconstruction_spectral_material(context, basis, made, "made", &material));
    check_status(gonio_material_evaluate(context, material, pair, 2, value));
    for (size_t k = 0; k < 2 * gonio_material_describe(material)->channels; k++) {
        check(isnan(value[k]) || (isfinite(value[k]) && value[k] >= 0.0), "a BRDF is one");
    }
    gonio_material_free(&material);
}

static void check_made(gonio_context *context, const gonio_basis *basis,
                       const gonio_reconstruction *made)
{
    const size_t rows = gonio_basis_describe(basis)->rows;
    check_finite(made->coefficients, made->field == NULL ? made->columns * made->components : 0);
    check_finite(made->field, made->columns * rows);
    check_finite(made->deviation, made->columns * rows);
    check_finite(made->dark, made->columns);
    check(isfinite(made->residual) && made->predicted_e6 >= 0.0 && isfinite(made->predicted_e6),
          "errors are numbers");
    check_material(context, basis, made);
}

static void plan_next(gonio_context *context, const gonio_basis *basis,
                      const gonio_readings *readings, const gonio_reconstruct_options *how)
{
    gonio_plan_options planning;
    gonio_plan *plan = NULL;
    double now = 0.0;
    gonio_plan_options_default(&planning);
    planning.count = 2;
    const gonio_status status =
        gonio_plan_next(context, basis, readings, how, &planning, &now, NULL, &plan);
    check_status(status);
    check(status != GONIO_OK || (isfinite(now) && now >= 0.0), "an expected error is a number");
    gonio_plan_free(&plan);
}

static gonio_basis *basis[BASES];

static void fuzz_begin(void)
{
    if (basis[0] == NULL) {
        basis[0] = small_basis(GONIO_SECTORED, GONIO_SEPARATE, 15, 12);
        basis[1] = small_basis(GONIO_BIVARIATE, GONIO_JOINT, 15, 0);
    }
}

FUZZ_INITIALIZE

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    fuzz_bytes b = {data, size};
    gonio_reconstruct_options how;
    gonio_reconstruction *made = NULL;
    fuzz_begin();
    const gonio_basis *with = basis[fuzz_byte(&b) % BASES];
    choose(&b, &how);
    gonio_readings *readings = make_readings(context, &b);
    if (readings != NULL) {
        const gonio_status status = gonio_reconstruct(context, with, readings, &how, &made);
        check_status(status);
        if (status == GONIO_OK) {
            check_made(context, with, made);
        }
        if (with == basis[0] && size % 8 == 0) {
            plan_next(context, with, readings, &how);
        }
    }
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    return 0;
}
