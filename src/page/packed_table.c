/* Compressed tables for the page: logarithms in steps, predicted from their neighbours, deflated.
 *
 * A code is 1 + round(g/step) in 16 bits. Each row of 180 phi_d bins is predicted in one of three
 * ways, whichever gives the smallest differences (as PNG does): the bin before; the same bin of the
 * row before; left + above - above left. The differences are small or zero and compress well. Noise
 * does not. It gets coarser steps until the table fits. docs/report-page.md has the layout. */
#include "page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    ROW = GONIO_PHI_D_BINS,
    ROWS = GONIO_CHANNELS * GONIO_CELLS,
    VALUES = ROWS * ROW,
    MASK = (GONIO_BINS + 7) / 8,
    STREAM = MASK + ROWS + 2 * VALUES,
    MOST_STEPS = 65534,
    PREDICTORS = 3
};

typedef struct packing {
    const double *values; /* [theta_h][channel][theta_d][phi_d] */
    gonio_i_web_kind kind;
    double step;
    uint16_t *codes; /* [channel][theta_h][theta_d][phi_d], gaps filled by their prediction */
    uint8_t *stream; /* mask, predictors, low bytes, high bytes */
    uint8_t *packed;
    uLong room;
} packing;

static const double *row_values(const packing *p, int row, int channel)
{
    const int theta_h = row / GONIO_THETA_D_BINS;
    const int theta_d = row % GONIO_THETA_D_BINS;
    return p->values + (size_t)theta_h * GONIO_SLAB_VALUES + (size_t)channel * GONIO_SLAB_BINS +
           (size_t)theta_d * ROW;
}

/* The value that is rounded to steps. */
static double coordinate(const packing *p, int channel, double value)
{
    return p->kind == GONIO_I_WEB_LOG ? log1p(value / gonio_log_scale(channel)) : value;
}

/* The finest step that the budget is tried with: 16 bits must hold the largest value. */
static double finest_step(const packing *p)
{
    double largest = 0.0;
    for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
        double most = 0.0;
        for (int row = 0; row < GONIO_CELLS; row++) {
            const double *values = row_values(p, row, channel);
            for (int k = 0; k < ROW; k++) {
                most = fmax(most, values[k]);
            }
        }
        largest = fmax(largest, coordinate(p, channel, most));
    }
    double step = 1.0 / 2048.0;
    while (largest / step > MOST_STEPS) {
        step *= 2.0;
    }
    return step;
}

static void write_mask(const packing *p)
{
    memset(p->stream, 0, MASK);
    for (int row = 0; row < GONIO_CELLS; row++) {
        const double *values = row_values(p, row, 0);
        for (int k = 0; k < ROW; k++) {
            const int bin = row * ROW + k;
            p->stream[bin / 8] |= (uint8_t)((values[k] >= 0.0) << bin % 8);
        }
    }
}

static uint16_t prediction(int predictor, const uint16_t *row, const uint16_t *above, int k)
{
    const uint16_t left = k > 0 ? row[k - 1] : above[0];
    const uint16_t corner = k > 0 ? above[k - 1] : above[0];
    return predictor == 0 ? left : predictor == 1 ? above[k] : (uint16_t)(left + above[k] - corner);
}

/* Sign in the lowest bit, so that small differences of either sign have no high byte. */
static uint16_t zigzag(uint16_t difference)
{
    const int signed_difference = (int16_t)difference;
    return (uint16_t)((difference << 1) ^ (signed_difference < 0 ? 0xffff : 0));
}

/* Codes of a row (0 where there is no data) to differences; fills the gaps. Returns their sum. */
static long predict_row(int predictor, const uint16_t *wanted, const uint16_t *above,
                        uint16_t *filled, uint16_t *differences)
{
    long sum = 0;
    for (int k = 0; k < ROW; k++) {
        const uint16_t guess = prediction(predictor, filled, above, k);
        filled[k] = wanted[k] != 0 ? wanted[k] : guess;
        differences[k] = zigzag((uint16_t)(filled[k] - guess));
        sum += differences[k];
    }
    return sum;
}

/* Uses the predictor with the smallest differences. */
static void write_row(const packing *p, int at, const uint16_t *wanted)
{
    static const uint16_t nothing[ROW] = {0};
    const uint16_t *above = at % GONIO_CELLS > 0 ? p->codes + (size_t)(at - 1) * ROW : nothing;
    uint16_t *filled = p->codes + (size_t)at * ROW;
    uint8_t *low = p->stream + MASK + ROWS + (size_t)at * ROW;
    long least = 0;
    int best = 0;
    uint16_t differences[ROW];
    for (int predictor = 0; predictor < PREDICTORS; predictor++) {
        const long sum = predict_row(predictor, wanted, above, filled, differences);
        if (predictor == 0 || sum < least) {
            least = sum;
            best = predictor;
        }
    }
    predict_row(best, wanted, above, filled, differences);
    p->stream[MASK + at] = (uint8_t)best;
    for (int k = 0; k < ROW; k++) {
        low[k] = (uint8_t)(differences[k] & 0xff);
        low[VALUES + k] = (uint8_t)(differences[k] >> 8);
    }
}

static void write_codes(const packing *p)
{
    for (int at = 0; at < ROWS; at++) {
        const int channel = at / GONIO_CELLS;
        const double *values = row_values(p, at % GONIO_CELLS, channel);
        uint16_t wanted[ROW];
        for (int k = 0; k < ROW; k++) {
            wanted[k] = values[k] >= 0.0
                            ? (uint16_t)(1 + lround(coordinate(p, channel, values[k]) / p->step))
                            : 0;
        }
        write_row(p, at, wanted);
    }
}

static gonio_status deflate_stream(gonio_context *context, packing *p, uLong *size)
{
    *size = p->room;
    return compress2(p->packed, size, p->stream, STREAM, 6) == Z_OK
               ? GONIO_OK
               : gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for the page's tables");
}

static char *base64(const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc((size + 2) / 3 * 4 + 1);
    char *next = text;
    for (size_t k = 0; text != NULL && k < size; k += 3) {
        const size_t left = size - k;
        const uint32_t three = (uint32_t)data[k] << 16 |
                               (uint32_t)(left > 1 ? data[k + 1] : 0) << 8 |
                               (uint32_t)(left > 2 ? data[k + 2] : 0);
        *next++ = digits[three >> 18];
        *next++ = digits[three >> 12 & 63];
        *next++ = '=';
        *next++ = '=';
        if (left > 1) {
            next[-2] = digits[three >> 6 & 63];
        }
        if (left > 2) {
            next[-1] = digits[three & 63];
        }
    }
    if (text != NULL) {
        *next = '\0';
    }
    return text;
}

/* Tries coarser steps until the table fits. A table of one step, all zeros, fits in any case. */
static gonio_status fit(gonio_context *context, packing *p, size_t budget, uLong *size)
{
    write_mask(p);
    gonio_status status = GONIO_OK;
    for (p->step = finest_step(p); status == GONIO_OK; p->step *= 2.0) {
        write_codes(p);
        status = deflate_stream(context, p, size);
        if (status == GONIO_OK && *size <= budget) {
            return GONIO_OK;
        }
        if (status == GONIO_OK) {
            status = gonio_i_progress(context, "packing", 0.5);
        }
    }
    return status;
}

gonio_status gonio_i_web_pack(gonio_context *context, const double *values, gonio_i_web_kind kind,
                              size_t budget, gonio_i_web_table *packed)
{
    packing p = {.values = values, .kind = kind, .room = compressBound(STREAM)};
    uLong size = 0;
    gonio_status status = GONIO_ERROR_MEMORY;
    p.codes = gonio_i_allocate(context, VALUES, sizeof *p.codes);
    p.stream = p.codes != NULL ? gonio_i_allocate(context, STREAM, 1) : NULL;
    p.packed = p.stream != NULL ? gonio_i_allocate(context, p.room, 1) : NULL;
    if (p.packed != NULL) {
        status = fit(context, &p, budget, &size);
    }
    char *text = status == GONIO_OK ? base64(p.packed, size) : NULL;
    free(p.codes);
    free(p.stream);
    free(p.packed);
    if (status == GONIO_OK && text == NULL) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory for the page's tables");
    }
    if (text != NULL) {
        *packed = (gonio_i_web_table){text, strlen(text), p.step};
    }
    return status;
}
