/* Settings of OpenBLAS and OpenMP: see library_settings.h. */
#include "library_settings.h"

#include <cblas.h>
#include <limits.h>
#include <omp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
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

/* "1" if the address space is limited, otherwise NULL. OpenBLAS's own threads, which gonio does not
 * use, try for ever to map their buffers if there is no room. */
static const char *fewer_threads(void)
{
    struct rlimit limit;
    const bool limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return limited ? "1" : NULL;
}

/* How often a thread of libgomp looks whether the others have come before it sleeps: half a
 * millisecond or so, a tenth of libgomp's own choice. NULL if the user says how threads wait, or
 * there is only one. */
static const char *fewer_looks(void)
{
    const bool chosen = getenv("OMP_WAIT_POLICY") != NULL || omp_get_max_threads() < 2;
    return chosen ? NULL : "30000";
}

/* The names of the variables that the first start has set, for the second. */
static const char marker[] = "GONIO_LIBRARY_SETTINGS";

/* Sets a variable unless the user has set it, and adds its name to a list of them. */
static void set_unless_set(const char *variable, const char *value, char names[128])
{
    if (value != NULL && getenv(variable) == NULL && setenv(variable, value, 1) == 0) {
        strcat(strcat(names, " "), variable);
    }
}

/* Whether this is the second start. Its variables have been read and are removed. */
static bool forget_settings(void)
{
    static const char *const ours[] = {"OPENBLAS_CORETYPE", "OPENBLAS_NUM_THREADS",
                                       "GOMP_SPINCOUNT"};
    const char *names = getenv(marker);
    for (size_t k = 0; names != NULL && k < sizeof ours / sizeof *ours; k++) {
        if (strstr(names, ours[k]) != NULL) {
            unsetenv(ours[k]);
        }
    }
    unsetenv(marker);
    return names != NULL;
}

void library_settings_choose(char **argv, bool parallel)
{
    char names[128] = "";
    char path[PATH_MAX];
    if (forget_settings()) {
        return;
    }
    set_unless_set("OPENBLAS_CORETYPE", better_kernels(openblas_get_corename()), names);
    set_unless_set("OPENBLAS_NUM_THREADS", fewer_threads(), names);
    set_unless_set("GOMP_SPINCOUNT", parallel ? fewer_looks() : NULL, names);
    const ssize_t length = names[0] != '\0' && setenv(marker, names, 1) == 0
                               ? readlink("/proc/self/exe", path, sizeof path - 1)
                               : -1;
    if (length > 0) {
        path[length] = '\0';
        execv(path, argv); /* if it fails, the libraries' own choices are used */
    }
    forget_settings();
}
