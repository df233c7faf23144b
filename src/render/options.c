/* What is rendered if nothing else is said. */
#include <gonio/render.h>
#include <math.h>

void gonio_render_options_default(gonio_render_options *options)
{
    *options = (gonio_render_options){
        .size = sizeof *options,
        .width = 512,
        .height = 512,
        .samples = 64,
        .lamp = GONIO_LAMP_DIRECTIONAL,
        .lamp_position = {-0.4095760221444959, 0.5735764363510461, 0.7094064799162224},
        .field_of_view = M_PI / 6.0};
}
