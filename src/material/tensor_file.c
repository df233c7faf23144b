/* Reading tensor files: see tensor_file.h. */
#include "tensor_file.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../core/core.h"

static const char magic[GONIO_I_TENSOR_MAGIC] = "tensor_file";

enum {
    MAJOR = 1,
    HEADER = 18,       /* magic, version and number of fields, bytes */
    MOST_FIELDS = 256, /* a material has about ten */
    TYPES = 12
};

/* Bytes of a number of each type. */
static const size_t size_of[TYPES] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

static const char *const type_name[TYPES] = {"",    "u8",  "i8",  "u16", "i16", "u32",
                                             "i32", "u64", "i64", "f16", "f32", "f64"};

size_t gonio_i_tensor_size(gonio_i_tensor_type type)
{
    return size_of[type];
}

void gonio_i_tensor_byte_order(void *values, size_t count, size_t size)
{
#if __BYTE_ORDER == __BIG_ENDIAN
    unsigned char *byte = values;
    for (size_t k = 0; k < count; k++, byte += size) {
        for (size_t low = 0, high = size - 1; low < high; low++, high--) {
            const unsigned char kept = byte[low];
            byte[low] = byte[high];
            byte[high] = kept;
        }
    }
#else
    (void)values;
    (void)count;
    (void)size;
#endif
}

bool gonio_i_tensor_recognises(const unsigned char *head, size_t size)
{
    return size >= sizeof magic && memcmp(head, magic, sizeof magic) == 0;
}

/* ---- reading ---- */

static gonio_status read_bytes(gonio_context *context, const gonio_i_tensor_file *file, void *to,
                               size_t size, uint64_t offset)
{
    if (offset > file->size || size > file->size - offset) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: truncated: %llu bytes, and more are needed; copy it again from "
                            "its source",
                            file->path, (unsigned long long)file->size);
    }
    char *next = to;
    while (size > 0) {
        const ssize_t got = pread(file->descriptor, next, size, (off_t)offset);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", file->path,
                                got < 0 ? strerror(errno) : "the file became shorter");
        }
        next += got;
        offset += (uint64_t)got;
        size -= (size_t)got;
    }
    return GONIO_OK;
}

/* A position in the header; reading moves it forward. */
typedef struct reader {
    gonio_context *context;
    const gonio_i_tensor_file *file;
    uint64_t offset;
} reader;

static gonio_status take(reader *r, void *to, size_t size)
{
    const gonio_status status = read_bytes(r->context, r->file, to, size, r->offset);
    r->offset += size;
    return status;
}

static gonio_status take_u16(reader *r, uint16_t *value)
{
    const gonio_status status = take(r, value, sizeof *value);
    *value = le16toh(*value);
    return status;
}

static gonio_status take_u64(reader *r, uint64_t *value)
{
    const gonio_status status = take(r, value, sizeof *value);
    *value = le64toh(*value);
    return status;
}

/* ---- the table of fields ---- */

static gonio_status damaged(const reader *r, const char *what)
{
    return gonio_i_fail(r->context, GONIO_ERROR_FORMAT, "%s: damaged tensor file: %s at byte %llu",
                        r->file->path, what, (unsigned long long)r->offset);
}

static gonio_status read_name(reader *r, gonio_i_tensor *field)
{
    uint16_t length = 0;
    gonio_status status = take_u16(r, &length);
    if (status == GONIO_OK && (length == 0 || length >= GONIO_I_TENSOR_NAME)) {
        return damaged(r, "a field's name of an impossible length");
    }
    return status == GONIO_OK ? take(r, field->name, length) : status;
}

/* The number of numbers, whose bytes must be countable. */
static bool count_numbers(gonio_i_tensor *field)
{
    uint64_t bytes = 0;
    field->count = 1;
    for (int k = 0; k < field->dimensions; k++) {
        if (__builtin_mul_overflow(field->count, field->shape[k], &field->count)) {
            return false;
        }
    }
    return !__builtin_mul_overflow(field->count, (uint64_t)8, &bytes);
}

static gonio_status read_shape(reader *r, gonio_i_tensor *field)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < field->dimensions && status == GONIO_OK; k++) {
        status = take_u64(r, &field->shape[k]);
    }
    return status == GONIO_OK && !count_numbers(field) ? damaged(r, "a shape that overflows")
                                                       : status;
}

static gonio_status read_field(reader *r, gonio_i_tensor *field)
{
    uint16_t dimensions = 0;
    uint8_t type = 0;
    gonio_status status = read_name(r, field);
    if (status == GONIO_OK) {
        status = take_u16(r, &dimensions);
    }
    if (status == GONIO_OK) {
        status = take(r, &type, sizeof type);
    }
    if (status == GONIO_OK && (type == 0 || type >= TYPES)) {
        return damaged(r, "a type that does not exist");
    }
    if (status == GONIO_OK && dimensions > GONIO_I_TENSOR_DIMENSIONS) {
        return damaged(r, "an array of more than 8 dimensions");
    }
    field->type = type;
    field->dimensions = dimensions;
    if (status == GONIO_OK) {
        status = take_u64(r, &field->offset);
    }
    return status == GONIO_OK ? read_shape(r, field) : status;
}

static gonio_status read_header(gonio_context *context, gonio_i_tensor_file *file)
{
    unsigned char header[HEADER];
    reader r = {context, file, 0};
    gonio_status status = take(&r, header, sizeof header);
    if (status != GONIO_OK) {
        return status;
    }
    uint32_t fields = 0;
    memcpy(&fields, header + HEADER - sizeof fields, sizeof fields);
    fields = le32toh(fields);
    if (!gonio_i_tensor_recognises(header, sizeof header) ||
        header[GONIO_I_TENSOR_MAGIC] != MAJOR) {
        return damaged(&r, "another kind or version");
    }
    if (fields == 0 || fields > MOST_FIELDS) {
        return damaged(&r, "an impossible number of fields");
    }
    file->field = gonio_i_allocate(context, fields, sizeof *file->field);
    if (file->field == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (file->fields = 0; file->fields < fields && status == GONIO_OK; file->fields++) {
        status = read_field(&r, &file->field[file->fields]);
    }
    return status;
}

gonio_status gonio_i_tensor_open(gonio_context *context, const char *path,
                                 gonio_i_tensor_file *file)
{
    struct stat about;
    *file =
        (gonio_i_tensor_file){.path = strdup(path), .descriptor = open(path, O_RDONLY | O_CLOEXEC)};
    gonio_status status = GONIO_OK;
    if (file->path == NULL) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    } else if (file->descriptor < 0 || fstat(file->descriptor, &about) != 0) {
        status =
            gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: %s", path, strerror(errno));
    } else {
        file->size = (uint64_t)about.st_size;
        status = read_header(context, file);
    }
    if (status != GONIO_OK) {
        gonio_i_tensor_close(file);
    }
    return status;
}

void gonio_i_tensor_close(gonio_i_tensor_file *file)
{
    if (file->descriptor >= 0) {
        close(file->descriptor);
    }
    free(file->path);
    free(file->field);
    *file = (gonio_i_tensor_file){.descriptor = -1};
}

/* ---- fields ---- */

const gonio_i_tensor *gonio_i_tensor_find(const gonio_i_tensor_file *file, const char *name)
{
    for (size_t k = 0; k < file->fields; k++) {
        if (strcmp(file->field[k].name, name) == 0) {
            return &file->field[k];
        }
    }
    return NULL;
}

gonio_status gonio_i_tensor_expect(gonio_context *context, const gonio_i_tensor_file *file,
                                   const char *name, gonio_i_tensor_type type, int dimensions,
                                   const gonio_i_tensor **field)
{
    const gonio_i_tensor *found = gonio_i_tensor_find(file, name);
    if (found == NULL || found->type != type || found->dimensions != dimensions ||
        found->count == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: the field '%s' is %s; %s of %d dimension%s is needed", file->path,
                            name, found == NULL ? "missing" : "of another type or shape",
                            type_name[type], dimensions, dimensions == 1 ? "" : "s");
    }
    if (found->offset > file->size || found->count * size_of[type] > file->size - found->offset) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: truncated: the field '%s' goes on beyond the end of the file; "
                            "copy it again from its source",
                            file->path, name);
    }
    *field = found;
    return GONIO_OK;
}

gonio_status gonio_i_tensor_read(gonio_context *context, const gonio_i_tensor_file *file,
                                 const gonio_i_tensor *field, uint64_t first, size_t count,
                                 void *values)
{
    const size_t size = size_of[field->type];
    if (first > field->count || count > field->count - first) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: the field '%s' has fewer numbers",
                            file->path, field->name);
    }
    uint64_t offset = 0;
    if (__builtin_add_overflow(field->offset, first * size, &offset)) {
        offset = UINT64_MAX;
    }
    const gonio_status status = read_bytes(context, file, values, count * size, offset);
    if (status == GONIO_OK) {
        gonio_i_tensor_byte_order(values, count, size);
    }
    return status;
}

gonio_status gonio_i_tensor_floats(gonio_context *context, const gonio_i_tensor_file *file,
                                   const gonio_i_tensor *field, float **values)
{
    float *read = gonio_i_allocate(context, field->count, sizeof *read);
    if (read == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = gonio_i_tensor_read(context, file, field, 0, field->count, read);
    for (size_t k = 0; k < field->count && status == GONIO_OK; k++) {
        if (!isfinite(read[k])) {
            status = gonio_i_fail(context, GONIO_ERROR_FORMAT,
                                  "%s: number %zu of the field '%s' is not finite", file->path, k,
                                  field->name);
        }
    }
    if (status != GONIO_OK) {
        free(read);
        return status;
    }
    *values = read;
    return GONIO_OK;
}
