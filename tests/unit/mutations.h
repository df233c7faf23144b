/* Copies of a material's file cut short and with bytes changed at random. */
#ifndef MUTATIONS_H
#define MUTATIONS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gonio/material.h>

#include "core/random.h"

static inline void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static inline unsigned char *read_bytes(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    *size = (size_t)ftell(stream);
    rewind(stream);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, stream), *size);
    assert_int_equal(fclose(stream), 0);
    return bytes;
}

/* Copies of a file cut short, and with bytes changed at random, are refused or read, and what is
 * read can be evaluated. */
static inline void check_mutations(const char *path, const char *folder)
{
    enum { TIMES = 60 };
    char mutated[4096];
    size_t size = 0;
    unsigned char *bytes = read_bytes(path, &size);
    gonio_i_random random;
    gonio_i_random_seed(&random, 5, 0);
    snprintf(mutated, sizeof mutated, "%s/mutated", folder);
    for (int k = 0; k < TIMES; k++) {
        unsigned char *copy = malloc(size);
        assert_non_null(copy);
        memcpy(copy, bytes, size);
        const size_t most = size < 600 ? size : 600;
        for (int n = 0; n < 1 + k % 4; n++) {
            copy[gonio_i_random_below(&random, k % 2 ? most : size)] =
                (unsigned char)gonio_i_random_below(&random, 256);
        }
        write_bytes(mutated, copy, k % 3 == 0 ? gonio_i_random_below(&random, size) : size);
        free(copy);
        gonio_material *material = NULL;
        if (gonio_material_open(NULL, mutated, &material) == GONIO_OK) {
            const gonio_pair pair = {{0.3, 0.1}, {0.7, 2.0}};
            const size_t channels = gonio_material_describe(material)->channels;
            double *values = calloc(channels, sizeof *values);
            assert_int_equal(gonio_material_evaluate(NULL, material, &pair, 1, values), GONIO_OK);
            free(values);
            gonio_material_free(&material);
        }
    }
    free(bytes);
}

#endif
