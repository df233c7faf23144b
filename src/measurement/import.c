/* From rows to readings: see import.h. */
#include "import.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "angle_unit.h"
#include "convention.h"
#include "rules.h"
#include "value_scale.h"

enum { DIGITS = 9 };

static const double MOST_AZIMUTH = 720.0; /* degrees */

/* ---- beginning ---- */

void gonio_i_import_begin(gonio_i_import *import, gonio_context *context, gonio_readings *readings,
                          const char *taken_as, const gonio_convention *stated)
{
    *import = (gonio_i_import){.context = context,
                               .readings = readings,
                               .how = gonio_i_convention_of(stated, &readings->options.as),
                               .taken_as = taken_as};
    if (readings->options.directions_only) {
        import->how.values = GONIO_AS_STATED;
        import->how.scale = GONIO_AS_STATED;
    }
    readings->keep_angles = true;
    import->latest = NAN;
}

void gonio_i_import_leniently(gonio_i_import *import)
{
    import->lenient = true;
    import->readings->options.average_repeats = true;
}

/* The unit in which a wavelength would be light; NULL if there is none. */
static const char *unit_of_light(double wavelength)
{
    return wavelength > gonio_i_least_wavelength * 1e-9 &&
                   wavelength < gonio_i_most_wavelength * 1e-9
               ? "m"
           : wavelength > gonio_i_least_wavelength * 1e-3 &&
                   wavelength < gonio_i_most_wavelength * 1e-3
               ? "um"
               : NULL;
}

static gonio_status refuse_wavelength(const gonio_i_import *in, double wavelength)
{
    const char *unit = unit_of_light(wavelength);
    return unit != NULL && in->how.wavelengths <= GONIO_NANOMETRES
               ? gonio_i_fail(
                     in->context, GONIO_ERROR_FORMAT,
                     "%s: a wavelength of %g nm is not light; is it in %s? Give nm, or use "
                     "--as wavelengths=%s",
                     in->readings->path, wavelength, unit, unit)
               : gonio_i_fail(in->context, GONIO_ERROR_FORMAT,
                              "%s: %g is not a wavelength of light", in->readings->path,
                              wavelength);
}

static double nanometres(const gonio_i_import *in, double wavelength)
{
    const double scale = in->how.wavelengths == GONIO_METRES        ? 1e9
                         : in->how.wavelengths == GONIO_MICROMETRES ? 1e3
                                                                    : 1.0;
    return scale == 1.0 ? wavelength : nearbyint(wavelength * scale * 1e6) / 1e6;
}

static gonio_status take_wavelengths(const gonio_i_import *in, size_t channels,
                                     const double *wavelength, double *nm)
{
    for (size_t k = 0; k < channels; k++) {
        nm[k] = nanometres(in, wavelength[k]);
        if (!(nm[k] >= gonio_i_least_wavelength && nm[k] <= gonio_i_most_wavelength)) {
            return refuse_wavelength(in, wavelength[k]);
        }
    }
    const double twice = gonio_i_wavelength_twice(nm, channels);
    if (twice > 0.0) {
        return gonio_i_fail(in->context, GONIO_ERROR_FORMAT, "%s: %g nm occurs twice",
                            in->readings->path, twice);
    }
    return gonio_i_readings_begin(in->context, in->readings, channels, nm);
}

gonio_status gonio_i_import_channels(gonio_i_import *import, size_t channels,
                                     const double *wavelength)
{
    import->value = gonio_i_allocate(import->context, channels, sizeof *import->value);
    import->deviation = gonio_i_allocate(import->context, channels, sizeof *import->deviation);
    double *nm = gonio_i_allocate(import->context, channels, sizeof *nm);
    gonio_status status = GONIO_ERROR_MEMORY;
    /* Known here: a reader may have set it since the beginning. */
    import->readings->unit.kind = import->how.values;
    if (import->value != NULL && import->deviation != NULL && nm != NULL) {
        status = wavelength != NULL
                     ? take_wavelengths(import, channels, wavelength, nm)
                     : gonio_i_readings_begin(import->context, import->readings, channels, NULL);
    }
    free(nm);
    return status;
}

/* ---- angles ---- */

double gonio_i_import_rounded(double degrees)
{
    if (degrees == 0.0 || !isfinite(degrees)) {
        return fabs(degrees);
    }
    const int places = DIGITS - 1 - (int)floor(log10(fabs(degrees)));
    const double scale = pow(10.0, places);
    const double whole = nearbyint(degrees * scale);
    return places >= 0 && places <= 22 ? whole / scale : degrees;
}

double gonio_i_import_degrees(const gonio_i_import *import, double angle)
{
    const double degrees = gonio_i_degrees_of(import->how.angles, angle);
    return degrees == angle ? angle : gonio_i_import_rounded(degrees);
}

static gonio_status refuse_angle(const gonio_i_import *in, const gonio_i_row *row, int which)
{
    static const char *const names[4] = {"theta_i", "phi_i", "theta_o", "phi_o"};
    const bool radians = in->how.angles == GONIO_RADIANS;
    const double number = gonio_i_angle_of(in->how.angles, row->degrees[which]);
    const char *advice = radians && fabs(number) <= 360.0 ? "; these look like degrees: use --as "
                                                            "angles=degrees"
                                                          : "";
    return gonio_i_fail(in->context, isfinite(number) ? GONIO_ERROR_DATA : GONIO_ERROR_FORMAT,
                        "%s:%zu: %s = %.7g is impossible in %s%s", in->readings->path, row->line,
                        names[which], number, gonio_i_angle_unit_word(in->how.angles), advice);
}

/* Makes theta positive, which turns phi by 180 degrees. Limits phi to one turn. */
static void fold(double *theta, double *phi)
{
    if (*theta < 0.0) {
        *theta = -*theta;
        *phi += *phi < 180.0 ? 180.0 : -180.0;
    }
    if (fabs(*phi) > 360.0) {
        *phi = gonio_i_import_rounded(fmod(*phi, 360.0));
    }
}

/* Sets phi to 0 at the normal, where it has no meaning. */
static void settle_pole(double theta, double *phi)
{
    *phi = theta == 0.0 ? 0.0 : *phi;
}

/* Converts the angles of a row to gonio's convention. False at or below the horizon. */
static bool take_angles(const gonio_i_import *in, const double from[4], double to[4])
{
    memcpy(to, from, 4 * sizeof *to);
    if (in->how.mirror == GONIO_MIRROR_0) {
        to[3] += to[3] < 180.0 ? 180.0 : -180.0;
    }
    fold(&to[0], &to[1]);
    fold(&to[2], &to[3]);
    if (in->lenient) {
        settle_pole(to[0], &to[1]);
        settle_pole(to[2], &to[3]);
    }
    return to[0] < 90.0 && to[2] < 90.0;
}

/* Refuses angles that are impossible. Azimuths in degrees may have any size, because encoders count
 * turns. Azimuths of many radians are degrees by mistake. */
static gonio_status check_angles(const gonio_i_import *in, const gonio_i_row *row)
{
    const double most_azimuth = in->how.angles == GONIO_RADIANS ? MOST_AZIMUTH : HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        const bool polar = k % 2 == 0;
        if (!isfinite(row->degrees[k]) || fabs(row->degrees[k]) > (polar ? 180.0 : most_azimuth)) {
            return refuse_angle(in, row, k);
        }
    }
    return GONIO_OK;
}

/* ---- values ---- */

/* Counts need the instrument as soon as there is one: a plan with an empty column does not. */
static gonio_status check_counts(const gonio_i_import *in, const gonio_i_row *row)
{
    const gonio_i_value_unit *unit = &in->readings->unit;
    bool any = false;
    for (size_t k = 0; k < in->readings->channels && unit->kind == GONIO_VALUE_COUNTS; k++) {
        any = any || !isnan(row->value[k]);
    }
    return !any || unit->counts > 0.0
               ? GONIO_OK
               : gonio_i_fail(
                     in->context, GONIO_ERROR_ARGUMENT,
                     "%s: its values are counts: how many of them are 1/sr is said by "
                     "counts_of_1_per_sr of an instrument file (--instrument); or take them as "
                     "they are by --as values=brdf",
                     in->readings->path);
}

/* Converts the values of a row to a BRDF. Returns whether there is a value. */
static bool take_values(gonio_i_import *in, const gonio_i_row *row, const double degrees[4])
{
    const double by = gonio_i_value_factor(&in->readings->unit, degrees[2] * M_PI / 180.0);
    bool any = false;
    for (size_t k = 0; k < in->readings->channels; k++) {
        const bool missing = row->value[k] == 0.0 && in->how.zeros == GONIO_ZEROS_MISSING;
        const double value = missing ? NAN : row->value[k] / by;
        const bool negative = in->lenient && value < 0.0 && isfinite(value);
        in->negative += negative;
        in->value[k] = negative ? 0.0 : value;
        any = any || !isnan(value);
        in->deviation[k] = row->deviation != NULL ? row->deviation[k] / by : NAN;
    }
    return any;
}

/* ---- rows ---- */

/* A clock without a date begins again at midnight. */
static const double DAY = 86400.0;

/* The time of a row, after those before it; counts rows that are earlier. */
static double take_time(gonio_i_import *in, const gonio_i_row *row)
{
    double time = row->timed ? row->time + in->days * DAY : NAN;
    if (time < in->latest - DAY / 2.0 && time >= 0.0 && row->time < DAY) {
        in->days += 1.0;
        time += DAY;
    }
    if (time < in->latest) {
        in->first_backwards = in->backwards == 0 ? row->line : in->first_backwards;
        in->backwards++;
    }
    in->latest = isnan(time) ? in->latest : time;
    return time;
}

/* A row of the reference or of the dark level. */
static gonio_status add_marked(gonio_i_import *in, const gonio_i_row *row, double time)
{
    gonio_i_marked marked = {.mark = row->mark, .time = time, .line = row->line};
    memcpy(marked.degrees, row->degrees, sizeof marked.degrees);
    return gonio_i_marked_add(in->context, &in->marked, in->readings->channels, &marked,
                              row->value);
}

/* Makes values of logarithms. Numbers stay the caller's. */
static gonio_i_row without_logarithms(const gonio_i_import *in, const gonio_i_row *row)
{
    gonio_i_row linear = *row;
    if (!gonio_i_scale_is_logarithm(in->how.scale)) {
        return linear;
    }
    for (size_t k = 0; k < in->readings->channels; k++) {
        in->value[k] = gonio_i_scale_value(in->how.scale, row->value[k]);
        in->deviation[k] =
            row->deviation != NULL
                ? gonio_i_scale_deviation(in->how.scale, in->value[k], row->deviation[k])
                : NAN;
    }
    linear.value = in->value;
    linear.deviation = row->deviation != NULL ? in->deviation : NULL;
    return linear;
}

gonio_status gonio_i_import_add(gonio_i_import *import, const gonio_i_row *given)
{
    const gonio_i_row linear = without_logarithms(import, given);
    const gonio_i_row *row = &linear;
    const double time = take_time(import, row);
    if (row->mark != GONIO_I_SAMPLE && import->readings->options.directions_only) {
        gonio_i_import_leave_out(import, GONIO_I_NOT_THE_SAMPLE);
        return GONIO_OK;
    }
    if (row->mark != GONIO_I_SAMPLE) {
        return add_marked(import, row, time);
    }
    gonio_i_reading reading = {.planned = row->planned,
                               .line = row->line,
                               .timed = row->timed,
                               .time = time,
                               .value = import->value,
                               .deviation = row->deviation != NULL ? import->deviation : NULL};
    gonio_status status = check_angles(import, row);
    status = status == GONIO_OK ? check_counts(import, row) : status;
    if (status != GONIO_OK) {
        return status;
    }
    if (!take_angles(import, row->degrees, reading.degrees)) {
        gonio_i_import_leave_out(import, GONIO_I_BELOW_HORIZON);
        return GONIO_OK;
    }
    const bool needed =
        import->lenient || (import->readings->options.values_needed && !import->keep_unmeasured);
    if (!take_values(import, row, reading.degrees) && needed) {
        gonio_i_import_leave_out(import, GONIO_I_NOT_MEASURED);
        return GONIO_OK;
    }
    import->negative_theta += row->degrees[0] < 0.0 || row->degrees[2] < 0.0;
    return gonio_i_readings_add(import->context, import->readings, &reading);
}

/* ---- about the mirror direction ---- */

void gonio_i_from_mirror(double theta_i, double radial, double azimuth, double *theta_o,
                         double *phi_difference)
{
    const double t = theta_i * M_PI / 180.0;
    const double r = radial * M_PI / 180.0;
    const double a = azimuth * M_PI / 180.0;
    /* The mirror direction m = (-sin t, 0, cos t) for light from (sin t, 0, cos t); towards the
     * normal from there: u = (cos t, 0, sin t); v = m x u. */
    const double along = cos(r);
    const double towards = sin(r) * cos(a);
    const double x = -sin(t) * along + cos(t) * towards;
    const double y = sin(r) * sin(a);
    const double z = cos(t) * along + sin(t) * towards;
    *theta_o = gonio_i_import_rounded(atan2(hypot(x, y), z) * 180.0 / M_PI);
    *phi_difference = *theta_o < 1e-6 ? 0.0 : gonio_i_import_rounded(atan2(y, x) * 180.0 / M_PI);
    *theta_o = *theta_o < 1e-6 ? 0.0 : *theta_o;
}
