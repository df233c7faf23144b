/* libFuzzer on the folder of a run: whatever the bytes of run.json (first byte odd) or of a kept
 * piece (even) are, the folder is refused with one message, or the run ends with its result. */
#include "fuzz.h"

#include <jansson.h>
#include <sys/stat.h>

#include "run/checkpoint.h"

static char *name_of(void *user, size_t piece)
{
    (void)user;
    (void)piece;
    return strdup("p");
}

static gonio_status compute(void *user, gonio_context *context, size_t piece, json_t **result)
{
    (void)user;
    (void)context;
    (void)piece;
    *result = json_pack("{s:[f, i, n]}", "x", 1.5, 3);
    return GONIO_OK;
}

static bool accept(void *user, size_t piece, const json_t *result, char *complaint)
{
    (void)user;
    (void)piece;
    snprintf(complaint, GONIO_I_COMPLAINT, "it is no list");
    return json_array_size(json_object_get(result, "x")) == 3;
}

static void run(gonio_context *context, const gonio_i_checkpoint *checkpoint)
{
    const gonio_i_work work = {
        .title = "t", .count = 1, .name = name_of, .compute = compute, .accept = accept};
    json_t *result = NULL;
    const gonio_status status = gonio_i_checkpoint_run(context, checkpoint, &work, &result);
    check_status(status);
    check(status != GONIO_OK || json_array_size(json_object_get(result, "x")) == 3,
          "a result is one");
    json_decref(result);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char folder[128];
    char path[3][192];
    gonio_i_checkpoint *checkpoint = NULL;
    if (size < 1) {
        return -1;
    }
    fuzz_path(folder, "run");
    snprintf(path[0], sizeof path[0], "%s/run.json", folder);
    snprintf(path[1], sizeof path[1], "%s/pieces", folder);
    snprintf(path[2], sizeof path[2], "%s/pieces/p.json", folder);
    mkdir(folder, 0700);
    if (data[0] % 2 != 0) {
        fuzz_write(path[0], data + 1, size - 1);
    }
    json_t *identity = json_pack("{s:s, s:[i, i]}", "build", "x", "sizes", 1, 2);
    const gonio_status status =
        gonio_i_checkpoint_open(context, folder, identity, NULL, &checkpoint);
    check_status(status);
    if (status == GONIO_OK) {
        if (data[0] % 2 == 0) {
            fuzz_write(path[2], data + 1, size - 1);
        }
        run(context, checkpoint);
    }
    gonio_i_checkpoint_free(&checkpoint);
    json_decref(identity);
    unlink(path[2]);
    rmdir(path[1]);
    unlink(path[0]);
    rmdir(folder);
    return 0;
}
