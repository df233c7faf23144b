/* What the test programs share: see support.h. */
#include "support.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *support_shared(void)
{
    const char *folder = getenv("GONIO_SHARED");
    return folder != NULL && access(folder, R_OK) == 0 ? folder : NULL;
}

void support_need_shared(void)
{
    if (support_shared() == NULL) {
        print_message("skipped: the folder of shared data is not there ($GONIO_SHARED)\n");
        skip();
    }
}

char *support_folder(void)
{
    char *folder = strdup("/tmp/gonio-test-XXXXXX");
    assert_non_null(folder);
    assert_non_null(mkdtemp(folder));
    return folder;
}

static char last_message[4096];

static void keep_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    if (level == GONIO_MESSAGE_ERROR) {
        snprintf(last_message, sizeof last_message, "%s", text);
    }
}

gonio_context *support_context(void)
{
    gonio_context *context = NULL;
    const gonio_context_options options = {.message = keep_message};
    last_message[0] = '\0';
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    return context;
}

const char *support_message(void)
{
    return last_message;
}

static int remove_one(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status;
    (void)type;
    (void)walk;
    return remove(path);
}

void support_remove(char *folder)
{
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    free(folder);
}
