/* libFuzzer on instrument files: whatever the bytes are, a file is refused with one message or is
 * an instrument whose settings read what they say, stay within its limits, and take finite times.
 * The size says how much freedom the sample gives, and whether candidates are
 * listed. */
#include "fuzz.h"

enum { PAIRS = 6, MOST_CANDIDATES = 60 };

static void check_view(const gonio_instrument_view *view)
{
    check(view->axes >= 1 && view->axes <= GONIO_MOST_AXES, "there are axes");
    for (size_t k = 0; k < view->axes; k++) {
        const gonio_axis *axis = &view->axis[k];
        check(isfinite(axis->low) && isfinite(axis->high) && axis->low <= axis->high,
              "an axis has a range");
        check(isfinite(axis->speed) && axis->speed >= 0.0 && axis->settling >= 0.0,
              "an axis moves forwards in time");
    }
    for (size_t k = 0; k < view->limits; k++) {
        check(view->limit[k].low <= view->limit[k].high, "a limit has a range");
    }
    check(isfinite(view->noise) && view->noise >= 0.0 && isfinite(view->floor),
          "the noise is a number");
    check(view->saturation > 0.0, "something can be read");
}

static void check_pair(const gonio_pair *pair)
{
    check(pair->incident.theta >= 0.0 && pair->incident.theta < M_PI / 2.0 + 1e-9 &&
              pair->outgoing.theta >= 0.0 && pair->outgoing.theta < M_PI / 2.0 + 1e-9,
          "directions are above the horizon");
    check(isfinite(pair->incident.phi) && isfinite(pair->outgoing.phi), "azimuths are numbers");
}

static void check_setting(const gonio_instrument *instrument, const gonio_setting *setting)
{
    const size_t axes = gonio_instrument_describe(instrument)->axes;
    check_pair(&setting->pair);
    for (size_t k = 0; k < axes; k++) {
        check(isfinite(setting->axis[k]), "positions are numbers");
    }
    check(gonio_instrument_obstacle(instrument, setting) == NULL, "a setting can be used");
    const double factor = gonio_instrument_value_factor(instrument, setting->pair);
    check(isfinite(factor) && factor > 0.0, "a value can be stated");
    gonio_pair sample[1 + 3 * 2];
    const size_t room = gonio_instrument_aperture_samples(instrument, 0);
    check(room >= 1 && room <= sizeof sample / sizeof *sample, "one sample of each aperture");
    check(gonio_instrument_aperture(instrument, setting->pair, 0, sample) >= 1, "which is there");
}

static void check_settings(const gonio_instrument *instrument, gonio_freedom freedom)
{
    for (int k = 0; k < PAIRS; k++) {
        const gonio_pair pair = {{0.23 * k, 0.3 * k}, {1.4 - 0.25 * k, 0.3 + 0.8 * k}};
        gonio_setting setting[GONIO_MOST_SETTINGS];
        const size_t count =
            gonio_instrument_settings(instrument, pair, freedom, setting, GONIO_MOST_SETTINGS);
        check(count <= GONIO_MOST_SETTINGS, "not more settings than there is room for");
        for (size_t s = 0; s < count; s++) {
            check_setting(instrument, &setting[s]);
        }
    }
}

/* The order of a run of all candidates, and what it takes. */
static void check_order(gonio_context *context, const gonio_instrument *instrument,
                        const gonio_setting *setting, size_t count)
{
    size_t first[MOST_CANDIDATES + 1];
    size_t order[MOST_CANDIDATES];
    gonio_setting chosen[MOST_CANDIDATES];
    count = count < MOST_CANDIDATES ? count : MOST_CANDIDATES;
    for (size_t k = 0; k <= count; k++) {
        first[k] = k;
    }
    const gonio_status status =
        gonio_instrument_order(context, instrument, setting, first, count, NULL, order, chosen);
    check_status(status);
    check(status == GONIO_OK, "readings have an order");
    const double time = gonio_instrument_schedule(instrument, chosen, count, NULL);
    check(time >= 0.0 && isfinite(time), "a run ends");
}

static void check_candidates(gonio_context *context, const gonio_instrument *instrument,
                             gonio_freedom freedom)
{
    gonio_setting *setting = NULL;
    size_t count = 0;
    const gonio_status status = gonio_instrument_candidates(context, instrument, freedom,
                                                            MOST_CANDIDATES, &setting, &count);
    check_status(status);
    if (status == GONIO_OK) {
        check(count > 0, "there are candidates");
        for (size_t k = 0; k < count; k++) {
            check_setting(instrument, &setting[k]);
        }
        check_order(context, instrument, setting, count);
    }
    free(setting);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    const gonio_freedom freedom = {size % 2 == 0, size % 4 < 2, size % 8 < 4};
    gonio_instrument *instrument = NULL;
    char path[128];
    fuzz_path(path, "rig.json");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_instrument_read(context, path, &instrument);
    check_status(status);
    if (status == GONIO_OK) {
        check_view(gonio_instrument_describe(instrument));
        check_settings(instrument, freedom);
        if (size % 16 < 2) { /* these take long */
            check_candidates(context, instrument, freedom);
        }
    }
    gonio_instrument_free(&instrument);
    unlink(path);
    return 0;
}
