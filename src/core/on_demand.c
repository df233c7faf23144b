/* Libraries loaded when they are used: see on_demand.h. */
#include "on_demand.h"

#include <dlfcn.h>
#include <string.h>

static void *open_library(const gonio_i_on_demand *library)
{
    const int visible = library->global ? RTLD_GLOBAL : RTLD_LOCAL;
    return library->library != NULL ? dlopen(library->library, RTLD_LAZY | visible) : NULL;
}

static gonio_status fail(gonio_context *context, const gonio_i_on_demand *library)
{
    const char *why = dlerror();
    return gonio_i_fail(context, GONIO_ERROR_IO, "a library cannot be loaded: %s",
                        why != NULL ? why : library->library);
}

static gonio_status find(gonio_context *context, const gonio_i_on_demand *library)
{
    void *handle = NULL;
    for (size_t k = 0; k < library->symbols; k++) {
        const void *address = library->symbol[k].linked;
        if (address == NULL && handle == NULL) {
            handle = open_library(library);
        }
        if (address == NULL && handle != NULL) {
            address = dlsym(handle, library->symbol[k].name);
        }
        if (address == NULL) {
            return fail(context, library);
        }
        memcpy((char *)library->pointers + k * sizeof address, &address, sizeof address);
    }
    return GONIO_OK;
}

gonio_status gonio_i_load(gonio_context *context, gonio_i_on_demand *library)
{
    if (__atomic_load_n(&library->ready, __ATOMIC_ACQUIRE)) {
        return GONIO_OK;
    }
    pthread_mutex_lock(&library->lock);
    const gonio_status status = library->ready ? GONIO_OK : find(context, library);
    __atomic_store_n(&library->ready, status == GONIO_OK, __ATOMIC_RELEASE);
    pthread_mutex_unlock(&library->lock);
    return status;
}
