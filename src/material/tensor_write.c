/* Writing tensor files: see tensor_write.h. */
#include "tensor_write.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

#include "../core/output.h"

enum { HEADER = 18, ALIGNMENT = 8, MOST_HEADER = 4096 };

static uint64_t aligned(uint64_t offset)
{
    return (offset + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

static uint64_t bytes_of(const gonio_i_tensor_field *field)
{
    uint64_t bytes = gonio_i_tensor_size(field->type);
    for (int k = 0; k < field->dimensions; k++) {
        bytes *= field->shape[k];
    }
    return bytes;
}

/* The bytes of a field's entry in the table of fields. */
static uint64_t entry_size(const gonio_i_tensor_field *field)
{
    return 2 + strlen(field->name) + 2 + 1 + 8 + 8 * (uint64_t)field->dimensions;
}

static unsigned char *put(unsigned char *to, const void *data, size_t size)
{
    memcpy(to, data, size);
    return to + size;
}

static unsigned char *put_u16(unsigned char *to, uint16_t value)
{
    value = htole16(value);
    return put(to, &value, sizeof value);
}

static unsigned char *put_u64(unsigned char *to, uint64_t value)
{
    value = htole64(value);
    return put(to, &value, sizeof value);
}

static unsigned char *put_entry(unsigned char *to, const gonio_i_tensor_field *field,
                                uint64_t offset)
{
    const uint8_t type = (uint8_t)field->type;
    to = put_u16(to, (uint16_t)strlen(field->name));
    to = put(to, field->name, strlen(field->name));
    to = put_u16(to, (uint16_t)field->dimensions);
    to = put(to, &type, sizeof type);
    to = put_u64(to, offset);
    for (int k = 0; k < field->dimensions; k++) {
        to = put_u64(to, field->shape[k]);
    }
    return to;
}

/* Fills in the header, and the offset of each field's numbers. */
static void lay_out(const gonio_i_tensor_field *fields, size_t count, unsigned char *header,
                    uint64_t *offset)
{
    const unsigned char version[2] = {1, 0};
    const uint32_t entries = htole32((uint32_t)count);
    uint64_t next = HEADER;
    for (size_t k = 0; k < count; k++) {
        next += entry_size(&fields[k]);
    }
    unsigned char *to = put(header, "tensor_file", GONIO_I_TENSOR_MAGIC);
    to = put(to, version, sizeof version);
    to = put(to, &entries, sizeof entries);
    for (size_t k = 0; k < count; k++) {
        offset[k] = aligned(next);
        next = offset[k] + bytes_of(&fields[k]);
        to = put_entry(to, &fields[k], offset[k]);
    }
    offset[count] = next;
}

static gonio_status write_data(gonio_context *context, gonio_i_output *output,
                               const gonio_i_tensor_field *field, uint64_t offset)
{
    const size_t bytes = bytes_of(field);
    const size_t size = gonio_i_tensor_size(field->type);
    void *copy = gonio_i_allocate(context, bytes, 1);
    if (copy == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(copy, field->data, bytes);
    gonio_i_tensor_byte_order(copy, bytes / size, size);
    const gonio_status status =
        gonio_i_output_write_at(context, output, copy, bytes, (off_t)offset);
    free(copy);
    return status;
}

gonio_status gonio_i_tensor_write(gonio_context *context, const char *path,
                                  const gonio_i_tensor_field *fields, size_t count)
{
    unsigned char header[MOST_HEADER] = {0};
    uint64_t offset[MOST_HEADER / 32];
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(context, path, &output);
    lay_out(fields, count, header, offset);
    if (status == GONIO_OK) {
        status = gonio_i_output_reserve(context, &output, (off_t)offset[count]);
    }
    if (status == GONIO_OK) {
        status = gonio_i_output_write_at(context, &output, header, offset[0], 0);
    }
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        status = write_data(context, &output, &fields[k], offset[k]);
    }
    return gonio_i_output_close(context, &output, status);
}
