/* A material as a MERL table: its row in the table of writers. The table itself is written by
 * merl.c. */
#include "../colour.h"
#include "writers.h"

static gonio_status write_merl(gonio_context *context, const gonio_material *material,
                               const char *path, const gonio_write_options *options)
{
    const gonio_material_view *view = gonio_material_describe(material);
    (void)options;
    if (view->wavelength != NULL) {
        gonio_i_note_colours(context, view->name, view->wavelength, view->channels);
    }
    return gonio_material_write_merl(context, material, path);
}

const gonio_i_format_writer gonio_i_merl_writer = {
    .name = "merl",
    .extension = ".binary",
    .summary = "MERL table 90 x 90 x 180 of R, G, B; isotropic, reciprocal",
    .isotropic = true,
    .averages = true,
    .write = write_merl,
};
