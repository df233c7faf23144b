/* An instrument in words and as JSON: see instrument_words.h. */
#include "instrument_words.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "json_output.h"

static double degrees(double angle)
{
    const double value = angle * 180.0 / M_PI;
    return round(value * 1e6) / 1e6 + 0.0; /* no -0 */
}

/* ---- words ---- */

static const char *summary_of_kinematics(const char *name)
{
    int k = 0;
    while (gonio_kinematics_name(k) != NULL && strcmp(gonio_kinematics_name(k), name) != 0) {
        k++;
    }
    return gonio_kinematics_summary(k);
}

static void print_axis(FILE *stream, const gonio_axis *axis)
{
    fprintf(stream, "  %-10s ", axis->name);
    if (axis->positions > 0) {
        fputs("at", stream);
        for (size_t k = 0; k < axis->positions; k++) {
            fprintf(stream, "%s %g", k > 0 ? "," : "", degrees(axis->position[k]));
        }
    } else {
        fprintf(stream, "%g to %g", degrees(axis->low), degrees(axis->high));
    }
    if (axis->step > 0.0) {
        fprintf(stream, " by %g", degrees(axis->step));
    }
    fputs(" degrees", stream);
    if (axis->speed > 0.0) {
        fprintf(stream, ", %g degrees/s", degrees(axis->speed));
    }
    if (axis->settling > 0.0) {
        fprintf(stream, ", settles in %g s", axis->settling);
    }
    fputc('\n', stream);
}

static void print_ranges(FILE *stream, const gonio_range *range, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        fprintf(stream, "%s%s %g to %g", k > 0 ? ", " : "", range[k].quantity,
                degrees(range[k].low), degrees(range[k].high));
    }
}

static void print_rules(FILE *stream, const gonio_instrument_view *view)
{
    if (view->limits > 0) {
        fputs("limits: ", stream);
        print_ranges(stream, view->limit, view->limits);
        fputs(" degrees\n", stream);
    }
    for (size_t k = 0; k < view->zones; k++) {
        fprintf(stream, "forbidden: %s (", view->zone[k].name);
        print_ranges(stream, view->zone[k].range, view->zone[k].ranges);
        fputs(" degrees)\n", stream);
    }
    if (view->lit > 0.0) {
        fprintf(stream, "footprint: the %s spot (lit %g mm, seen %g mm) stays inside the other\n",
                view->lit_inside ? "lit" : "seen", view->lit, view->seen);
    }
}

static void print_channels(FILE *stream, const gonio_instrument_view *view)
{
    for (size_t k = 0; k < view->channels; k++) {
        fputs(k > 0 ? ", " : "", stream);
        if (view->channel != NULL) {
            fputs(view->channel[k], stream);
        }
        if (view->wavelength != NULL) {
            fprintf(stream, "%s%g nm", view->channel != NULL ? " at " : "", view->wavelength[k]);
        }
    }
    fputs(view->channels > 0 ? "; " : "", stream);
}

static const char *sentence_of_values(const gonio_instrument_view *view)
{
    static const char *const sentences[] = {"BRDF in 1/sr",
                                            "reflectance factors",
                                            "reflectance factors in per cent",
                                            "BRDF times cos theta_o, in 1/sr",
                                            "reflectance factors times cos theta_o",
                                            "relative to a reference",
                                            "counts"};
    return sentences[view->values - GONIO_VALUE_BRDF];
}

/* Appends ", TEXT" where a number is above 0. */
static void print_part(FILE *stream, const char *format, double number)
{
    if (number != 0.0 && isfinite(number)) {
        fputs(", ", stream);
        char text[128];
        snprintf(text, sizeof text, format, number);
        fputs(text, stream);
    }
}

static void print_readings(FILE *stream, const gonio_instrument_view *view)
{
    fputs("readings: ", stream);
    print_channels(stream, view);
    fputs(sentence_of_values(view), stream);
    if (*view->reference != '\0') {
        fprintf(stream, " (%s)", view->reference);
    }
    const struct {
        const char *format;
        double number;
    } parts[] = {
        {"noise %g %%", 100.0 * view->noise},        {"floor %g 1/sr", view->floor},
        {"dark level %g 1/sr", view->dark},          {"stray light %g 1/sr", view->stray},
        {"saturation at %g 1/sr", view->saturation}, {"drift %g %% an hour", 100.0 * view->drift}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        print_part(stream, parts[k].format, parts[k].number);
    }
    fprintf(stream, "\napertures: half angles of %g (light) and %g degrees (detector)\n",
            degrees(view->source_aperture), degrees(view->detector_aperture));
}

static void print_times(FILE *stream, const gonio_instrument_view *view)
{
    fprintf(stream, "times: %g s a reading", view->exposure);
    print_part(stream, "%g s more where the incidence changes", view->incidence_change);
    if (view->reference_every > 0.0) {
        fprintf(stream, ", a reference every %g min, which takes %g s",
                view->reference_every / 60.0, view->reference_time);
    }
    fprintf(stream, "; axes move %s\n", view->in_turn ? "one after another" : "together");
}

/* What else counts as reached. */
static const char *words_of_between(const gonio_instrument_view *view)
{
    bool lists = false;
    for (size_t k = 0; k < view->axes; k++) {
        lists = lists || view->axis[k].positions > 0;
    }
    return view->directions > 0 ? ", with what is within 7.5 degrees of the table's"
           : lists              ? ", with what is between listed positions"
                                : "";
}

static void print_reach(FILE *stream, const gonio_instrument_view *view, const gonio_reach *reach)
{
    const bool region = reach->share > 0.0;
    if (region) {
        fprintf(stream, "reach: %.1f %% of all pairs of directions of an isotropic sample%s",
                100.0 * reach->share, words_of_between(view));
    } else {
        fputs("reach: single directions or a plane", stream);
    }
    fprintf(stream, ", theta_i %.4g to %.4g and theta_o %.4g to %.4g degrees;\n",
            degrees(reach->theta_i[0]), degrees(reach->theta_i[1]), degrees(reach->theta_o[0]),
            degrees(reach->theta_o[1]));
    fprintf(stream, "  as near as %.2g degrees to the light and %.2g to the mirror direction",
            degrees(reach->least_separation), degrees(reach->least_from_specular));
    fprintf(stream, "; light and detector are %s\n",
            view->reciprocal ? "exchanged where that helps" : "not exchanged");
    for (size_t k = 0; k < reach->obstacles && region; k++) {
        fprintf(stream, "%s%s %.1f %%", k == 0 ? "out of reach: " : ", ", reach->obstacle[k],
                100.0 * reach->kept_out[k]);
    }
    fputs(reach->obstacles > 0 && region ? "\n" : "", stream);
}

void instrument_print(FILE *stream, const gonio_instrument_view *view, const gonio_reach *reach)
{
    fprintf(stream, "%s: %s (%s)\n", view->path, view->name, view->kinematics);
    if (*view->comment != '\0') {
        fprintf(stream, "%s\n", view->comment);
    }
    fprintf(stream, "kinematics: %s\n", summary_of_kinematics(view->kinematics));
    for (size_t k = 0; k < view->axes; k++) {
        if (view->axis[k].present) {
            print_axis(stream, &view->axis[k]);
        }
    }
    if (view->directions > 0) {
        fprintf(stream, "  %zu directions\n", view->directions);
    }
    print_rules(stream, view);
    print_readings(stream, view);
    print_times(stream, view);
    print_reach(stream, view, reach);
}

/* ---- JSON ---- */

static json_t *range_json(double low, double high)
{
    return json_pack("[f, f]", degrees(low), degrees(high));
}

static json_t *axes_json(const gonio_instrument_view *view)
{
    json_t *axes = json_object();
    for (size_t k = 0; k < view->axes; k++) {
        const gonio_axis *axis = &view->axis[k];
        if (axis->present) {
            json_object_set_new(axes, axis->name,
                                json_pack("{s:f, s:f, s:f, s:f, s:f, s:I}", "from_deg",
                                          degrees(axis->low), "to_deg", degrees(axis->high),
                                          "step_deg", degrees(axis->step), "speed_deg_per_s",
                                          degrees(axis->speed), "settling_s", axis->settling,
                                          "positions", (json_int_t)axis->positions));
        }
    }
    return axes;
}

static json_t *ranges_json(const gonio_range *range, size_t count)
{
    json_t *ranges = json_object();
    for (size_t k = 0; k < count; k++) {
        char key[128];
        snprintf(key, sizeof key, "%s_deg", range[k].quantity);
        json_object_set_new(ranges, key, range_json(range[k].low, range[k].high));
    }
    return ranges;
}

static json_t *zones_json(const gonio_instrument_view *view)
{
    json_t *zones = json_array();
    for (size_t k = 0; k < view->zones; k++) {
        json_t *zone = ranges_json(view->zone[k].range, view->zone[k].ranges);
        json_object_set_new(zone, "name", tool_json_text(view->zone[k].name));
        json_array_append_new(zones, zone);
    }
    return zones;
}

static json_t *reach_json(const gonio_reach *reach)
{
    json_t *kept_out = json_object();
    for (size_t k = 0; k < reach->obstacles; k++) {
        json_object_set_new(kept_out, reach->obstacle[k], json_real(reach->kept_out[k]));
    }
    return json_pack("{s:f, s:o, s:o, s:f, s:f, s:o}", "share", reach->share, "theta_i_deg",
                     range_json(reach->theta_i[0], reach->theta_i[1]), "theta_o_deg",
                     range_json(reach->theta_o[0], reach->theta_o[1]), "least_separation_deg",
                     degrees(reach->least_separation), "least_from_specular_deg",
                     degrees(reach->least_from_specular), "kept_out", kept_out);
}

static json_t *sensor_json(const gonio_instrument_view *view)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:o, s:f}", "noise", view->noise, "floor_per_sr",
                     view->floor, "dark_per_sr", view->dark, "stray_per_sr", view->stray,
                     "saturation_per_sr", tool_json_number(view->saturation), "drift_per_hour",
                     view->drift);
}

static json_t *times_json(const gonio_instrument_view *view)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:s}", "exposure_s", view->exposure,
                     "incidence_change_s", view->incidence_change, "reference_every_min",
                     view->reference_every / 60.0, "reference_s", view->reference_time, "axes_move",
                     view->in_turn ? "in-turn" : "together");
}

json_t *instrument_json(const gonio_instrument_view *view, const gonio_reach *reach)
{
    json_t *wavelengths = json_array();
    for (size_t k = 0; k < view->channels && view->wavelength != NULL; k++) {
        json_array_append_new(wavelengths, json_real(view->wavelength[k]));
    }
    return json_pack(
        "{s:o, s:o, s:s, s:o, s:I, s:o, s:o, s:{s:f, s:f}, s:s, s:o, s:o, s:{s:f, s:f}, s:o, s:b, "
        "s:o}",
        "instrument", tool_json_text(view->path), "name", tool_json_text(view->name), "kinematics",
        view->kinematics, "axes", axes_json(view), "directions", (json_int_t)view->directions,
        "limits", ranges_json(view->limit, view->limits), "forbidden", zones_json(view),
        "footprint", "lit_mm", view->lit, "seen_mm", view->seen, "values",
        gonio_value_kind_name(view->values), "wavelengths_nm", wavelengths, "sensor",
        sensor_json(view), "apertures", "source_half_angle_deg", degrees(view->source_aperture),
        "detector_half_angle_deg", degrees(view->detector_aperture), "times", times_json(view),
        "reciprocal", view->reciprocal, "reach", reach_json(reach));
}
