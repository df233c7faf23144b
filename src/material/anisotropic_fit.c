/* Anisotropic tables made from any material: values in log space at evenly spaced phi_h become
 * Fourier series. The symmetry and the orders that are needed are found at a few hundred cells
 * first. */
#include <math.h>
#include <stdlib.h>

#include "../core/core.h"
#include "../direction/grid.h"
#include "anisotropic_table.h"
#include "azimuth_series.h"
#include "formats/merl.h"

enum {
    PHI_D_CELLS = 36,             /* of a usual table */
    FEW_PHI_D_CELLS = 12,         /* of one with many channels */
    TURN = GONIO_I_MOST_AZIMUTHS, /* phi_h in a full turn, while the symmetry is found */
    LEAST_NODES = 32,             /* phi_h in a period */
    SIDES = 2,                    /* of the reciprocal pair */
    EVERY = 9,                    /* which theta_h and theta_d are looked at first */
    FIRST_PHI_D = 4,              /* and how many phi_d of each */
    MOST_VALUES = 1 << 22,        /* in memory at a time */
    LEAST_ORDERS = 2
};

static const double FLOOR = 0.1;        /* of the log space of errors */
static const double SAME = 5e-3;        /* RMS in log space below which two turns are one */
static const double LEFT_OUT = 4e-3;    /* RMS in log space of the orders that are left out */
static const double MOST_BYTES = 5.4e8; /* of a table, roughly */

/* Cells of one size: what is evaluated together, and its values in log space. */
typedef struct batch {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    const double *floor;
    size_t channels;
    size_t nodes;     /* phi_h of a cell */
    double period;    /* radians */
    gonio_pair *pair; /* [cells][nodes][SIDES] */
    double *value;    /* [cells][nodes][SIDES][channels] */
} batch;

static gonio_status begin_batch(batch *b, size_t cells)
{
    const size_t pairs = cells * b->nodes * SIDES;
    b->pair = gonio_i_allocate(b->context, pairs, sizeof *b->pair);
    b->value = gonio_i_allocate(b->context, pairs * b->channels, sizeof *b->value);
    return b->pair != NULL && b->value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static void end_batch(batch *b)
{
    free(b->pair);
    free(b->value);
    b->pair = NULL;
    b->value = NULL;
}

/* The middle of a cell, or the nearest phi_d that is above the horizon; false if none is. */
static bool middle_of(int theta_h, int theta_d, int phi, int phi_d_cells, gonio_half_difference *at)
{
    const int first = gonio_i_first_valid_phi(theta_h, theta_d);
    const double bin = M_PI / GONIO_PHI_D_BINS;
    *at = gonio_bin_centre((gonio_bin){theta_h, theta_d, 0});
    at->phi_d = fmin(fmax((phi + 0.5) * M_PI / phi_d_cells, (first + 0.5) * bin),
                     (GONIO_PHI_D_BINS - 0.5 - first) * bin);
    return first < GONIO_PHI_D_BINS / 2;
}

static void set_cell(const batch *b, size_t cell, gonio_half_difference at)
{
    const gonio_pair pair = gonio_pair_from_half_difference(at);
    gonio_pair *to = b->pair + cell * b->nodes * SIDES;
    for (size_t n = 0; n < b->nodes; n++) {
        const double phi_h = b->period * (double)n / (double)b->nodes;
        gonio_pair turned = pair;
        turned.incident.phi += phi_h;
        turned.outgoing.phi += phi_h;
        to[SIDES * n] = turned;
        to[SIDES * n + 1] = (gonio_pair){turned.outgoing, turned.incident};
    }
}

static gonio_status evaluate_cells(const batch *b, size_t cells)
{
    return gonio_i_sampler_values(b->context, b->sampler, b->pair, cells * b->nodes * SIDES,
                                  b->value);
}

/* The values of a cell in log space, v[nodes]: the mean of both sides of the pair. Where a node has
 * no data it gets the mean of the others. False if none has. */
static bool read_cell(const batch *b, size_t cell, size_t channel, double *v)
{
    const double *value = b->value + cell * b->nodes * SIDES * b->channels + channel;
    double sum = 0.0;
    size_t count = 0;
    for (size_t n = 0; n < b->nodes; n++) {
        const double one = value[SIDES * n * b->channels];
        const double other = value[(SIDES * n + 1) * b->channels];
        const double rho = isnan(one) ? other : isnan(other) ? one : 0.5 * (one + other);
        v[n] = log(rho + b->floor[channel]);
        sum += isfinite(v[n]) ? v[n] : 0.0;
        count += isfinite(v[n]) ? 1 : 0;
    }
    for (size_t n = 0; n < b->nodes && count > 0; n++) {
        v[n] = isfinite(v[n]) ? v[n] : sum / (double)count;
    }
    return count > 0;
}

/* ---- symmetry and orders ---- */

/* Sums over the cells that are looked at first. */
typedef struct spectrum {
    double power[TURN / 2]; /* mean square of each order of a full turn */
    double count;
} spectrum;

static void add_power(const batch *b, size_t cells, spectrum *s)
{
    const gonio_i_circle turn = gonio_i_circle_of(TURN);
    double v[TURN] = {0.0};
    double coefficient[TURN];
    for (size_t k = 0; k < cells * b->channels; k++) {
        if (read_cell(b, k / b->channels, k % b->channels, v)) {
            gonio_i_circle_series(&turn, v, TURN / 2 - 1, coefficient);
            for (int n = 1; n < TURN / 2; n++) {
                s->power[n] += 0.5 * (coefficient[2 * n - 1] * coefficient[2 * n - 1] +
                                      coefficient[2 * n] * coefficient[2 * n]);
            }
            s->count += 1.0;
        }
    }
}

static gonio_status find_spectrum(batch *b, spectrum *s)
{
    enum { AT_ONCE = GONIO_THETA_D_BINS / EVERY * FIRST_PHI_D };
    gonio_status status = begin_batch(b, AT_ONCE);
    for (int theta_h = EVERY / 2; theta_h < GONIO_THETA_H_BINS && status == GONIO_OK;
         theta_h += EVERY) {
        size_t cells = 0;
        for (int k = 0; k < AT_ONCE; k++) {
            gonio_half_difference at;
            if (middle_of(theta_h, EVERY / 2 + EVERY * (k / FIRST_PHI_D), k % FIRST_PHI_D,
                          FIRST_PHI_D, &at)) {
                set_cell(b, cells++, at);
            }
        }
        status = evaluate_cells(b, cells);
        if (status == GONIO_OK) {
            add_power(b, cells, s);
        }
    }
    end_batch(b);
    return status;
}

/* RMS of the orders from `first` on that are no multiples of `symmetry`, or that are. */
static double rms_of(const spectrum *s, int first, int symmetry, bool multiples)
{
    double sum = 0.0;
    for (int n = first; n < TURN / 2; n++) {
        sum += (n % symmetry == 0) == multiples ? s->power[n] : 0.0;
    }
    return sqrt(sum / fmax(s->count, 1.0));
}

static int find_symmetry(const spectrum *s)
{
    return rms_of(s, 1, 4, false) < SAME ? 4 : rms_of(s, 1, 2, false) < SAME ? 2 : 1;
}

static int find_orders(const spectrum *s, int symmetry)
{
    const int most = LEAST_NODES / 2 - 3;
    int orders = LEAST_ORDERS;
    while (orders < most && rms_of(s, (orders + 1) * symmetry, symmetry, true) > LEFT_OUT) {
        orders++;
    }
    return orders;
}

/* ---- all cells ---- */

/* A cell of a batch: its place among those that are evaluated; -1 if it is below the horizon. */
typedef ptrdiff_t slot;

/* Writes the series of a cell in all channels. */
static void store_cell(const batch *b, const gonio_anisotropic_table *t, const gonio_i_circle *turn,
                       slot at, float *coefficient)
{
    const size_t terms = 1 + 2 * (size_t)t->orders;
    for (size_t c = 0; c < t->channels; c++) {
        double v[TURN] = {0.0};
        double series[1 + 2 * GONIO_ANISOTROPIC_ORDERS];
        const bool data = at >= 0 && read_cell(b, (size_t)at, c, v);
        if (data) {
            gonio_i_circle_series(turn, v, t->orders, series);
        }
        for (size_t k = 0; k < terms; k++) {
            coefficient[c * terms + k] = data ? (float)series[k] : NAN;
        }
    }
}

static void store(const batch *b, const gonio_anisotropic_table *t, float *coefficient,
                  size_t cells, const slot *slots)
{
    const gonio_i_circle turn = gonio_i_circle_of(b->nodes);
    const size_t numbers = t->channels * (1 + 2 * (size_t)t->orders);
#pragma omp parallel for schedule(static) num_threads(gonio_context_threads(b->context))
    for (size_t cell = 0; cell < cells; cell++) {
        store_cell(b, t, &turn, slots[cell], coefficient + cell * numbers);
    }
}

/* Rows of theta_d from `first` on. */
static gonio_status fit_rows(const batch *b, gonio_anisotropic_table *t, int theta_h, int first,
                             int rows, slot *slots)
{
    const size_t phi = (size_t)t->phi_d_cells;
    const size_t cells = (size_t)rows * phi;
    const size_t start = ((size_t)theta_h * GONIO_THETA_D_BINS + (size_t)first) * phi;
    const size_t numbers = t->channels * (1 + 2 * (size_t)t->orders);
    size_t known = 0;
    for (size_t k = 0; k < cells; k++) {
        gonio_half_difference at;
        slots[k] = -1;
        if (middle_of(theta_h, first + (int)(k / phi), (int)(k % phi), t->phi_d_cells, &at)) {
            slots[k] = (slot)known;
            set_cell(b, known++, at);
        }
    }
    const gonio_status status = evaluate_cells(b, known);
    if (status == GONIO_OK) {
        store(b, t, (float *)t->coefficient + start * numbers, cells, slots);
    }
    return status;
}

static gonio_status fit_all(batch *b, gonio_anisotropic_table *t)
{
    const size_t row = (size_t)t->phi_d_cells * b->nodes * SIDES * b->channels;
    const int rows = (int)fmin(fmax((double)MOST_VALUES / (double)row, 1.0), GONIO_THETA_D_BINS);
    const size_t cells = (size_t)rows * (size_t)t->phi_d_cells;
    slot *slots = gonio_i_allocate(b->context, cells, sizeof *slots);
    gonio_status status = begin_batch(b, cells);
    status = slots != NULL ? status : GONIO_ERROR_MEMORY;
    for (int h = 0; h < GONIO_THETA_H_BINS && status == GONIO_OK; h++) {
        for (int d = 0; d < GONIO_THETA_D_BINS && status == GONIO_OK; d += rows) {
            const int left = GONIO_THETA_D_BINS - d;
            status = fit_rows(b, t, h, d, left < rows ? left : rows, slots);
        }
        if (status == GONIO_OK) {
            status = gonio_i_progress(b->context, "writing", 0.9 * (h + 1) / GONIO_THETA_H_BINS);
        }
    }
    end_batch(b);
    free(slots);
    return status;
}

/* Chooses fewer cells of phi_d, unless their number is given, then fewer orders, for many channels.
 */
static void choose_sizes(gonio_anisotropic_table *t, int phi_d_cells)
{
    const double budget = MOST_BYTES / sizeof(float);
    t->phi_d_cells = phi_d_cells > 0 ? phi_d_cells : PHI_D_CELLS;
    if (phi_d_cells == 0 && (double)gonio_i_anisotropic_count(t) > budget) {
        t->phi_d_cells = FEW_PHI_D_CELLS;
    }
    while (t->orders > LEAST_ORDERS && (double)gonio_i_anisotropic_count(t) > budget) {
        t->orders--;
    }
}

static gonio_status make_arrays(gonio_context *context, const gonio_material_view *view,
                                double **floor, double **wavelength)
{
    *floor = gonio_i_allocate(context, view->channels, sizeof **floor);
    *wavelength = view->wavelength != NULL
                      ? gonio_i_allocate(context, view->channels, sizeof **wavelength)
                      : NULL;
    if (*floor == NULL || (*wavelength == NULL && view->wavelength != NULL)) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t c = 0; c < view->channels; c++) {
        (*floor)[c] = FLOOR * gonio_i_merl_scale[view->channels == GONIO_CHANNELS ? c : 0];
        if (*wavelength != NULL) {
            (*wavelength)[c] = view->wavelength[c];
        }
    }
    return GONIO_OK;
}

gonio_status gonio_i_anisotropic_fit(gonio_context *context, const gonio_i_sampler *sampler,
                                     int phi_d_cells, gonio_anisotropic_table *table)
{
    double *floor = NULL;
    double *wavelength = NULL;
    float *coefficient = NULL;
    gonio_status status = make_arrays(context, sampler->view, &floor, &wavelength);
    gonio_anisotropic_table t = {.size = sizeof t,
                                 .channels = sampler->view->channels,
                                 .wavelength = wavelength,
                                 .floor = floor,
                                 .theta_limit = sampler->view->theta_limit};
    batch b = {.context = context,
               .sampler = sampler,
               .floor = floor,
               .channels = t.channels,
               .nodes = TURN,
               .period = 2.0 * M_PI};
    spectrum s = {0};
    if (status == GONIO_OK) {
        status = find_spectrum(&b, &s);
    }
    if (status == GONIO_OK) {
        t.symmetry = find_symmetry(&s);
        t.orders = find_orders(&s, t.symmetry);
        choose_sizes(&t, phi_d_cells);
        b.nodes = t.symmetry == 1 ? TURN : LEAST_NODES;
        b.period = 2.0 * M_PI / t.symmetry;
        coefficient = gonio_i_allocate(context, gonio_i_anisotropic_count(&t), sizeof *coefficient);
        t.coefficient = coefficient;
        status = coefficient != NULL ? fit_all(&b, &t) : GONIO_ERROR_MEMORY;
    }
    if (status != GONIO_OK) {
        gonio_i_anisotropic_clear(&t);
        return status;
    }
    *table = t;
    return GONIO_OK;
}
