/* Attributes of HDF5 objects, and lists of strings in attributes and datasets: see hdf_read.h. */
#include <stdlib.h>
#include <string.h>

#include "hdf_chunks.h"
#include "hdf_messages.h"

enum { LONGEST_LIST = 1 << 20, LONGEST_VARIABLE_LIST = 1 << 14, HEAP_PLACE = 16 };
enum { MOST_IN_HEAP = 4096 }; /* objects of a collection, which HDF5 keeps below 64 KiB */

/* ---- attributes ---- */

/* An attribute: type, shape, bytes. */
typedef struct attribute {
    gonio_i_hdf_type type;
    gonio_i_hdf_space space;
    gonio_i_hdf_cursor data;
} attribute;

/* Takes a part of an attribute; version 1 pads each to eight bytes. */
static gonio_i_hdf_cursor take_part(gonio_i_hdf_cursor *body, uint64_t version, uint64_t size)
{
    const unsigned char *at = gonio_i_hdf_take(body, version == 1 ? (size + 7) / 8 * 8 : size);
    return (gonio_i_hdf_cursor){
        .at = at, .left = at != NULL ? (size_t)size : 0, .failed = at == NULL};
}

/* Version, flags, lengths of name, type and shape (in version 3 a character set), these three, the
 * data. False if it has another name, or a type or shape that is kept elsewhere. */
static bool read_attribute(gonio_i_hdf_cursor body, const char *name, attribute *found)
{
    enum { ELSEWHERE = 0x03 };
    const size_t length = strlen(name) + 1;
    const uint64_t version = gonio_i_hdf_number(&body, 1);
    const uint64_t flags = gonio_i_hdf_number(&body, 1);
    const uint64_t name_size = gonio_i_hdf_number(&body, 2);
    const uint64_t type_size = gonio_i_hdf_number(&body, 2);
    const uint64_t space_size = gonio_i_hdf_number(&body, 2);
    gonio_i_hdf_take(&body, version == 3 ? 1 : 0);
    const gonio_i_hdf_cursor own = take_part(&body, version, name_size);
    const gonio_i_hdf_cursor type = take_part(&body, version, type_size);
    const gonio_i_hdf_cursor space = take_part(&body, version, space_size);
    if (body.failed || version < 1 || version > 3 || (version > 1 && (flags & ELSEWHERE) != 0) ||
        own.left < length || memcmp(own.at, name, length) != 0) {
        return false;
    }
    found->data = body;
    return gonio_i_hdf_read_type(type, &found->type) &&
           gonio_i_hdf_read_space(space, &found->space) &&
           found->space.count <= body.left / found->type.size;
}

static bool find_attribute(gonio_i_hdf_object object, const char *name, attribute *found)
{
    gonio_i_hdf_messages messages;
    gonio_i_hdf_cursor body;
    gonio_i_hdf_messages_begin(object, &messages);
    while (gonio_i_hdf_messages_next(&messages, GONIO_I_HDF_ATTRIBUTE, &body)) {
        if (read_attribute(body, name, found)) {
            return true;
        }
    }
    return false;
}

bool gonio_i_hdf_has_attribute(gonio_i_hdf_object object, const char *name)
{
    attribute found;
    return find_attribute(object, name, &found);
}

bool gonio_i_hdf_read_number(gonio_i_hdf_object object, const char *name, int64_t *value)
{
    attribute found;
    if (!find_attribute(object, name, &found) || found.type.class != GONIO_I_HDF_INTEGER ||
        found.space.count != 1) {
        return false;
    }
    *value = gonio_i_hdf_integer(&found.type, found.data.at);
    return true;
}

/* ---- strings ---- */

/* A string somewhere in the file; not followed by a zero. */
typedef struct stretch {
    const char *text;
    size_t length;
} stretch;

static stretch stretch_of(const unsigned char *at, size_t room)
{
    const char *text = (const char *)at;
    return (stretch){text, strnlen(text, room)};
}

/* A collection of a heap: GCOL, version, its size; objects of number, references, padding, size and
 * bytes padded to eight. Number 0 is free room at the end. */
static stretch find_in_heap(const gonio_i_hdf_file *file, uint64_t address, uint64_t wanted)
{
    gonio_i_hdf_cursor c = gonio_i_hdf_from(file, address);
    gonio_i_hdf_expect(&c, "GCOL");
    gonio_i_hdf_take(&c, 4);
    const uint64_t size = gonio_i_hdf_number(&c, 8);
    if (c.failed || size < HEAP_PLACE || size - HEAP_PLACE > c.left) {
        return (stretch){NULL, 0};
    }
    c.left = (size_t)size - HEAP_PLACE;
    for (int k = 0; k < MOST_IN_HEAP && !c.failed; k++) {
        const uint64_t number = gonio_i_hdf_number(&c, 2);
        gonio_i_hdf_take(&c, 6);
        const uint64_t bytes = gonio_i_hdf_number(&c, 8);
        const bool whole = !c.failed && bytes <= c.left;
        if (number == 0 || !whole) {
            break;
        }
        if (number == wanted) {
            return stretch_of(c.at, (size_t)bytes);
        }
        gonio_i_hdf_take(&c, (bytes + 7) / 8 * 8);
    }
    return (stretch){NULL, 0};
}

/* A string of variable length: its length, a collection, a number in there. Of length 0 there is
 * none. */
static stretch find_variable(const gonio_i_hdf_file *file, const unsigned char *place)
{
    gonio_i_hdf_cursor c = {.at = place, .left = HEAP_PLACE};
    const uint64_t length = gonio_i_hdf_number(&c, 4);
    const uint64_t address = gonio_i_hdf_number(&c, 8);
    const uint64_t number = gonio_i_hdf_number(&c, 4);
    if (length == 0) {
        return (stretch){"", 0};
    }
    const stretch found = find_in_heap(file, address, number);
    return (stretch){found.text, found.length < length ? found.length : (size_t)length};
}

static stretch string_at(const gonio_i_hdf_file *file, const gonio_i_hdf_type *type,
                         const unsigned char *stored, size_t k)
{
    const unsigned char *at = stored + k * type->size;
    return type->class == GONIO_I_HDF_STRING ? stretch_of(at, type->size) : find_variable(file, at);
}

/* Bytes of all strings with their zeros; SIZE_MAX if one is missing or they are more than the file
 * holds, as of strings that stand in it once each. */
static size_t total_length(const gonio_i_hdf_file *file, const gonio_i_hdf_type *type,
                           const unsigned char *stored, size_t count)
{
    size_t total = 0;
    for (size_t k = 0; k < count; k++) {
        const stretch s = string_at(file, type, stored, k);
        if (s.text == NULL || s.length > file->size) {
            return SIZE_MAX;
        }
        total += s.length + 1;
        if (type->class == GONIO_I_HDF_VARIABLE_STRING && total > file->size) {
            return SIZE_MAX;
        }
    }
    return total;
}

/* Copies the strings into one block, behind pointers to them. */
static char **pack(const gonio_i_hdf_file *file, const gonio_i_hdf_type *type,
                   const unsigned char *stored, size_t count)
{
    const size_t total = total_length(file, type, stored, count);
    char **packed = total < SIZE_MAX ? malloc(count * sizeof *packed + total + 1) : NULL;
    char *text = packed != NULL ? (char *)(packed + count) : NULL;
    for (size_t k = 0; k < count && packed != NULL; k++) {
        const stretch s = string_at(file, type, stored, k);
        packed[k] = text;
        if (s.length > 0) {
            memcpy(text, s.text, s.length);
        }
        text[s.length] = '\0';
        text += s.length + 1;
    }
    return packed;
}

/* Whether this is a list of strings, of which the empty one may have any type. */
static bool is_list(const gonio_i_hdf_type *type, const gonio_i_hdf_space *space)
{
    const bool variable = type->class == GONIO_I_HDF_VARIABLE_STRING;
    const size_t most = variable ? LONGEST_VARIABLE_LIST : LONGEST_LIST;
    return space->count == 0 || (space->rank <= 1 && space->count <= most &&
                                 (variable || type->class == GONIO_I_HDF_STRING));
}

bool gonio_i_hdf_read_strings(gonio_i_hdf_object object, const char *name, char ***strings,
                              size_t *count)
{
    attribute found;
    if (!find_attribute(object, name, &found) || !is_list(&found.type, &found.space)) {
        return false;
    }
    *count = found.space.count;
    *strings = pack(object.file, &found.type, found.data.at, *count);
    return *strings != NULL;
}

/* ---- strings of datasets ---- */

/* A block that is being filled with elements as they are stored. */
typedef struct filling {
    unsigned char *bytes;
    size_t element;
} filling;

static void keep(void *user, size_t first, size_t count, const unsigned char *stored)
{
    const filling *f = user;
    memcpy(f->bytes + first * f->element, stored, count * f->element);
}

bool gonio_i_hdf_read_string_set(gonio_i_hdf_object group, const char *path, char ***strings,
                                 size_t *count)
{
    gonio_i_hdf_object object;
    gonio_i_hdf_set set;
    if (!gonio_i_hdf_find(group, path, &object) || gonio_i_hdf_read_set(object, &set) != NULL ||
        !is_list(&set.type, &set.space) || gonio_i_hdf_lacks(&set, set.type.size) != NULL) {
        return false;
    }
    filling f = {.element = set.type.size};
    f.bytes = calloc(set.space.count + 1, set.type.size);
    *count = set.space.count;
    *strings = f.bytes != NULL && gonio_i_hdf_visit_stored(&set, keep, &f) == NULL
                   ? pack(object.file, &set.type, f.bytes, *count)
                   : NULL;
    free(f.bytes);
    return *strings != NULL;
}
