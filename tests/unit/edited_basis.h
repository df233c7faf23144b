/* A basis file changed by hand: its header's text, its arrays' values, its checksums made right
 * again, as a liar would. */
#ifndef EDITED_BASIS_H
#define EDITED_BASIS_H

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

#include "core/safetensors.h"

typedef struct edited {
    char *bytes; /* aligned as a mapped file is */
    size_t size;
} edited;

static inline size_t edited_data(const edited *e)
{
    uint64_t length = 0;
    memcpy(&length, e->bytes, sizeof length);
    return 8 + (size_t)length;
}

static inline edited edited_load(const char *path)
{
    edited e = {0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    e.size = (size_t)ftell(file);
    rewind(file);
    e.bytes = aligned_alloc(64, (e.size + 64) / 64 * 64);
    assert_non_null(e.bytes);
    assert_int_equal(fread(e.bytes, 1, e.size, file), e.size);
    fclose(file);
    return e;
}

static inline void edited_save(edited *e, const char *path)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(e->bytes, 1, e->size, file), e->size);
    assert_int_equal(fclose(file), 0);
    free(e->bytes);
}

/* Replaces a text of the header by another one, of any length. */
static inline void edited_header(edited *e, const char *from, const char *to)
{
    const size_t data = edited_data(e);
    char *found = memmem(e->bytes + 8, data - 8, from, strlen(from));
    if (found == NULL) {
        fail_msg("%s is not in the header", from);
    }
    const size_t before = (size_t)(found - e->bytes);
    const size_t after = data - before - strlen(from);
    const size_t end = (before + strlen(to) + after + 63) / 64 * 64;
    char *bytes = aligned_alloc(64, (end + e->size - data + 64) / 64 * 64);
    assert_non_null(bytes);
    memset(bytes, ' ', end);
    memcpy(bytes, e->bytes, before);
    memcpy(bytes + before, to, strlen(to));
    memcpy(bytes + before + strlen(to), found + strlen(from), after);
    memcpy(bytes + end, e->bytes + data, e->size - data);
    const uint64_t length = end - 8;
    memcpy(bytes, &length, sizeof length);
    free(e->bytes);
    *e = (edited){bytes, end + e->size - data};
}

/* The values of an array, to be changed in place, and their bytes; NULL if there is none. */
static inline void *edited_array(const edited *e, const char *name, size_t *size)
{
    gonio_i_safetensors *file = NULL;
    char *data = NULL;
    assert_int_equal(gonio_i_safetensors_parse(NULL, "", "", e->bytes, e->size, &file), GONIO_OK);
    const gonio_i_array *array = gonio_i_safetensors_array(file, name);
    if (array != NULL) {
        data = e->bytes + ((const char *)array->data - e->bytes);
        *size = array->size;
    }
    gonio_i_safetensors_close(&file);
    return data;
}

/* Makes the checksums of all arrays right. */
static inline void edited_seal(edited *e)
{
    static const char *const names[] = {
        "log_scale", "mean",           "variances", "material_fingerprints", "components",
        "cell",      "material_names", "loadings",  "mixture_parents"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char key[64], text[20];
        size_t size = 0;
        const void *data = edited_array(e, names[k], &size);
        snprintf(key, sizeof key, "\"xxh3.%s\":\"", names[k]);
        char *place = memmem(e->bytes, edited_data(e), key, strlen(key));
        if (data == NULL || place == NULL) {
            continue;
        }
        gonio_fingerprint *hash = NULL;
        assert_int_equal(gonio_fingerprint_create(&hash), GONIO_OK);
        gonio_fingerprint_add(hash, data, size);
        snprintf(text, sizeof text, "%016" PRIx64, gonio_fingerprint_value(hash));
        memcpy(place + strlen(key), text, 16);
        gonio_fingerprint_free(&hash);
    }
}

#endif
