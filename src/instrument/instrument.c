/* An instrument, made of a JSON text: a file, or a built-in one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/text_file.h"
#include "builtin.h"
#include "file_parts.h"

void gonio_instrument_free(gonio_instrument **instrument)
{
    if (instrument == NULL || *instrument == NULL) {
        return;
    }
    gonio_instrument *i = *instrument;
    json_decref(i->source);
    free(i->path);
    free(i->position);
    free(i->range);
    free(i->zone);
    free((void *)i->channel);
    free(i->wavelength);
    free(i->reference);
    free(i->row);
    free(i->by_angles);
    free(i->by_axes);
    free(i);
    *instrument = NULL;
}

const gonio_instrument_view *gonio_instrument_describe(const gonio_instrument *instrument)
{
    return &instrument->view;
}

/* ---- the file ---- */

static const gonio_i_field top_fields[] = {{.key = "$schema"},
                                           {.key = "gonio_instrument", .needed = true},
                                           {.key = "name"},
                                           {.key = "comment"},
                                           {.key = "kinematics", .needed = true},
                                           {.key = "axes"},
                                           {.key = "directions"},
                                           {.key = "limits"},
                                           {.key = "forbidden"},
                                           {.key = "footprint"},
                                           {.key = "channels"},
                                           {.key = "wavelengths_nm"},
                                           {.key = "values"},
                                           {.key = "sensor"},
                                           {.key = "apertures"},
                                           {.key = "times"},
                                           {.key = "reciprocal"}};

enum { VERSION = 1 };

static gonio_status read_kinematics(const gonio_i_place *place, const json_t *root,
                                    gonio_instrument *instrument)
{
    const char *names[16] = {NULL};
    int choice = 0;
    for (int k = 0; k < 15 && gonio_kinematics_name(k) != NULL; k++) {
        names[k] = gonio_kinematics_name(k);
    }
    const gonio_status status = gonio_i_read_word(place, root, "kinematics", names, &choice);
    instrument->kinematics = gonio_i_kinematics_at(choice);
    instrument->view.kinematics = instrument->kinematics->name;
    return status;
}

static gonio_status read_top(const gonio_i_place *place, const json_t *root,
                             gonio_instrument *instrument)
{
    gonio_instrument_view *view = &instrument->view;
    gonio_status status =
        gonio_i_read_fields(place, root, top_fields, sizeof top_fields / sizeof *top_fields, NULL);
    const json_t *version = json_object_get(root, "gonio_instrument");
    if (status == GONIO_OK && json_integer_value(version) != VERSION) {
        return gonio_i_fail_at(place, "gonio_instrument",
                               "this gonio reads version %d of instrument files", VERSION);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_text(place, root, "name", "instrument", &view->name);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_text(place, root, "comment", "", &view->comment);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_flag(place, root, "reciprocal", &view->reciprocal);
    }
    return status == GONIO_OK ? read_kinematics(place, root, instrument) : status;
}

static gonio_status read_parts(gonio_context *context, gonio_instrument *instrument)
{
    const gonio_i_place place = {context, instrument->path, ""};
    const json_t *root = instrument->source;
    gonio_status status = read_top(&place, root, instrument);
    if (status == GONIO_OK) {
        status = gonio_i_read_axes(&place, root, instrument);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_limits(&place, root, instrument);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_sensor(&place, root, instrument);
    }
    if (status == GONIO_OK) {
        status = gonio_i_read_times(&place, root, instrument);
    }
    return status == GONIO_OK ? gonio_i_check_reach(context, instrument) : status;
}

static gonio_status load(gonio_context *context, const char *text, size_t size, const char *name,
                         gonio_instrument *instrument)
{
    json_error_t error;
    const bool mark = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0;
    instrument->path = gonio_i_format("%s", name);
    if (instrument->path == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", name);
    }
    instrument->view.path = instrument->path;
    instrument->view.saturation = INFINITY;
    instrument->view.values = GONIO_VALUE_BRDF;
    instrument->view.reference = "";
    instrument->source =
        json_loadb(text + (mark ? 3 : 0), size - (mark ? 3 : 0), JSON_REJECT_DUPLICATES, &error);
    if (instrument->source == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s:%d: JSON: %s", name, error.line,
                            error.text);
    }
    return read_parts(context, instrument);
}

static gonio_status make(gonio_context *context, const char *text, size_t size, const char *name,
                         gonio_instrument **instrument)
{
    gonio_instrument *made = gonio_i_allocate(context, 1, sizeof *made);
    const gonio_status status =
        made != NULL ? load(context, text, size, name, made) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        *instrument = made;
    } else {
        gonio_instrument_free(&made);
    }
    return status;
}

gonio_status gonio_instrument_parse(gonio_context *context, const char *text, const char *name,
                                    gonio_instrument **instrument)
{
    return make(context, text, strlen(text), name, instrument);
}

gonio_status gonio_instrument_read(gonio_context *context, const char *path,
                                   gonio_instrument **instrument)
{
    size_t size = 0;
    const char *builtin = gonio_i_builtin_instrument(path, &size);
    if (builtin != NULL) {
        return make(context, builtin, size, path, instrument);
    }
    char *text = NULL;
    gonio_status status = gonio_i_text_read(context, path, &text, &size);
    if (status == GONIO_OK) {
        status = make(context, text, size, path, instrument);
    }
    free(text);
    return status;
}
