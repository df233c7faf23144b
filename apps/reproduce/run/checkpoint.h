/* Long work in independent pieces. Each finished piece is kept in a file, so that a run that was
 * stopped resumes there and ends with the same bytes.
 *
 * A run's folder holds
 *   run.json           its identity: gonio's version and the caller's data (options, materials with
 *                      fingerprints ...); a folder with another identity is refused
 *   pieces/NAME.json   a finished piece: its name, the run, a checksum, the result
 * Pieces run in parallel on the context's threads, one thread each, the expensive ones first. The
 * ranks of a group share them by cost. The results do not depend on this. */
#ifndef GONIO_REPRODUCE_CHECKPOINT_H
#define GONIO_REPRODUCE_CHECKPOINT_H

#include <jansson.h>

#include "core/core.h"
#include "process_group.h"

typedef struct gonio_i_checkpoint gonio_i_checkpoint;

enum { GONIO_I_COMPLAINT = 128 }; /* bytes of a text that says what is wrong with a result */

typedef struct gonio_i_work {
    const char *title; /* for the progress; must last as long as the context */
    size_t count;
    void *user; /* handed to the callbacks, which are called from several threads */
    /* A piece's name, different from all others of the run; to be released with free(); NULL when
     * out of memory. */
    char *(*name)(void *user, size_t piece);
    /* Its cost relative to the others, > 0; NULL if all cost the same. */
    double (*cost)(void *user, size_t piece);
    /* Computes a piece under a context of one thread: a new JSON object or array. It must depend on
     * the run's identity and the piece's name alone. */
    gonio_status (*compute)(void *user, gonio_context *context, size_t piece, json_t **result);
    /* Whether a result from a file belongs to this piece. If not, complaint [GONIO_I_COMPLAINT]
     * says what is wrong. NULL accepts any result. */
    bool (*accept)(void *user, size_t piece, const json_t *result, char *complaint);
    /* Whether a process does this piece only while it does no other such piece, because they need
     * much memory. NULL if there are none. */
    bool (*one_at_a_time)(void *user, size_t piece);
} gonio_i_work;

/* Makes a run's folder, or takes up an existing one of the same identity (a JSON object; borrowed).
 * `group` is NULL for a process on its own. Every rank calls this; rank 0 makes the folder, and the
 * others must see it.
 * Errors: _MISMATCH if it is another run's; _ARGUMENT if it holds other things or a run is going on
 * in it; _IO, _FORMAT, _MEMORY. */
gonio_status gonio_i_checkpoint_open(gonio_context *context, const char *folder, json_t *identity,
                                     const process_group *group, gonio_i_checkpoint **checkpoint);
void gonio_i_checkpoint_free(gonio_i_checkpoint **checkpoint);

/* Computes the pieces that are missing. A file that is damaged, or not this run's, counts as
 * missing and is warned of. After the first failure, or when cancelled, no further piece is begun;
 * those that were finished stay. Every rank of a group calls this with the same work. Then
 * `results` [count], where not NULL, is filled with all ranks' results, which the caller owns
 * (json_decref). Errors: those of the pieces; _ARGUMENT for two pieces of one name;
 * _FORMAT for a kept result with a right checksum that is not accepted; _IO; _CANCELLED. */
gonio_status gonio_i_checkpoint_run(gonio_context *context, const gonio_i_checkpoint *checkpoint,
                                    const gonio_i_work *work, json_t **results);

#endif
