/* Instruments: files and their mistakes, kinematics forth and back, reach, apertures and times. */
#include "../support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#define DEGREE (M_PI / 180.0)

static gonio_instrument *parse(gonio_context *context, const char *text)
{
    gonio_instrument *instrument = NULL;
    const gonio_status status = gonio_instrument_parse(context, text, "rig.json", &instrument);
    if (status != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    return instrument;
}

static gonio_instrument *builtin(gonio_context *context, const char *word)
{
    gonio_instrument *instrument = NULL;
    if (gonio_instrument_read(context, word, &instrument) != GONIO_OK) {
        fail_msg("%s", support_message());
    }
    return instrument;
}

static gonio_pair pair_of(double theta_i, double phi_i, double theta_o, double phi_o)
{
    return (gonio_pair){{theta_i * DEGREE, phi_i * DEGREE}, {theta_o * DEGREE, phi_o * DEGREE}};
}

/* ---- files ---- */

static void test_builtin_instruments(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    int count = 0;
    for (; gonio_instrument_word(count) != NULL; count++) {
        gonio_instrument *instrument = builtin(context, gonio_instrument_word(count));
        const gonio_instrument_view *view = gonio_instrument_describe(instrument);
        assert_string_equal(view->path, gonio_instrument_word(count));
        assert_true(strlen(gonio_instrument_summary(count)) > 10);
        assert_true(view->axes >= 2 && view->exposure > 0.0 && view->detector_aperture > 0.0);
        gonio_instrument_free(&instrument);
        assert_null(instrument);
    }
    assert_true(count >= 3);
    assert_null(gonio_instrument_summary(count));
    assert_null(gonio_instrument_word(-1));
    assert_string_equal(gonio_kinematics_name(0), "direct");
    assert_non_null(gonio_kinematics_summary(4));
    assert_null(gonio_kinematics_name(5));
    assert_string_equal(gonio_value_kind_name(GONIO_VALUE_FACTOR_COSINE), "factor-cosine");
    assert_null(gonio_value_kind_name((gonio_value_kind)0));
    gonio_context_free(&context);
}

#define IN_PLANE "\"kinematics\": \"in-plane\", "
#define AXES                                                                                       \
    "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 80}, "                                \
    "\"detector\": {\"from_deg\": -80, \"to_deg\": 80}}"

#define SIXTEEN "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,"
#define SIXTY_FOUR SIXTEEN SIXTEEN SIXTEEN SIXTEEN

static const struct {
    const char *text; /* without the braces and the version */
    gonio_status status;
    const char *message;
} mistakes[] = {
    {AXES, GONIO_ERROR_FORMAT, "rig.json: kinematics: this key is missing"},
    {"\"kinematics\": \"six-axis\", " AXES, GONIO_ERROR_FORMAT,
     "kinematics: 'six-axis' is not known; known are direct, in-plane, arms, four-axis, table"},
    {IN_PLANE "\"axis\": 1", GONIO_ERROR_FORMAT, "axis: unknown key; known are"},
    {IN_PLANE "\"reciprocal\": 1, " AXES, GONIO_ERROR_FORMAT, "reciprocal: this is neither"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 80}}", GONIO_ERROR_FORMAT,
     "axes.detector: this key is missing"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"from_deg\": 80, \"to_deg\": 0}, \"detector\": "
              "{\"positions_deg\": [1]}}",
     GONIO_ERROR_FORMAT, "axes.incidence.from_deg: 80 is above to_deg, 0"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 5, \"step_deg\": 9}, "
              "\"detector\": {\"positions_deg\": [1]}}",
     GONIO_ERROR_FORMAT, "axes.incidence.step_deg: 9 is more than the whole range"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"positions_deg\": [5, 5]}, \"detector\": "
              "{\"positions_deg\": [1]}}",
     GONIO_ERROR_FORMAT, "axes.incidence.positions_deg: entry 2 is not above"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"positions_deg\": [5], \"from_deg\": 1}, "
              "\"detector\": {\"positions_deg\": [1]}}",
     GONIO_ERROR_FORMAT, "not both"},
    {IN_PLANE "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 8, \"speed_deg_per_s\": 0}, "
              "\"detector\": {\"positions_deg\": [1]}}",
     GONIO_ERROR_FORMAT, "axes.incidence.speed_deg_per_s: 0 is not between"},
    {IN_PLANE AXES ", \"limits\": {\"theta_x_deg\": [0, 1]}", GONIO_ERROR_FORMAT,
     "limits.theta_x_deg: unknown quantity; known are theta_i_deg"},
    {IN_PLANE AXES ", \"limits\": {\"theta_i_deg\": [75, 0]}", GONIO_ERROR_FORMAT,
     "limits.theta_i_deg: [75, 0] is no range"},
    {IN_PLANE AXES ", \"limits\": {\"theta_i_deg\": [85, 89]}", GONIO_ERROR_DATA,
     "no pair of directions can be reached; most are kept out by 'theta_i'"},
    {IN_PLANE AXES ", \"forbidden\": [{\"name\": \"fog\", \"separation_deg\": [0, 181]}]",
     GONIO_ERROR_DATA, "kept out by 'fog'"},
    {IN_PLANE AXES ", \"forbidden\": [{\"name\": \"fog\"}]", GONIO_ERROR_FORMAT,
     "forbidden[0]: a zone needs at least one range"},
    {IN_PLANE AXES ", \"footprint\": {\"lit_mm\": 5}", GONIO_ERROR_FORMAT,
     "footprint.seen_mm: this key is missing"},
    {IN_PLANE AXES ", \"footprint\": {\"lit_mm\": 5, \"seen_mm\": 2}", GONIO_ERROR_FORMAT,
     "footprint: the inner spot of 5 mm is larger"},
    {IN_PLANE AXES ", \"wavelengths_nm\": [532, 500]", GONIO_ERROR_FORMAT,
     "wavelengths_nm: entry 2 is not above"},
    {IN_PLANE AXES ", \"values\": \"lumens\"", GONIO_ERROR_FORMAT, "values: 'lumens' is not known"},
    {IN_PLANE AXES ", \"values\": \"counts\"", GONIO_ERROR_FORMAT, "values.counts_of_1_per_sr"},
    {IN_PLANE AXES ", \"values\": {\"kind\": \"relative\"}", GONIO_ERROR_FORMAT,
     "values.reference: relative values need"},
    {IN_PLANE AXES ", \"sensor\": {\"floor_per_sr\": 2, \"saturation_per_sr\": 1}",
     GONIO_ERROR_FORMAT, "sensor.saturation_per_sr: 1 is not above the floor"},
    {IN_PLANE AXES ", \"sensor\": {\"noise\": \"1 %\"}", GONIO_ERROR_FORMAT,
     "sensor.noise: this is no number"},
    {IN_PLANE AXES ", \"times\": {\"reference_every_min\": 1, \"reference_s\": 60}",
     GONIO_ERROR_FORMAT, "times.reference_every_min: 1 min are too short"},
    {IN_PLANE AXES ", \"directions\": [[1, 2, 3, 4]]", GONIO_ERROR_FORMAT,
     "directions: only for the kinematics 'table'"},
    {"\"kinematics\": \"table\"", GONIO_ERROR_FORMAT, "directions: 0 directions"},
    {"\"kinematics\": \"table\", \"directions\": [[1, 2, 3]]", GONIO_ERROR_FORMAT,
     "directions: entry 1 is no array of 4 numbers"},
    {"\"kinematics\": \"table\", \"directions\": [[1, 2, 95, 4]]", GONIO_ERROR_FORMAT,
     "directions: entry 1 is at or below the horizon"},
    {"\"kinematics\": \"table\", \"directions\": \"none.csv\"", GONIO_ERROR_IO, "none.csv"},
    {"\"kinematics\": \"table\", \"directions\": \"/dev/zero\"", GONIO_ERROR_FORMAT,
     "directions: '/dev/zero' is not a name of a file beside this one"},
    {"\"kinematics\": \"table\", \"directions\": \"a/../../b.csv\"", GONIO_ERROR_FORMAT,
     "directions: 'a/../../b.csv' is not a name"},
    {IN_PLANE AXES ", \"forbidden\": [" SIXTY_FOUR SIXTY_FOUR SIXTY_FOUR SIXTY_FOUR "0]",
     GONIO_ERROR_FORMAT, "forbidden: more than 256 zones"},
};

static void test_mistakes_name_the_key(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    for (size_t k = 0; k < sizeof mistakes / sizeof *mistakes; k++) {
        char text[1024];
        gonio_instrument *instrument = NULL;
        snprintf(text, sizeof text, "{\"gonio_instrument\": 1, %s}", mistakes[k].text);
        const gonio_status status = gonio_instrument_parse(context, text, "rig.json", &instrument);
        if (status != mistakes[k].status ||
            strstr(support_message(), mistakes[k].message) == NULL) {
            fail_msg("case %zu: status %d, '%s'; expected %d, '%s'", k, (int)status,
                     support_message(), (int)mistakes[k].status, mistakes[k].message);
        }
        assert_null(instrument);
    }
    gonio_instrument *none = NULL;
    assert_int_equal(
        gonio_instrument_parse(context, "{\"gonio_instrument\": 2}", "rig.json", &none),
        GONIO_ERROR_FORMAT);
    assert_int_equal(gonio_instrument_parse(context, "{]", "rig.json", &none), GONIO_ERROR_FORMAT);
    assert_int_equal(gonio_instrument_read(context, "nowhere.json", &none), GONIO_ERROR_IO);
    gonio_instrument_free(&none);
    gonio_context_free(&context);
}

/* ---- kinematics ---- */

static double apart(gonio_angles a, gonio_angles b)
{
    const double cosine =
        cos(a.theta) * cos(b.theta) + sin(a.theta) * sin(b.theta) * cos(a.phi - b.phi);
    return acos(fmin(cosine, 1.0));
}

/* Whether what is read tells the same of an isotropic sample. */
static double isotropic_distance(gonio_pair a, gonio_pair b)
{
    const gonio_half_difference x = gonio_half_difference_from_pair(a);
    const gonio_half_difference y = gonio_half_difference_from_pair(b);
    const double mirrored = fmin(fabs(x.phi_d - y.phi_d), fabs(M_PI - x.phi_d - y.phi_d));
    return fabs(x.theta_h - y.theta_h) + fabs(x.theta_d - y.theta_d) +
           fmin(mirrored, fabs(M_PI - fabs(x.phi_d - y.phi_d))) * sin(x.theta_h) * sin(x.theta_d);
}

static void check_pair(const gonio_instrument *instrument, gonio_pair pair, gonio_freedom freedom,
                       size_t *reached)
{
    gonio_setting setting[GONIO_MOST_SETTINGS];
    const size_t count =
        gonio_instrument_settings(instrument, pair, freedom, setting, GONIO_MOST_SETTINGS);
    *reached += count > 0;
    for (size_t k = 0; k < count; k++) {
        const gonio_pair made = gonio_instrument_pair(instrument, setting[k].axis);
        assert_null(gonio_instrument_obstacle(instrument, &setting[k]));
        assert_true(apart(made.incident, setting[k].pair.incident) < 1e-7);
        assert_true(apart(made.outgoing, setting[k].pair.outgoing) < 1e-7);
        if (freedom.isotropic) {
            assert_true(isotropic_distance(made, pair) < 2e-3);
        } else {
            assert_true(apart(made.incident, pair.incident) < 1e-3);
            assert_true(apart(made.outgoing, pair.outgoing) < 1e-3);
        }
    }
}

static const char *const rigs[] = {
    "{\"gonio_instrument\": 1, \"kinematics\": \"direct\", \"axes\": {"
    "\"theta_i\": {\"from_deg\": 0, \"to_deg\": 85}, \"theta_o\": {\"from_deg\": -85, \"to_deg\": "
    "85}, \"phi_i\": {\"from_deg\": 0, \"to_deg\": 360}, \"phi_o\": {\"from_deg\": -90, "
    "\"to_deg\": "
    "90}}}",
    "{\"gonio_instrument\": 1, \"kinematics\": \"arms\", \"axes\": {"
    "\"incidence\": {\"from_deg\": 0, \"to_deg\": 85}, \"receive\": {\"from_deg\": -85, "
    "\"to_deg\": "
    "85}, \"azimuth\": {\"from_deg\": -90, \"to_deg\": 90}, \"stage\": {\"from_deg\": 0, "
    "\"to_deg\": 360}}}",
    "{\"gonio_instrument\": 1, \"kinematics\": \"four-axis\", \"axes\": {"
    "\"alpha\": {\"from_deg\": -180, \"to_deg\": 180}, \"beta\": {\"from_deg\": -89, \"to_deg\": "
    "89}, \"gamma\": {\"from_deg\": -89, \"to_deg\": 89}, \"delta\": {\"from_deg\": 0, "
    "\"to_deg\": 180}}}"};

/* Every pair has settings on rigs of full reach, and they make that pair. */
static void test_kinematics_forth_and_back(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    const gonio_freedom freedoms[] = {
        {false, false, false}, {true, false, false}, GONIO_ALL_FREEDOM};
    for (size_t r = 0; r < sizeof rigs / sizeof *rigs; r++) {
        gonio_instrument *instrument = parse(context, rigs[r]);
        for (size_t f = 0; f < 3; f++) {
            size_t reached = 0;
            size_t asked = 0;
            for (int a = 0; a <= 80; a += 16) {
                for (int b = 4; b < 80; b += 15) {
                    for (int c = 0; c < 360; c += 40) {
                        check_pair(instrument, pair_of(a, 23.0, b, c), freedoms[f], &reached);
                        asked++;
                    }
                }
            }
            assert_int_equal(reached, asked);
        }
        gonio_instrument_free(&instrument);
    }
    gonio_context_free(&context);
}

/* A zone of the axis azimuth of arms is of the axis, not of the angle between the azimuths. */
static void test_shadow_of_a_cable(void **state)
{
    (void)state;
    static const char text[] =
        "{\"gonio_instrument\": 1, \"kinematics\": \"arms\", \"axes\": {"
        "\"incidence\": {\"from_deg\": 0, \"to_deg\": 80}, \"azimuth\": {\"from_deg\": -90, "
        "\"to_deg\": 90}, \"receive\": {\"from_deg\": -80, \"to_deg\": 80}}, \"forbidden\": "
        "[{\"name\": \"cable\", \"azimuth_deg\": [-91, -45], \"receive_deg\": [40, 81]}]}";
    gonio_context *context = support_context();
    gonio_instrument *rig = parse(context, text);
    gonio_setting shaded = {.axis = {60.0 * DEGREE, -60.0 * DEGREE, 60.0 * DEGREE}};
    gonio_setting free = {.axis = {60.0 * DEGREE, 60.0 * DEGREE, 60.0 * DEGREE}};
    shaded.pair = gonio_instrument_pair(rig, shaded.axis);
    free.pair = gonio_instrument_pair(rig, free.axis);
    assert_string_equal(gonio_instrument_obstacle(rig, &shaded), "cable");
    assert_null(gonio_instrument_obstacle(rig, &free));
    const gonio_freedom none = {false, false, false};
    gonio_setting found[GONIO_MOST_SETTINGS];
    assert_int_equal(gonio_instrument_settings(rig, shaded.pair, none, found, GONIO_MOST_SETTINGS),
                     0);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

static void test_in_plane_goniometer(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig = builtin(context, "in-plane");
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_setting setting[GONIO_MOST_SETTINGS];
    assert_int_equal(gonio_instrument_settings(rig, pair_of(60, 10, 30, 190), all, setting, 4), 1);
    assert_true(fabs(setting[0].axis[0] - 60.0 * DEGREE) < 1e-9);
    assert_true(fabs(setting[0].axis[1] - 30.0 * DEGREE) < 1e-9);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(60, 10, 30, 10), all, setting, 4), 1);
    assert_true(fabs(setting[0].axis[1] + 30.0 * DEGREE) < 1e-9);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(60, 10, 30, 100), all, setting, 4), 0);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(50, 10, 30, 190), all, setting, 4), 0);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(60, 10, 60, 10), all, setting, 4), 0);
    const gonio_setting hidden = {pair_of(60, 0, 60, 0), {60.0 * DEGREE, -60.0 * DEGREE}};
    assert_string_equal(gonio_instrument_obstacle(rig, &hidden), "the detector hides the laser");
    const gonio_setting beyond = {pair_of(60, 0, 60, 0), {61.0 * DEGREE, 0.0}};
    assert_string_equal(gonio_instrument_obstacle(rig, &beyond), "incidence");
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

/* A lit spot of 5.5/cos theta_i fits a seen one of 20/cos theta_o. */
static void test_footprint_and_limits(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig = parse(context, "{\"gonio_instrument\": 1, " IN_PLANE AXES
                                           ", \"limits\": {\"theta_i_deg\": [5, 70]}, "
                                           "\"footprint\": {\"lit_mm\": 5.5, \"seen_mm\": 8}}");
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_setting setting;
    for (int theta_i = 1; theta_i < 80; theta_i += 2) {
        const bool fits = 5.5 / cos(theta_i * DEGREE) <= 8.0 / cos(20 * DEGREE);
        const gonio_pair pair = pair_of(theta_i, 0, 20, 180);
        const bool reached = gonio_instrument_settings(rig, pair, all, &setting, 1) == 1;
        assert_int_equal(reached, fits && theta_i >= 5 && theta_i <= 70);
        const char *obstacle = gonio_instrument_pair_obstacle(rig, pair, all);
        assert_int_equal(obstacle == NULL, reached);
        assert_true(reached || strcmp(obstacle, fits ? "theta_i" : "footprint") == 0 ||
                    theta_i > 70);
    }
    gonio_instrument_free(&rig);
    rig = builtin(context, "four-axis");
    assert_int_equal(gonio_instrument_settings(rig, pair_of(30, 0, 33, 0), all, &setting, 1), 0);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(30, 0, 76, 90), all, &setting, 1), 0);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(30, 0, 73, 90), all, &setting, 1), 1);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

static void test_table_of_directions(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    const gonio_freedom none = {false, false, false};
    gonio_setting setting[4];
    gonio_instrument *rig =
        parse(context, "{\"gonio_instrument\": 1, \"kinematics\": \"table\", \"reciprocal\": true, "
                       "\"axes\": {\"port\": {\"from_deg\": 0, \"to_deg\": 9}}, "
                       "\"directions\": [[10, 0, 20, 90, 1], [30, 0, 40, 180, 2]]}");
    assert_int_equal(gonio_instrument_describe(rig)->directions, 2);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(10, 0, 20, 90), none, setting, 4), 1);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(10, 50, 20, 140), none, setting, 4), 0);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(10, 50, 20, 140), all, setting, 4), 1);
    assert_int_equal(gonio_instrument_settings(rig, pair_of(40, 0, 30, 180), all, setting, 4), 1);
    assert_true(fabs(setting[0].axis[0] - 2.0 * DEGREE) < 1e-9);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

/* ---- candidates, apertures, values, times ---- */

/* Of a table with too many directions those at all incidences are kept. */
static void test_candidates_of_a_table_are_thinned_evenly(void **state)
{
    (void)state;
    enum { ROWS = 70, MOST = 10 };
    gonio_context *context = support_context();
    char text[8192] = "{\"gonio_instrument\": 1, \"kinematics\": \"table\", \"directions\": [";
    for (int k = 0; k < ROWS; k++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s[%d, 0, 20, 180]", k > 0 ? ", " : "", k);
    }
    strcat(text, "]}");
    gonio_instrument *rig = parse(context, text);
    const gonio_freedom all = {.isotropic = true, .bilateral = true};
    gonio_setting *setting = NULL;
    size_t count = 0;
    assert_int_equal(gonio_instrument_candidates(context, rig, all, MOST, &setting, &count),
                     GONIO_OK);
    assert_int_equal(count, MOST);
    for (size_t k = 0; k < MOST; k++) {
        assert_true(fabs(setting[k].pair.incident.theta - 7.0 * (double)k * DEGREE) < 1e-9);
    }
    free(setting);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

/* Where light and detectors stand at listed angles, every pair of them is offered once. */
static void test_candidates_of_listed_positions(void **state)
{
    (void)state;
    static const double lights[] = {0, 15, 30, 45, 60};
    static const double detectors[] = {5, 15, 25, 35, 45, 55, 65};
    static const char text[] = "{\"gonio_instrument\": 1, \"kinematics\": \"direct\", \"axes\": {"
                               "\"theta_i\": {\"positions_deg\": [0, 15, 30, 45, 60]},"
                               "\"theta_o\": {\"positions_deg\": [5, 15, 25, 35, 45, 55, 65]},"
                               "\"phi_o\": {\"from_deg\": 0, \"to_deg\": 350, \"step_deg\": 10}},"
                               "\"forbidden\": [{\"separation_deg\": [0, 7]}]}";
    size_t expected = 0;
    for (int i = 0; i < 5; i++) {
        for (int o = 0; o < 7; o++) {
            for (int turn = 0; turn <= (lights[i] > 0 ? 180 : 0); turn += 10) {
                const double a = lights[i] * DEGREE;
                const double b = detectors[o] * DEGREE;
                expected +=
                    cos(a) * cos(b) + sin(a) * sin(b) * cos(turn * DEGREE) < cos(7.0 * DEGREE);
            }
        }
    }
    gonio_context *context = support_context();
    gonio_instrument *rig = parse(context, text);
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_setting *offered = NULL;
    size_t count = 0;
    assert_int_equal(gonio_instrument_candidates(context, rig, all, 5000, &offered, &count),
                     GONIO_OK);
    assert_int_equal(count, expected);
    for (size_t k = 0; k < count; k++) {
        gonio_setting found[GONIO_MOST_SETTINGS];
        assert_true(
            gonio_instrument_settings(rig, offered[k].pair, all, found, GONIO_MOST_SETTINGS) > 0);
    }
    assert_non_null(gonio_instrument_pair_obstacle(rig, pair_of(20, 0, 30, 90), all));
    assert_null(gonio_instrument_region_obstacle(rig, pair_of(20, 0, 30, 90), all));
    assert_non_null(gonio_instrument_region_obstacle(rig, pair_of(20, 0, 70, 90), all));
    free(offered);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

static void test_candidates_can_be_read(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    for (int k = 0; gonio_instrument_word(k) != NULL; k++) {
        gonio_instrument *rig = builtin(context, gonio_instrument_word(k));
        const gonio_freedom all = GONIO_ALL_FREEDOM;
        gonio_setting *setting = NULL;
        size_t count = 0;
        assert_int_equal(gonio_instrument_candidates(context, rig, all, 5000, &setting, &count),
                         GONIO_OK);
        print_message("%s: %zu candidates\n", gonio_instrument_word(k), count);
        assert_true(count > 300 && count <= 5000);
        for (size_t i = 0; i < count; i++) {
            assert_null(gonio_instrument_obstacle(rig, &setting[i]));
        }
        free(setting);
        gonio_instrument_free(&rig);
    }
    gonio_context_free(&context);
}

static void test_survey(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig = builtin(context, "four-axis");
    const gonio_freedom all = GONIO_ALL_FREEDOM;
    gonio_reach reach;
    assert_int_equal(gonio_instrument_survey(context, rig, all, &reach), GONIO_OK);
    double sum = reach.share;
    for (size_t k = 0; k < reach.obstacles; k++) {
        assert_true(k == 0 || reach.kept_out[k] <= reach.kept_out[k - 1]);
        sum += reach.kept_out[k];
    }
    assert_true(fabs(sum - 1.0) < 1e-9);
    const double below = sin(75 * DEGREE) * sin(75 * DEGREE); /* of each direction */
    assert_true(reach.share > 0.9 * below * below && reach.share <= 1.01 * below * below);
    assert_true(reach.theta_o[1] < 75.1 * DEGREE && reach.theta_o[1] > 74 * DEGREE);
    assert_true(reach.least_separation > 7.99 * DEGREE);
    assert_true(reach.least_from_specular < 0.1 * DEGREE);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

/* The directions cover a disc evenly: the mean square of their distance is half that of the rim. */
static void test_apertures_are_discs(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig = parse(context, "{\"gonio_instrument\": 1, " IN_PLANE AXES
                                           ", \"apertures\": {\"detector_half_angle_deg\": 2}}");
    const gonio_pair centre = pair_of(20, 0, 60, 170);
    gonio_pair sample[61];
    assert_int_equal(gonio_instrument_aperture_samples(rig, 4), 61);
    assert_int_equal(gonio_instrument_aperture_samples(rig, 0), 1);
    assert_int_equal(gonio_instrument_aperture(rig, centre, 4, sample), 61);
    double square = 0.0;
    for (size_t k = 0; k < 61; k++) {
        const double away = apart(sample[k].outgoing, centre.outgoing) / (2.0 * DEGREE);
        assert_true(away < 1.0 && apart(sample[k].incident, centre.incident) < 1e-7);
        square += away * away / 61.0;
    }
    assert_true(fabs(square - 0.5) < 0.01);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

static void test_values(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig =
        parse(context, "{\"gonio_instrument\": 1, " IN_PLANE AXES
                       ", \"values\": {\"kind\": \"relative\", \"reference\": \"white tile\", "
                       "\"reference_factors\": [[0, 1.0], [60, 0.9]]}, "
                       "\"sensor\": {\"noise\": 0.03, \"floor_per_sr\": 0.04}}");
    assert_true(fabs(gonio_instrument_value_factor(rig, pair_of(0, 0, 30, 0)) - M_PI / 0.95) <
                1e-12);
    assert_true(fabs(gonio_instrument_deviation(rig, 1.0) - 0.05) < 1e-12);
    gonio_instrument_free(&rig);
    rig = parse(context, "{\"gonio_instrument\": 1, " IN_PLANE AXES ", \"values\": \"cosine\"}");
    assert_true(fabs(gonio_instrument_value_factor(rig, pair_of(0, 0, 60, 0)) - 0.5) < 1e-12);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

static gonio_setting setting_at(const gonio_instrument *rig, double incidence, double detector)
{
    gonio_setting setting = {.axis = {incidence * DEGREE, detector * DEGREE}};
    setting.pair = gonio_instrument_pair(rig, setting.axis);
    return setting;
}

static void test_times(void **state)
{
    (void)state;
    gonio_context *context = support_context();
    gonio_instrument *rig = parse(
        context,
        "{\"gonio_instrument\": 1, " IN_PLANE
        "\"axes\": {\"incidence\": {\"from_deg\": 0, \"to_deg\": 80, \"speed_deg_per_s\": 1}, "
        "\"detector\": {\"from_deg\": -80, \"to_deg\": 80, \"speed_deg_per_s\": 10, "
        "\"settling_s\": 0.5}}, \"times\": {\"exposure_s\": 2, \"incidence_change_s\": 20, "
        "\"reference_every_min\": 1, \"reference_s\": 10}}");
    const gonio_setting run[3] = {setting_at(rig, 0.0, 20.0), setting_at(rig, 0.0, 40.0),
                                  setting_at(rig, 10.0, 40.0)};
    gonio_setting home;
    gonio_instrument_home(rig, &home);
    assert_true(fabs(gonio_instrument_travel(rig, &home, &run[0]) - 2.5) < 1e-9);
    assert_true(fabs(gonio_instrument_travel(rig, &run[1], &run[2]) - 30.0) < 1e-9);
    double time[3];
    const double all = gonio_instrument_schedule(rig, run, 3, time);
    assert_true(fabs(time[0] - 14.5) < 1e-9 && fabs(time[1] - 19.0) < 1e-9);
    assert_true(fabs(all - 51.0) < 1e-9 && time[2] == all);
    const gonio_setting longer[4] = {run[0], run[1], run[2], setting_at(rig, 0.0, 40.0)};
    assert_true(fabs(gonio_instrument_schedule(rig, longer, 4, NULL) - 93.0) < 1e-9);
    gonio_instrument_free(&rig);
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_builtin_instruments),
        cmocka_unit_test(test_mistakes_name_the_key),
        cmocka_unit_test(test_kinematics_forth_and_back),
        cmocka_unit_test(test_shadow_of_a_cable),
        cmocka_unit_test(test_in_plane_goniometer),
        cmocka_unit_test(test_footprint_and_limits),
        cmocka_unit_test(test_table_of_directions),
        cmocka_unit_test(test_candidates_of_listed_positions),
        cmocka_unit_test(test_candidates_can_be_read),
        cmocka_unit_test(test_candidates_of_a_table_are_thinned_evenly),
        cmocka_unit_test(test_survey),
        cmocka_unit_test(test_apertures_are_discs),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_times)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
