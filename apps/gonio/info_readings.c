/* gonio info on plans and readings: see info_readings.h. */
#include "info_readings.h"
#include "inputs.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_ROOM = 32, MOST_LISTED = 8 };

static const double ENOUGH = 0.5; /* share of a hemisphere that an albedo needs */
static const double NARROW =
    0.25; /* share of one reading in an albedo, if its peak is too narrow */

static const double ANISOTROPIC_PERCENT = 28.0; /* ln 1.28: gonio_interpretation.anisotropic */

typedef struct description {
    const char *path;
    const char *format; /* NULL: unknown, for a pipe */
    const gonio_readings *readings;
    const gonio_readings_view *view;
    const gonio_survey *survey;
    char basis[20];
} description;

/* Degrees, rounded to 1e-6. */
static double degrees(double radians)
{
    return round(radians * 180e6 / M_PI) * 1e-6;
}

static void name_channel(const description *d, size_t channel, char name[NAME_ROOM])
{
    if (d->view->wavelength != NULL) {
        snprintf(name, NAME_ROOM, "%g nm", d->view->wavelength[channel]);
    } else if (gonio_readings_are_colours(d->readings)) {
        snprintf(name, NAME_ROOM, "%c", "RGB"[channel]);
    } else {
        snprintf(name, NAME_ROOM, d->view->channels == 1 ? "value" : "value %zu", channel + 1);
    }
}

static const char *kind_of(const description *d)
{
    return d->survey->measured > 0 ? "readings" : "plan";
}

static size_t count_zeros(const description *d)
{
    size_t zeros = 0;
    for (size_t c = 0; c < d->view->channels; c++) {
        zeros += d->survey->channel[c].zero;
    }
    return zeros;
}

/* Whether an albedo is known well enough to be shown. */
static bool has_albedo(const gonio_incidence *incidence)
{
    return incidence->albedo != NULL && incidence->covered >= ENOUGH;
}

/* The largest albedo, of all or only of those that no single reading dominates; NaN if there is
 * none. */
static double largest_albedo(const description *d, bool all)
{
    double largest = NAN;
    for (size_t n = 0; n < d->survey->incidences; n++) {
        const gonio_incidence *incidence = &d->survey->incidence[n];
        const bool counts = has_albedo(incidence) && (all || incidence->peak <= NARROW);
        for (size_t c = 0; c < d->view->channels && counts; c++) {
            largest = fmax(largest, incidence->albedo[c]);
        }
    }
    return largest;
}

static const char *energy_of(const description *d)
{
    return largest_albedo(d, true) <= 1.0   ? "conserved at these incidences"
           : largest_albedo(d, false) > 1.0 ? "NOT conserved: reflects more than it receives"
                                            : "not known: single readings of a narrow peak make "
                                              "the albedos above 1";
}

/* ---- in words ---- */

/* Chooses the channels to show of many: the first, the middle and the last. */
static size_t choose_channels(const description *d, size_t channel[3])
{
    const size_t count = d->view->channels;
    channel[0] = 0;
    channel[1] = count > 2 ? count / 2 : count - 1;
    channel[2] = count - 1;
    return count < 3 ? count : 3;
}

static void print_channels(const description *d)
{
    size_t shown[3];
    const size_t count = choose_channels(d, shown);
    if (d->view->wavelength != NULL) {
        double least = INFINITY;
        double most = 0.0;
        for (size_t k = 0; k < d->view->channels; k++) {
            least = fmin(least, d->view->wavelength[k]);
            most = fmax(most, d->view->wavelength[k]);
        }
        printf("  channels     %zu wavelength%s, %g", d->view->channels,
               tool_plural(d->view->channels), least);
        printf(most > least ? " to %g nm\n" : " nm\n", most);
    } else if (gonio_readings_are_colours(d->readings)) {
        printf("  channels     R, G, B\n");
    } else {
        printf("  channels     %zu, without wavelengths\n", d->view->channels);
    }
    printf("  values       %-10s %9s %9s %9s  1/sr\n", "", "least", "median", "most");
    for (size_t k = 0; k < count; k++) {
        char name[NAME_ROOM];
        const gonio_channel_survey *c = &d->survey->channel[shown[k]];
        name_channel(d, shown[k], name);
        if (c->read == 0) {
            printf("               %-10s nothing was read\n", name);
        } else {
            printf("               %-10s %9.4g %9.4g %9.4g\n", name, c->least, c->median, c->most);
        }
    }
}

/* Prints "10 to 80 deg", or "10 deg" for a single angle. */
static void print_range(const char *name, const double radians[2])
{
    const double least = degrees(radians[0]);
    const double most = degrees(radians[1]);
    printf("%s %.4g", name, least);
    printf(most > least ? " to %.4g deg" : " deg", most);
}

static void print_directions(const description *d)
{
    const gonio_survey *s = d->survey;
    if (s->incidences > 0 && s->incidences <= MOST_LISTED) {
        printf("  light        theta_i");
        for (size_t n = 0; n < s->incidences; n++) {
            printf("%s %.4g", n > 0 ? "," : "", degrees(s->incidence[n].theta_i));
        }
        printf(" deg\n");
    } else {
        print_range("  light        theta_i", s->theta_i);
        if (s->incidences > 0) {
            printf(", %zu polar angles", s->incidences);
        }
        putchar('\n');
    }
    print_range("  viewer       theta_o", s->theta_o);
    printf("; %s in the plane of incidence\n", s->in_plane == d->view->count ? "all"
                                               : s->in_plane == 0            ? "none"
                                                                             : "some");
    print_range("  half vector  theta_h", s->theta_h);
    puts("; 0 is the mirror direction");
}

static void print_one_albedo(const description *d, const gonio_incidence *incidence)
{
    size_t shown[3];
    const size_t count = choose_channels(d, shown);
    printf("               %4.4g deg %6.0f %%  ", degrees(incidence->theta_i),
           100.0 * incidence->covered);
    for (size_t k = 0; k < count; k++) {
        const double albedo = incidence->albedo[shown[k]];
        if (isnan(albedo)) {
            printf(" %9s", "-");
        } else {
            printf(" %9.3f", albedo);
        }
    }
    if (incidence->peak > NARROW) {
        printf("  %.0f %% of it from one reading", 100.0 * incidence->peak);
    }
    putchar('\n');
}

static void print_albedo_headings(const description *d)
{
    size_t shown[3];
    const size_t count = choose_channels(d, shown);
    printf("  albedo       theta_i   covered  ");
    for (size_t k = 0; k < count; k++) {
        char name[NAME_ROOM];
        name_channel(d, shown[k], name);
        printf(" %9s", name);
    }
    putchar('\n');
}

/* Prints the albedos at some of the incidences that have one. */
static void print_albedos(const description *d)
{
    const gonio_survey *s = d->survey;
    double covered = 0.0;
    size_t known = 0;
    for (size_t n = 0; n < s->incidences; n++) {
        covered = fmax(covered, s->incidence[n].covered);
        known += has_albedo(&s->incidence[n]);
    }
    if (known == 0) {
        printf("  albedo       not known: %s\n",
               covered > 0.0 ? "less than half of the hemisphere was read at each incidence"
                             : "too few readings of the same incidence");
        return;
    }
    print_albedo_headings(d);
    const size_t step = (known + MOST_LISTED - 1) / MOST_LISTED;
    size_t met = 0;
    for (size_t n = 0; n < s->incidences; n++) {
        if (has_albedo(&s->incidence[n]) && met++ % step == 0) {
            print_one_albedo(d, &s->incidence[n]);
        }
    }
    printf("  energy       %s\n", energy_of(d));
}

static void print_agreement(const gonio_survey *s)
{
    if (s->repeats > 0) {
        printf("  repeats      %zu reading%s at the angles of others, which differ by %.2f %% "
               "(RMS)\n",
               s->repeats, tool_plural(s->repeats), s->repeats_percent);
    }
    if (s->turned_pairs > 0) {
        printf(
            "  turned       %zu pair%s at other turns of the sample differ by %.2g %% (median)%s\n",
            s->turned_pairs, tool_plural(s->turned_pairs), s->turned_percent,
            s->turned_percent > ANISOTROPIC_PERCENT ? ": anisotropic?" : "");
    }
    if (s->reciprocal_pairs > 0) {
        printf(
            "  reciprocity  %zu pair%s with light and viewer exchanged differ by %.2f %% (RMS)\n",
            s->reciprocal_pairs, tool_plural(s->reciprocal_pairs), s->reciprocity_percent);
    } else {
        printf("  reciprocity  not known: no direction was read with light and viewer exchanged\n");
    }
}

/* Prints the lines of outliers. A line may have several readings. */
static void print_outliers(const description *d)
{
    const gonio_survey *s = d->survey;
    size_t before = 0;
    int listed = 0;
    printf("  suspicious   %zu reading%s far from those around %s: line%s", s->outliers,
           tool_plural(s->outliers), s->outliers == 1 ? "it" : "them", tool_plural(s->outliers));
    for (size_t k = 0; k < s->outliers && k < GONIO_MOST_OUTLIERS && listed < MOST_LISTED; k++) {
        const size_t line = d->view->line[s->outlier[k]];
        if (line != before) {
            printf("%s %zu", listed > 0 ? "," : "", line);
            before = line;
            listed++;
        }
    }
    puts(s->outliers > MOST_LISTED ? " ..." : "");
    if (s->outliers > s->measured / 100 && s->outliers > MOST_LISTED) {
        puts("               so many are found of an anisotropic or a textured material, and of "
             "noise");
    }
}

/* Prints what may be wrong. */
static void print_suspicions(const description *d)
{
    const size_t values = d->view->count * d->view->channels;
    if (d->survey->empty > 0) {
        printf("  empty        %zu of %zu values\n", d->survey->empty, values);
    }
    if (d->view->below_zero > 0) {
        printf("  below zero   %zu value%s, taken as 0\n", d->view->below_zero,
               tool_plural(d->view->below_zero));
    }
    const size_t zeros = count_zeros(d);
    if (zeros > d->view->below_zero) {
        printf("  zeros        %zu of %zu values: below the instrument's sensitivity, or not "
               "measured\n",
               zeros - d->view->below_zero, values);
    }
    if (d->survey->outliers > 0) {
        print_outliers(d);
    }
}

static void print_all(const description *d)
{
    printf("%s: gonio %s, %zu directions, %zu measured\n", d->path, kind_of(d), d->view->count,
           d->survey->measured);
    if (d->format != NULL) {
        printf("  format       %s\n", d->format);
    }
    for (size_t k = 0; k < d->view->notes; k++) {
        printf("  note         %s\n", d->view->note[k]);
    }
    printf("  basis        %s\n", d->basis);
    if (d->view->components > 0) {
        printf("  components   %zu\n", d->view->components);
    }
    if (d->view->method[0] != '\0') {
        printf("  method       %s\n", d->view->method);
    }
    print_directions(d);
    if (d->survey->measured > 0) {
        print_channels(d);
        print_albedos(d);
        print_agreement(d->survey);
        print_suspicions(d);
    }
}

/* ---- as JSON ---- */

static json_t *range_json(const double radians[2])
{
    return json_pack("[o, o]", tool_json_number(degrees(radians[0])),
                     tool_json_number(degrees(radians[1])));
}

static json_t *channels_json(const description *d)
{
    json_t *list = json_array();
    for (size_t k = 0; k < d->view->channels; k++) {
        char name[NAME_ROOM];
        const gonio_channel_survey *c = &d->survey->channel[k];
        name_channel(d, k, name);
        json_array_append_new(
            list,
            json_pack("{s:s, s:o, s:I, s:I, s:o, s:o, s:o}", "name", name, "wavelength_nm",
                      d->view->wavelength != NULL ? json_real(d->view->wavelength[k]) : json_null(),
                      "read", (json_int_t)c->read, "zeros", (json_int_t)c->zero, "least_per_sr",
                      tool_json_number(c->least), "median_per_sr", tool_json_number(c->median),
                      "most_per_sr", tool_json_number(c->most)));
    }
    return list;
}

static json_t *albedo_json(const description *d, const gonio_incidence *incidence)
{
    json_t *list = has_albedo(incidence) ? json_array() : json_null();
    for (size_t k = 0; k < d->view->channels && has_albedo(incidence); k++) {
        json_array_append_new(list, tool_json_number(incidence->albedo[k]));
    }
    return list;
}

static json_t *incidences_json(const description *d)
{
    json_t *list = json_array();
    for (size_t n = 0; n < d->survey->incidences; n++) {
        const gonio_incidence *incidence = &d->survey->incidence[n];
        json_array_append_new(
            list, json_pack("{s:f, s:I, s:f, s:f, s:o}", "theta_i_deg", degrees(incidence->theta_i),
                            "readings", (json_int_t)incidence->count, "covered", incidence->covered,
                            "largest_share_of_a_reading", incidence->peak, "albedo",
                            albedo_json(d, incidence)));
    }
    return list;
}

static json_t *lines_json(const description *d)
{
    json_t *list = json_array();
    for (size_t k = 0; k < d->survey->outliers && k < GONIO_MOST_OUTLIERS; k++) {
        json_array_append_new(list, json_integer((json_int_t)d->view->line[d->survey->outlier[k]]));
    }
    return list;
}

static json_t *notes_json(const gonio_readings_view *view)
{
    json_t *list = json_array();
    for (size_t k = 0; k < view->notes; k++) {
        json_array_append_new(list, tool_json_text(view->note[k]));
    }
    return list;
}

/* A number in per cent; null if it is unknown. */
static json_t *percent_json(size_t count, double percent)
{
    return count > 0 ? tool_json_number(percent) : json_null();
}

/* Whether energy is conserved: true, false, or null if it is unknown. */
static json_t *energy_json(const description *d)
{
    return largest_albedo(d, true) <= 1.0   ? json_true()
           : largest_albedo(d, false) > 1.0 ? json_false()
                                            : json_null();
}

/* The checks: what is or may be wrong, and how far readings contradict each other. */
static json_t *checks_json(const description *d)
{
    const gonio_survey *s = d->survey;
    return json_pack("{s:o, s:I, s:o, s:I, s:o, s:I, s:o, s:I, s:I, s:I, s:I, s:o}",
                     "conserves_energy", energy_json(d), "repeats", (json_int_t)s->repeats,
                     "repeats_rms_percent", percent_json(s->repeats, s->repeats_percent),
                     "reciprocal_pairs", (json_int_t)s->reciprocal_pairs, "reciprocity_rms_percent",
                     percent_json(s->reciprocal_pairs, s->reciprocity_percent), "turned_pairs",
                     (json_int_t)s->turned_pairs, "turned_median_percent",
                     percent_json(s->turned_pairs, s->turned_percent), "empty",
                     (json_int_t)s->empty, "zeros", (json_int_t)count_zeros(d), "below_zero",
                     (json_int_t)d->view->below_zero, "outliers", (json_int_t)s->outliers,
                     "outlier_lines", lines_json(d));
}

static json_t *all_json(const description *d)
{
    const gonio_survey *s = d->survey;
    json_t *json = json_pack(
        "{s:o, s:s, s:s?, s:o, s:I, s:I, s:s, s:I, s:o, s:o, s:o, s:o, s:I, s:o, s:o}", "file",
        tool_json_text(d->path), "kind", kind_of(d), "format", d->format, "notes",
        notes_json(d->view), "directions", (json_int_t)d->view->count, "measured",
        (json_int_t)s->measured, "basis", d->basis, "components", (json_int_t)d->view->components,
        "method", tool_json_text(d->view->method), "theta_i_deg", range_json(s->theta_i),
        "theta_o_deg", range_json(s->theta_o), "theta_h_deg", range_json(s->theta_h), "in_plane",
        (json_int_t)s->in_plane, "channels", channels_json(d), "incidences", incidences_json(d));
    json_t *checks = checks_json(d);
    if (json != NULL && checks != NULL) {
        json_object_update(json, checks);
    }
    json_decref(checks);
    return json;
}

/* ---- either ---- */

static void describe(description *d, json_t *results)
{
    snprintf(d->basis, sizeof d->basis, "not stated");
    if (d->view->basis != 0) {
        snprintf(d->basis, sizeof d->basis, "%016" PRIx64, d->view->basis);
    }
    if (results != NULL) {
        json_array_append_new(results, all_json(d));
    } else {
        print_all(d);
    }
}

int tool_info_readings(const tool *t, const char *path, json_t *results)
{
    const gonio_readings_options how = {.size = sizeof how,
                                        .average_repeats = true,
                                        .negative_to_zero = true,
                                        .instrument = t->instrument};
    gonio_readings *readings = NULL;
    gonio_survey *survey = NULL;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const char *format = NULL;
    gonio_status status = gonio_file_kind(t->context, path, &kind, &format);
    if (status == GONIO_OK) {
        status = tool_read_readings(t, path, &how, &readings);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_survey(t->context, readings, &survey);
    }
    if (status == GONIO_OK) {
        description d = {.path = path,
                         .format = tool_has_convention(path) ? NULL : format,
                         .readings = readings,
                         .view = gonio_readings_describe(readings),
                         .survey = survey};
        describe(&d, results);
    }
    gonio_survey_free(&survey);
    gonio_readings_free(&readings);
    return tool_exit_code(status);
}
