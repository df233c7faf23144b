/* The limits, forbidden zones and footprint of an instrument file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file_parts.h"

#define DEGREE (M_PI / 180.0)

enum { ROOM = 96, MOST_ZONES = 256 };

/* The name of a range's quantity: of the list, or of an axis; NULL if there is none. */
static const char *quantity_of(const gonio_instrument *instrument, const char *key)
{
    char name[ROOM];
    const size_t length = strlen(key);
    if (length < 4 || length >= sizeof name || strcmp(key + length - 4, "_deg") != 0) {
        return NULL;
    }
    snprintf(name, sizeof name, "%.*s", (int)(length - 4), key);
    for (size_t k = 0; k < instrument->view.axes; k++) {
        const gonio_axis *axis = &instrument->axis[k];
        if (axis->present && strcmp(axis->name, name) == 0 &&
            (gonio_i_quantity_named(name) == NULL || gonio_i_quantity_gives_way(name))) {
            return axis->name;
        }
    }
    return gonio_i_quantity_named(name);
}

static gonio_status refuse_quantity(const gonio_i_place *place, const gonio_instrument *instrument,
                                    const char *key)
{
    char known[4 * ROOM] = "";
    for (int k = 0; gonio_i_quantity_at(k) != NULL; k++) {
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s_deg", k > 0 ? ", " : "",
                 gonio_i_quantity_at(k));
    }
    for (size_t k = 0; k < instrument->view.axes; k++) {
        const size_t used = strlen(known);
        if (instrument->axis[k].present &&
            gonio_i_quantity_named(instrument->axis[k].name) == NULL) {
            snprintf(known + used, sizeof known - used, ", %s_deg", instrument->axis[k].name);
        }
    }
    return gonio_i_fail_at(place, key, "unknown quantity; known are %s", known);
}

/* A range "theta_i_deg": [0, 75]. */
static gonio_status read_range(const gonio_i_place *place, const gonio_instrument *instrument,
                               const char *key, const json_t *value, gonio_range *range)
{
    range->quantity = quantity_of(instrument, key);
    if (range->quantity == NULL) {
        return refuse_quantity(place, instrument, key);
    }
    const json_t *low = json_array_get(value, 0);
    const json_t *high = json_array_get(value, 1);
    if (json_array_size(value) != 2 || !json_is_number(low) || !json_is_number(high)) {
        return gonio_i_fail_at(place, key, "a range is two numbers [from, to]");
    }
    range->low = json_number_value(low) * DEGREE;
    range->high = json_number_value(high) * DEGREE;
    if (!(range->low <= range->high) || fabs(range->low) > 8.0 * M_PI ||
        fabs(range->high) > 8.0 * M_PI) {
        return gonio_i_fail_at(place, key, "[%g, %g] is no range of degrees", range->low / DEGREE,
                               range->high / DEGREE);
    }
    return GONIO_OK;
}

/* All ranges of an object, but for the key "name". */
static gonio_status read_ranges(const gonio_i_place *place, const gonio_instrument *instrument,
                                const json_t *object, gonio_range *range, size_t *count)
{
    const char *key = NULL;
    json_t *value = NULL;
    *count = 0;
    if (!json_is_object(object)) {
        return gonio_i_fail_at(place, "", "this is no object {...}");
    }
    json_object_foreach((json_t *)object, key, value)
    {
        if (strcmp(key, "name") == 0) {
            continue;
        }
        const gonio_status status = read_range(place, instrument, key, value, &range[*count]);
        if (status != GONIO_OK) {
            return status;
        }
        ++*count;
    }
    return GONIO_OK;
}

static gonio_status read_zone(const gonio_i_place *file, const json_t *object, size_t index,
                              gonio_instrument *instrument, gonio_range *range)
{
    char where[ROOM];
    const gonio_i_place place = {file->context, file->file, where};
    gonio_zone *zone = &instrument->zone[index];
    snprintf(where, sizeof where, "forbidden[%zu]", index);
    gonio_status status = read_ranges(&place, instrument, object, range, &zone->ranges);
    zone->range = range;
    if (status == GONIO_OK) {
        status = gonio_i_read_text(&place, object, "name", "forbidden zone", &zone->name);
    }
    if (status == GONIO_OK && zone->ranges == 0) {
        return gonio_i_fail_at(&place, "", "a zone needs at least one range");
    }
    for (size_t k = 0; k < zone->ranges && status == GONIO_OK; k++) {
        if (range[k].low == range[k].high) {
            status = gonio_i_fail_at(&place, "", "the range of %s is empty", range[k].quantity);
        }
    }
    return status;
}

static gonio_status allocate(gonio_context *context, const json_t *limits, const json_t *zones,
                             gonio_instrument *instrument)
{
    size_t ranges = json_object_size(limits) + 1;
    for (size_t k = 0; k < json_array_size(zones); k++) {
        ranges += json_object_size(json_array_get(zones, k));
    }
    instrument->range = gonio_i_allocate(context, ranges, sizeof *instrument->range);
    instrument->zone =
        gonio_i_allocate(context, json_array_size(zones) + 1, sizeof *instrument->zone);
    return instrument->range != NULL && instrument->zone != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- the footprint ---- */

static gonio_status read_footprint(const gonio_i_place *file, const json_t *root,
                                   gonio_instrument *instrument)
{
    static const gonio_i_field fields[] = {
        {"lit_mm", true, true, offsetof(gonio_instrument_view, lit), 1e-6, 1e6, 1.0},
        {"seen_mm", true, true, offsetof(gonio_instrument_view, seen), 1e-6, 1e6, 1.0},
        {"inside", false, false, 0, 0.0, 0.0, 0.0}};
    static const char *const words[] = {"lit", "seen", NULL};
    const gonio_i_place place = {file->context, file->file, "footprint"};
    const json_t *object = json_object_get(root, "footprint");
    gonio_instrument_view *view = &instrument->view;
    int inside = 0;
    gonio_status status =
        gonio_i_read_fields(&place, object, fields, sizeof fields / sizeof *fields, view);
    if (status == GONIO_OK) {
        status = gonio_i_read_word(&place, object, "inside", words, &inside);
    }
    view->lit_inside = inside == 0;
    const double inner = view->lit_inside ? view->lit : view->seen;
    const double outer = view->lit_inside ? view->seen : view->lit;
    if (status == GONIO_OK && inner > outer) {
        return gonio_i_fail_at(
            &place, "", "the inner spot of %g mm is larger than the other, %g mm", inner, outer);
    }
    return status;
}

gonio_status gonio_i_read_limits(const gonio_i_place *place, const json_t *root,
                                 gonio_instrument *instrument)
{
    const json_t *limits = json_object_get(root, "limits");
    const json_t *zones = json_object_get(root, "forbidden");
    const gonio_i_place here = {place->context, place->file, "limits"};
    gonio_instrument_view *view = &instrument->view;
    if (zones != NULL && !json_is_array(zones)) {
        return gonio_i_fail_at(place, "forbidden", "this is no array [...]");
    }
    if (json_array_size(zones) > MOST_ZONES) {
        return gonio_i_fail_at(place, "forbidden", "more than %d zones", MOST_ZONES);
    }
    gonio_status status = allocate(place->context, limits, zones, instrument);
    if (status == GONIO_OK && limits != NULL) {
        status = read_ranges(&here, instrument, limits, instrument->range, &view->limits);
    }
    gonio_range *next = status == GONIO_OK ? instrument->range + view->limits : NULL;
    for (size_t k = 0; k < json_array_size(zones) && status == GONIO_OK; k++) {
        status = read_zone(place, json_array_get(zones, k), k, instrument, next);
        next += instrument->zone[k].ranges;
        view->zones = k + 1;
    }
    view->limit = instrument->range;
    view->zone = instrument->zone;
    return status == GONIO_OK ? read_footprint(place, root, instrument) : status;
}
