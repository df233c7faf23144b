/* PLY meshes (Turk 1994), text and binary. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/number.h"
#include "mesh.h"

enum { MOST_ELEMENTS = 16, MOST_PROPERTIES = 64, NAME = 32, PLACES = 6 };

typedef enum encoding { TEXT, LITTLE_ENDIAN_BINARY, BIG_ENDIAN_BINARY } encoding;

typedef enum type { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, NO_TYPE } type;

static const int bytes_of[NO_TYPE] = {1, 1, 2, 2, 4, 4, 4, 8};

typedef struct property {
    char name[NAME];
    type count; /* of a list's length; NO_TYPE for a single value */
    type value;
} property;

typedef struct element {
    char name[NAME];
    unsigned long long items;
    int properties;
    property property[MOST_PROPERTIES];
} element;

typedef struct reading {
    gonio_i_mesh_making *making;
    const unsigned char *at, *end;
    size_t line; /* of the header, from 1 */
    encoding encoding;
    int elements;
    element element[MOST_ELEMENTS];
} reading;

static gonio_status fail(const reading *r, const char *what)
{
    return gonio_i_fail(r->making->context, GONIO_ERROR_FORMAT, "%s: cannot be read as PLY: %s",
                        r->making->path, what);
}

/* ---- the header ---- */

/* The next line without its end. False at the end of the file or for a line that is too long. */
static bool next_line(reading *r, char *line, size_t size)
{
    const unsigned char *end = memchr(r->at, '\n', (size_t)(r->end - r->at));
    const size_t length = end != NULL ? (size_t)(end - r->at) : size;
    if (end == NULL || length >= size) {
        return false;
    }
    memcpy(line, r->at, length);
    line[length > 0 && line[length - 1] == '\r' ? length - 1 : length] = '\0';
    r->at = end + 1;
    r->line++;
    return true;
}

static type type_of(const char *name)
{
    static const struct {
        const char *name;
        type type;
    } names[] = {
        {"char", INT8},     {"int8", INT8},       {"uchar", UINT8},    {"uint8", UINT8},
        {"short", INT16},   {"int16", INT16},     {"ushort", UINT16},  {"uint16", UINT16},
        {"int", INT32},     {"int32", INT32},     {"uint", UINT32},    {"uint32", UINT32},
        {"float", FLOAT32}, {"float32", FLOAT32}, {"double", FLOAT64}, {"float64", FLOAT64}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        if (strcmp(names[k].name, name) == 0) {
            return names[k].type;
        }
    }
    return NO_TYPE;
}

static bool add_element(reading *r, const char *line)
{
    element *e = &r->element[r->elements];
    if (r->elements == MOST_ELEMENTS ||
        sscanf(line, "element %31s %llu", e->name, &e->items) != 2) {
        return false;
    }
    e->properties = 0;
    r->elements++;
    return true;
}

static bool add_property(reading *r, const char *line)
{
    char count[NAME] = "";
    char value[NAME] = "";
    element *e = r->elements > 0 ? &r->element[r->elements - 1] : NULL;
    if (e == NULL || e->properties == MOST_PROPERTIES) {
        return false;
    }
    property *p = &e->property[e->properties++];
    p->count = NO_TYPE;
    if (sscanf(line, "property list %31s %31s %31s", count, value, p->name) == 3) {
        p->count = type_of(count);
        p->value = type_of(value);
        return p->count < FLOAT32 && p->value != NO_TYPE;
    }
    if (sscanf(line, "property %31s %31s", value, p->name) != 2) {
        return false;
    }
    p->value = type_of(value);
    return p->value != NO_TYPE;
}

static bool set_encoding(reading *r, const char *line)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    char name[NAME] = "";
    char version[NAME] = "";
    if (sscanf(line, "format %31s %31s", name, version) != 2 || strcmp(version, "1.0") != 0) {
        return false;
    }
    for (int k = 0; k < 3; k++) {
        if (strcmp(names[k], name) == 0) {
            r->encoding = (encoding)k;
            return true;
        }
    }
    return false;
}

static bool begins(const char *line, const char *word)
{
    const size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && (line[length] == ' ' || line[length] == '\0');
}

static gonio_status read_header(reading *r)
{
    char line[1024];
    bool format = false;
    while (next_line(r, line, sizeof line)) {
        bool good = true;
        if (strcmp(line, "end_header") == 0) {
            return format ? GONIO_OK : fail(r, "its header states no format");
        }
        if (begins(line, "format")) {
            good = format = set_encoding(r, line);
        } else if (begins(line, "element")) {
            good = add_element(r, line);
        } else if (begins(line, "property")) {
            good = add_property(r, line);
        }
        if (!good) {
            return gonio_i_fail(r->making->context, GONIO_ERROR_FORMAT,
                                "%s:%zu: cannot be read as PLY: '%s'", r->making->path, r->line,
                                line);
        }
    }
    return fail(r, "its header does not end");
}

/* ---- values ---- */

/* Reads a number. A zero byte follows the file, so that strtod stops there. */
static bool read_text(reading *r, double *value)
{
    char *end = NULL;
    *value = gonio_i_number((const char *)r->at, &end);
    if (end == (const char *)r->at || (const unsigned char *)end > r->end) {
        return false;
    }
    r->at = (const unsigned char *)end;
    return true;
}

static double signed_of(uint64_t bits, int bytes)
{
    const int shift = 64 - 8 * bytes;
    return (double)((int64_t)(bits << shift) >> shift);
}

static bool read_binary(reading *r, type kind, double *value)
{
    const int bytes = bytes_of[kind];
    if (r->end - r->at < bytes) {
        return false;
    }
    uint64_t bits = 0;
    for (int k = 0; k < bytes; k++) {
        const int place = r->encoding == LITTLE_ENDIAN_BINARY ? k : bytes - 1 - k;
        bits |= (uint64_t)r->at[k] << (8 * place);
    }
    r->at += bytes;
    if (kind == FLOAT32) {
        const uint32_t half = (uint32_t)bits;
        float number;
        memcpy(&number, &half, sizeof number);
        *value = (double)number;
    } else if (kind == FLOAT64) {
        memcpy(value, &bits, sizeof *value);
    } else {
        *value =
            kind == INT8 || kind == INT16 || kind == INT32 ? signed_of(bits, bytes) : (double)bits;
    }
    return true;
}

static bool read_value(reading *r, type kind, double *value)
{
    return r->encoding == TEXT ? read_text(r, value) : read_binary(r, kind, value);
}

/* ---- corners and faces ---- */

/* The place of a property of a corner: x, y, z, nx, ny, nz are 0 to 5; -1 for others. */
static int place_of(const element *e, int index)
{
    static const char *const names[PLACES] = {"x", "y", "z", "nx", "ny", "nz"};
    for (int k = 0; k < PLACES; k++) {
        if (strcmp(e->property[index].name, names[k]) == 0 && e->property[index].count == NO_TYPE) {
            return k;
        }
    }
    return -1;
}

static bool is_polygon(const element *e, int index)
{
    return strcmp(e->name, "face") == 0 && e->property[index].count != NO_TYPE &&
           (strcmp(e->property[index].name, "vertex_indices") == 0 ||
            strcmp(e->property[index].name, "vertex_index") == 0);
}

static uint32_t corner_of(double value)
{
    return value >= 0.0 && value < (double)UINT32_MAX ? (uint32_t)value : UINT32_MAX;
}

/* Reads a list: the corners of a polygon. Other lists are skipped. */
static gonio_status read_list(reading *r, const property *p, bool polygon)
{
    double count = 0.0;
    gonio_status status = GONIO_OK;
    if (!read_value(r, p->count, &count)) {
        return fail(r, "it is cut short");
    }
    for (double k = 0.0; k < count && status == GONIO_OK; k += 1.0) {
        double value = 0.0;
        if (!read_value(r, p->value, &value)) {
            return fail(r, "it is cut short");
        }
        status = polygon ? gonio_i_mesh_add_to_polygon(r->making, corner_of(value)) : GONIO_OK;
    }
    return status == GONIO_OK && polygon ? gonio_i_mesh_end_polygon(r->making) : status;
}

static gonio_status read_item(reading *r, const element *e)
{
    float corner[PLACES] = {0.0F};
    unsigned given = 0; /* a bit a place */
    for (int k = 0; k < e->properties; k++) {
        const property *p = &e->property[k];
        if (p->count != NO_TYPE) {
            const gonio_status status = read_list(r, p, is_polygon(e, k));
            if (status != GONIO_OK) {
                return status;
            }
            continue;
        }
        double value = 0.0;
        if (!read_value(r, p->value, &value)) {
            return fail(r, "it is cut short");
        }
        const int place = place_of(e, k);
        if (place >= 0) {
            corner[place] = (float)value;
            given |= 1U << place;
        }
    }
    if (strcmp(e->name, "vertex") != 0) {
        return GONIO_OK;
    }
    return (given & 7U) == 7U
               ? gonio_i_mesh_add_corner(r->making, corner, given == 63U ? corner + 3 : NULL)
               : fail(r, "its corners lack x, y or z");
}

static gonio_status read_items(reading *r, const element *e)
{
    gonio_status status = GONIO_OK;
    /* An item without properties takes no bytes, so its count has no limit. */
    for (unsigned long long item = 0; e->properties > 0 && item < e->items && status == GONIO_OK;
         item++) {
        status = read_item(r, e);
        if (status == GONIO_OK && (item + 1) % GONIO_I_MESH_PROGRESS == 0) {
            status = gonio_i_progress(r->making->context, "reading the mesh",
                                      (double)item / (double)e->items);
        }
    }
    return status;
}

gonio_status gonio_i_read_ply(gonio_i_mesh_making *making, const gonio_i_bytes *bytes)
{
    reading *r = gonio_i_allocate(making->context, 1, sizeof *r);
    if (r == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *r = (reading){.making = making, .at = bytes->data, .end = bytes->data + bytes->size};
    gonio_status status = read_header(r);
    for (int k = 0; k < r->elements && status == GONIO_OK; k++) {
        status = read_items(r, &r->element[k]);
    }
    free(r);
    return status;
}
