/* Structs that begin with their size: see options.h. */
#include "options.h"

gonio_status gonio_i_take(gonio_context *context, const char *type, const char *remedy,
                          const void *given, void *taken, size_t size)
{
    if (gonio_i_copy_known(given, taken, size)) {
        return GONIO_OK;
    }
    size_t claimed;
    memcpy(&claimed, given, sizeof claimed);
    return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a %s of %zu bytes was not initialised: %s",
                        type, claimed, remedy);
}
