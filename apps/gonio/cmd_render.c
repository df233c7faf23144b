/* gonio render: a material on a sphere or a mesh, and comparison pictures of several. */
#include "inputs.h"
#include "json_output.h"
#include "render_options.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static bool ends_with(const char *path, const char *extension)
{
    const size_t length = strlen(path);
    const size_t tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

static bool check_output_name(const tool *t, const render_request *o)
{
    return ends_with(o->output, ".png") || (!o->compare && ends_with(o->output, ".exr")) ||
           tool_refuse(t, "%s: the output's name must end in .png%s", o->output,
                       o->compare ? "" : " or .exr");
}

/* ---- the scene ---- */

static gonio_status load_scene(const tool *t, const render_request *o, render_scene *s)
{
    gonio_status status = GONIO_OK;
    if (o->light == NULL) {
        const char *name = o->environment != NULL ? o->environment : "studio";
        status = gonio_environment_open(t->context, name, o->repair != 0, &s->environment);
    }
    if (status == GONIO_OK && o->mesh != NULL) {
        status = tool_read_mesh(t, o->mesh, &s->mesh);
    }
    s->how.environment = s->environment;
    s->how.mesh = s->mesh;
    return status;
}

static void free_scene(render_scene *s)
{
    gonio_environment_free(&s->environment);
    gonio_mesh_free(&s->mesh);
}

/* ---- one material ---- */

static gonio_status write_image(const tool *t, const render_request *o, const gonio_image *image)
{
    if (ends_with(o->output, ".exr")) {
        return gonio_image_write_exr(t->context, image, o->output);
    }
    const gonio_tone tone = gonio_tone_measure(image, o->key);
    return gonio_image_write_png(t->context, image, &tone, o->output);
}

/* Reports the picture. */
static int report_one(const tool *t, const render_request *o, const render_scene *s,
                      const char *material, const gonio_image *image)
{
    if (tool_json) {
        return tool_print_json(t, json_pack("{s:o, s:o, s:i, s:i, s:i}", "output",
                                            tool_json_text(o->output), "material",
                                            tool_json_text(material), "width", image->width,
                                            "height", image->height, "samples", s->how.samples));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: %s, %d x %d pixels, %d samples\n", o->output, material,
                image->width, image->height, s->how.samples);
    }
    return 0;
}

static int render_one(const tool *t, const render_request *o, const render_scene *s,
                      const char *path)
{
    gonio_material *material = NULL;
    gonio_image *image = NULL;
    gonio_status status = tool_open_material(t, path, &material);
    if (status == GONIO_OK) {
        status = gonio_render(t->context, material, &s->how, &image);
    }
    if (status == GONIO_OK) {
        status = write_image(t, o, image);
    }
    const int code = status == GONIO_OK ? report_one(t, o, s, gonio_material_name(material), image)
                                        : tool_exit_code(status);
    gonio_image_free(&image);
    gonio_material_free(&material);
    return code;
}

/* ---- the command ---- */

static bool check_arguments(const tool *t, const render_request *o, size_t count)
{
    if (o->flat && o->mesh != NULL) {
        return tool_refuse(t, "--flat and --mesh exclude each other");
    }
    if (!o->compare && count != 1) {
        return tool_refuse(t, "one MATERIAL is needed; --compare takes several");
    }
    if (!o->compare && (o->columns > 0 || o->labels != NULL || o->differences)) {
        return tool_refuse(t, "--columns, --labels and --differences go with --compare");
    }
    if (o->compare && count < 2) {
        return tool_refuse(t, "REFERENCE and at least one OTHER are needed");
    }
    if (o->columns < 0 || o->columns == 1 || (o->columns > 1 && count % (size_t)o->columns != 0)) {
        return tool_refuse(t, "--columns: %zu materials do not fill rows of %ld", count,
                           o->columns);
    }
    return true;
}

static bool check(const tool *t, const render_request *o, const char **arguments, size_t count,
                  gonio_render_options *how)
{
    const char *const inputs[] = {o->mesh, o->environment};
    return check_arguments(t, o, count) && tool_check_output(t, o->output, arguments, count) &&
           tool_check_output(t, o->output, inputs, 2) && check_output_name(t, o) &&
           render_set_options(t, o, how);
}

static int run(tool *t, void *given)
{
    const render_request *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    render_scene s = {.mesh = NULL};
    if (!check(t, o, arguments, count, &s.how)) {
        return EXIT_USAGE;
    }
    const gonio_status status = load_scene(t, o, &s);
    int code = tool_exit_code(status);
    if (status == GONIO_OK) {
        code = o->compare ? render_comparison(t, o, &s, arguments, count)
                          : render_one(t, o, &s, arguments[0]);
    }
    free_scene(&s);
    return code;
}

int cmd_render(int argc, const char **argv)
{
    render_request o = {
        .light_at = "-30,35", .view = "0,0", .field_of_view = 30.0, .key = 0.18, .samples = 64};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The picture: .png, tone-mapped, or .exr, linear", "OUT"},
        {"mesh", 'm', POPT_ARG_STRING, &o.mesh, 0, "An OBJ or PLY file instead of a sphere",
         "FILE"},
        {"flat", '\0', POPT_ARG_NONE, &o.flat, 0, "A flat square sample instead of a sphere", NULL},
        {"grain", '\0', POPT_ARG_DOUBLE, &o.grain, 0,
         "Rotate an anisotropic sample about its normal; at 0 its azimuth 0 is horizontal", "DEG"},
        {"environment", 'e', POPT_ARG_STRING, &o.environment, 0,
         "studio (the default), sky, furnace, or an .exr or .hdr file", "NAME|FILE"},
        {"turn", '\0', POPT_ARG_DOUBLE, &o.turn, 0, "Rotate the environment to the right", "DEG"},
        {"show-environment", '\0', POPT_ARG_NONE, &o.show, 0,
         "Show the environment behind the object", NULL},
        {"repair", '\0', POPT_ARG_NONE, &o.repair, 0,
         "Take negative, NaN and infinite pixels of the environment as black", NULL},
        {"light", '\0', POPT_ARG_STRING, &o.light, 0,
         "Use a lamp instead of an environment: directional or point", "KIND"},
        {"light-at", '\0', POPT_ARG_STRING, &o.light_at, 0,
         "Position of the lamp, degrees (default: -30,35; distance 4)", "AZ,EL[,DIST]"},
        {"view", '\0', POPT_ARG_STRING, &o.view, 0,
         "Position of the viewer, degrees (default: 0,0)", "AZ,EL"},
        {"fov", '\0', POPT_ARG_DOUBLE, &o.field_of_view, 0,
         "Vertical field of view; 0 for parallel rays (default: 30)", "DEG"},
        {"size", '\0', POPT_ARG_STRING, &o.size, 0,
         "Size in pixels (default: 512; 256 with --compare)", "N|WxH"},
        {"samples", '\0', POPT_ARG_LONG, &o.samples, 0, "Samples of each pixel (default: 64)", "N"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Seed of the samples (default: 0)", "N"},
        {"key", '\0', POPT_ARG_DOUBLE, &o.key, 0,
         "Brightness of the tone-mapped average (default: 0.18)", "A"},
        {"compare", '\0', POPT_ARG_NONE, &o.compare, 0,
         "A picture of REFERENCE and OTHERs side by side, with errors", NULL},
        {"columns", '\0', POPT_ARG_LONG, &o.columns, 0,
         "Rows of N materials, each with its reference first", "N"},
        {"labels", '\0', POPT_ARG_STRING, &o.labels, 0, "Titles of the columns", "NAME,NAME..."},
        {"differences", '\0', POPT_ARG_NONE, &o.differences, 0,
         "Also draw Delta E_ITP below each row", NULL},
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] MATERIAL -o OUT | --compare REFERENCE OTHER... -o OUT",
        .text =
            "Azimuths are degrees to the right of the default view, elevations are degrees "
            "upwards.\n"
            "Only direct light is computed. The same seed gives the same image.\n"
            "PNG is tone-mapped after Reinhard et al. 2002. Below a comparison: E6, PSNR and "
            "mean\n"
            "Delta E_ITP. Example: gonio render atlas:gold-polished -e sky --show-environment -o "
            "g.png",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
