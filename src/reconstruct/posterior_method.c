/* The method posterior: from readings to columns (src/posterior), and from those to a
 * reconstruction. */
#include "posterior_method.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "../database/layout.h"
#include "../measurement/readings.h"
#include "../posterior/interpret.h"
#include "method.h"

gonio_i_noise gonio_i_posterior_noise(const gonio_reconstruct_options *options)
{
    return (gonio_i_noise){options->noise, options->floor, options->saturation};
}

static gonio_status allocate(gonio_context *context, const gonio_basis_view *view, size_t columns,
                             const gonio_reconstruct_options *options, gonio_reconstruction **made)
{
    gonio_reconstruction *r = gonio_i_allocate(context, 1, sizeof *r);
    if (r == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    r->columns = columns;
    r->database_share = NAN;
    r->components = view->components;
    r->coefficients = gonio_i_allocate(context, columns * r->components, sizeof *r->coefficients);
    r->field = gonio_i_allocate(context, columns * view->rows, sizeof *r->field);
    if (options->deviation) {
        r->deviation = gonio_i_allocate(context, columns * view->rows, sizeof *r->deviation);
    }
    if (r->coefficients == NULL || r->field == NULL ||
        (options->deviation && r->deviation == NULL)) {
        gonio_reconstruction_free(&r);
        return GONIO_ERROR_MEMORY;
    }
    *made = r;
    return GONIO_OK;
}

static bool is_measured(const gonio_readings *readings, size_t reading)
{
    bool measured = false;
    for (size_t c = 0; c < readings->channels; c++) {
        measured = measured || !isnan(readings->value[reading * readings->channels + c]);
    }
    return measured;
}

/* Where the error is expected: of the directions of the options those that were not read, or all if
 * all were. readings: NULL if rows were read. */
static gonio_status list_expected(gonio_context *context, const gonio_readings *readings,
                                  const gonio_reconstruct_options *options,
                                  gonio_half_difference **at, size_t *count)
{
    const size_t all = options->expected_at != NULL ? options->expected_count : 0;
    size_t *read = gonio_i_allocate(context, all + 1, sizeof *read);
    *at = gonio_i_allocate(context, all + 1, sizeof **at);
    gonio_status status = read != NULL && *at != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK && readings != NULL && all > 0) {
        status = gonio_i_find_readings(context, readings, true, options->expected_at, all, SIZE_MAX,
                                       read);
    }
    size_t left = 0;
    for (size_t k = 0; k < all && status == GONIO_OK; k++) {
        const bool known =
            readings != NULL && read[k] < readings->count && is_measured(readings, read[k]);
        (*at)[left] = gonio_half_difference_from_pair(options->expected_at[k]);
        left += !known;
    }
    for (size_t k = 0; k < all && left == 0 && status == GONIO_OK; k++) {
        (*at)[k] = gonio_half_difference_from_pair(options->expected_at[k]);
    }
    *count = left == 0 ? all : left;
    free(read);
    return status;
}

/* readings: as of list_expected. */
static gonio_status find(gonio_context *context, const gonio_i_prior *prior,
                         const gonio_readings *readings, const gonio_i_columns *columns,
                         const gonio_reconstruct_options *options, gonio_reconstruction *r)
{
    gonio_half_difference *expected_at = NULL;
    size_t expected = 0;
    gonio_status status = list_expected(context, readings, options, &expected_at, &expected);
    const gonio_i_posterior_options how = {.smoothness = -1.0,
                                           .deviation = options->deviation,
                                           .wavelength = r->wavelength,
                                           .expected_at = expected_at,
                                           .expected_count = expected};
    gonio_i_posterior p = {.coefficients = r->coefficients,
                           .field = r->field,
                           .deviation = r->deviation,
                           .contradicted = r->contradicted};
    if (status == GONIO_OK) {
        status = gonio_i_posterior_find(context, prior, columns->column, columns->count, &how, &p);
    }
    free(expected_at);
    r->smoothness = p.smoothness;
    r->predicted_e6 = p.predicted;
    r->outlying = p.outlying;
    r->surprise = p.surprise;
    r->residual = p.residual;
    for (size_t k = 0; k < columns->count; k++) {
        r->readings =
            columns->column[k].count > r->readings ? columns->column[k].count : r->readings;
    }
    return status;
}

/* ---- what no reading tells of ---- */

/* A row is told of by a reading whose error there and here is correlated by at least this: one
 * length of the smooth part of the remainder. */
static const double TOLD = 0.6065;

static gonio_status list_places(gonio_context *context, const gonio_i_columns *columns,
                                gonio_i_place **place, size_t *count)
{
    size_t most = 0;
    for (size_t k = 0; k < columns->count; k++) {
        most = columns->column[k].count > columns->column[most].count ? k : most;
    }
    const gonio_i_column *column = &columns->column[most];
    *count = column->count;
    *place = gonio_i_allocate(context, column->count + 1, sizeof **place);
    for (size_t i = 0; *place != NULL && i < column->count; i++) {
        (*place)[i] = gonio_i_place_of(column->observation[i].at);
    }
    return *place != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static bool is_told(const gonio_basis_view *view, size_t row, const gonio_i_place *place,
                    size_t count)
{
    int channel = 0;
    const gonio_i_place here = gonio_i_place_of(gonio_i_row_coordinates(view, row, &channel));
    bool told = false;
    for (size_t i = 0; i < count && !told; i++) {
        told = gonio_i_smooth(&here, &place[i]) >= TOLD;
    }
    return told;
}

/* The share of the bins that no reading is near, from the column with most readings. */
static gonio_status find_database_share(gonio_context *context, const gonio_basis_view *view,
                                        const gonio_i_columns *columns, double *share)
{
    gonio_i_place *place = NULL;
    size_t count = 0;
    long untold = 0;
    long bins = 0;
    const gonio_status status = list_places(context, columns, &place, &count);
#pragma omp parallel for schedule(static) reduction(+ : untold, bins)                              \
    num_threads(gonio_context_threads(context))
    for (size_t row = 0; row < (status == GONIO_OK ? view->rows : 0); row++) {
        const int here = gonio_i_row_bins(view, row);
        bins += here;
        untold += is_told(view, row, place, count) ? 0 : here;
    }
    *share = bins > 0 ? (double)untold / (double)bins : NAN;
    free(place);
    return status;
}

static gonio_status keep_wavelengths(gonio_context *context, const gonio_readings *readings,
                                     gonio_reconstruction *r)
{
    const gonio_readings_view *view = gonio_readings_describe(readings);
    if (view->wavelength == NULL) {
        return GONIO_OK;
    }
    r->wavelengths = view->channels;
    r->wavelength = gonio_i_allocate(context, view->channels, sizeof *r->wavelength);
    if (r->wavelength == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(r->wavelength, view->wavelength, view->channels * sizeof *r->wavelength);
    return GONIO_OK;
}

static gonio_status estimate(gonio_context *context, const gonio_i_prior *prior,
                             const gonio_readings *readings,
                             const gonio_reconstruct_options *options, gonio_reconstruction *r,
                             gonio_i_columns *columns)
{
    const gonio_i_noise noise = gonio_i_posterior_noise(options);
    gonio_status status = keep_wavelengths(context, readings, r);
    if (status == GONIO_OK) {
        r->contradicted = gonio_i_allocate(context, readings->count, sizeof *r->contradicted);
        status = r->contradicted == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    if (status == GONIO_OK && !options->no_checks) {
        status = gonio_i_interpret(context, prior, readings, &noise, columns, &r->interpretation,
                                   &r->dark);
        r->suspicion = r->interpretation.alternative[0].mistake;
    }
    if (status == GONIO_OK) {
        status = find_database_share(context, prior->view, columns, &r->database_share);
    }
    return status == GONIO_OK ? find(context, prior, readings, columns, options, r) : status;
}

void gonio_i_spread_out(const gonio_i_apertures *apertures, size_t channels,
                        const gonio_i_columns *columns)
{
    for (size_t k = 0; apertures != NULL && k < columns->count; k++) {
        for (size_t i = 0; i < columns->column[k].count; i++) {
            gonio_i_observation *o = &columns->column[k].observation[i];
            o->spread = &apertures->spread[o->reading];
            o->g -= apertures->offset[o->reading * channels + (size_t)o->channel];
        }
    }
}

static gonio_status from_readings(const gonio_i_reconstruct_task *task,
                                  const gonio_readings *readings,
                                  gonio_reconstruction **reconstruction)
{
    gonio_context *context = task->context;
    const gonio_basis *basis = task->basis;
    const gonio_reconstruct_options *options = task->options;
    const gonio_basis_view *view = gonio_basis_describe(basis);
    const gonio_i_noise noise = gonio_i_posterior_noise(options);
    gonio_i_columns columns;
    gonio_i_prior *prior = NULL;
    gonio_reconstruction *made = NULL;
    gonio_status status = gonio_i_columns_create(context, view, readings, &noise, &columns);
    if (status == GONIO_OK) {
        status = gonio_i_columns_check(context, &columns, readings);
        gonio_i_spread_out(task->apertures, readings->channels, &columns);
    }
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(context, basis, &prior);
    }
    if (status == GONIO_OK) {
        status = allocate(context, view, columns.count, options, &made);
    }
    if (status == GONIO_OK) {
        status = estimate(context, prior, readings, options, made, &columns);
    }
    gonio_i_columns_free(&columns);
    gonio_i_prior_free(&prior);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}

/* ---- from rows ---- */

static gonio_status observe_rows(gonio_context *context, const gonio_basis_view *view,
                                 const size_t *rows, size_t count, const double *b,
                                 gonio_i_columns *columns)
{
    *columns = (gonio_i_columns){.count = gonio_i_columns_per_material(view->channels)};
    columns->column = gonio_i_allocate(context, columns->count, sizeof *columns->column);
    for (size_t k = 0; columns->column != NULL && k < columns->count; k++) {
        gonio_i_column *column = &columns->column[k];
        column->count = count;
        column->observation = gonio_i_allocate(context, count, sizeof *column->observation);
        for (size_t i = 0; column->observation != NULL && i < count; i++) {
            gonio_i_observation *o = &column->observation[i];
            *o = (gonio_i_observation){.g = b[k * count + i],
                                       .variance =
                                           GONIO_I_MODEL_DEVIATION * GONIO_I_MODEL_DEVIATION};
            o->at = gonio_i_row_coordinates(view, rows[i], &o->channel);
            o->bound = o->g <= 0.0 ? -1 : 0;
        }
        if (column->observation == NULL) {
            return GONIO_ERROR_MEMORY;
        }
    }
    return columns->column != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status from_rows(const gonio_i_reconstruct_task *task, const size_t *rows,
                              size_t count, const double *b, gonio_reconstruction **reconstruction)
{
    gonio_context *context = task->context;
    const gonio_basis *basis = task->basis;
    const gonio_reconstruct_options *options = task->options;
    const gonio_basis_view *view = gonio_basis_describe(basis);
    gonio_i_columns columns = {0};
    gonio_i_prior *prior = NULL;
    gonio_reconstruction *made = NULL;
    gonio_status status = observe_rows(context, view, rows, count, b, &columns);
    if (status == GONIO_OK) {
        status = gonio_i_columns_check(context, &columns, NULL);
    }
    if (status == GONIO_OK) {
        status = gonio_i_prior_create(context, basis, &prior);
    }
    if (status == GONIO_OK) {
        status = allocate(context, view, columns.count, options, &made);
    }
    if (status == GONIO_OK) {
        status = find(context, prior, NULL, &columns, options, made);
    }
    gonio_i_columns_free(&columns);
    gonio_i_prior_free(&prior);
    if (status != GONIO_OK) {
        gonio_reconstruction_free(&made);
        return status;
    }
    *reconstruction = made;
    return GONIO_OK;
}

const gonio_i_reconstruct_method gonio_i_posterior_method = {
    .name = "posterior",
    .summary = "what the database and the readings say together, with its uncertainty",
    .wants = {.log_mapping = true,
              .all_components = true,
              .noise = true,
              .basis_of_mixtures = true},
    .from_readings = from_readings,
    .from_rows = from_rows,
};
