/* What an instrument file says of readings: channels, values, noise and levels, apertures, times.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "file_parts.h"

#define DEGREE (M_PI / 180.0)

#define NUMBER(key, member, low, high, unit)                                                       \
    {                                                                                              \
        key, true, false, offsetof(gonio_instrument_view, member), low, high, unit                 \
    }
#define OTHER(key)                                                                                 \
    {                                                                                              \
        key, false, false, 0, 0.0, 0.0, 0.0                                                        \
    }

enum { MOST_CHANNELS = 4096 };

/* ---- channels ---- */

static gonio_status read_wavelengths(const gonio_i_place *place, const json_t *root,
                                     gonio_instrument *instrument)
{
    gonio_instrument_view *view = &instrument->view;
    const gonio_status status = gonio_i_read_numbers(place, root, "wavelengths_nm", 1,
                                                     &instrument->wavelength, &view->channels);
    for (size_t k = 0; k < view->channels && status == GONIO_OK; k++) {
        const double nm = instrument->wavelength[k];
        if (!(nm >= 100.0 && nm <= 1e6)) {
            return gonio_i_fail_at(place, "wavelengths_nm", "entry %zu is not between 100 and 1e6",
                                   k + 1);
        }
        if (k > 0 && !(nm > instrument->wavelength[k - 1])) {
            return gonio_i_fail_at(place, "wavelengths_nm",
                                   "entry %zu is not above the one before it", k + 1);
        }
    }
    view->wavelength = instrument->wavelength;
    return status;
}

static gonio_status read_channels(const gonio_i_place *place, const json_t *root,
                                  gonio_instrument *instrument)
{
    const json_t *names = json_object_get(root, "channels");
    gonio_instrument_view *view = &instrument->view;
    const gonio_status status = read_wavelengths(place, root, instrument);
    if (status != GONIO_OK || names == NULL) {
        return status;
    }
    const size_t count = json_array_size(names);
    if (!json_is_array(names) || count == 0 || count > MOST_CHANNELS ||
        (view->channels > 0 && view->channels != count)) {
        return gonio_i_fail_at(place, "channels",
                               "this is no array with a name for each channel or wavelength");
    }
    instrument->channel = gonio_i_allocate(place->context, count, sizeof *instrument->channel);
    if (instrument->channel == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        instrument->channel[k] = json_string_value(json_array_get(names, k));
        if (instrument->channel[k] == NULL) {
            return gonio_i_fail_at(place, "channels", "entry %zu is no text in quotes", k + 1);
        }
    }
    view->channel = instrument->channel;
    view->channels = count;
    return GONIO_OK;
}

/* ---- what values are ---- */

static const char *const kinds[] = {"brdf",          "factor",   "percent", "cosine",
                                    "factor-cosine", "relative", "counts",  NULL};

const char *gonio_value_kind_name(gonio_value_kind kind)
{
    const int index = (int)kind - GONIO_VALUE_BRDF;
    return index >= 0 && index <= GONIO_VALUE_COUNTS - GONIO_VALUE_BRDF ? kinds[index] : NULL;
}

static gonio_status read_reference(const gonio_i_place *place, const json_t *object,
                                   gonio_instrument *instrument)
{
    gonio_instrument_view *view = &instrument->view;
    double *numbers = NULL;
    gonio_status status = gonio_i_read_numbers(place, object, "reference_factors", 2, &numbers,
                                               &view->reference_rows);
    if (status == GONIO_OK && numbers != NULL) {
        instrument->reference =
            gonio_i_allocate(place->context, view->reference_rows, sizeof *instrument->reference);
        status = instrument->reference != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; numbers != NULL && k < view->reference_rows && status == GONIO_OK; k++) {
        gonio_reference_row *row = &instrument->reference[k];
        *row = (gonio_reference_row){numbers[2 * k] * DEGREE, numbers[2 * k + 1]};
        if (!(row->theta >= 0.0 && row->theta <= 0.5 * M_PI && row->factor > 0.0) ||
            (k > 0 && !(row->theta > row[-1].theta))) {
            status = gonio_i_fail_at(place, "reference_factors",
                                     "entry %zu is not an angle of 0 to 90 above the one before it "
                                     "and a factor above 0",
                                     k + 1);
        }
    }
    free(numbers);
    view->reference_row = instrument->reference;
    return status;
}

static gonio_status check_values(const gonio_i_place *place, const gonio_instrument_view *view)
{
    if (view->values == GONIO_VALUE_COUNTS && view->counts == 0.0) {
        return gonio_i_fail_at(place, "counts_of_1_per_sr", "counts need this key");
    }
    if (view->values != GONIO_VALUE_COUNTS && view->counts != 0.0) {
        return gonio_i_fail_at(place, "counts_of_1_per_sr", "only for the kind 'counts'");
    }
    if (view->values == GONIO_VALUE_RELATIVE && *view->reference == '\0') {
        return gonio_i_fail_at(place, "reference", "relative values need the reference's name");
    }
    if (view->values != GONIO_VALUE_RELATIVE &&
        (*view->reference != '\0' || view->reference_rows > 0)) {
        return gonio_i_fail_at(place, "reference", "only for the kind 'relative'");
    }
    return GONIO_OK;
}

static gonio_status read_values(const gonio_i_place *file, const json_t *root,
                                gonio_instrument *instrument)
{
    static const gonio_i_field fields[] = {OTHER("kind"), OTHER("reference"),
                                           OTHER("reference_factors"),
                                           NUMBER("counts_of_1_per_sr", counts, 1e-12, 1e15, 1.0)};
    const gonio_i_place place = {file->context, file->file, "values"};
    const json_t *object = json_object_get(root, "values");
    gonio_instrument_view *view = &instrument->view;
    int kind = 0;
    if (json_is_string(object)) {
        const gonio_status status = gonio_i_read_word(file, root, "values", kinds, &kind);
        view->values = (gonio_value_kind)(GONIO_VALUE_BRDF + kind);
        return status == GONIO_OK ? check_values(&place, view) : status;
    }
    gonio_status status =
        gonio_i_read_fields(&place, object, fields, sizeof fields / sizeof *fields, view);
    if (status == GONIO_OK) {
        status = gonio_i_read_word(&place, object, "kind", kinds, &kind);
    }
    if (status == GONIO_OK) {
        view->values = (gonio_value_kind)(GONIO_VALUE_BRDF + kind);
        status = gonio_i_read_text(&place, object, "reference", "", &view->reference);
    }
    if (status == GONIO_OK) {
        status = read_reference(&place, object, instrument);
    }
    return status == GONIO_OK ? check_values(&place, view) : status;
}

/* ---- noise, levels, apertures ---- */

static gonio_status read_noise(const gonio_i_place *file, const json_t *root,
                               gonio_instrument *instrument)
{
    static const gonio_i_field sensor[] = {
        NUMBER("noise", noise, 0.0, 10.0, 1.0),
        NUMBER("floor_per_sr", floor, 0.0, 1e6, 1.0),
        NUMBER("dark_per_sr", dark, 0.0, 1e6, 1.0),
        NUMBER("stray_per_sr", stray, 0.0, 1e6, 1.0),
        NUMBER("saturation_per_sr", saturation, 1e-12, 1e15, 1.0),
        NUMBER("drift_per_hour", drift, -1.0, 1.0, 1.0)};
    static const gonio_i_field apertures[] = {
        NUMBER("source_half_angle_deg", source_aperture, 0.0, 30.0, DEGREE),
        NUMBER("detector_half_angle_deg", detector_aperture, 0.0, 30.0, DEGREE)};
    gonio_instrument_view *view = &instrument->view;
    gonio_i_place place = {file->context, file->file, "sensor"};
    gonio_status status = gonio_i_read_fields(&place, json_object_get(root, "sensor"), sensor,
                                              sizeof sensor / sizeof *sensor, view);
    const double least = view->floor + view->dark + view->stray;
    if (status == GONIO_OK && view->saturation <= least) {
        return gonio_i_fail_at(&place, "saturation_per_sr",
                               "%g is not above the floor and the levels without a sample, %g",
                               view->saturation, least);
    }
    place.where = "apertures";
    return status == GONIO_OK
               ? gonio_i_read_fields(&place, json_object_get(root, "apertures"), apertures,
                                     sizeof apertures / sizeof *apertures, view)
               : status;
}

gonio_status gonio_i_read_sensor(const gonio_i_place *place, const json_t *root,
                                 gonio_instrument *instrument)
{
    gonio_status status = read_channels(place, root, instrument);
    if (status == GONIO_OK) {
        status = read_values(place, root, instrument);
    }
    return status == GONIO_OK ? read_noise(place, root, instrument) : status;
}

/* ---- times ---- */

gonio_status gonio_i_read_times(const gonio_i_place *file, const json_t *root,
                                gonio_instrument *instrument)
{
    static const gonio_i_field times[] = {
        NUMBER("exposure_s", exposure, 0.0, 86400.0, 1.0),
        NUMBER("incidence_change_s", incidence_change, 0.0, 86400.0, 1.0),
        NUMBER("reference_every_min", reference_every, 1e-3, 1e5, 60.0),
        NUMBER("reference_s", reference_time, 0.0, 86400.0, 1.0), OTHER("axes_move")};
    static const char *const moves[] = {"together", "in-turn", NULL};
    const gonio_i_place place = {file->context, file->file, "times"};
    const json_t *object = json_object_get(root, "times");
    gonio_instrument_view *view = &instrument->view;
    int move = 0;
    gonio_status status =
        gonio_i_read_fields(&place, object, times, sizeof times / sizeof *times, view);
    if (status == GONIO_OK) {
        status = gonio_i_read_word(&place, object, "axes_move", moves, &move);
    }
    view->in_turn = move == 1;
    if (status == GONIO_OK && view->reference_time > 0.0 && view->reference_every == 0.0) {
        return gonio_i_fail_at(&place, "reference_every_min", "reference_s needs this key");
    }
    if (status == GONIO_OK && view->reference_every > 0.0 &&
        view->exposure + view->reference_time >= view->reference_every) {
        return gonio_i_fail_at(&place, "reference_every_min",
                               "%g min are too short for a reference and a reading",
                               view->reference_every / 60.0);
    }
    return status;
}
