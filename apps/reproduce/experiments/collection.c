/* The materials that experiments run on: see collection.h. */
#include "collection.h"
#include "core/memory_stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- reading a material and its faults ---- */

typedef struct candidate {
    gonio_i_digest *digest;
    char *fault; /* NULL if it can be used */
} candidate;

/* Keeps the first error. */
static void keep_error(void *user, gonio_message_level level, const char *text)
{
    candidate *c = user;
    if (level == GONIO_MESSAGE_ERROR && c->fault == NULL) {
        c->fault = strdup(text);
    }
}

static gonio_status open_and_digest(gonio_context *context, const char *path, candidate *c)
{
    gonio_material *material = NULL;
    gonio_status status = gonio_material_open(context, path, &material);
    if (status == GONIO_OK) {
        status = gonio_i_digest_create(context, material, &c->digest);
    }
    gonio_material_free(&material);
    return status;
}

/* Reads a material. One that cannot be used is not an error here. */
static gonio_status read_candidate(const char *path, candidate *c)
{
    const gonio_context_options options = {
        .size = sizeof options, .message = keep_error, .user = c, .threads = 1};
    gonio_context *context = NULL;
    gonio_status status = gonio_context_create(&context, &options);
    if (status == GONIO_OK) {
        status = open_and_digest(context, path, c);
    }
    gonio_context_free(&context);
    if (status != GONIO_OK && c->fault == NULL) {
        c->fault = gonio_i_format("%s: %s", path, gonio_status_text(status));
    }
    return status == GONIO_ERROR_MEMORY ? status : GONIO_OK;
}

static gonio_status read_candidates(gonio_context *context, const char *const *paths, size_t count,
                                    candidate *candidates)
{
    gonio_status result = GONIO_OK;
    size_t done = 0;
#pragma omp parallel for schedule(dynamic, 1) num_threads(gonio_context_threads(context))
    for (size_t k = 0; k < count; k++) {
        gonio_status so_far;
#pragma omp atomic read
        so_far = result;
        if (so_far != GONIO_OK) {
            continue;
        }
        gonio_status mine = read_candidate(paths[k], &candidates[k]);
        if (mine == GONIO_OK) {
#pragma omp critical(gonio_collection)
            mine = gonio_i_progress(context, "reading materials", (double)++done / (double)count);
        }
        if (mine != GONIO_OK) {
#pragma omp atomic write
            result = mine;
        }
    }
    return result;
}

/* ---- refusing materials ---- */

static void find_twin(const char *const *paths, candidate *candidates, size_t index)
{
    candidate *c = &candidates[index];
    for (size_t k = 0; k < index && c->fault == NULL; k++) {
        const gonio_i_digest *other = candidates[k].fault == NULL ? candidates[k].digest : NULL;
        if (other != NULL && strcmp(other->name, c->digest->name) == 0) {
            c->fault = gonio_i_format("%s: there is another material of this name, %s",
                                      paths[index], paths[k]);
        } else if (other != NULL && other->fingerprint == c->digest->fingerprint) {
            c->fault = gonio_i_format("%s: has the same values as %s", paths[index], paths[k]);
        }
    }
}

static size_t count_faults(const candidate *candidates, size_t count)
{
    size_t faults = 0;
    for (size_t k = 0; k < count; k++) {
        faults += candidates[k].fault != NULL;
    }
    return faults;
}

/* Refuses the materials with faults, all in one message. */
static gonio_status refuse(gonio_context *context, const candidate *candidates, size_t count,
                           size_t faults)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    for (size_t k = 0; k < count; k++) {
        if (candidates[k].fault != NULL) {
            fprintf(stream, "; %s", candidates[k].fault);
        }
    }
    const gonio_status status =
        fclose(stream) != 0
            ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory")
            : gonio_i_fail(context, GONIO_ERROR_DATA,
                           "%zu of %zu materials cannot be used (--skip-bad leaves them out)%s",
                           faults, count, text);
    free(text);
    return status;
}

static gonio_status judge(gonio_context *context, const char *const *paths, size_t count,
                          bool skip_bad, candidate *candidates)
{
    for (size_t k = 0; k < count; k++) {
        if (candidates[k].fault == NULL) {
            find_twin(paths, candidates, k);
        }
    }
    const size_t faults = count_faults(candidates, count);
    if (faults > 0 && !skip_bad) {
        return refuse(context, candidates, count, faults);
    }
    for (size_t k = 0; k < count; k++) {
        if (candidates[k].fault != NULL) {
            gonio_i_warn(context, "left out: %s", candidates[k].fault);
        }
    }
    return GONIO_OK;
}

/* ---- the collection ---- */

/* Moves the materials without faults into the collection. */
static gonio_status take(gonio_context *context, const char *const *paths, size_t count,
                         candidate *candidates, gonio_i_collection *c)
{
    c->path = gonio_i_allocate(context, count, sizeof(char *));
    c->digest = gonio_i_allocate(context, count, sizeof(gonio_i_digest *));
    c->mean = gonio_i_allocate(context, count, sizeof(double *));
    c->cache = gonio_i_allocate(context, 1, sizeof *c->cache);
    if (c->path == NULL || c->digest == NULL || c->mean == NULL || c->cache == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        if (candidates[k].fault != NULL) {
            continue;
        }
        const size_t at = c->count++;
        c->digest[at] = candidates[k].digest;
        candidates[k].digest = NULL;
        c->path[at] = strdup(paths[k]);
        c->mean[at] =
            gonio_i_allocate(context, (size_t)GONIO_CELLS * GONIO_CHANNELS, sizeof *c->mean[at]);
        if (c->path[at] == NULL || c->mean[at] == NULL) {
            return GONIO_ERROR_MEMORY;
        }
        gonio_i_digest_mean(c->digest[at], c->mean[at]);
    }
    return GONIO_OK;
}

gonio_status gonio_i_collect(gonio_context *context, const char *const *paths, size_t count,
                             bool skip_bad, gonio_i_collection *collection)
{
    const gonio_database_options papers = {
        .size = sizeof papers, .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT};
    *collection = (gonio_i_collection){0};
    candidate *candidates = gonio_i_allocate(context, count, sizeof *candidates);
    if (candidates == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = read_candidates(context, paths, count, candidates);
    if (status == GONIO_OK) {
        status = judge(context, paths, count, skip_bad, candidates);
    }
    if (status == GONIO_OK) {
        status = take(context, paths, count, candidates, collection);
    }
    if (status == GONIO_OK) {
        status = gonio_database_create(context, (const char *const *)collection->path,
                                       collection->count, &papers, &collection->database);
    }
    for (size_t k = 0; k < count; k++) {
        gonio_i_digest_free(&candidates[k].digest);
        free(candidates[k].fault);
    }
    free(candidates);
    return status;
}

void gonio_i_collection_free(gonio_i_collection *collection)
{
    for (size_t k = 0; k < collection->count; k++) {
        gonio_i_digest_free(&collection->digest[k]);
        free(collection->mean[k]);
        free(collection->path[k]);
    }
    if (collection->cache != NULL) {
        gonio_i_basis_cache_clear(collection->cache);
    }
    free(collection->cache);
    gonio_database_free(&collection->database);
    free(collection->digest);
    free(collection->mean);
    free(collection->path);
    *collection = (gonio_i_collection){0};
}

size_t gonio_i_find_material(const gonio_i_collection *collection, const char *name)
{
    size_t k = 0;
    while (k < collection->count && strcmp(gonio_i_name_of(collection, k), name) != 0) {
        k++;
    }
    return k;
}
