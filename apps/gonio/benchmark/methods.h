/* Methods that complete a BRDF from readings: one list, a file each. */
#ifndef GONIO_BENCHMARK_METHODS_H
#define GONIO_BENCHMARK_METHODS_H

#include "setting.h"

/* What is to be completed. */
typedef struct benchmark_task {
    const benchmark_setting *setting;
    const gonio_basis *basis; /* what was learned from; not every method needs it */
    const gonio_readings *readings;
    const gonio_pair *compared; /* [compared_count]: where it will be compared; none: anywhere */
    size_t compared_count;
    const char *method; /* of the library's own, by name; NULL for any other */
} benchmark_task;

/* A completed BRDF. What the task points to must outlive it. */
typedef struct benchmark_completion {
    void *self;
    void (*release)(void *self);
    /* values[count][channels] at any directions above the horizon, 1/sr, channels those of the
     * readings; and, unless it is NULL, deviations[count][channels] of ln(1 + value/s). */
    gonio_status (*predict)(void *self, gonio_context *context, const gonio_pair *pair,
                            size_t count, double *values, double *deviations);
    /* The whole as materials: the values and, if there are any, the deviations (reconstruct.h).
     * NULL: it is only what predict says. */
    gonio_status (*materials)(void *self, gonio_context *context, gonio_material **values,
                              gonio_material **deviations);
    bool has_deviations;
    double expected; /* the E6 that the method expects, per cent; NaN: it does not say */
} benchmark_completion;

typedef struct benchmark_method {
    const char *name;
    const char *summary;
    bool simple;  /* what others have to be better than */
    bool learned; /* needs a basis */
    /* Errors: _UNDETERMINED, _DATA, _NUMERICAL, _MISMATCH where the method cannot do it; others end
     * the run. */
    gonio_status (*complete)(gonio_context *context, const benchmark_task *task,
                             benchmark_completion *completion);
} benchmark_method;

/* The methods, each in the file of its name. */
extern const benchmark_method benchmark_posterior;
extern const benchmark_method benchmark_interpolation;
extern const benchmark_method benchmark_lambert_ggx;
extern const benchmark_method benchmark_external;

/* The library's other methods, for what published ways to choose directions are made for. */
extern const benchmark_method benchmark_published;

/* The methods at a place of the list; NULL past the last. By name: -1 if there is none. */
const benchmark_method *benchmark_method_at(int index);
int benchmark_method_find(const char *name);

void benchmark_completion_free(benchmark_completion *completion);

#endif
