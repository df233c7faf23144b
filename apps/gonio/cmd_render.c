/* gonio render: a material on a sphere or a mesh, and comparison pictures of several. */
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct options {
    const char *output;
    const char *mesh;
    const char *environment;
    const char *light;
    const char *light_at;
    const char *view;
    const char *size;
    const char *labels;
    double turn;
    double field_of_view;
    double key;
    long samples;
    long seed;
    long columns;
    int show;
    int repair;
    int compare;
    int differences;
} options;

/* What is rendered with. */
typedef struct scene {
    gonio_render_options how;
    gonio_mesh *mesh;
    gonio_environment *environment;
} scene;

enum { MOST_SAMPLES = 1000000 };

static const double degree = M_PI / 180.0;

/* ---- the command line ---- */

/* Numbers between commas: how many there are, at most `most`; 0 for anything else. */
static int read_numbers(const char *text, double *number, int most)
{
    int count = 0;
    while (count < most) {
        char *end = NULL;
        number[count++] = strtod(text, &end);
        if (end == text || !isfinite(number[count - 1])) {
            return 0;
        }
        if (*end == '\0') {
            return count;
        }
        if (*end != ',') {
            return 0;
        }
        text = end + 1;
    }
    return 0;
}

/* "512" or "640x480"; a number too large for any image is left for the library to refuse. */
static bool read_size(const char *text, int *width, int *height)
{
    char *end = NULL;
    if (!isdigit((unsigned char)*text)) {
        return false;
    }
    const long first = strtol(text, &end, 10);
    long second = first;
    if (*end == 'x') {
        const char *rest = end + 1;
        if (!isdigit((unsigned char)*rest)) {
            return false;
        }
        second = strtol(rest, &end, 10);
    }
    const long most = GONIO_MOST_PIXELS + 1L;
    *width = (int)(first < most ? first : most);
    *height = (int)(second < most ? second : most);
    return *end == '\0';
}

static bool set_view(const tool *t, const options *o, gonio_render_options *how)
{
    double angle[2];
    if (read_numbers(o->view, angle, 2) != 2 || fabs(angle[1]) > 90.0) {
        return tool_refuse(t, "--view: '%s' is not AZIMUTH,ELEVATION in degrees", o->view);
    }
    if (!(o->field_of_view >= 0.0 && o->field_of_view <= 110.0)) {
        return tool_refuse(t, "--fov: %g is outside 0 to 110 degrees", o->field_of_view);
    }
    how->azimuth = angle[0] * degree;
    how->elevation = angle[1] * degree;
    how->field_of_view = o->field_of_view * degree;
    return true;
}

static bool set_lamp(const tool *t, const options *o, gonio_render_options *how)
{
    double at[3] = {0.0, 0.0, 4.0};
    const bool point = o->light != NULL && strcmp(o->light, "point") == 0;
    if (o->light != NULL && !point && strcmp(o->light, "directional") != 0) {
        return tool_refuse(t, "--light: '%s' is neither directional nor point", o->light);
    }
    if (o->light != NULL && o->environment != NULL) {
        return tool_refuse(t, "--light and --environment exclude each other");
    }
    const int numbers = read_numbers(o->light_at, at, 3);
    if (numbers < 2 || (numbers == 3 && !point)) {
        return tool_refuse(t, "--light-at: '%s' is not AZIMUTH,ELEVATION in degrees%s", o->light_at,
                           point ? "[,DISTANCE]" : "");
    }
    if (point && at[2] <= 1.0) {
        return tool_refuse(t, "--light-at: distance %g must be above 1, the radius of the object",
                           at[2]);
    }
    how->lamp = point ? GONIO_LAMP_POINT : GONIO_LAMP_DIRECTIONAL;
    how->lamp_position[0] = at[2] * cos(at[1] * degree) * sin(at[0] * degree);
    how->lamp_position[1] = at[2] * sin(at[1] * degree);
    how->lamp_position[2] = at[2] * cos(at[1] * degree) * cos(at[0] * degree);
    return true;
}

static bool set_options(const tool *t, const options *o, gonio_render_options *how)
{
    gonio_render_options_default(how);
    const char *size = o->size != NULL ? o->size : o->compare ? "256" : "512";
    if (!read_size(size, &how->width, &how->height)) {
        return tool_refuse(t, "--size: '%s' is not N or WIDTHxHEIGHT in pixels", size);
    }
    if (!(o->key > 0.0 && isfinite(o->key))) {
        return tool_refuse(t, "--key: %g must be above 0", o->key);
    }
    if (!tool_check_count(t, "--samples", o->samples, 1)) {
        return false;
    }
    if (o->samples > MOST_SAMPLES) {
        return tool_refuse(t, "--samples: %ld is too large, at most %d", o->samples, MOST_SAMPLES);
    }
    how->samples = (int)o->samples;
    how->seed = (uint64_t)o->seed;
    how->environment_turn = o->turn * degree;
    how->show_environment = o->show != 0;
    return tool_check_count(t, "--seed", o->seed, 0) && set_view(t, o, how) && set_lamp(t, o, how);
}

static bool ends_with(const char *path, const char *extension)
{
    const size_t length = strlen(path);
    const size_t tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}

static bool check_output_name(const tool *t, const options *o)
{
    return ends_with(o->output, ".png") || (!o->compare && ends_with(o->output, ".exr")) ||
           tool_refuse(t, "%s: the output's name must end in .png%s", o->output,
                       o->compare ? "" : " or .exr");
}

/* ---- the scene ---- */

static gonio_status load_scene(const tool *t, const options *o, scene *s)
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

static void free_scene(scene *s)
{
    gonio_environment_free(&s->environment);
    gonio_mesh_free(&s->mesh);
}

/* ---- one material ---- */

static gonio_status write_image(const tool *t, const options *o, const gonio_image *image)
{
    if (ends_with(o->output, ".exr")) {
        return gonio_image_write_exr(t->context, image, o->output);
    }
    const gonio_tone tone = gonio_tone_measure(image, o->key);
    return gonio_image_write_png(t->context, image, &tone, o->output);
}

/* What was drawn of what. */
static int report_one(const tool *t, const options *o, const scene *s, const char *material,
                      const gonio_image *image)
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

static int render_one(const tool *t, const options *o, const scene *s, const char *path)
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

/* ---- a comparison picture ---- */

typedef struct picture {
    size_t rows, columns;
    gonio_image **image;     /* [rows][columns] */
    gonio_sheet_cell *cells; /* the same */
    char **row_name;         /* [rows] */
    char **column_name;      /* [columns] */
} picture;

static void free_picture(picture *p)
{
    for (size_t k = 0; p->image != NULL && k < p->rows * p->columns; k++) {
        gonio_image_free(&p->image[k]);
    }
    for (size_t k = 0; p->row_name != NULL && k < p->rows; k++) {
        free(p->row_name[k]);
    }
    for (size_t k = 0; p->column_name != NULL && k < p->columns; k++) {
        free(p->column_name[k]);
    }
    free(p->image);
    free(p->cells);
    free(p->row_name);
    free(p->column_name);
}

static gonio_status make_picture(const tool *t, size_t rows, size_t columns, picture *p)
{
    *p = (picture){.rows = rows, .columns = columns};
    p->image = calloc(rows * columns, sizeof(gonio_image *));
    p->cells = calloc(rows * columns, sizeof *p->cells);
    p->row_name = calloc(rows, sizeof(char *));
    p->column_name = calloc(columns, sizeof(char *));
    if (p->image == NULL || p->cells == NULL || p->row_name == NULL || p->column_name == NULL) {
        fprintf(stderr, "gonio %s: out of memory\n", t->name);
        return GONIO_ERROR_MEMORY;
    }
    return GONIO_OK;
}

static gonio_status compare_cell(const tool *t, const gonio_reference *reference,
                                 const gonio_material *original, const char *path, picture *p,
                                 size_t at)
{
    gonio_material *material = NULL;
    gonio_comparison comparison;
    gonio_status status = tool_open_material(t, path, &material);
    if (status == GONIO_OK) {
        status = gonio_reference_render(t->context, reference, material, &p->image[at]);
    }
    if (status == GONIO_OK) {
        status = gonio_compare(t->context, original, material, &comparison);
    }
    if (status == GONIO_OK) {
        p->cells[at] = (gonio_sheet_cell){p->image[at], comparison.all.value[GONIO_E6]};
        if (p->column_name[at % p->columns] == NULL) {
            p->column_name[at % p->columns] = strdup(gonio_material_name(material));
        }
    }
    gonio_material_free(&material);
    return status;
}

static gonio_status copy_image(const tool *t, const gonio_image *from, gonio_image **to)
{
    const gonio_status status = gonio_image_create(t->context, from->width, from->height, to);
    if (status == GONIO_OK) {
        memcpy((*to)->rgba, from->rgba,
               (size_t)from->width * (size_t)from->height * GONIO_IMAGE_CHANNELS *
                   sizeof *from->rgba);
    }
    return status;
}

static gonio_status compare_row(const tool *t, const scene *s, const char *const *paths, picture *p,
                                size_t row)
{
    const size_t first = row * p->columns;
    gonio_material *original = NULL;
    gonio_reference *reference = NULL;
    gonio_status status = tool_open_material(t, paths[0], &original);
    if (status == GONIO_OK) {
        p->row_name[row] = strdup(gonio_material_name(original));
        status = gonio_reference_create(t->context, original, &s->how, &reference);
    }
    if (status == GONIO_OK) {
        status = copy_image(t, gonio_reference_image(reference), &p->image[first]);
    }
    if (status == GONIO_OK) {
        p->cells[first] = (gonio_sheet_cell){p->image[first], NAN};
    }
    for (size_t k = 1; k < p->columns && status == GONIO_OK; k++) {
        status = compare_cell(t, reference, original, paths[k], p, first + k);
    }
    gonio_reference_free(&reference);
    gonio_material_free(&original);
    return status;
}

/* Names between commas, one a column; false if they are not as many. */
static bool read_labels(const char *text, picture *p)
{
    for (size_t k = 0; k < p->columns; k++) {
        const size_t length = strcspn(text, ",");
        free(p->column_name[k]);
        p->column_name[k] = strndup(text, length);
        text += length;
        if ((*text == ',') != (k + 1 < p->columns)) {
            return false;
        }
        text += *text == ',' ? 1 : 0;
    }
    return true;
}

static gonio_status write_picture(const tool *t, const options *o, picture *p)
{
    for (size_t k = 0; k < p->rows + p->columns; k++) {
        char **name = k < p->rows ? &p->row_name[k] : &p->column_name[k - p->rows];
        if (*name == NULL) {
            *name = strdup(k == p->rows ? "original" : "");
        }
        if (*name == NULL) {
            return GONIO_ERROR_MEMORY;
        }
    }
    const gonio_sheet sheet = {.size = sizeof sheet,
                               .rows = p->rows,
                               .columns = p->columns,
                               .row_names = (const char *const *)p->row_name,
                               .column_names = (const char *const *)p->column_name,
                               .cells = p->cells,
                               .key = o->key,
                               .differences = o->differences != 0};
    return gonio_sheet_write_png(t->context, &sheet, o->output);
}

/* The rows of renderings: of each material the E6 from the first of its row. */
static json_t *picture_json(const options *o, const picture *p, const char *const *paths)
{
    json_t *rows = json_array();
    for (size_t row = 0; row < p->rows; row++) {
        json_t *others = json_array();
        for (size_t k = 1; k < p->columns; k++) {
            const size_t at = row * p->columns + k;
            json_array_append_new(others,
                                  json_pack("{s:o, s:o}", "file", tool_json_text(paths[at]),
                                            "e6_percent", tool_json_number(p->cells[at].e6)));
        }
        json_array_append_new(rows, json_pack("{s:o, s:o}", "reference",
                                              tool_json_text(paths[row * p->columns]),
                                              "comparisons", others));
    }
    return json_pack("{s:o, s:i, s:i, s:o}", "output", tool_json_text(o->output), "width",
                     p->image[0]->width, "height", p->image[0]->height, "rows", rows);
}

static int report_picture(const tool *t, const options *o, const picture *p,
                          const char *const *paths)
{
    if (tool_json) {
        return tool_print_json(t, picture_json(o, p, paths));
    }
    if (!tool_quiet) {
        fprintf(tool_results(), "%s: %zu x %zu renderings\n", o->output, p->rows, p->columns);
    }
    return 0;
}

static int compare_all(const tool *t, const options *o, const scene *s, const char *const *paths,
                       size_t count)
{
    const size_t columns = o->columns > 0 ? (size_t)o->columns : count;
    picture p;
    gonio_status status = make_picture(t, count / columns, columns, &p);
    if (status == GONIO_OK && o->labels != NULL && !read_labels(o->labels, &p)) {
        free_picture(&p);
        tool_refuse(t, "--labels: '%s' must be %zu names separated by commas", o->labels, columns);
        return EXIT_USAGE;
    }
    for (size_t row = 0; row < p.rows && status == GONIO_OK; row++) {
        status = compare_row(t, s, paths + row * columns, &p, row);
    }
    if (status == GONIO_OK) {
        status = write_picture(t, o, &p);
    }
    const int code = status == GONIO_OK ? report_picture(t, o, &p, paths) : tool_exit_code(status);
    free_picture(&p);
    return code;
}

/* ---- the command ---- */

static bool check_arguments(const tool *t, const options *o, size_t count)
{
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

static bool check(const tool *t, const options *o, const char **arguments, size_t count,
                  gonio_render_options *how)
{
    const char *const inputs[] = {o->mesh, o->environment};
    return check_arguments(t, o, count) && tool_check_output(t, o->output, arguments, count) &&
           tool_check_output(t, o->output, inputs, 2) && check_output_name(t, o) &&
           set_options(t, o, how);
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    scene s = {.mesh = NULL};
    if (!check(t, o, arguments, count, &s.how)) {
        return EXIT_USAGE;
    }
    const gonio_status status = load_scene(t, o, &s);
    int code = tool_exit_code(status);
    if (status == GONIO_OK) {
        code = o->compare ? compare_all(t, o, &s, arguments, count)
                          : render_one(t, o, &s, arguments[0]);
    }
    free_scene(&s);
    return code;
}

int cmd_render(int argc, const char **argv)
{
    options o = {
        .light_at = "-30,35", .view = "0,0", .field_of_view = 30.0, .key = 0.18, .samples = 64};
    const struct poptOption table[] = {
        {"output", 'o', POPT_ARG_STRING, &o.output, 0,
         "The picture: .png, tone-mapped, or .exr, linear", "OUT"},
        {"mesh", 'm', POPT_ARG_STRING, &o.mesh, 0, "An OBJ or PLY file instead of a sphere",
         "FILE"},
        {"environment", 'e', POPT_ARG_STRING, &o.environment, 0,
         "studio (the default), sky, furnace, or an .exr or .hdr file", "NAME|FILE"},
        {"turn", '\0', POPT_ARG_DOUBLE, &o.turn, 0, "Turn the environment to the right", "DEG"},
        {"show-environment", '\0', POPT_ARG_NONE, &o.show, 0, "Show it behind the object", NULL},
        {"repair", '\0', POPT_ARG_NONE, &o.repair, 0,
         "Take negative, NaN and infinite pixels of the environment as black", NULL},
        {"light", '\0', POPT_ARG_STRING, &o.light, 0,
         "Light it by a lamp instead: directional or point", "KIND"},
        {"light-at", '\0', POPT_ARG_STRING, &o.light_at, 0,
         "Where the lamp is (default: -30,35; distance 4)", "AZ,EL[,DIST]"},
        {"view", '\0', POPT_ARG_STRING, &o.view, 0, "From where to look, degrees (default: 0,0)",
         "AZ,EL"},
        {"fov", '\0', POPT_ARG_DOUBLE, &o.field_of_view, 0,
         "Vertical field of view; 0 for parallel rays (default: 30)", "DEG"},
        {"size", '\0', POPT_ARG_STRING, &o.size, 0, "Pixels (default: 512; 256 with --compare)",
         "N|WxH"},
        {"samples", '\0', POPT_ARG_LONG, &o.samples, 0, "Of each pixel (default: 64)", "N"},
        {"seed", '\0', POPT_ARG_LONG, &o.seed, 0, "Of the samples (default: 0)", "N"},
        {"key", '\0', POPT_ARG_DOUBLE, &o.key, 0, "Of the tone mapping: how bright (default: 0.18)",
         "A"},
        {"compare", '\0', POPT_ARG_NONE, &o.compare, 0,
         "A picture of REFERENCE and OTHERs side by side, with errors", NULL},
        {"columns", '\0', POPT_ARG_LONG, &o.columns, 0,
         "Rows of N materials, each with its reference first", "N"},
        {"labels", '\0', POPT_ARG_STRING, &o.labels, 0, "Titles of the columns", "NAME,NAME..."},
        {"differences", '\0', POPT_ARG_NONE, &o.differences, 0,
         "With Delta E_ITP as pictures below", NULL},
        TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] MATERIAL -o OUT | --compare REFERENCE OTHER... -o OUT",
        .text =
            "Azimuths are degrees to the right of the viewer's first place, elevations upwards.\n"
            "Light comes straight from the lamp or the environment; the same seed gives the same "
            "image."
            "\nPNG is tone-mapped after Reinhard et al. 2002. Below a comparison: E6, PSNR and "
            "mean\n"
            "Delta E_ITP. Example: gonio render atlas:gold-polished -e sky --show-environment -o "
            "g.png",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
