/* gonio render --compare: a picture of several renderings side by side. See render_options.h. */
#include "inputs.h"
#include "json_output.h"
#include "render_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct picture {
    size_t rows, columns;
    gonio_image **image;       /* [rows][columns] */
    gonio_picture_cell *cells; /* the same */
    char **row_name;           /* [rows] */
    char **column_name;        /* [columns] */
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
        p->cells[at] = (gonio_picture_cell){p->image[at], comparison.all.value[GONIO_E6]};
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

static gonio_status compare_row(const tool *t, const render_scene *s, const char *const *paths,
                                picture *p, size_t row)
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
        p->cells[first] = (gonio_picture_cell){p->image[first], NAN};
    }
    for (size_t k = 1; k < p->columns && status == GONIO_OK; k++) {
        status = compare_cell(t, reference, original, paths[k], p, first + k);
    }
    gonio_reference_free(&reference);
    gonio_material_free(&original);
    return status;
}

/* Reads the columns' names, separated by commas. False if their number is wrong. */
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

static gonio_status write_picture(const tool *t, const render_request *o, picture *p)
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
    const gonio_comparison_picture drawn = {.size = sizeof drawn,
                                            .rows = p->rows,
                                            .columns = p->columns,
                                            .row_names = (const char *const *)p->row_name,
                                            .column_names = (const char *const *)p->column_name,
                                            .cells = p->cells,
                                            .key = o->key,
                                            .differences = o->differences != 0};
    return gonio_comparison_picture_write_png(t->context, &drawn, o->output);
}

/* The rows as JSON, with the E6 of each material relative to the first of its row. */
static json_t *picture_json(const render_request *o, const picture *p, const char *const *paths)
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

static int report_picture(const tool *t, const render_request *o, const picture *p,
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

int render_comparison(const tool *t, const render_request *o, const render_scene *s,
                      const char *const *paths, size_t count)
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
