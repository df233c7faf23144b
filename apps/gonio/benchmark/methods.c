/* Methods that complete a BRDF from readings: see methods.h. */
#include "methods.h"

#include <stdlib.h>
#include <string.h>

static const benchmark_method *const list[] = {&benchmark_posterior, &benchmark_interpolation,
                                               &benchmark_lambert_ggx, &benchmark_external};

enum { METHODS = sizeof list / sizeof *list };

const benchmark_method *benchmark_method_at(int index)
{
    return index >= 0 && index < METHODS ? list[index] : NULL;
}

int benchmark_method_find(const char *name)
{
    for (int k = 0; k < METHODS; k++) {
        if (strcmp(list[k]->name, name) == 0) {
            return k;
        }
    }
    return -1;
}

void benchmark_completion_free(benchmark_completion *completion)
{
    if (completion->release != NULL) {
        completion->release(completion->self);
    }
    *completion = (benchmark_completion){0};
}
