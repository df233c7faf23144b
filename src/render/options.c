/* What is rendered if nothing else is said. */
#include <gonio/render.h>
#include <math.h>

void gonio_render_options_default(gonio_render_options *options)
{
    *options = (gonio_render_options){.width = 512,
                                      .height = 512,
                                      .samples = 64,
                                      .lamp = GONIO_LAMP_DIRECTIONAL,
                                      .lamp_position = {-0.5, 0.7071067811865476, 0.5},
                                      .field_of_view = M_PI / 6.0};
}
