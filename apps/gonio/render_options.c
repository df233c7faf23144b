/* The options of gonio render: sizes, views, lamps. See render_options.h. */
#include "render_options.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SAMPLES = 1000000 };

static const double degree = M_PI / 180.0;

/* Reads numbers separated by commas. Returns their number, at most `most`; 0 for other text. */
static int read_numbers(const char *text, double *number, int most)
{
    int count = 0;
    while (count < most) {
        char *end = NULL;
        number[count++] = strtod(text, &end);
        if (end == text || !isfinite(number[count - 1])) {
            return 0;
        }
        if (*end == '\0') {
            return count;
        }
        if (*end != ',') {
            return 0;
        }
        text = end + 1;
    }
    return 0;
}

/* Reads "512" or "640x480". The library refuses numbers that are too large for an image. */
static bool read_size(const char *text, int *width, int *height)
{
    char *end = NULL;
    if (!isdigit((unsigned char)*text)) {
        return false;
    }
    const long first = strtol(text, &end, 10);
    long second = first;
    if (*end == 'x') {
        const char *rest = end + 1;
        if (!isdigit((unsigned char)*rest)) {
            return false;
        }
        second = strtol(rest, &end, 10);
    }
    const long most = GONIO_MOST_PIXELS + 1L;
    *width = (int)(first < most ? first : most);
    *height = (int)(second < most ? second : most);
    return *end == '\0';
}

static bool set_view(const tool *t, const render_request *o, gonio_render_options *how)
{
    double angle[2];
    if (read_numbers(o->view, angle, 2) != 2 || fabs(angle[1]) > 90.0) {
        return tool_refuse(t, "--view: '%s' is not AZIMUTH,ELEVATION in degrees", o->view);
    }
    if (!(o->field_of_view >= 0.0 && o->field_of_view <= 110.0)) {
        return tool_refuse(t, "--fov: %g is outside 0 to 110 degrees", o->field_of_view);
    }
    how->azimuth = angle[0] * degree;
    how->elevation = angle[1] * degree;
    how->field_of_view = o->field_of_view * degree;
    return true;
}

static bool set_lamp(const tool *t, const render_request *o, gonio_render_options *how)
{
    double at[3] = {0.0, 0.0, 4.0};
    const bool point = o->light != NULL && strcmp(o->light, "point") == 0;
    if (o->light != NULL && !point && strcmp(o->light, "directional") != 0) {
        return tool_refuse(t, "--light: '%s' is neither directional nor point", o->light);
    }
    if (o->light != NULL && o->environment != NULL) {
        return tool_refuse(t, "--light and --environment exclude each other");
    }
    const int numbers = read_numbers(o->light_at, at, 3);
    if (numbers < 2 || (numbers == 3 && !point)) {
        return tool_refuse(t, "--light-at: '%s' is not AZIMUTH,ELEVATION in degrees%s", o->light_at,
                           point ? "[,DISTANCE]" : "");
    }
    if (point && at[2] <= 1.0) {
        return tool_refuse(t, "--light-at: distance %g must be above 1, the radius of the object",
                           at[2]);
    }
    how->lamp = point ? GONIO_LAMP_POINT : GONIO_LAMP_DIRECTIONAL;
    how->lamp_position[0] = at[2] * cos(at[1] * degree) * sin(at[0] * degree);
    how->lamp_position[1] = at[2] * sin(at[1] * degree);
    how->lamp_position[2] = at[2] * cos(at[1] * degree) * cos(at[0] * degree);
    return true;
}

bool render_set_options(const tool *t, const render_request *o, gonio_render_options *how)
{
    gonio_render_options_default(how);
    const char *size = o->size != NULL ? o->size : o->compare ? "256" : "512";
    if (!read_size(size, &how->width, &how->height)) {
        return tool_refuse(t, "--size: '%s' is not N or WIDTHxHEIGHT in pixels", size);
    }
    if (!(o->key > 0.0 && isfinite(o->key))) {
        return tool_refuse(t, "--key: %g must be above 0", o->key);
    }
    if (!tool_check_count(t, "--samples", o->samples, 1)) {
        return false;
    }
    if (o->samples > MOST_SAMPLES) {
        return tool_refuse(t, "--samples: %ld is too large, at most %d", o->samples, MOST_SAMPLES);
    }
    how->samples = (int)o->samples;
    how->seed = (uint64_t)o->seed;
    how->environment_turn = o->turn * degree;
    how->grain = o->grain * degree;
    how->flat = o->flat != 0;
    how->show_environment = o->show != 0;
    return tool_check_count(t, "--seed", o->seed, 0) && set_view(t, o, how) && set_lamp(t, o, how);
}
