/* The default options of rendering. */
#include <gonio/render.h>
#include "../core/options.h"
#include <math.h>

void gonio_render_options_default_of(gonio_render_options *options, size_t size)
{
    const gonio_render_options usual = {
        .width = 512,
        .height = 512,
        .samples = 64,
        .lamp = GONIO_LAMP_DIRECTIONAL,
        .lamp_position = {-0.4095760221444959, 0.5735764363510461, 0.7094064799162224},
        .field_of_view = M_PI / 6.0};
    gonio_i_give(&usual, sizeof usual, options, size);
}
