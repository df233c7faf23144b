/* A planning method: to add one, write a file like random.c (of rows) or expected_error_plan.c (of
 * directions), declare its gonio_i_method below and add a line to the table in methods.c. */
#ifndef GONIO_METHOD_H
#define GONIO_METHOD_H

#include <gonio/plan.h>

#include "../core/core.h"

/* Choose `count` of the rows of V (rows x components, row-major, `stride` values apart). */
typedef struct gonio_i_selection_problem {
    gonio_context *context;
    const double *vectors;
    size_t rows;
    size_t components;
    size_t stride;
    size_t count;
    int restarts;
    uint64_t seed;
    bool keep_history;
    const struct gonio_i_start *start; /* of the swaps: starting_rows.h */
    const size_t *given; /* [count] or NULL: rows to start from; may be the result's */
    bool part;           /* this is a part of another problem, which reports the progress */
    const gonio_basis_view *basis; /* V has its rows; NULL for the caller's rows */
} gonio_i_selection_problem;

static inline const double *gonio_i_row(const gonio_i_selection_problem *problem, size_t row)
{
    return problem->vectors + row * problem->stride;
}

typedef struct gonio_i_selection {
    size_t *chosen; /* [count], the caller's; to be filled in ascending */
    double condition_number;
    gonio_plan_step *history; /* grown by gonio_i_selection_record; released by the caller */
    size_t steps;
    uint64_t
        tests; /* eigenvalue solves that the plain algorithm would have made for the same swaps */
} gonio_i_selection;

typedef gonio_status gonio_i_selector(const gonio_i_selection_problem *problem,
                                      gonio_i_selection *selection);

/* What a method that chooses rows has to have. */
typedef enum gonio_i_needs {
    GONIO_I_NEEDS_ROWS,     /* of any matrix */
    GONIO_I_NEEDS_A_BASIS,  /* to know what the rows stand for */
    GONIO_I_NEEDS_NO_MEAN,  /* a basis that was learned without one */
    GONIO_I_NEEDS_LOADINGS, /* a basis that has its materials' */
} gonio_i_needs;

typedef struct gonio_i_method {
    const char *name;
    const char *summary;
    const char *reconstruction; /* the method (reconstruct.h) that its plans are made for */
    gonio_plan_basis basis;     /* the kind of basis that it is made for */
    gonio_i_needs needs;
    const char *where_it_lacks; /* the message if a basis lacks what it needs */
    bool needs_full_rank;       /* n >= K */
    bool few_components;        /* by default, no more components than readings */

    /* One of these: chooses rows, or makes a whole plan from directions and noise. */
    gonio_i_selector *select;
    gonio_status (*plan)(gonio_context *context, const gonio_basis *basis,
                         const gonio_plan_options *options, gonio_plan **plan);
} gonio_i_method;

/* The bases of Ali et al., and those of Nielsen et al. and of Miandji et al. */
#define GONIO_I_PAPERS_BASIS                                                                       \
    {                                                                                              \
        .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT, .mapping = GONIO_LOG           \
    }
#define GONIO_I_RELATIVE_BASIS                                                                     \
    {                                                                                              \
        .representation = GONIO_FULL, .channels = GONIO_SEPARATE, .mapping = GONIO_LOG_RELATIVE    \
    }

/* The methods, in the order of lists. The first that suits a basis is its default. */
#define GONIO_I_PLAN_METHODS(METHOD)                                                               \
    METHOD(expected_error)                                                                         \
    METHOD(condition) METHOD(random) METHOD(matusik) METHOD(nielsen) METHOD(frost)

#define GONIO_I_DECLARE_METHOD(name) extern const gonio_i_method gonio_i_##name##_method;
GONIO_I_PLAN_METHODS(GONIO_I_DECLARE_METHOD)

/* ---- what methods that choose rows share ---- */

/* Appends to the history, if it is kept. */
gonio_status gonio_i_selection_record(const gonio_i_selection_problem *problem,
                                      gonio_i_selection *selection, int restart, int swap,
                                      double condition_number);

/* kappa = largest/smallest eigenvalue; infinity where the smallest is not above rounding. */
double gonio_i_condition(const double *eigenvalues, size_t n);

/* G (K x K) = X'X of the rows chosen[count] of V; `rows` is scratch of count x K values. */
gonio_status gonio_i_chosen_gram(const gonio_i_selection_problem *problem, const size_t *chosen,
                                 double *rows, double *gram);

/* The condition number of a choice. */
gonio_status gonio_i_chosen_condition(const gonio_i_selection_problem *problem,
                                      const size_t *chosen, double *condition_number);

/* A row of V S (K values) of the problem's basis. */
void gonio_i_scaled_row(const gonio_i_selection_problem *problem, size_t row, double *scaled);

/* The condition number of a choice among the rows of V S. */
gonio_status gonio_i_scaled_condition(const gonio_i_selection_problem *problem,
                                      const size_t *chosen, double *condition_number);

/* Ascending. */
void gonio_i_sort_rows(size_t *rows, size_t count);

/* A random choice without repeats, ascending. */
gonio_status gonio_i_random_choice(const gonio_i_selection_problem *problem, uint64_t stream,
                                   size_t *chosen);

#endif
