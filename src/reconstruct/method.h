/* A reconstruction method: to add one, write a file like least_squares.c and add a line to the
 * table in reconstruct.c. */
#ifndef GONIO_RECONSTRUCT_METHOD_H
#define GONIO_RECONSTRUCT_METHOD_H

#include <gonio/reconstruct.h>

#include "../core/core.h"

/* Coefficients c of one column from X c = b. */
typedef struct gonio_i_equations {
    size_t count;
    size_t components;
    const double *x;        /* [count][components]: rows of V */
    const double *b;        /* [count]: readings in the basis's space less m */
    const double *singular; /* [components]: S */
    double eta;             /* weight of what the method adds to the squares */
} gonio_i_equations;

typedef struct gonio_i_solution {
    double *coefficients; /* [components], the caller's */
    size_t rank;          /* independent equations; below K no coefficients were written */
    double condition_number;
} gonio_i_solution;

typedef struct gonio_i_reconstruct_method {
    const char *name;
    const char *summary;
    bool needs_full_rank; /* as many independent readings as coefficients */
    /* NULL: not equation by equation, see estimate.h */
    gonio_status (*solve)(gonio_context *context, const gonio_i_equations *equations,
                          gonio_i_solution *solution);
} gonio_i_reconstruct_method;

extern const gonio_i_reconstruct_method gonio_i_least_squares_method;
extern const gonio_i_reconstruct_method gonio_i_ridge_method;
extern const gonio_i_reconstruct_method gonio_i_posterior_method;

#endif
