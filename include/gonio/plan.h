/* A plan: where to measure.
 *
 * By default a plan minimises the expected error of the reconstruction by posterior
 * (reconstruct.h): greedy selection of the best next reading, improved by exchanges
 * (docs/method.md).
 *
 * The method of Ali et al., section 3.8, chooses n rows X of V_K that minimise the condition number
 * kappa = lambda_max(X'X)/lambda_min(X'X), by swaps until no single swap lowers it. The other
 * methods are for comparison (docs/method.md). */
#ifndef GONIO_PLAN_H
#define GONIO_PLAN_H

#include <gonio/basis.h>
#include <gonio/instrument.h>
#include <gonio/metric.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { GONIO_ALL_CHANNELS = -1 };

/* One reading to make. */
typedef struct gonio_plan_entry {
    int32_t cell;    /* database.h */
    int channel;     /* 0 .. 2 for a row of a joint basis, GONIO_ALL_CHANNELS otherwise */
    gonio_pair pair; /* radians */
} gonio_plan_entry;

/* One point of the search: kappa after `swap` swaps of a start. */
typedef struct gonio_plan_step {
    int32_t restart;
    int32_t swap;
    double condition_number;
} gonio_plan_step;

enum { GONIO_MOST_PARTS = 16, GONIO_NAME_ROOM = 64 };

/* A part of all pairs of directions. */
typedef struct gonio_plan_part {
    char obstacle[GONIO_NAME_ROOM]; /* what keeps the instrument out; "": what it reaches */
    double share;                   /* of all pairs, by projected solid angle, 0 to 1 */
    double deviation;               /* root mean square of the standard deviation there after the
                                     * plan, relative to the BRDF (in log space) */
} gonio_plan_part;

/* How an instrument makes the readings of a plan. */
typedef struct gonio_plan_run {
    char instrument[GONIO_NAME_ROOM]; /* its name */
    size_t axes;
    char axis[GONIO_MOST_AXES][GONIO_NAME_ROOM];
    bool shown[GONIO_MOST_AXES]; /* whether the instrument has the axis */
    gonio_setting *setting;      /* [count] of the plan */
    double *time;                /* [count], s from the start to the end of each reading */
    double duration;             /* s, of the whole run */
    double unordered;            /* s, that the same readings take in the order in which they were
                                  * chosen */
    double free_expected; /* expected E6 of as many readings anywhere, per cent; NAN if it was
                           * not looked for */
    size_t parts;
    gonio_plan_part part[GONIO_MOST_PARTS];
} gonio_plan_run;

typedef struct gonio_plan {
    size_t count;
    gonio_plan_entry *entries; /* in ascending order of the basis's rows; by expected-error in the
                                * order of use: the first ones are a good plan too */
    size_t components;         /* K that the plan was made for */
    double condition_number;   /* kappa of X'X, infinity if singular; for matusik, nielsen and
                                * frost that of the rows of V S */
    uint64_t basis;            /* fingerprint of the basis */
    char method[32];
    uint64_t tests; /* number of rows tried, in all starts; the paper solves an eigenvalue problem
                       for each */
    size_t steps;
    gonio_plan_step *history; /* all restarts, in order; not kept in files */
    double *expected;         /* [count] by expected-error: the expected E6 after each reading, per
                               * cent; NULL by other methods */
    gonio_plan_run *run;      /* of plans for an instrument, whose entries are in the order of the
                               * run; NULL otherwise */
} gonio_plan;

/* The default number of readings: 80, at most 300 with a target error, 5 for gonio_plan_next. */
#define GONIO_USUAL_COUNT SIZE_MAX

typedef struct gonio_plan_options {
    size_t size;        /* of this struct, which gonio_plan_options_default sets */
    const char *method; /* gonio_plan_method_name; NULL: expected-error for a basis with
                         * mixtures, condition for others */
    const char *start;  /* of the swaps: "random" (default): gonio_plan_start_name */
    size_t components;  /* K; 0: all of the basis, with nielsen and frost at most n */
    size_t count;       /* n, rows to choose; GONIO_USUAL_COUNT by default */
    int restarts;       /* starts of swaps, of which the best is kept; 5 by default */
    uint64_t seed;      /* same seed, same plan, on any number of threads */
    bool keep_history;  /* true by default; false saves memory in a search of very many starts */
    double phi_d;       /* phi_d of the readings of bivariate cells; pi/2 by default */
    /* Of expected-error only: */
    gonio_metric metric;          /* whose expected value is minimised */
    const gonio_pair *candidates; /* choose among these directions, so that the error at all of
                                   * them is least; NULL: any, for the error over the grid */
    size_t candidate_count;       /* at most 100,000 */
    double target;                /* per cent: plan the fewest readings with at most this expected
                                   * E6, at most `count` of them; 0: exactly `count` */
    const gonio_instrument *instrument; /* read by this instrument: what it reaches, with its noise
                                         * and apertures, in the order of least time; NULL: by any.
                                         * The sample is taken as isotropic */
    double budget; /* s: as many readings as the instrument makes in this time (and at most `count`,
                    * if that is set), the best for the time; 0: `count` readings */
    bool nested; /* the first 5, 10, 20, 40 ... readings of an instrument stay good plans: they are
                  * ordered within these blocks only */
    bool anisotropic; /* for a material that depends on the azimuth of the half vector
                       * too: over all pairs of directions, azimuths included, of which
                       * `seed` draws some; metric e6 only, at most 20,000 candidates */
} gonio_plan_options;

GONIO_API void gonio_plan_options_default_of(gonio_plan_options *options, size_t size);
static inline void gonio_plan_options_default(gonio_plan_options *options)
{
    gonio_plan_options_default_of(options, sizeof *options);
}

/* Names and one-line descriptions of the methods; NULL past the last. */
GONIO_API const char *gonio_plan_method_name(int index);
GONIO_API const char *gonio_plan_method_summary(int index);

/* The reconstruction method (reconstruct.h) that plans of a method are made for; NULL if there is
 * no such method. */
GONIO_API const char *gonio_plan_method_reconstruction(const char *method);

/* The kind of basis that a method is meant for. */
typedef struct gonio_plan_basis {
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    bool without_mean;
    bool mixtures; /* whether the basis is also learned from mixtures */
} gonio_plan_basis;

/* The basis of a method, static; NULL for an unknown name. */
GONIO_API const gonio_plan_basis *gonio_plan_method_basis(const char *method);

/* Names and one-line descriptions of the starts that the condition method's swaps may begin with;
 * NULL past the last. */
GONIO_API const char *gonio_plan_start_name(int index);
GONIO_API const char *gonio_plan_start_summary(int index);

/* Makes a plan. A chosen cell becomes the pair at its centre with phi_h = 0 and the given phi_d
 * (with a full basis the bin's own phi_d). If that pair is at or below the horizon, the nearest
 * valid phi_d is taken. options may be NULL. *plan is the caller's; the basis need not outlive it.
 * The plan does not depend on the number of threads. Errors: _ARGUMENT (unknown method, K more than
 * the basis has, n < K for the condition method, n more than there are rows, phi_d outside [0, pi),
 * a method that works on another kind of basis); _DATA (rows of rank less than K); _CANCELLED.
 */
GONIO_API gonio_status gonio_plan_create(gonio_context *context, const gonio_basis *basis,
                                         const gonio_plan_options *options, gonio_plan **plan);

GONIO_API void gonio_plan_free(gonio_plan **plan);

/* The rows of the basis that a plan reads: rows[plan->count]. Errors: _MISMATCH for an entry whose
 * cell or channel the basis lacks. */
GONIO_API gonio_status gonio_plan_rows(gonio_context *context, const gonio_plan *plan,
                                       const gonio_basis *basis, size_t *rows);

/* The results of gonio_plan_select besides the rows. */
typedef struct gonio_selection_report {
    double condition_number;
    uint64_t tests; /* see gonio_plan */
    size_t steps;
    gonio_plan_step *history; /* the caller's; released with free() */
} gonio_selection_report;

/* Chooses n of the rows of a matrix V[rows][leading], ascending: chosen[n]. The first `components`
 * numbers of each row count. This is the search of gonio_plan_create for any matrix. V is neither
 * copied nor changed. options may be NULL; method NULL is condition.
 * Errors: _ARGUMENT for methods that need to know the basis, for more components than `leading` and
 * as gonio_plan_create; _DATA (rows of rank less than `components`); _CANCELLED; _MEMORY. */
GONIO_API gonio_status gonio_plan_select(gonio_context *context, const double *vectors, size_t rows,
                                         size_t leading, size_t components,
                                         const gonio_plan_options *options, size_t *chosen,
                                         gonio_selection_report *report);

/* kappa of X'X for the rows chosen[count] of V[rows][leading]: the first `components` of each row.
 * Infinity if singular to working precision. Errors: _ARGUMENT for a row that does not exist, or
 * more components than `leading`; _MEMORY. */
GONIO_API gonio_status gonio_condition_number(gonio_context *context, const double *vectors,
                                              size_t rows, size_t leading, size_t components,
                                              const size_t *chosen, size_t count,
                                              double *condition_number);

/* Writes a plan as CSV (docs/plan-and-readings.md): `#` lines, then columns theta_i_deg, phi_i_deg,
 * theta_o_deg, phi_o_deg, channel. The file appears whole or not at all. command may be NULL.
 * Errors: _ARGUMENT (an unknown channel), _IO, _MEMORY. */
GONIO_API gonio_status gonio_plan_write(gonio_context *context, const gonio_plan *plan,
                                        const char *command, const char *path);

/* Writes kappa by swaps as CSV: restart, swap, condition_number. Errors and command as above. */
GONIO_API gonio_status gonio_plan_write_history(gonio_context *context, const gonio_plan *plan,
                                                const char *command, const char *path);

#ifdef __cplusplus
}
#endif
#endif
