/* Splits of the materials: see splits.h. */
#include "splits.h"

#include <stdlib.h>

#include "core/random.h"

void gonio_i_splits_free(gonio_i_splits *splits)
{
    for (size_t s = 0; s < splits->count; s++) {
        free(splits->split[s].basis);
        free(splits->split[s].test);
    }
    free(splits->split);
    *splits = (gonio_i_splits){0};
}

static gonio_status allocate(gonio_context *context, size_t count, gonio_i_splits *splits)
{
    *splits = (gonio_i_splits){0};
    splits->split = gonio_i_allocate(context, count, sizeof *splits->split);
    splits->count = splits->split != NULL ? count : 0;
    return splits->split != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status allocate_split(gonio_context *context, size_t basis, size_t test,
                                   gonio_i_split *split)
{
    *split = (gonio_i_split){.basis_count = basis, .test_count = test};
    split->basis = gonio_i_allocate(context, basis, sizeof *split->basis);
    split->test = gonio_i_allocate(context, test, sizeof *split->test);
    return split->basis != NULL && split->test != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* ---- random ---- */

static void fill_split(size_t materials, gonio_i_random *random, unsigned char *used,
                       gonio_i_split *split)
{
    size_t test = 0;
    size_t basis = 0;
    gonio_i_random_subset(random, materials, split->test_count, used, split->test);
    for (size_t k = 0; k < materials; k++) {
        if (test < split->test_count && split->test[test] == k) {
            test++;
        } else {
            split->basis[basis++] = k;
        }
    }
}

gonio_status gonio_i_splits_make(gonio_context *context, const gonio_i_collection *collection,
                                 size_t count, uint64_t seed, gonio_i_splits *splits)
{
    const size_t materials = collection->count;
    const size_t basis = (4 * materials + 2) / 5;
    gonio_status status = allocate(context, count, splits);
    if (status == GONIO_OK && (basis < GONIO_I_LEAST_BASIS || basis == materials)) {
        status = gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                              "%zu materials are too few to learn from some and test on others: at "
                              "least 4 are needed",
                              materials);
    }
    for (size_t s = 0; s < count && status == GONIO_OK; s++) {
        unsigned char *used = gonio_i_allocate(context, materials, 1);
        gonio_i_random random;
        gonio_i_random_seed(&random, seed, s);
        status = used != NULL ? allocate_split(context, basis, materials - basis, &splits->split[s])
                              : GONIO_ERROR_MEMORY;
        if (status == GONIO_OK) {
            fill_split(materials, &random, used, &splits->split[s]);
        }
        free(used);
    }
    return status;
}

/* ---- from a file ---- */

typedef struct reader {
    gonio_context *context;
    const gonio_i_collection *collection;
    const char *path;
    size_t split;        /* which one is being read */
    unsigned char *used; /* [materials] in it */
} reader;

static gonio_status read_names(const reader *r, const json_t *names, size_t *materials)
{
    for (size_t k = 0; k < json_array_size(names); k++) {
        const char *name = json_string_value(json_array_get(names, k));
        const size_t m = name != NULL ? gonio_i_find_material(r->collection, name) : 0;
        if (name == NULL) {
            return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                "%s: split %zu: a material's name must be a string", r->path,
                                r->split);
        }
        if (m == r->collection->count) {
            return gonio_i_fail(r->context, GONIO_ERROR_DATA,
                                "%s: split %zu: no material is called '%s'", r->path, r->split,
                                name);
        }
        if (r->used[m]++ != 0) {
            return gonio_i_fail(r->context, GONIO_ERROR_DATA, "%s: split %zu: '%s' is named twice",
                                r->path, r->split, name);
        }
        materials[k] = m;
    }
    return GONIO_OK;
}

static gonio_status read_split(const reader *r, const json_t *json, gonio_i_split *split)
{
    const json_t *basis = json_object_get(json, "basis");
    const json_t *test = json_object_get(json, "test");
    if (!json_is_array(basis) || !json_is_array(test)) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: split %zu must have arrays 'basis' and 'test' of names", r->path,
                            r->split);
    }
    if (json_array_size(basis) < GONIO_I_LEAST_BASIS || json_array_size(test) == 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_DATA,
                            "%s: split %zu has %zu materials to learn from and %zu to test on; at "
                            "least %d and 1 are needed",
                            r->path, r->split, json_array_size(basis), json_array_size(test),
                            GONIO_I_LEAST_BASIS);
    }
    gonio_status status =
        allocate_split(r->context, json_array_size(basis), json_array_size(test), split);
    if (status == GONIO_OK) {
        status = read_names(r, basis, split->basis);
    }
    return status == GONIO_OK ? read_names(r, test, split->test) : status;
}

static gonio_status read_splits(reader *r, const json_t *list, gonio_i_splits *splits)
{
    const size_t count = json_array_size(list);
    if (count == 0) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT, "%s: holds no array 'splits'", r->path);
    }
    gonio_status status = allocate(r->context, count, splits);
    for (size_t s = 0; s < count && status == GONIO_OK; s++) {
        r->split = s + 1;
        r->used = gonio_i_allocate(r->context, r->collection->count, 1);
        status = r->used != NULL ? read_split(r, json_array_get(list, s), &splits->split[s])
                                 : GONIO_ERROR_MEMORY;
        free(r->used);
    }
    return status;
}

gonio_status gonio_i_splits_read(gonio_context *context, const gonio_i_collection *collection,
                                 const char *path, gonio_i_splits *splits)
{
    *splits = (gonio_i_splits){0};
    json_error_t error;
    json_t *file = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (file == NULL) {
        return error.line < 0 ? gonio_i_fail(context, GONIO_ERROR_IO, "%s: %s", path, error.text)
                              : gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s:%d: not JSON: %s",
                                             path, error.line, error.text);
    }
    reader r = {.context = context, .collection = collection, .path = path};
    const gonio_status status = read_splits(&r, json_object_get(file, "splits"), splits);
    json_decref(file);
    return status;
}

/* ---- as JSON ---- */

static json_t *names_of(const gonio_i_collection *collection, const size_t *materials, size_t count)
{
    json_t *names = json_array();
    for (size_t k = 0; k < count; k++) {
        json_array_append_new(names, json_string(gonio_i_name_of(collection, materials[k])));
    }
    return names;
}

json_t *gonio_i_splits_json(const gonio_i_collection *collection, const gonio_i_splits *splits)
{
    json_t *list = json_array();
    for (size_t s = 0; s < splits->count; s++) {
        const gonio_i_split *split = &splits->split[s];
        json_array_append_new(
            list,
            json_pack("{s:o, s:o}", "basis", names_of(collection, split->basis, split->basis_count),
                      "test", names_of(collection, split->test, split->test_count)));
    }
    return list;
}
