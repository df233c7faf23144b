/* Tables packed for the page: unpacked here by docs/report-page.md, they are what they were. */
#include "../support.h"

#include <math.h>
#include <string.h>
#include <zlib.h>

#include "core/random.h"
#include "made_material.h"
#include "page/page.h"

enum {
    MASK = (GONIO_BINS + 7) / 8,
    ROWS = GONIO_CHANNELS * GONIO_CELLS,
    VALUES = GONIO_CHANNELS * GONIO_BINS,
    STREAM = MASK + ROWS + 2 * VALUES
};

static const size_t generous = 4000000;

static int digit(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = c != '\0' ? strchr(digits, c) : NULL;
    return found != NULL ? (int)(found - digits) : 0; /* 0 for the padding */
}

/* Base64 and zlib undone. */
static uint8_t *stream_of(const gonio_i_web_table *packed)
{
    uint8_t *bytes = malloc(packed->size);
    uint8_t *stream = malloc(STREAM);
    size_t count = 0;
    assert_true(bytes != NULL && stream != NULL);
    assert_int_equal(packed->size % 4, 0);
    for (size_t k = 0; k < packed->size; k += 4) {
        const char *c = packed->text + k;
        const uint32_t three = (uint32_t)digit(c[0]) << 18 | (uint32_t)digit(c[1]) << 12 |
                               (uint32_t)digit(c[2]) << 6 | (uint32_t)digit(c[3]);
        bytes[count++] = (uint8_t)(three >> 16);
        bytes[count++] = (uint8_t)(three >> 8);
        bytes[count++] = (uint8_t)three;
    }
    uLong size = STREAM;
    assert_int_equal(uncompress(stream, &size, bytes, count), Z_OK);
    assert_int_equal(size, STREAM);
    free(bytes);
    return stream;
}

/* Codes [channel][theta_h][theta_d][phi_d]. */
static uint16_t *codes_of(const uint8_t *stream)
{
    uint16_t *codes = calloc(VALUES, sizeof *codes);
    assert_non_null(codes);
    for (int at = 0; at < VALUES; at++) {
        const int row = at / GONIO_PHI_D_BINS;
        const bool first = at % GONIO_PHI_D_BINS == 0;
        const bool top = row % GONIO_CELLS == 0;
        const int above = top ? 0 : codes[at - GONIO_PHI_D_BINS];
        const int left = first ? above : codes[at - 1];
        const int corner = first || top ? above : codes[at - GONIO_PHI_D_BINS - 1];
        const int kind = stream[MASK + row];
        const int folded = stream[MASK + ROWS + at] | stream[MASK + ROWS + VALUES + at] << 8;
        const int difference = folded & 1 ? -(folded / 2) - 1 : folded / 2;
        const int guess = kind == 0 ? left : kind == 1 ? above : left + above - corner;
        codes[at] = (uint16_t)(guess + difference);
    }
    return codes;
}

/* Packs, unpacks, and compares bin by bin in steps of g. */
static gonio_i_web_table check_round_trip(const double *values, size_t budget)
{
    gonio_i_web_table packed;
    assert_int_equal(gonio_i_web_pack(NULL, values, GONIO_I_WEB_LOG, budget, &packed), GONIO_OK);
    uint8_t *stream = stream_of(&packed);
    uint16_t *codes = codes_of(stream);
    double worst = 0.0;
    for (int at = 0; at < VALUES; at++) {
        const int channel = at / GONIO_BINS;
        const int bin = at % GONIO_BINS;
        const double value =
            values[(size_t)(bin / GONIO_SLAB_BINS) * GONIO_SLAB_VALUES +
                   (size_t)channel * GONIO_SLAB_BINS + (size_t)(bin % GONIO_SLAB_BINS)];
        assert_int_equal(stream[bin / 8] >> bin % 8 & 1, value >= 0.0);
        if (value >= 0.0) {
            const double g = log1p(value / gonio_log_scale(channel));
            worst = fmax(worst, fabs((codes[at] - 1) * packed.step - g) / packed.step);
        }
    }
    if (!(worst <= 0.500001)) {
        fail_msg("off by %g steps", worst);
    }
    free(codes);
    free(stream);
    return packed;
}

static void test_a_smooth_table_keeps_the_finest_steps(void **state)
{
    (void)state;
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(NULL, "atlas:gold-polished", &material), GONIO_OK);
    gonio_table *table = made_table(material);
    gonio_i_web_table packed = check_round_trip(gonio_table_values(table), generous);
    assert_true(packed.step == 1.0 / 2048.0);
    assert_true(packed.size < 1500000);
    free(packed.text);
    gonio_table_free(&table);
    gonio_material_free(&material);
}

/* Noise in every bin, holes, and a value far beyond any BRDF. */
static double *noisy_values(void)
{
    const size_t count = (size_t)GONIO_THETA_H_BINS * GONIO_SLAB_VALUES;
    double *values = calloc(count, sizeof *values);
    gonio_i_random random;
    gonio_i_random_seed(&random, 3, 0);
    assert_non_null(values);
    for (size_t k = 0; k < count; k++) {
        values[k] = exp(2.0 * gonio_i_random_normal(&random));
    }
    for (size_t slab = 0; slab < GONIO_THETA_H_BINS; slab++) {
        for (size_t k = slab % 7; k < GONIO_SLAB_BINS; k += 7) {
            for (size_t channel = 0; channel < GONIO_CHANNELS; channel++) {
                values[slab * GONIO_SLAB_VALUES + channel * GONIO_SLAB_BINS + k] = -1.0;
            }
        }
    }
    values[1] = 1e300;
    return values;
}

static void test_noise_gets_coarser_steps_until_it_fits(void **state)
{
    (void)state;
    const size_t budget = 1500000;
    double *values = noisy_values();
    gonio_i_web_table packed = check_round_trip(values, budget);
    assert_true(packed.step > 1.0 / 2048.0);
    assert_true(packed.size <= (budget + 2) / 3 * 4);
    free(packed.text);
    free(values);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_smooth_table_keeps_the_finest_steps),
        cmocka_unit_test(test_noise_gets_coarser_steps_until_it_fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
