/* Radiance .hdr images (Ward, "Real Pixels", Graphics Gems II, 1991): a header of text, then
 * scan lines of R, G, B mantissas with a common exponent, plain or run-length coded by component.
 * The code is gonio's own, because the library at hand does not return from some truncated files
 * and ignores EXPOSURE. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../core/number.h"
#include "image.h"

enum { RGBE = 4, LEAST_CODED = 8, MOST_CODED = 32767 };

typedef struct reading {
    gonio_context *context;
    const char *path;
    const unsigned char *at; /* the next byte */
    const unsigned char *end;
    double scale[3]; /* the factors that R, G, B were multiplied by */
    int width, height;
} reading;

static gonio_status fail(const reading *r, const char *problem)
{
    return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                        "%s: cannot be read as a Radiance image: %s", r->path, problem);
}

/* ---- the header ---- */

/* The next line without its end. False if it is too long or there is none. */
static bool next_line(reading *r, char line[128])
{
    const unsigned char *end = memchr(r->at, '\n', (size_t)(r->end - r->at));
    const size_t length = end != NULL ? (size_t)(end - r->at) : 0;
    if (end == NULL) {
        return false;
    }
    const size_t kept = length < 127 ? length : 127; /* long lines are comments and commands */
    memcpy(line, r->at, kept);
    line[kept] = '\0';
    line[strcspn(line, "\r")] = '\0';
    r->at = end + 1;
    return true;
}

/* Multiplies the scale by the numbers of EXPOSURE (one) and COLORCORR (three). */
static bool take_scale(reading *r, const char *text, int numbers)
{
    double factor[3];
    for (int k = 0; k < numbers; k++) {
        char *end = NULL;
        factor[k] = gonio_i_number(text, &end);
        if (end == text || !(factor[k] > 0.0) || !isfinite(factor[k])) {
            return false;
        }
        text = end;
    }
    for (int k = 0; k < 3; k++) {
        r->scale[k] *= factor[numbers == 1 ? 0 : k];
    }
    return true;
}

static const char *after(const char *line, const char *key)
{
    const size_t length = strlen(key);
    return strncmp(line, key, length) == 0 ? line + length : NULL;
}

static gonio_status read_header(reading *r)
{
    char line[128] = "";
    bool known = false;
    while (next_line(r, line)) {
        const char *format = after(line, "FORMAT=");
        const char *exposure = after(line, "EXPOSURE=");
        const char *colour = after(line, "COLORCORR=");
        if (line[0] == '\0') {
            return known ? GONIO_OK : fail(r, "its FORMAT is not 32-bit_rle_rgbe");
        }
        if (format != NULL) {
            known = strcmp(format, "32-bit_rle_rgbe") == 0;
        } else if ((exposure != NULL && !take_scale(r, exposure, 1)) ||
                   (colour != NULL && !take_scale(r, colour, 3))) {
            return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                "%s: '%s' in the header: numbers above 0 are expected", r->path,
                                line);
        }
    }
    return fail(r, "its header does not end");
}

/* A whole number from 1 on; 0 for other text. */
static long side_of(const char *text, char **end)
{
    const long side = strtol(text, end, 10);
    return *end != text && side > 0 ? side : 0;
}

/* Reads "-Y height +X width", the usual orientation. */
static gonio_status read_size(reading *r)
{
    char line[128] = "";
    char *next = NULL;
    const char *text = next_line(r, line) ? after(line, "-Y ") : NULL;
    const long height = text != NULL ? side_of(text, &next) : 0;
    text = next != NULL ? after(next, " +X ") : NULL;
    const long width = text != NULL ? side_of(text, &next) : 0;
    if (height == 0 || width == 0) {
        return fail(r, "its size is not given as '-Y height +X width'");
    }
    if (width > GONIO_MOST_PIXELS || height > GONIO_MOST_PIXELS) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: an image of %ld x %ld pixels: each side must be 1 to %d", r->path,
                            width, height, GONIO_MOST_PIXELS);
    }
    r->width = (int)width;
    r->height = (int)height;
    return GONIO_OK;
}

/* ---- scan lines ---- */

/* Reads one component of a coded line. A count above 128 repeats the next byte; a smaller one
 * copies bytes. */
static bool read_component(reading *r, unsigned char *line, int component)
{
    for (int x = 0; x < r->width;) {
        if (r->end - r->at < 2) {
            return false;
        }
        const bool repeated = *r->at > 128;
        const int count = repeated ? *r->at - 128 : *r->at;
        r->at++;
        if (count == 0 || count > r->width - x || (!repeated && count > r->end - r->at)) {
            return false;
        }
        for (int k = 0; k < count; k++, x++) {
            line[x * RGBE + component] = repeated ? *r->at : r->at[k];
        }
        r->at += repeated ? 1 : count;
    }
    return true;
}

static bool is_coded(const reading *r)
{
    return r->width >= LEAST_CODED && r->width <= MOST_CODED && r->end - r->at >= RGBE &&
           r->at[0] == 2 && r->at[1] == 2 && (r->at[2] << 8 | r->at[3]) == r->width;
}

/* Reads line[width][4]. False if the file is damaged or ends early. */
static bool read_line(reading *r, unsigned char *line)
{
    if (!is_coded(r)) {
        const size_t size = (size_t)r->width * RGBE;
        if ((size_t)(r->end - r->at) < size) {
            return false;
        }
        memcpy(line, r->at, size);
        r->at += size;
        return true;
    }
    r->at += RGBE;
    bool whole = true;
    for (int k = 0; k < RGBE && whole; k++) {
        whole = read_component(r, line, k);
    }
    return whole;
}

static void to_radiance(const reading *r, const unsigned char *line, float *rgba)
{
    for (int x = 0; x < r->width; x++, line += RGBE, rgba += GONIO_IMAGE_CHANNELS) {
        const double unit = line[3] != 0 ? ldexp(1.0, line[3] - (128 + 8)) : 0.0;
        for (int k = 0; k < 3; k++) {
            rgba[k] = (float)(line[k] * unit / r->scale[k]);
        }
        rgba[3] = 1.0F;
    }
}

static gonio_status read_lines(reading *r, gonio_image *image)
{
    unsigned char *line = gonio_i_allocate(r->context, (size_t)r->width, RGBE);
    gonio_status status = line != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (int y = 0; y < r->height && status == GONIO_OK; y++) {
        if (read_line(r, line)) {
            to_radiance(r, line, image->rgba + (size_t)y * (size_t)r->width * GONIO_IMAGE_CHANNELS);
        } else {
            status =
                gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                             "%s: damaged or cut off in row %d of %d", r->path, y + 1, r->height);
        }
    }
    free(line);
    return status;
}

/* Whether the file is large enough for its pixels. A pixel takes 4 bytes, or a run of at most 127
 * pixels 2 bytes a component. */
static bool can_hold(const reading *r)
{
    return (int64_t)r->width * r->height / 127 * 2 * RGBE <= r->end - r->at;
}

gonio_status gonio_i_read_radiance(gonio_context *context, const char *path,
                                   const gonio_i_bytes *bytes, gonio_image **image)
{
    reading r = {.context = context,
                 .path = path,
                 .at = bytes->data,
                 .end = bytes->data + bytes->size,
                 .scale = {1.0, 1.0, 1.0}};
    gonio_image *made = NULL;
    gonio_status status = read_header(&r);
    if (status == GONIO_OK) {
        status = read_size(&r);
    }
    if (status == GONIO_OK && !can_hold(&r)) {
        status = fail(&r, "it is cut off");
    }
    if (status == GONIO_OK) {
        status = gonio_image_create(context, r.width, r.height, &made);
    }
    if (status == GONIO_OK) {
        status = read_lines(&r, made);
    }
    if (status != GONIO_OK) {
        gonio_image_free(&made);
        return status;
    }
    *image = made;
    return GONIO_OK;
}
