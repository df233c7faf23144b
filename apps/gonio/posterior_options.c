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
