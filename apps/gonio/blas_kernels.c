/* Chooses the kernels and threads of OpenBLAS: see blas_kernels.h. */
#include "blas_kernels.h"

#include <cblas.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/resource.h>
#include <unistd.h>

/* OpenBLAS's names of kernels, by the vector instructions that they need. */
static const char *const wide[] = {"SkylakeX", "Cooperlake", "SapphireRapids", NULL}; /* AVX-512 */
static const char *const narrow[] = {"Haswell", "Zen", "Excavator", NULL};            /* AVX2 */

static bool is_among(const char *name, const char *const *names)
{
    while (*names != NULL && strcasecmp(name, *names) != 0) {
        names++;
    }
    return *names != NULL;
}

/* Better kernels than those in use; NULL if there are none. */
static const char *better_kernels(const char *used)
{
#ifdef __x86_64__
    const bool has_narrow = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    const bool has_wide = has_narrow && __builtin_cpu_supports("avx512f") &&
                          __builtin_cpu_supports("avx512bw") &&
                          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    if (has_wide && !is_among(used, wide)) {
        return wide[0];
    }
    if (has_narrow && !is_among(used, wide) && !is_among(used, narrow)) {
        return narrow[0];
    }
#else
    (void)used;
#endif
    return NULL;
}

/* Sets a variable unless the user or an earlier start has set it. Returns whether it was set. */
static bool set_once(const char *variable, const char *value)
{
    return value != NULL && getenv(variable) == NULL && setenv(variable, value, 1) == 0;
}

/* "1" if the address space is limited, otherwise NULL. OpenBLAS's own threads, which gonio does not
 * use, try for ever to map their buffers if there is no room. */
static const char *fewer_threads(void)
{
    struct rlimit limit;
    const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return limited ? "1" : NULL;
}

void blas_kernels_choose(char **argv)
{
    char path[PATH_MAX];
    const bool kernels = set_once("OPENBLAS_CORETYPE", better_kernels(openblas_get_corename()));
    const bool threads = set_once("OPENBLAS_NUM_THREADS", fewer_threads());
    const ssize_t length =
        kernels || threads ? readlink("/proc/self/exe", path, sizeof path - 1) : -1;
    if (length > 0) {
        path[length] = '\0';
        execv(path, argv); /* if it fails, the slower kernels are used */
    }
}
