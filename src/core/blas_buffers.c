/* Buffers of OpenBLAS: see blas_buffers.h. */
#include "blas_buffers.h"

#include <stdlib.h>
#include <sys/mman.h>
#include <sys/resource.h>

/* OpenBLAS' own, not in its headers; NULL where a build hides them. */
extern void *blas_memory_alloc(int unused) __attribute__((weak));
extern void blas_memory_free(void *buffer) __attribute__((weak));

/* Above what any of its builds maps for a buffer (128 MB). */
static const size_t room = (size_t)160 << 20;

static bool is_limited(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

static bool has_room(void)
{
    void *tried = mmap(NULL, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return tried != MAP_FAILED && munmap(tried, room) == 0;
}

bool gonio_i_reserve_blas_buffers(int threads)
{
    if (!is_limited() || blas_memory_alloc == NULL || blas_memory_free == NULL) {
        return true;
    }
    void **buffer = calloc((size_t)threads, sizeof *buffer);
    int taken = 0;
    while (buffer != NULL && taken < threads && has_room()) {
        buffer[taken++] = blas_memory_alloc(0);
    }
    const bool all = taken == threads;
    while (taken > 0) {
        blas_memory_free(buffer[--taken]);
    }
    free(buffer);
    return all;
}
