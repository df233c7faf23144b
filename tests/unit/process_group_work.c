/* Work in pieces by a group: process-group-work FOLDER [FAILING_RANK]. Started by mpirun or alone.
 * Rank 0 prints the sum of all results. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/core.h"
#include "run/checkpoint.h"

enum { PIECES = 30 };

typedef struct task {
    int rank, failing;
} task;

static char *name_of(void *user, size_t piece)
{
    (void)user;
    return gonio_i_format("piece-%02zu", piece);
}

static double cost_of(void *user, size_t piece)
{
    (void)user;
    return (double)(1 + piece);
}

static gonio_status compute(void *user, gonio_context *context, size_t piece, json_t **result)
{
    const task *t = user;
    if (t->rank == t->failing) {
        return gonio_i_fail(context, GONIO_ERROR_DATA, "made to fail");
    }
    *result = json_pack("{s:f}", "third", (double)piece / 3.0);
    return GONIO_OK;
}

static void on_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

static gonio_status run(gonio_context *context, const char *folder, const process_group *group,
                        task *t)
{
    json_t *results[PIECES] = {0};
    gonio_i_checkpoint *checkpoint = NULL;
    json_t *identity = json_pack("{s:s}", "test", "group");
    const gonio_i_work work = {.title = "thirds",
                               .count = PIECES,
                               .user = t,
                               .name = name_of,
                               .cost = cost_of,
                               .compute = compute};
    gonio_status status = gonio_i_checkpoint_open(context, folder, identity, group, &checkpoint);
    if (status == GONIO_OK) {
        status =
            gonio_i_checkpoint_run(context, checkpoint, &work, group->rank == 0 ? results : NULL);
    }
    if (status == GONIO_OK && group->rank == 0) {
        double sum = 0.0;
        for (int k = 0; k < PIECES; k++) {
            sum += json_real_value(json_object_get(results[k], "third"));
            json_decref(results[k]);
        }
        printf("sum %.3f by %d\n", sum, group->size);
    }
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(identity);
    return status;
}

int main(int argc, char **argv)
{
    process_group group;
    int code = 1;
    gonio_context *context = NULL;
    const gonio_context_options options = {
        .size = sizeof options, .message = on_message, .threads = 1};
    if (argc > 1 && process_group_join(&group, "process-group-work") &&
        gonio_context_create(&context, &options) == GONIO_OK) {
        task t = {group.rank, argc > 2 ? atoi(argv[2]) : -1};
        code = run(context, argv[1], &group, &t) == GONIO_OK ? 0 : 1;
    }
    gonio_context_free(&context);
    return process_group_leave(code);
}
