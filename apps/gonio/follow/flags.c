/* What the instrument's limits say of a reading: see flags.h. */
#include "flags.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "measurement/readings.h"
#include "say.h"
#include "requests.h"

/* A saturated value may be rounded in the file. */
static const double ROUNDED = 1e-6;

/* Deviations of the additive noise: a value that is so far below the dark level is no noise; one
 * that is no further above it shows no light. */
static const double IMPOSSIBLE = 5.0;
static const double NO_LIGHT = 2.0;

enum { IN_A_ROW = 5 /* readings at the dark level, after which the lamp is asked about */ };

void follow_set_limits(follower *f, posterior_options *judged)
{
    const gonio_instrument *instrument = f->inputs.instrument;
    f->limits = (follow_limits){.saturation = judged->saturation > 0.0 ? judged->saturation
                                                                       : (double)INFINITY,
                                .dark = -INFINITY,
                                .lit = -INFINITY};
    if (instrument == NULL) {
        return;
    }
    const gonio_instrument_view *view = gonio_instrument_describe(instrument);
    judged->noise = f->o->noise_given ? judged->noise : 100.0 * view->noise;
    judged->floor = f->o->floor_given ? judged->floor : view->floor;
    if (judged->saturation <= 0.0 && isfinite(view->saturation)) {
        f->limits.saturation = view->saturation * (1.0 - ROUNDED);
        judged->saturation = fmax(f->limits.saturation - view->dark, 0.0);
    }
    f->limits.dark = view->dark - IMPOSSIBLE * view->floor;
    f->limits.lit = view->dark + view->stray + NO_LIGHT * view->floor;
}

void follow_check_values(follower *f, const gonio_readings *readings)
{
    const bool says_its_unit = f->run.names != NULL && strcasestr(f->run.names, "_per_sr") != NULL;
    if (f->inputs.instrument == NULL || f->said_values || says_its_unit) {
        return;
    }
    const gonio_value_kind stated = gonio_instrument_describe(f->inputs.instrument)->values;
    const gonio_value_kind taken =
        readings->unit.kind != 0 ? (gonio_value_kind)readings->unit.kind : GONIO_VALUE_BRDF;
    /* The program of an instrument may have converted relative values and counts already. */
    if (stated != taken && stated < GONIO_VALUE_RELATIVE) {
        follow_say(f, GONIO_MESSAGE_WARNING,
                   "%s: values were taken as '%s', but the instrument states '%s': if it is right, "
                   "begin again with --as values=%s",
                   f->run.path, gonio_value_kind_name(taken), gonio_value_kind_name(stated),
                   gonio_value_kind_name(stated));
    }
    f->said_values = true;
}

/* The largest and the smallest value of a row; NaN without any. */
static void find_range(const run_row *row, double *least, double *most)
{
    *least = NAN;
    *most = NAN;
    for (size_t k = 0; k < row->channels; k++) {
        *least = fmin(*least, row->value[k]);
        *most = fmax(*most, row->value[k]);
    }
}

/* A reading of no light is a fact of a dark sample. Many of them may be a lamp that is off. */
static void note_dark(follower *f, const run_row *row, bool is_dark)
{
    f->at_dark += is_dark;
    f->dark_in_a_row = is_dark ? f->dark_in_a_row + 1 : 0;
    if (is_dark && f->at_dark == 1) {
        follow_say(f, GONIO_MESSAGE_NOTE,
                   "%s:%zu: the value is at the dark level of the instrument: it says only that "
                   "the BRDF is small there",
                   f->run.path, row->line);
    }
    if (f->dark_in_a_row == IN_A_ROW) {
        follow_say(f, GONIO_MESSAGE_WARNING,
                   "%s:%zu: %d readings in a row are at the dark level: is the lamp on?",
                   f->run.path, row->line, IN_A_ROW);
    }
}

void follow_flag(follower *f)
{
    const run_row *row = &f->run.row[f->run.rows - 1];
    double least = NAN;
    double most = NAN;
    if (!row->of_sample) {
        return;
    }
    find_range(row, &least, &most);
    note_dark(f, row, most <= f->limits.lit);
    if (row->wanted == RUN_NOWHERE) {
        return;
    }
    if (most >= f->limits.saturation) {
        follow_ask(f, row->wanted, "saturated: with less light, please");
    } else if (least < f->limits.dark) {
        follow_ask(f, row->wanted, "below the dark level of the instrument");
    }
}
