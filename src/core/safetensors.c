/* Safetensors files: see safetensors.h. */
#include "safetensors.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <jansson.h>

#include "output.h"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "arrays are mapped as they are in the file, which is little-endian"
#endif

enum {
    LENGTH_SIZE = 8,         /* of the number in front of the header */
    ALIGNMENT = 64,          /* of the first array, where we write it */
    LONGEST_HEADER = 1 << 24 /* of a file that is read */
};

static const char metadata_key[] = "__metadata__";

/* The format's types; the first ones are those of gonio_i_array_type. */
static const struct {
    const char *name;
    size_t size; /* in bytes */
} types[] = {{"F64", 8},  {"U64", 8}, {"F32", 4},  {"I32", 4},     {"U8", 1},
             {"I64", 8},  {"U32", 4}, {"F16", 2},  {"I16", 2},     {"U16", 2},
             {"BF16", 2}, {"I8", 1},  {"BOOL", 1}, {"F8_E4M3", 1}, {"F8_E5M2", 1}};

enum { TYPES = sizeof types / sizeof *types };

/* ---- writing ---- */

static size_t size_of(const gonio_i_array *array)
{
    size_t size = types[array->type].size;
    for (int k = 0; k < array->rank; k++) {
        size *= array->shape[k];
    }
    return size;
}

/* A JSON string. In a text that is not UTF-8 every byte beyond ASCII becomes U+FFFD. */
static json_t *json_of(const char *text)
{
    static const char unknown[] = "\xEF\xBF\xBD"; /* U+FFFD */
    json_t *made = json_string(text);
    if (made != NULL) {
        return made;
    }
    char *mended = calloc(strlen(text) + 1, sizeof unknown - 1);
    char *end = mended;
    for (const char *c = text; mended != NULL && *c != '\0'; c++) {
        if ((unsigned char)*c < 0x80) {
            *end++ = *c;
        } else {
            end = stpcpy(end, unknown);
        }
    }
    made = mended != NULL ? json_string(mended) : NULL;
    free(mended);
    return made;
}

static json_t *describe_metadata(const gonio_i_metadata *metadata, size_t texts)
{
    json_t *made = json_object();
    for (size_t k = 0; k < texts; k++) {
        if (json_object_set_new(made, metadata[k].key, json_of(metadata[k].text)) != 0) {
            json_decref(made);
            return NULL;
        }
    }
    return made;
}

static json_t *describe_array(const gonio_i_array *array, size_t begin)
{
    const json_int_t end = (json_int_t)begin + (json_int_t)size_of(array);
    json_t *shape = json_array();
    for (int k = 0; k < array->rank; k++) {
        json_array_append_new(shape, json_integer((json_int_t)array->shape[k]));
    }
    if (shape == NULL || json_array_size(shape) != (size_t)array->rank) {
        json_decref(shape);
        return NULL;
    }
    return json_pack("{s:s, s:o, s:[I, I]}", "dtype", types[array->type].name, "shape", shape,
                     "data_offsets", (json_int_t)begin, end);
}

/* The header's JSON, with the arrays in the given order. */
static char *make_header(const gonio_i_metadata *metadata, size_t texts,
                         const gonio_i_array *const *arrays, size_t count)
{
    json_t *header = json_object();
    bool done = json_object_set_new(header, metadata_key, describe_metadata(metadata, texts)) == 0;
    size_t begin = 0;
    for (size_t k = 0; k < count && done; k++) {
        done = json_object_set_new(header, arrays[k]->name, describe_array(arrays[k], begin)) == 0;
        begin += size_of(arrays[k]);
    }
    char *text = done ? json_dumps(header, JSON_COMPACT) : NULL;
    json_decref(header);
    return text;
}

/* Sorts arrays by the size of their numbers, larger first; equals keep their order. */
static void sort_arrays(const gonio_i_array *arrays, size_t count, const gonio_i_array **sorted)
{
    size_t done = 0;
    for (size_t size = 8; size > 0; size /= 2) {
        for (size_t k = 0; k < count; k++) {
            if (types[arrays[k].type].size == size) {
                sorted[done++] = &arrays[k];
            }
        }
    }
}

/* Length and header, padded with spaces so that the arrays begin at a multiple of ALIGNMENT. */
static gonio_status write_header(gonio_context *context, const char *header, gonio_i_output *output)
{
    static const char spaces[ALIGNMENT + 1] =
        "                                                                ";
    const size_t length = strlen(header);
    const size_t filling = (ALIGNMENT - (LENGTH_SIZE + length) % ALIGNMENT) % ALIGNMENT;
    const uint64_t whole = length + filling;
    gonio_status status = gonio_i_output_write(context, output, &whole, sizeof whole);
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, output, header, length);
    }
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, output, spaces, filling);
    }
    return status;
}

/* A large array in parts, between which the work may be stopped. */
static gonio_status write_array(gonio_context *context, const gonio_i_array *array,
                                gonio_i_output *output)
{
    static const size_t most = (size_t)1 << 24;
    const char *data = array->data;
    const size_t size = size_of(array);
    gonio_status status = GONIO_OK;
    for (size_t at = 0; at < size && status == GONIO_OK; at += most) {
        const size_t part = size - at < most ? size - at : most;
        status = gonio_i_output_write(context, output, data + at, part);
        if (status == GONIO_OK && size > most) {
            status = gonio_i_progress(context, "writing", (double)(at + part) / (double)size);
        }
    }
    return status;
}

static gonio_status write_file(gonio_context *context, const char *header,
                               const gonio_i_array *const *arrays, size_t count, const char *path)
{
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(context, path, &output);
    if (status != GONIO_OK) {
        return status;
    }
    status = write_header(context, header, &output);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = write_array(context, arrays[k], &output);
    }
    return gonio_i_output_close(context, &output, status);
}

gonio_status gonio_i_safetensors_write(gonio_context *context, const gonio_i_metadata *metadata,
                                       size_t texts, const gonio_i_array *arrays, size_t count,
                                       const char *path)
{
    const gonio_i_array **sorted = gonio_i_allocate(context, count, sizeof *sorted);
    if (sorted == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    sort_arrays(arrays, count, sorted);
    char *header = make_header(metadata, texts, sorted, count);
    const gonio_status status =
        header != NULL ? write_file(context, header, sorted, count, path)
                       : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    free(header);
    free(sorted);
    return status;
}

/* ---- reading ---- */

struct gonio_i_safetensors {
    gonio_context *context; /* while it is opened */
    const char *path;       /* the same */
    const char *remedy;     /* the same */
    void *map;              /* NULL for a file in the caller's memory */
    size_t size;            /* of the whole file */
    json_t *header;
    gonio_i_array *arrays; /* in the order of their data */
    size_t count;
};

static gonio_status damaged(const gonio_i_safetensors *f, const char *name, const char *problem)
{
    return gonio_i_fail(f->context, GONIO_ERROR_FORMAT, "%s: damaged: '%.64s' %s; %s", f->path,
                        name, problem, f->remedy);
}

static gonio_status no_header(const gonio_i_safetensors *f, const char *problem)
{
    return gonio_i_fail(f->context, GONIO_ERROR_FORMAT, "%s: damaged: the header %s; %s", f->path,
                        problem, f->remedy);
}

/* Reads a JSON array of at most `most` numbers; false if it is something else. */
static bool read_sizes(const json_t *json, size_t most, size_t *sizes, size_t *count)
{
    *count = json_array_size(json);
    if (!json_is_array(json) || *count > most) {
        return false;
    }
    for (size_t k = 0; k < *count; k++) {
        const json_t *number = json_array_get(json, k);
        if (!json_is_integer(number) || json_integer_value(number) < 0) {
            return false;
        }
        sizes[k] = (size_t)json_integer_value(number);
    }
    return true;
}

/* The index in `types`; TYPES if there is none. */
static int read_type(const json_t *json)
{
    const char *name = json_string_value(json);
    int type = 0;
    while (type < TYPES && (name == NULL || strcmp(name, types[type].name) != 0)) {
        type++;
    }
    return type;
}

/* The bytes of an array, checked for overflow. */
static bool multiply(size_t element, const size_t *shape, size_t rank, size_t *size)
{
    *size = element;
    for (size_t k = 0; k < rank; k++) {
        if (__builtin_mul_overflow(*size, shape[k], size)) {
            return false;
        }
    }
    return true;
}

/* Reads one entry of the header and checks it against the bytes data[size] of all arrays. */
static gonio_status read_array(const gonio_i_safetensors *f, const char *name, const json_t *json,
                               const char *data, size_t size, gonio_i_array *array)
{
    size_t offsets[2];
    size_t rank = 0;
    size_t ends = 0;
    if (!json_is_object(json) || json_object_size(json) != 3) {
        return damaged(f, name, "is not a dtype, a shape and data_offsets");
    }
    const int type = read_type(json_object_get(json, "dtype"));
    if (type == TYPES) {
        return damaged(f, name, "has an unknown dtype");
    }
    if (!read_sizes(json_object_get(json, "shape"), GONIO_I_MOST_DIMENSIONS, array->shape, &rank)) {
        return damaged(f, name, "has a shape that is not a list of up to 8 sizes");
    }
    if (!read_sizes(json_object_get(json, "data_offsets"), 2, offsets, &ends) || ends != 2 ||
        offsets[0] > offsets[1] || offsets[1] > size) {
        return damaged(f, name, "has data_offsets that are not in the file, which may be cut off");
    }
    if (!multiply(types[type].size, array->shape, rank, &array->size) ||
        array->size != offsets[1] - offsets[0]) {
        return damaged(f, name, "has a shape that does not fit its data_offsets");
    }
    array->name = name;
    array->type = type < GONIO_I_OTHER_TYPE ? (gonio_i_array_type)type : GONIO_I_OTHER_TYPE;
    array->rank = (int)rank;
    array->data = data + offsets[0];
    return (uintptr_t)array->data % types[type].size == 0 ? GONIO_OK
                                                          : damaged(f, name, "is not aligned");
}

static gonio_status check_metadata(const gonio_i_safetensors *f, json_t *metadata)
{
    const char *key = NULL;
    const json_t *text = NULL;
    if (!json_is_object(metadata)) {
        return damaged(f, metadata_key, "is not an object");
    }
    json_object_foreach(metadata, key, text)
    {
        if (!json_is_string(text)) {
            return damaged(f, key, "in the metadata is not a text");
        }
    }
    return GONIO_OK;
}

static int compare_places(const void *a, const void *b)
{
    const gonio_i_array *x = a;
    const gonio_i_array *y = b;
    const uintptr_t p = (uintptr_t)x->data;
    const uintptr_t q = (uintptr_t)y->data;
    return p != q ? (p > q) - (p < q) : (x->size > y->size) - (x->size < y->size);
}

/* Checks that the arrays follow one another from the first byte to the last. */
static gonio_status check_places(const gonio_i_safetensors *f, const char *data, size_t size)
{
    const char *end = data;
    for (size_t k = 0; k < f->count; k++) {
        if ((const char *)f->arrays[k].data != end) {
            return damaged(f, f->arrays[k].name,
                           (const char *)f->arrays[k].data < end ? "overlaps another array"
                                                                 : "comes after a gap");
        }
        end += f->arrays[k].size;
    }
    return end == data + size ? GONIO_OK : no_header(f, "does not say what the last bytes are");
}

static gonio_status read_arrays(gonio_i_safetensors *f, const char *data, size_t size)
{
    const char *name = NULL;
    json_t *entry = NULL;
    gonio_status status = GONIO_OK;
    f->arrays = gonio_i_allocate(f->context, json_object_size(f->header), sizeof *f->arrays);
    if (f->arrays == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    json_object_foreach(f->header, name, entry)
    {
        status = strcmp(name, metadata_key) == 0
                     ? check_metadata(f, entry)
                     : read_array(f, name, entry, data, size, &f->arrays[f->count++]);
        if (status != GONIO_OK) {
            return status;
        }
    }
    qsort(f->arrays, f->count, sizeof *f->arrays, compare_places);
    return check_places(f, data, size);
}

static gonio_status no_json(const gonio_i_safetensors *f, enum json_error_code code)
{
    switch (code) {
    case json_error_out_of_memory:
        return gonio_i_fail(f->context, GONIO_ERROR_MEMORY, "%s: out of memory", f->path);
    case json_error_duplicate_key:
        return no_header(f, "has a name twice");
    case json_error_stack_overflow:
        return no_header(f, "is nested too deeply");
    default:
        return no_header(f, "is not JSON");
    }
}

static gonio_status read_header(gonio_i_safetensors *f, const char *bytes)
{
    uint64_t length = 0;
    json_error_t error;
    if (f->size <= LENGTH_SIZE || !gonio_i_safetensors_begin(bytes, f->size)) {
        return gonio_i_fail(f->context, GONIO_ERROR_FORMAT, "%s: not a safetensors file; %s",
                            f->path, f->remedy);
    }
    memcpy(&length, bytes, sizeof length);
    if (length > f->size - LENGTH_SIZE) {
        return no_header(f, "is longer than the file, which is cut off");
    }
    f->header = json_loadb(bytes + LENGTH_SIZE, (size_t)length, JSON_REJECT_DUPLICATES, &error);
    if (f->header == NULL) {
        return no_json(f, json_error_code(&error));
    }
    return read_arrays(f, bytes + LENGTH_SIZE + length, f->size - LENGTH_SIZE - (size_t)length);
}

bool gonio_i_safetensors_begin(const void *head, size_t size)
{
    uint64_t length = 0;
    if (size <= LENGTH_SIZE) {
        return false;
    }
    memcpy(&length, head, sizeof length);
    return length >= 2 && length <= LONGEST_HEADER && ((const char *)head)[LENGTH_SIZE] == '{';
}

gonio_status gonio_i_safetensors_parse(gonio_context *context, const char *path, const char *remedy,
                                       const void *bytes, size_t size, gonio_i_safetensors **file)
{
    gonio_i_safetensors *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    *made = (gonio_i_safetensors){.context = context, .path = path, .remedy = remedy, .size = size};
    const gonio_status status = read_header(made, bytes);
    if (status != GONIO_OK) {
        gonio_i_safetensors_close(&made);
        return status;
    }
    *file = made;
    return GONIO_OK;
}

void gonio_i_safetensors_close(gonio_i_safetensors **file)
{
    if (file == NULL || *file == NULL) {
        return;
    }
    if ((*file)->map != NULL) {
        munmap((*file)->map, (*file)->size);
    }
    json_decref((*file)->header);
    free((*file)->arrays);
    free(*file);
    *file = NULL;
}

/* Maps a file; `map` is NULL for an empty one. */
static gonio_status map_file(gonio_context *context, const char *path, void **map, size_t *size)
{
    struct stat about;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool known = descriptor >= 0 && fstat(descriptor, &about) == 0;
    if (known && S_ISDIR(about.st_mode)) {
        errno = EISDIR;
    }
    const bool regular = known && S_ISREG(about.st_mode);
    *map = NULL;
    *size = regular ? (size_t)about.st_size : 0;
    if (*size > 0) {
        *map = mmap(NULL, *size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    }
    const int problem = errno;
    if (descriptor >= 0) {
        close(descriptor);
    }
    if (regular && *map != MAP_FAILED) {
        return GONIO_OK;
    }
    const bool stream = known && !regular && !S_ISDIR(about.st_mode);
    return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path,
                        stream ? "a pipe or a device; give a file" : strerror(problem));
}

gonio_status gonio_i_safetensors_open(gonio_context *context, const char *path, const char *remedy,
                                      gonio_i_safetensors **file)
{
    void *map = NULL;
    size_t size = 0;
    gonio_i_safetensors *made = NULL;
    gonio_status status = map_file(context, path, &map, &size);
    if (status == GONIO_OK) {
        status = gonio_i_safetensors_parse(context, path, remedy, map, size, &made);
    }
    if (status != GONIO_OK) {
        if (map != NULL && map != MAP_FAILED) {
            munmap(map, size);
        }
        return status;
    }
    made->map = map;
    *file = made;
    return GONIO_OK;
}

const gonio_i_array *gonio_i_safetensors_array(const gonio_i_safetensors *file, const char *name)
{
    for (size_t k = 0; k < file->count; k++) {
        if (strcmp(file->arrays[k].name, name) == 0) {
            return &file->arrays[k];
        }
    }
    return NULL;
}

const char *gonio_i_safetensors_text(const gonio_i_safetensors *file, const char *key)
{
    return json_string_value(json_object_get(json_object_get(file->header, metadata_key), key));
}
