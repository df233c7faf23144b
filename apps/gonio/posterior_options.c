/* The options of the instrument's noise: see posterior_options.h. */
#include "posterior_options.h"

posterior_options posterior_options_default(void)
{
    gonio_reconstruct_options usual;
    gonio_reconstruct_options_default(&usual);
    return (posterior_options){.noise = 100.0 * usual.noise,
                               .floor = usual.floor,
                               .saturation = usual.saturation,
                               .no_checks = usual.no_checks};
}

posterior_options posterior_options_open(void)
{
    return (posterior_options){.noise = POSTERIOR_NOT_GIVEN,
                               .floor = POSTERIOR_NOT_GIVEN,
                               .saturation = POSTERIOR_NOT_GIVEN};
}

/* Of an instrument; its saturation is infinite if it has none. */
static posterior_options options_of(const gonio_instrument_view *view)
{
    return (posterior_options){.noise = 100.0 * view->noise,
                               .floor = view->floor,
                               .saturation = isfinite(view->saturation) ? view->saturation : 0.0};
}

static void settle(double *value, double usual)
{
    *value = *value == POSTERIOR_NOT_GIVEN ? usual : *value;
}

void posterior_options_settle(posterior_options *o, const gonio_instrument_view *instrument)
{
    const posterior_options usual =
        instrument != NULL ? options_of(instrument) : posterior_options_default();
    settle(&o->noise, usual.noise);
    settle(&o->floor, usual.floor);
    settle(&o->saturation, usual.saturation);
}

bool posterior_options_check(const tool *t, const posterior_options *o)
{
    return tool_check_not_negative(t, "--noise", o->noise) &&
           tool_check_not_negative(t, "--floor", o->floor) &&
           tool_check_not_negative(t, "--saturation", o->saturation);
}

void posterior_options_apply(const posterior_options *o, gonio_reconstruct_options *how)
{
    how->noise = o->noise / 100.0;
    how->floor = o->floor;
    how->saturation = o->saturation;
    how->no_checks = o->no_checks;
}
