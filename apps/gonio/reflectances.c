/* The directional-hemispherical reflectance at given incidences: see reflectances.h. */
#include "reflectances.h"

#include <math.h>
#include <stdlib.h>

#include "json_output.h"

bool tool_check_albedo_at(const tool *t, const char *text, tool_reflectances *at)
{
    *at = (tool_reflectances){0};
    const char *place = text;
    while (place != NULL && *place != '\0') {
        char *end = NULL;
        const double theta = strtod(place, &end);
        const bool valid = end > place && (*end == ',' || *end == '\0') && theta >= 0.0 &&
                           theta < 90.0 && at->incidences < TOOL_MOST_REFLECTANCES;
        if (!valid) {
            return tool_refuse(t,
                               "--albedo-at: '%s' is not a list of at most %d angles from 0 to "
                               "below 90 degrees",
                               text, TOOL_MOST_REFLECTANCES);
        }
        at->theta_i[at->incidences++] = theta;
        place = end + (*end == ',');
    }
    return true;
}

/* What is reflected at one incidence. */
typedef struct reflected {
    double theta_i; /* degrees */
    size_t channels;
    const double *value;
    const double *deviation; /* NULL: not known */
    double share;            /* of the hemisphere that has data */
} reflected;

static json_t *as_json(const reflected *r)
{
    json_t *value = json_array();
    json_t *deviation = r->deviation != NULL ? json_array() : json_null();
    for (size_t c = 0; c < r->channels; c++) {
        json_array_append_new(value, tool_json_number(r->value[c]));
        if (r->deviation != NULL) {
            json_array_append_new(deviation, tool_json_number(r->deviation[c]));
        }
    }
    return json_pack("{s:f, s:o, s:o, s:f}", "theta_i_deg", r->theta_i, "reflectance", value,
                     "deviation", deviation, "share_with_data", r->share);
}

static void print(const reflected *r)
{
    fprintf(tool_results(), "  reflectance  %g deg", r->theta_i);
    for (size_t c = 0; c < r->channels; c++) {
        fprintf(tool_results(), "  %.5f", r->value[c]);
        if (r->deviation != NULL) {
            fprintf(tool_results(), " +- %.5f", r->deviation[c]);
        }
    }
    if (r->share < 0.9995) {
        fprintf(tool_results(), "  at least: %.1f %% of the hemisphere has data", 100.0 * r->share);
    }
    fputc('\n', tool_results());
}

static void show(const reflected *r, json_t *list)
{
    if (list != NULL) {
        json_array_append_new(list, as_json(r));
    } else if (!tool_quiet) {
        print(r);
    }
}

/* The list in a JSON object; NULL without one. */
static json_t *list_in(json_t *object)
{
    json_t *list = object != NULL ? json_array() : NULL;
    if (list != NULL) {
        json_object_set_new(object, "reflectance", list);
    }
    return list;
}

gonio_status tool_reflectances_of_material(const tool *t, const tool_reflectances *at,
                                           const gonio_material *material, json_t *object)
{
    const size_t channels = gonio_material_describe(material)->channels;
    double *value = calloc(channels, sizeof *value);
    json_t *list = at->incidences > 0 ? list_in(object) : NULL;
    gonio_status status = value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < at->incidences && status == GONIO_OK; k++) {
        reflected r = {.theta_i = at->theta_i[k], .channels = channels, .value = value};
        status = gonio_material_reflectance(t->context, material, at->theta_i[k] * M_PI / 180.0,
                                            value, &r.share);
        if (status == GONIO_OK) {
            show(&r, list);
        }
    }
    free(value);
    return status;
}

gonio_status tool_reflectances_of_reconstruction(const tool *t, const tool_reflectances *at,
                                                 const gonio_basis *basis,
                                                 const gonio_reconstruction *reconstruction,
                                                 json_t *object)
{
    const bool joint = gonio_basis_describe(basis)->channels == GONIO_JOINT;
    const size_t channels = joint ? GONIO_CHANNELS : reconstruction->columns;
    double *value = calloc(channels, sizeof *value);
    double *deviation = calloc(channels, sizeof *deviation);
    json_t *list = at->incidences > 0 ? list_in(object) : NULL;
    gonio_status status = value != NULL && deviation != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < at->incidences && status == GONIO_OK; k++) {
        const reflected r = {at->theta_i[k], channels, value, deviation, 1.0};
        status = gonio_reconstruction_reflectance(t->context, basis, reconstruction,
                                                  at->theta_i[k] * M_PI / 180.0, value, deviation);
        if (status == GONIO_OK) {
            show(&r, list);
        }
    }
    free(value);
    free(deviation);
    return status;
}
