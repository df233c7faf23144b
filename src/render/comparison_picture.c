/* Comparison pictures: renderings in rows and columns with labels and errors, drawn by cairo. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/options.h"
#include "../core/number.h"
#include "cairo_library.h"
#include "image.h"

enum { GAP = 8, MARGIN = 14, MOST_SIDE = 32767, SCALE_HEIGHT = 10 }; /* pixels */

/* The layout, in pixels. */
typedef struct layout {
    int cell_width, cell_height;
    int font;  /* size */
    int names; /* width of the column of row names */
    int head;  /* height above the first row */
    int row;   /* height of a row with everything below it */
    int text;  /* height of the errors below a cell */
    int foot;  /* height below the last row */
    int width, height;
} layout;

typedef struct drawing {
    gonio_context *context;
    const gonio_comparison_picture *picture;
    layout at;
    double largest; /* Delta E_ITP of the brightest colour */
    cairo_surface_t *surface;
    cairo_t *cairo;
} drawing;

static const gonio_picture_cell *cell_at(const gonio_comparison_picture *picture, size_t row,
                                         size_t column)
{
    return &picture->cells[row * picture->columns + column];
}

/* ---- layout ---- */

static gonio_status check(gonio_context *context, const gonio_comparison_picture *picture)
{
    const gonio_image *first =
        picture->rows > 0 && picture->columns > 0 ? picture->cells[0].image : NULL;
    if (first == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a comparison picture needs images");
    }
    for (size_t k = 0; k < picture->rows * picture->columns; k++) {
        const gonio_image *image = picture->cells[k].image;
        if (image == NULL && k % picture->columns == 0) {
            return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                                "row %zu of a comparison picture has no reference",
                                k / picture->columns + 1);
        }
        if (image != NULL && (image->width != first->width || image->height != first->height)) {
            return gonio_i_fail(
                context, GONIO_ERROR_MISMATCH,
                "a comparison picture needs images of one size, not %d x %d and %d x %d pixels",
                first->width, first->height, image->width, image->height);
        }
    }
    return GONIO_OK;
}

/* Roughly the width of the longest name, within limits. Wider text is drawn smaller. */
static int width_of_names(const gonio_comparison_picture *picture, int font)
{
    size_t longest = 6;
    for (size_t row = 0; row < picture->rows; row++) {
        const size_t length = strlen(picture->row_names[row]);
        longest = length > longest ? length : longest;
    }
    return (int)(0.7 * font * (double)(longest < 28 ? longest : 28)) + GAP;
}

static gonio_status lay_out(gonio_context *context, const gonio_comparison_picture *picture,
                            layout *at)
{
    const gonio_image *first = picture->cells[0].image;
    const int shorter = first->width < first->height ? first->width : first->height;
    const int font = shorter / 14 < 10 ? 10 : shorter / 14 > 20 ? 20 : shorter / 14;
    *at = (layout){.cell_width = first->width, .cell_height = first->height, .font = font};
    at->names = width_of_names(picture, font);
    at->head = MARGIN + 2 * font;
    at->text = 3 * font + GAP;
    at->row = at->cell_height * (picture->differences ? 2 : 1) + at->text + GAP +
              (picture->differences ? GAP / 2 : 0);
    at->foot = MARGIN + (picture->differences ? 3 * font : 0);
    const double width =
        2.0 * MARGIN + at->names + (double)picture->columns * (at->cell_width + GAP);
    const double height = at->head + (double)picture->rows * at->row + at->foot;
    if (width > MOST_SIDE || height > MOST_SIDE) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a comparison picture of %.0f x %.0f pixels: at most %d either way; "
                            "make the renderings smaller",
                            width, height, MOST_SIDE);
    }
    at->width = (int)width;
    at->height = (int)height;
    return GONIO_OK;
}

static int left_of(const layout *at, size_t column)
{
    return MARGIN + at->names + (int)column * (at->cell_width + GAP);
}

static int top_of(const layout *at, size_t row)
{
    return at->head + (int)row * at->row;
}

/* ---- drawing ---- */

/* Replaces bytes that are not UTF-8, because cairo draws nothing after them. */
static void printable(const char *from, char *to, size_t size)
{
    size_t n = 0;
    for (const unsigned char *c = (const unsigned char *)from; *c != '\0' && n + 5 < size;) {
        const int length = *c < 0x80                 ? 1
                           : *c >= 0xC2 && *c < 0xE0 ? 2
                           : *c >= 0xE0 && *c < 0xF0 ? 3
                           : *c >= 0xF0 && *c < 0xF5 ? 4
                                                     : 0;
        bool good = length > 0 && *c >= ' ';
        for (int k = 1; k < length && good; k++) {
            good = (c[k] & 0xC0) == 0x80;
        }
        good = good && !(*c == 0xE0 && c[1] < 0xA0) && !(*c == 0xED && c[1] > 0x9F) &&
               !(*c == 0xF0 && c[1] < 0x90) && !(*c == 0xF4 && c[1] > 0x8F);
        memcpy(to + n, good ? (const char *)c : "?", good ? (size_t)length : 1);
        n += good ? (size_t)length : 1;
        c += good ? length : 1;
    }
    to[n] = '\0';
}

/* Draws one line in a box of a width, with its middle at x and its foot at y. Long text has smaller
 * letters. */
static void put_text(const drawing *d, const char *text, double x, double y, double width,
                     bool bold)
{
    char line[256];
    cairo_text_extents_t extents;
    printable(text, line, sizeof line);
    cairo_select_font_face(d->cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(d->cairo, d->at.font);
    cairo_text_extents(d->cairo, line, &extents);
    if (extents.x_advance > width) {
        cairo_set_font_size(d->cairo, d->at.font * width / extents.x_advance);
        cairo_text_extents(d->cairo, line, &extents);
    }
    cairo_move_to(d->cairo, x - 0.5 * extents.x_advance, y);
    cairo_show_text(d->cairo, line);
}

static void put_pixel(const drawing *d, int x, int y, const unsigned char rgb[3])
{
    unsigned char *row = cairo_image_surface_get_data(d->surface) +
                         (ptrdiff_t)y * cairo_image_surface_get_stride(d->surface);
    const uint32_t value = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
    memcpy(row + (ptrdiff_t)x * 4, &value, sizeof value);
}

static void put_image(const drawing *d, const gonio_image *image, const gonio_tone *tone, int left,
                      int top)
{
    for (int y = 0; y < image->height; y++) {
        for (int x = 0; x < image->width; x++) {
            double shown[3];
            unsigned char rgb[3];
            gonio_i_shown(tone,
                          image->rgba +
                              ((size_t)y * (size_t)image->width + (size_t)x) * GONIO_IMAGE_CHANNELS,
                          shown);
            gonio_i_shown_bytes(shown, rgb);
            put_pixel(d, left + x, top + y, rgb);
        }
    }
}

/* The colour of a value in 0 .. 1: from black over blue, red and yellow to white, ever brighter. */
static void heat(double value, unsigned char rgb[3])
{
    static const double stops[5][3] = {
        {0, 0, 0}, {60, 20, 130}, {200, 45, 85}, {250, 165, 40}, {255, 255, 225}};
    const double at = fmin(fmax(value, 0.0), 1.0) * 4.0;
    const int low = at < 4.0 ? (int)at : 3;
    for (int k = 0; k < 3; k++) {
        rgb[k] =
            (unsigned char)lround(stops[low][k] + (at - low) * (stops[low + 1][k] - stops[low][k]));
    }
}

static void put_map(const drawing *d, const float *map, int left, int top)
{
    for (int y = 0; y < d->at.cell_height; y++) {
        for (int x = 0; x < d->at.cell_width; x++) {
            unsigned char rgb[3];
            heat((double)map[(size_t)y * (size_t)d->at.cell_width + (size_t)x] / d->largest, rgb);
            put_pixel(d, left + x, top + y, rgb);
        }
    }
}

static void put_errors(const drawing *d, const gonio_picture_cell *cell,
                       const gonio_image_error *error, int left, int top)
{
    char e6[48] = "";
    char rendered[96];
    if (isfinite(cell->e6)) {
        gonio_i_print(e6, sizeof e6, "E6 %.2f %%", cell->e6);
    }
    if (isfinite(error->psnr)) {
        gonio_i_print(rendered, sizeof rendered,
                      "PSNR %.1f dB, \xce\x94"
                      "E %.2f",
                      error->psnr, error->delta_e_itp);
    } else {
        snprintf(rendered, sizeof rendered, "equal");
    }
    const double middle = left + 0.5 * d->at.cell_width;
    put_text(d, e6, middle, top + 1.2 * d->at.font, d->at.cell_width, false);
    put_text(d, rendered, middle, top + 2.5 * d->at.font, d->at.cell_width, false);
}

static gonio_status put_cell(const drawing *d, size_t row, size_t column, const gonio_tone *tone,
                             float *map)
{
    const gonio_picture_cell *cell = cell_at(d->picture, row, column);
    const int left = left_of(&d->at, column);
    const int top = top_of(&d->at, row);
    const int below = top + d->at.cell_height;
    if (cell->image == NULL) {
        return GONIO_OK;
    }
    put_image(d, cell->image, tone, left, top);
    if (column == 0) {
        return GONIO_OK;
    }
    gonio_image_error error;
    const gonio_status status = gonio_image_compare(d->context, cell_at(d->picture, row, 0)->image,
                                                    cell->image, tone, &error, map);
    if (status == GONIO_OK && d->picture->differences) {
        put_map(d, map, left, below + GAP / 2);
    }
    if (status == GONIO_OK) {
        cairo_surface_mark_dirty(d->surface);
        put_errors(d, cell, &error, left,
                   below + (d->picture->differences ? d->at.cell_height + GAP / 2 : 0));
    }
    return status;
}

static gonio_status put_row(const drawing *d, size_t row, float *map)
{
    const gonio_tone tone = gonio_tone_measure(cell_at(d->picture, row, 0)->image, d->picture->key);
    const double middle = top_of(&d->at, row) + 0.5 * d->at.cell_height;
    gonio_status status = GONIO_OK;
    cairo_surface_flush(d->surface);
    for (size_t column = 0; column < d->picture->columns && status == GONIO_OK; column++) {
        status = put_cell(d, row, column, &tone, map);
        cairo_surface_flush(d->surface);
    }
    cairo_surface_mark_dirty(d->surface);
    put_text(d, d->picture->row_names[row], MARGIN + 0.5 * d->at.names - GAP / 2.0, middle,
             d->at.names - GAP, true);
    if (d->picture->differences) {
        put_text(d,
                 "\xce\x94"
                 "E_ITP",
                 MARGIN + 0.5 * d->at.names - GAP / 2.0, middle + d->at.cell_height,
                 d->at.names - GAP, false);
    }
    return status;
}

/* Draws the scale of the colours of differences. */
static void put_scale(const drawing *d)
{
    const int width = d->at.cell_width;
    const int left = left_of(&d->at, 0);
    const int top = d->at.height - d->at.foot + d->at.font;
    char text[64];
    cairo_surface_flush(d->surface);
    for (int x = 0; x < width; x++) {
        unsigned char rgb[3];
        heat((double)x / width, rgb);
        for (int y = 0; y < SCALE_HEIGHT; y++) {
            put_pixel(d, left + x, top + y, rgb);
        }
    }
    cairo_surface_mark_dirty(d->surface);
    gonio_i_print(text, sizeof text,
                  "\xce\x94"
                  "E_ITP 0 to %g",
                  d->largest);
    put_text(d, text, left + 0.5 * width, top + SCALE_HEIGHT + 1.3 * d->at.font, width, false);
}

static gonio_status draw(const drawing *d)
{
    float *map = gonio_i_allocate(d->context, (size_t)d->at.cell_width * (size_t)d->at.cell_height,
                                  sizeof *map);
    if (map == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    cairo_set_source_rgb(d->cairo, 1.0, 1.0, 1.0);
    cairo_paint(d->cairo);
    cairo_set_source_rgb(d->cairo, 0.1, 0.1, 0.1);
    for (size_t column = 0; column < d->picture->columns; column++) {
        put_text(d, d->picture->column_names[column],
                 left_of(&d->at, column) + 0.5 * d->at.cell_width, MARGIN + 1.2 * d->at.font,
                 d->at.cell_width, true);
    }
    for (size_t row = 0; row < d->picture->rows && status == GONIO_OK; row++) {
        status = put_row(d, row, map);
    }
    if (status == GONIO_OK && d->picture->differences) {
        put_scale(d);
    }
    free(map);
    return status;
}

/* ---- as a file ---- */

static gonio_status write_surface(const drawing *d, const char *path)
{
    cairo_surface_flush(d->surface);
    if (cairo_status(d->cairo) != CAIRO_STATUS_SUCCESS) {
        return gonio_i_fail(d->context, GONIO_ERROR_MEMORY, "%s: cannot be drawn: %s", path,
                            cairo_status_to_string(cairo_status(d->cairo)));
    }
    unsigned char *rgb =
        gonio_i_allocate(d->context, (size_t)d->at.width * (size_t)d->at.height, 3);
    if (rgb == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const unsigned char *data = cairo_image_surface_get_data(d->surface);
    const ptrdiff_t stride = cairo_image_surface_get_stride(d->surface);
    unsigned char *to = rgb;
    for (int y = 0; y < d->at.height; y++) {
        for (int x = 0; x < d->at.width; x++) {
            uint32_t value;
            memcpy(&value, data + y * stride + (ptrdiff_t)x * 4, sizeof value);
            *to++ = (unsigned char)(value >> 16);
            *to++ = (unsigned char)(value >> 8);
            *to++ = (unsigned char)value;
        }
    }
    const gonio_status status = gonio_i_write_png(d->context, d->at.width, d->at.height, rgb, path);
    free(rgb);
    return status;
}

gonio_status gonio_comparison_picture_write_png(gonio_context *context,
                                                const gonio_comparison_picture *picture,
                                                const char *path)
{
    gonio_comparison_picture taken;
    drawing d = {.context = context, .picture = &taken};
    gonio_status status = GONIO_I_TAKE_PLAIN(context, gonio_comparison_picture, picture, &taken);
    if (status == GONIO_OK) {
        status = check(context, &taken);
    }
    if (status == GONIO_OK) {
        d.largest = taken.largest_difference > 0.0 ? taken.largest_difference : 20.0;
        status = lay_out(context, &taken, &d.at);
    }
    if (status == GONIO_OK) {
        status = gonio_i_cairo_load(context);
    }
    if (status != GONIO_OK) {
        return status;
    }
    d.surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, d.at.width, d.at.height);
    d.cairo = cairo_create(d.surface);
    status = cairo_status(d.cairo) == CAIRO_STATUS_SUCCESS
                 ? draw(&d)
                 : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    if (status == GONIO_OK) {
        status = write_surface(&d, path);
    }
    cairo_destroy(d.cairo);
    cairo_surface_destroy(d.surface);
    return status;
}
