/* Long work in pieces that are kept: see checkpoint.h. */
#include "checkpoint.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <xxhash.h>

#include "run_folder.h"

struct gonio_i_checkpoint {
    process_group group;
    char *folder; /* of the pieces */
    char run[17]; /* the identity's hash */
    int lock;     /* of rank 0; -1 for none */
};

/* The format of results. 17 digits represent a double exactly. */
enum { EXACT = JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(17) };

static void put_hash(char hash[17], const char *text)
{
    snprintf(hash, 17, "%016" PRIx64, (uint64_t)XXH3_64bits(text, strlen(text)));
}

typedef struct job {
    size_t piece;
    char *name;
    double cost;
    bool one_at_a_time;
    bool begun;
} job;

/* ---- a piece's file ---- */

static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";

/* Whether a name can be a file's everywhere. Other names get a hash, so that they stay different.
 */
static bool is_plain(const char *name)
{
    const size_t length = strlen(name);
    return length > 0 && length <= 100 && name[0] != '.' && strspn(name, plain) == length;
}

static char *path_of(const gonio_i_checkpoint *checkpoint, const char *name)
{
    if (is_plain(name)) {
        return gonio_i_format("%s/%s.json", checkpoint->folder, name);
    }
    char hash[17];
    char readable[61];
    snprintf(readable, sizeof readable, "%s", name);
    for (char *c = readable; *c != '\0'; c++) {
        *c = *c == '.' || strchr(plain, *c) == NULL ? '_' : *c;
    }
    put_hash(hash, name);
    return gonio_i_format("%s/%s-%s.json", checkpoint->folder, readable, hash);
}

/* The content of a piece's file; NULL when out of memory or for text that is not UTF-8. */
static char *text_of(const gonio_i_checkpoint *checkpoint, const char *name, const json_t *result)
{
    char checksum[17];
    char *dump = json_dumps(result, EXACT);
    if (dump == NULL) {
        return NULL;
    }
    put_hash(checksum, dump);
    json_t *whole = json_pack("{s:s, s:s, s:s, s:O}", "piece", name, "run", checkpoint->run,
                              "checksum", checksum, "result", result);
    free(dump);
    dump = json_dumps(whole, EXACT);
    json_decref(whole);
    char *line = dump != NULL ? gonio_i_format("%s\n", dump) : NULL;
    free(dump);
    return line;
}

static gonio_status write_piece(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                                const char *name, const json_t *result)
{
    char *path = path_of(checkpoint, name);
    char *text = path != NULL ? text_of(checkpoint, name, result) : NULL;
    const gonio_status status =
        text != NULL ? gonio_i_write_text(context, path, text)
                     : gonio_i_fail(context, GONIO_ERROR_MEMORY,
                                    "%s: the result cannot be kept: its name is not UTF-8, or out "
                                    "of memory",
                                    name);
    free(text);
    free(path);
    return status;
}

/* The result in a file of `length` bytes, if the file has exactly the bytes that would be written
 * for the result; otherwise NULL. */
static json_t *believe(const gonio_i_checkpoint *checkpoint, const char *name, const char *text,
                       size_t length)
{
    json_t *whole = json_loadb(text, length, JSON_REJECT_DUPLICATES, NULL);
    json_t *result = json_incref(json_object_get(whole, "result"));
    char *expected = result != NULL ? text_of(checkpoint, name, result) : NULL;
    if (expected == NULL || strlen(expected) != length || memcmp(expected, text, length) != 0) {
        json_decref(result);
        result = NULL;
    }
    free(expected);
    json_decref(whole);
    return result;
}

/* The result in a piece's file; NULL, with a warning, if the file is damaged or another's. */
static json_t *read_result(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                           const char *name, const char *path, FILE *file)
{
    char *text = NULL;
    size_t room = 0;
    const ssize_t length = getdelim(&text, &room, '\0', file); /* all of it */
    json_t *result = length > 0 ? believe(checkpoint, name, text, (size_t)length) : NULL;
    free(text);
    if (result == NULL) {
        gonio_i_warn(context, "%s: damaged, or of another run; it is computed again", path);
    }
    return result;
}

/* Checks a result, because anybody can write one with a right checksum. Releases a refused result.
 */
static gonio_status accept(gonio_context *context, const gonio_i_work *work, size_t piece,
                           const char *path, json_t **result)
{
    char complaint[GONIO_I_COMPLAINT] = "";
    if (*result == NULL || work->accept == NULL ||
        work->accept(work->user, piece, *result, complaint)) {
        return GONIO_OK;
    }
    json_decref(*result);
    *result = NULL;
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: %s: gonio has not written this. Delete the file, and it is computed "
                        "again",
                        path, complaint);
}

/* A finished piece's result; NULL if it is not finished. Errors: _FORMAT, _MEMORY. */
static gonio_status read_piece(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                               const gonio_i_work *work, const job *j, json_t **result)
{
    *result = NULL;
    char *path = path_of(checkpoint, j->name);
    if (path == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", j->name);
    }
    FILE *file = fopen(path, "rbe");
    if (file != NULL) {
        *result = read_result(context, checkpoint, j->name, path, file);
        fclose(file);
    }
    const gonio_status status = accept(context, work, j->piece, path, result);
    free(path);
    return status;
}

/* ---- the pieces to do ---- */

typedef struct run {
    gonio_context *context;
    const gonio_i_checkpoint *checkpoint;
    const gonio_i_work *work;
    job *job; /* [work->count], the expensive ones first */
    job **todo;
    size_t count;      /* of todo */
    double cost, done; /* of todo: of all pieces, of the finished ones */
    bool occupied;     /* by a piece of which there is one at a time */
    gonio_status status;
} run;

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const job *)a)->name, ((const job *)b)->name);
}

static int compare_costs(const void *a, const void *b)
{
    const job *p = a;
    const job *q = b;
    if (p->cost != q->cost) {
        return p->cost > q->cost ? -1 : 1;
    }
    return p->piece < q->piece ? -1 : p->piece > q->piece;
}

static gonio_status list_jobs(run *r)
{
    const gonio_i_work *work = r->work;
    for (size_t k = 0; k < work->count; k++) {
        r->job[k] = (job){k, work->name(work->user, k),
                          work->cost != NULL ? work->cost(work->user, k) : 1.0,
                          work->one_at_a_time != NULL && work->one_at_a_time(work->user, k), false};
        if (r->job[k].name == NULL) {
            return gonio_i_fail(r->context, GONIO_ERROR_MEMORY, "%s: out of memory", work->title);
        }
    }
    qsort(r->job, work->count, sizeof *r->job, compare_names);
    for (size_t k = 1; k < work->count; k++) {
        if (compare_names(&r->job[k - 1], &r->job[k]) == 0) {
            return gonio_i_fail(r->context, GONIO_ERROR_ARGUMENT,
                                "%s: two computations are called '%s'", work->title,
                                r->job[k].name);
        }
    }
    qsort(r->job, work->count, sizeof *r->job, compare_costs);
    return GONIO_OK;
}

/* Gives each piece, the expensive ones first, to the rank with the least to do (Graham 1969). Every
 * rank computes all shares. Lists the pieces of this rank. */
static gonio_status share_out(run *r)
{
    const process_group *group = &r->checkpoint->group;
    double *load = gonio_i_allocate(r->context, (size_t)group->size, sizeof *load);
    if (load == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < r->work->count; k++) {
        int least = 0;
        for (int rank = 1; rank < group->size; rank++) {
            least = load[rank] < load[least] ? rank : least;
        }
        load[least] += r->job[k].cost;
        if (least == group->rank) {
            r->todo[r->count++] = &r->job[k];
        }
    }
    free(load);
    return GONIO_OK;
}

/* Drops finished pieces from the list. Errors: those of read_piece. */
static gonio_status drop_finished(run *r)
{
    size_t left = 0;
    for (size_t k = 0; k < r->count; k++) {
        json_t *result = NULL;
        const gonio_status status =
            read_piece(r->context, r->checkpoint, r->work, r->todo[k], &result);
        if (status != GONIO_OK) {
            return status;
        }
        if (result == NULL) {
            r->cost += r->todo[k]->cost;
            r->todo[left++] = r->todo[k];
        }
        json_decref(result);
    }
    if (left < r->count && left > 0 && r->checkpoint->group.rank == 0) {
        gonio_i_note(r->context, "%s: resuming, %zu of %zu computations are finished",
                     r->work->title, r->count - left, r->count);
    }
    r->count = left;
    return GONIO_OK;
}

/* ---- doing the pieces ---- */

static gonio_status do_job(const run *r, gonio_context *shared, const job *j)
{
    gonio_context *context = NULL;
    json_t *result = NULL;
    gonio_status status = gonio_i_piece_begin(shared, j->name, &context);
    if (status != GONIO_OK) {
        return status;
    }
    status = r->work->compute(r->work->user, context, j->piece, &result);
    if (status == GONIO_OK) {
        status = write_piece(context, r->checkpoint, j->name, result);
    }
    json_decref(result);
    gonio_i_piece_end(context);
    return status;
}

/* Reports the share of the cost that is done. 1 is reported only when all ranks have finished. */
static gonio_status tell(run *r, gonio_context *shared)
{
    return gonio_i_progress(shared, r->work->title, 0.999 * r->done / r->cost);
}

static void note_end(run *r, gonio_context *shared, const job *j, gonio_status status)
{
#pragma omp critical(gonio_pieces)
    {
        if (status == GONIO_OK) {
            r->done += j->cost;
            status = tell(r, shared);
        }
        if (r->status == GONIO_OK) {
            r->status = status;
        }
        r->occupied = r->occupied && !j->one_at_a_time;
    }
}

/* The next piece for a thread; NULL if there is none. Pieces that run one at a time are left to the
 * thread that runs one of them. */
static const job *next_job(run *r)
{
    job *next = NULL;
#pragma omp critical(gonio_pieces)
    {
        for (size_t k = 0; k < r->count && next == NULL && r->status == GONIO_OK; k++) {
            job *j = r->todo[k];
            next = j->begun || (j->one_at_a_time && r->occupied) ? NULL : j;
        }
        if (next != NULL) {
            next->begun = true;
            r->occupied = r->occupied || next->one_at_a_time;
        }
    }
    return next;
}

static gonio_status do_jobs(run *r, int threads)
{
    gonio_context *shared = gonio_i_shared_context_begin(r->context);
    r->status = r->count > 0 ? tell(r, shared) : GONIO_OK;
#pragma omp parallel num_threads(threads)
    for (const job *j = next_job(r); j != NULL; j = next_job(r)) {
        note_end(r, shared, j, do_job(r, shared, j));
    }
    gonio_i_shared_context_end(shared, r->context);
    return r->status;
}

/* ---- all ranks ---- */

static gonio_status wait_for_all(gonio_context *context, const process_group *group)
{
    if (group->size > 1 && !group->barrier(group->user)) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "the other MPI processes have ended");
    }
    return GONIO_OK;
}

static gonio_status gather_piece(const run *r, const job *j, json_t **result)
{
    const gonio_status status = read_piece(r->context, r->checkpoint, r->work, j, result);
    if (status != GONIO_OK || *result != NULL) {
        return status;
    }
    return gonio_i_fail(r->context, GONIO_ERROR_IO,
                        "%s: the finished computation '%s' cannot be read back",
                        r->checkpoint->folder, j->name);
}

static gonio_status gather(const run *r, json_t **results)
{
    gonio_status status = GONIO_OK;
    memset(results, 0, r->work->count * sizeof *results);
    for (size_t k = 0; k < r->work->count && status == GONIO_OK; k++) {
        status = gather_piece(r, &r->job[k], &results[r->job[k].piece]);
    }
    for (size_t k = 0; k < r->work->count && status != GONIO_OK; k++) {
        json_decref(results[k]);
        results[k] = NULL;
    }
    return status;
}

static gonio_status do_all(run *r, int threads, json_t **results)
{
    gonio_status status = list_jobs(r);
    if (status == GONIO_OK) {
        status = share_out(r);
    }
    if (status == GONIO_OK) {
        status = drop_finished(r);
    }
    if (status == GONIO_OK) {
        status = do_jobs(r, threads);
    }
    if (status == GONIO_OK) {
        status = wait_for_all(r->context, &r->checkpoint->group);
    }
    if (status == GONIO_OK && r->count > 0) {
        status = gonio_i_progress(r->context, r->work->title, 1.0);
    }
    return status == GONIO_OK && results != NULL ? gather(r, results) : status;
}

static gonio_status run_pieces(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                               const gonio_i_work *work, int threads, json_t **results)
{
    run r = {.context = context, .checkpoint = checkpoint, .work = work};
    r.job = gonio_i_allocate(context, work->count, sizeof *r.job);
    r.todo = gonio_i_allocate(context, work->count, sizeof(job *));
    const gonio_status status =
        r.job != NULL && r.todo != NULL ? do_all(&r, threads, results) : GONIO_ERROR_MEMORY;
    for (size_t k = 0; r.job != NULL && k < work->count; k++) {
        free(r.job[k].name);
    }
    free(r.todo);
    free(r.job);
    return status;
}

gonio_status gonio_i_checkpoint_run(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                                    const gonio_i_work *work, json_t **results)
{
    const int threads = gonio_context_threads(context);
    if (checkpoint->group.rank == 0) {
        return run_pieces(context, checkpoint, work, threads, results);
    }
    /* Only rank 0 reports its progress. */
    char name[32];
    gonio_context *silent = NULL;
    snprintf(name, sizeof name, "rank %d", checkpoint->group.rank);
    gonio_status status = gonio_i_piece_begin(context, name, &silent);
    if (status == GONIO_OK) {
        status = run_pieces(silent, checkpoint, work, threads, results);
        gonio_i_piece_end(silent);
    }
    return status;
}

/* ---- the folder ---- */

/* Removes the unfinished files of a killed run. */
static void remove_parts(const char *folder)
{
    DIR *entries = opendir(folder);
    for (const struct dirent *entry = entries != NULL ? readdir(entries) : NULL; entry != NULL;
         entry = readdir(entries)) {
        const size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".part") == 0) {
            unlinkat(dirfd(entries), entry->d_name, 0);
        }
    }
    if (entries != NULL) {
        closedir(entries);
    }
}

static gonio_status take_folder(gonio_context *context, const char *folder, json_t *identity,
                                gonio_i_checkpoint *checkpoint)
{
    json_t *whole = json_pack("{s:s, s:O}", "gonio", gonio_version(), "identity", identity);
    char *text = json_dumps(whole, EXACT | JSON_SORT_KEYS);
    gonio_status status = GONIO_OK;
    if (text == NULL) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", folder);
    } else {
        put_hash(checkpoint->run, text);
        if (checkpoint->group.rank == 0) {
            status = gonio_i_run_folder_take(context, folder, whole, &checkpoint->lock);
        }
    }
    if (status == GONIO_OK && checkpoint->group.rank == 0) {
        status = gonio_i_make_folder(context, checkpoint->folder);
        remove_parts(checkpoint->folder);
    }
    if (status == GONIO_OK) {
        status = wait_for_all(context, &checkpoint->group);
    }
    if (status == GONIO_OK && checkpoint->group.rank != 0) {
        status = gonio_i_run_folder_check(context, folder, whole);
    }
    free(text);
    json_decref(whole);
    return status;
}

gonio_status gonio_i_checkpoint_open(gonio_context *context, const char *folder, json_t *identity,
                                     const process_group *group, gonio_i_checkpoint **checkpoint)
{
    gonio_i_checkpoint *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    made->lock = -1;
    made->group = group != NULL ? *group : (process_group){.size = 1};
    made->folder = gonio_i_format("%s/pieces", folder);
    const gonio_status status = made->folder != NULL
                                    ? take_folder(context, folder, identity, made)
                                    : gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    if (status != GONIO_OK) {
        gonio_i_checkpoint_free(&made);
        return status;
    }
    *checkpoint = made;
    return GONIO_OK;
}

void gonio_i_checkpoint_free(gonio_i_checkpoint **checkpoint)
{
    if (checkpoint == NULL || *checkpoint == NULL) {
        return;
    }
    if ((*checkpoint)->lock >= 0) {
        close((*checkpoint)->lock);
    }
    free((*checkpoint)->folder);
    free(*checkpoint);
    *checkpoint = NULL;
}
