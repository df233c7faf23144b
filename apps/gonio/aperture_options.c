/* The options of the instrument that made readings: see aperture_options.h. */
#include "aperture_options.h"

#include <math.h>
#include <stdlib.h>

static const double MOST_DEGREES = 45.0;

static bool is_half_angle(double degrees)
{
    return degrees >= 0.0 && degrees < MOST_DEGREES;
}

/* Reads "2" or "2,0.2": the half angles of detector and light. */
static bool read_half_angles(aperture_options *o)
{
    char *end = NULL;
    o->detector = strtod(o->aperture, &end);
    bool valid = end > o->aperture;
    if (*end == ',') {
        const char *second = end + 1;
        o->source = strtod(second, &end);
        valid = valid && end > second;
    }
    return valid && *end == '\0' && is_half_angle(o->detector) && is_half_angle(o->source);
}

bool aperture_options_check(const tool *t, aperture_options *o, const char *output)
{
    if (o->aperture != NULL && !read_half_angles(o)) {
        return tool_refuse(t,
                           "--aperture: '%s' is not a half angle of the detector, or of detector "
                           "and light (2,0.2), from 0 to below %g degrees",
                           o->aperture, MOST_DEGREES);
    }
    return o->instrument == NULL || tool_check_output(t, output, &o->instrument, 1);
}

gonio_status aperture_options_apply(const tool *t, aperture_options *o,
                                    posterior_options *posterior)
{
    gonio_status status = GONIO_OK;
    if (o->instrument != NULL) {
        status = gonio_instrument_read(t->context, o->instrument, &o->made);
    }
    if (status == GONIO_OK) {
        const gonio_instrument_view *view =
            o->made != NULL ? gonio_instrument_describe(o->made) : NULL;
        posterior_options_settle(posterior, view);
        if (view != NULL && o->aperture == NULL) {
            o->detector = view->detector_aperture * 180.0 / M_PI;
            o->source = view->source_aperture * 180.0 / M_PI;
        }
    }
    return status;
}

void aperture_options_end(aperture_options *o)
{
    gonio_instrument_free(&o->made);
}
