/* Fig. 6 and Fig. 7 by the renderer: see renderings.h. */
#include "renderings.h"

#include <gonio/render.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../run/run_folder.h"
#include "../figures/figure_writer.h"
#include "held_out.h"
#include "kept_results.h"

enum {
    SIDE = 128,
    QUICK_SIDE = 64,
    MOST_ROWS = 8,
    MOST_COLUMNS = 6,
    QUICK_MATERIALS = 2,
    PIXEL_DIGITS = 32
};

/* ---- which pictures ---- */

/* The paper's materials. Where it says only "a plastic", "rubber" or "maple", one of these. */
static const char *const fig6_materials[] = {"gold-paint",  "red-plastic", "yellow-phenolic",
                                             "red-fabric",  "blue-rubber", "colonial-maple-223",
                                             "green-latex", "pink-fabric", NULL};
static const char *const fig7_materials[] = {"red-metallic-paint", "green-acrylic", "blue-rubber",
                                             NULL};

/* The columns after the first, by the names in methods.c. */
static const char *const fig6_methods[] = {"condition-170", "condition-120", "condition-80",
                                           "random-80",     "matusik-800",   NULL};
static const char *const fig7_methods[] = {"condition-80", NULL};

/* The lights of each material. NULL: the lamp. */
static const char *const fig6_lights[] = {NULL};
static const char *const fig7_lights[] = {"studio", "sky"};

typedef struct layout {
    size_t rows, columns; /* columns: methods */
    size_t material[MOST_ROWS];
    const char *light[MOST_ROWS];
    const gonio_i_method_entry *method[MOST_COLUMNS];
} layout;

static size_t find_methods(const gonio_i_study *study, const char *const *names, layout *l)
{
    size_t count = 0;
    for (size_t k = 0; names[k] != NULL; k++) {
        for (size_t m = 0; m < gonio_i_methods(study); m++) {
            if (strcmp(gonio_i_method_at(m)->name, names[k]) == 0) {
                l->method[count++] = gonio_i_method_at(m);
            }
        }
    }
    return count;
}

/* Finds the materials. A database with other names gets its first materials. */
static size_t find_materials(const gonio_i_study *study, const char *const *names, size_t *material)
{
    size_t count = 0;
    const size_t all = study->collection.count;
    const size_t most = study->quick ? QUICK_MATERIALS : MOST_ROWS;
    for (size_t k = 0; names[k] != NULL && count < most; k++) {
        const size_t found = gonio_i_find_material(&study->collection, names[k]);
        if (found < all) {
            material[count++] = found;
        }
    }
    for (size_t m = 0; count == 0 && m < all && m < QUICK_MATERIALS; m++) {
        material[m] = m;
    }
    return count > 0 ? count : all < QUICK_MATERIALS ? all : QUICK_MATERIALS;
}

static layout lay_out(const gonio_i_study *study, gonio_i_experiment experiment)
{
    const bool lamp = experiment == GONIO_I_RENDERED;
    const char *const *lights = lamp ? fig6_lights : fig7_lights;
    const size_t light_count = lamp ? 1 : 2;
    size_t material[MOST_ROWS];
    layout l = {0};
    const size_t materials =
        find_materials(study, lamp ? fig6_materials : fig7_materials, material);
    l.columns = find_methods(study, lamp ? fig6_methods : fig7_methods, &l);
    for (size_t k = 0; k < materials * light_count && k < MOST_ROWS; k++) {
        l.material[k] = material[k / light_count];
        l.light[k] = lights[k % light_count];
        l.rows++;
    }
    return l;
}

size_t gonio_i_renderings(const gonio_i_study *study, gonio_i_experiment experiment)
{
    const layout l = lay_out(study, experiment);
    return l.rows * l.columns;
}

char *gonio_i_rendering_name(const gonio_i_study *study, gonio_i_experiment experiment,
                             size_t index)
{
    const layout l = lay_out(study, experiment);
    const size_t row = index / l.columns;
    return gonio_i_format("%s-%s-%s%s%s", gonio_experiment_name((int)experiment),
                          gonio_i_name_of(&study->collection, l.material[row]),
                          l.method[index % l.columns]->name, l.light[row] != NULL ? "-" : "",
                          l.light[row] != NULL ? l.light[row] : "");
}

double gonio_i_rendering_cost(const gonio_i_study *study, gonio_i_experiment experiment,
                              size_t index)
{
    const layout l = lay_out(study, experiment);
    return l.method[index % l.columns]->representation == GONIO_FULL ? 130.0 : 3.0;
}

/* The side of the renderings, pixels. */
static int side_of(const gonio_i_study *study)
{
    return study->quick ? QUICK_SIDE : SIDE;
}

/* ---- images as text ---- */

static json_t *image_json(const gonio_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    char *text = malloc(pixels * PIXEL_DIGITS + 1);
    for (size_t k = 0; text != NULL && k < pixels * GONIO_IMAGE_CHANNELS; k++) {
        uint32_t bits;
        memcpy(&bits, image->rgba + k, sizeof bits);
        snprintf(text + 8 * k, 9, "%08x", bits);
    }
    json_t *json = text != NULL ? json_string(text) : NULL;
    free(text);
    return json;
}

static gonio_status image_from(gonio_context *context, const json_t *json, int side,
                               gonio_image **image)
{
    const char *text = json_string_value(json);
    if (text == NULL || json_string_length(json) != (size_t)side * (size_t)side * PIXEL_DIGITS) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "a rendering that was kept is damaged");
    }
    const gonio_status status = gonio_image_create(context, side, side, image);
    for (size_t k = 0; status == GONIO_OK && k < (size_t)side * (size_t)side * GONIO_IMAGE_CHANNELS;
         k++) {
        char digits[9] = "";
        memcpy(digits, text + 8 * k, 8);
        const uint32_t bits = (uint32_t)strtoul(digits, NULL, 16);
        memcpy((*image)->rgba + k, &bits, sizeof bits);
    }
    return status;
}

/* ---- a piece ---- */

typedef struct showing {
    gonio_context *context;
    const gonio_i_study *study;
    const char *light;
    json_t *result;
} showing;

static gonio_status keep(const showing *s, const gonio_reference *reference,
                         const gonio_image *image)
{
    gonio_image_error error;
    const gonio_tone tone = gonio_reference_tone(reference);
    const gonio_image *original = gonio_reference_image(reference);
    const gonio_status status =
        gonio_image_compare(s->context, original, image, &tone, &error, NULL);
    if (status == GONIO_OK) {
        json_object_set_new(s->result, "psnr_db",
                            isfinite(error.psnr) ? json_real(error.psnr) : json_null());
        json_object_set_new(s->result, "delta_e_itp", json_real(error.delta_e_itp));
        json_object_set_new(s->result, "original", image_json(original));
        json_object_set_new(s->result, "image", image_json(image));
    }
    return status;
}

/* Renders a material and its reconstruction. */
static gonio_status show(void *user, const gonio_material *original, const gonio_material *made)
{
    const showing *s = user;
    gonio_render_options options;
    gonio_environment *environment = NULL;
    gonio_reference *reference = NULL;
    gonio_image *image = NULL;
    gonio_status status = GONIO_OK;
    gonio_render_options_default(&options);
    options.width = options.height = side_of(s->study);
    if (s->light != NULL) {
        status = gonio_environment_open(s->context, s->light, false, &environment);
        options.environment = environment;
        options.samples = s->study->quick ? 64 : 256;
    }
    if (status == GONIO_OK) {
        status = gonio_reference_create(s->context, original, &options, &reference);
    }
    if (status == GONIO_OK) {
        status = gonio_reference_render(s->context, reference, made, &image);
    }
    if (status == GONIO_OK) {
        status = keep(s, reference, image);
    }
    gonio_image_free(&image);
    gonio_reference_free(&reference);
    gonio_environment_free(&environment);
    return status;
}

gonio_status gonio_i_compute_rendering(const gonio_i_study *study, gonio_context *context,
                                       gonio_i_experiment experiment, size_t index, json_t *result)
{
    const layout l = lay_out(study, experiment);
    size_t material = l.material[index / l.columns];
    const gonio_i_method_entry *method = l.method[index % l.columns];
    const size_t all = study->collection.count;
    gonio_i_split split = {.basis_count = all - 1, .test_count = 1, .test = &material};
    split.basis = gonio_i_allocate(context, all, sizeof *split.basis);
    if (split.basis == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t m = 0, n = 0; m < all; m++) {
        if (m != material) {
            split.basis[n++] = m;
        }
    }
    showing s = {context, study, l.light[index / l.columns], result};
    const gonio_i_viewer viewer = {show, &s};
    double condition = NAN;
    gonio_error error;
    const gonio_status status =
        gonio_i_trial_seen(context, &study->collection, method, gonio_i_method_size(study, method),
                           &split, study->seed, &viewer, &condition, &error);
    if (status == GONIO_OK) {
        json_object_set_new(result, "condition",
                            isfinite(condition) ? json_real(condition) : json_null());
        json_object_set_new(result, "e6_percent",
                            isfinite(error.value[GONIO_E6]) ? json_real(error.value[GONIO_E6])
                                                            : json_null());
    }
    free(split.basis);
    return status;
}

bool gonio_i_accept_rendering(const gonio_i_study *study, const gonio_i_piece *p,
                              const json_t *result, char *complaint)
{
    (void)p;
    return gonio_i_accept_images(result, side_of(study), complaint);
}

/* ---- the picture ---- */

typedef struct picture {
    gonio_picture_cell cell[MOST_ROWS * (MOST_COLUMNS + 1)];
    gonio_image *image[MOST_ROWS * (MOST_COLUMNS + 1)];
    char *row[MOST_ROWS];
    char *column[MOST_COLUMNS + 1];
} picture;

static gonio_status fill(gonio_context *context, const gonio_i_study *study, const layout *l,
                         const json_t *pieces, picture *p)
{
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < l->rows * l->columns && status == GONIO_OK; k++) {
        const json_t *piece = json_array_get(pieces, k);
        const size_t at = k / l->columns * (l->columns + 1) + k % l->columns + 1;
        if (k % l->columns == 0) {
            status = image_from(context, json_object_get(piece, "original"), side_of(study),
                                &p->image[at - 1]);
            p->cell[at - 1] = (gonio_picture_cell){p->image[at - 1], NAN};
        }
        if (status == GONIO_OK) {
            status =
                image_from(context, json_object_get(piece, "image"), side_of(study), &p->image[at]);
            p->cell[at] = (gonio_picture_cell){
                p->image[at], gonio_i_json_number(json_object_get(piece, "e6_percent"))};
        }
    }
    for (size_t k = 0; k < l->rows; k++) {
        p->row[k] =
            gonio_i_format("%s%s%s", gonio_i_name_of(&study->collection, l->material[k]),
                           l->light[k] != NULL ? ", " : "", l->light[k] != NULL ? l->light[k] : "");
    }
    p->column[0] = strdup("original");
    for (size_t k = 0; k < l->columns; k++) {
        const gonio_i_size size = gonio_i_method_size(study, l->method[k]);
        p->column[k + 1] =
            gonio_i_format("%s, %zu/%zu", l->method[k]->label, size.samples, size.components);
    }
    return status;
}

static bool has_names(const layout *l, const picture *p)
{
    bool good = true;
    for (size_t k = 0; k < l->rows; k++) {
        good = good && p->row[k] != NULL;
    }
    for (size_t k = 0; k <= l->columns; k++) {
        good = good && p->column[k] != NULL;
    }
    return good;
}

static void free_picture(picture *p)
{
    for (size_t k = 0; k < sizeof p->image / sizeof *p->image; k++) {
        gonio_image_free(&p->image[k]);
    }
    for (size_t k = 0; k < MOST_ROWS; k++) {
        free(p->row[k]);
    }
    for (size_t k = 0; k <= MOST_COLUMNS; k++) {
        free(p->column[k]);
    }
}

gonio_status gonio_i_draw_renderings(gonio_context *context, const gonio_i_study *study,
                                     gonio_i_experiment experiment, const json_t *pieces,
                                     const char *folder)
{
    const layout l = lay_out(study, experiment);
    picture p = {0};
    gonio_status status = fill(context, study, &l, pieces, &p);
    char *path = gonio_i_format("%s/%s.png", folder, gonio_experiment_name((int)experiment));
    if (status == GONIO_OK && (path == NULL || !has_names(&l, &p))) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    if (status == GONIO_OK) {
        status = gonio_i_make_folder(context, folder);
    }
    if (status == GONIO_OK) {
        const gonio_comparison_picture drawn = {.size = sizeof drawn,
                                                .rows = l.rows,
                                                .columns = l.columns + 1,
                                                .row_names = (const char *const *)p.row,
                                                .column_names = (const char *const *)p.column,
                                                .cells = p.cell,
                                                .key = 0.18};
        status = gonio_comparison_picture_write_png(context, &drawn, path);
    }
    free(path);
    free_picture(&p);
    return status;
}

void gonio_i_put_renderings(FILE *f, const gonio_i_study *study, gonio_i_experiment experiment,
                            const json_t *pieces)
{
    const layout l = lay_out(study, experiment);
    fputs("material,light,method,components,samples,condition_number,e6_percent,psnr_db,"
          "delta_e_itp\n",
          f);
    for (size_t k = 0; k < l.rows * l.columns; k++) {
        static const char *const numbers[] = {"condition", "e6_percent", "psnr_db", "delta_e_itp"};
        const json_t *piece = json_array_get(pieces, k);
        const size_t row = k / l.columns;
        const gonio_i_method_entry *method = l.method[k % l.columns];
        const gonio_i_size size = gonio_i_method_size(study, method);
        gonio_i_put_cell(f, gonio_i_name_of(&study->collection, l.material[row]));
        fprintf(f, ",%s,%s,%zu,%zu", l.light[row] != NULL ? l.light[row] : "lamp", method->name,
                size.components, size.samples);
        for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
            fputc(',', f);
            gonio_i_put_number(f, gonio_i_json_number(json_object_get(piece, numbers[n])));
        }
        fputc('\n', f);
    }
}
