/* A reconstruction method is a row of a table: its requirements and its functions.
 *
 * To add one that finds coefficients from equations, copy least_squares.c; to add one that finds a
 * field from directions and values, copy posterior_method.c. Then add a line to the table in
 * reconstruct.c. */
#ifndef GONIO_RECONSTRUCT_METHOD_H
#define GONIO_RECONSTRUCT_METHOD_H

#include <gonio/reconstruct.h>

#include "../core/core.h"
#include "../posterior/posterior.h"

typedef struct gonio_i_reconstruct_method gonio_i_reconstruct_method;

/* Readings through apertures, linear about a reconstruction: what each is the mean of in log space,
 * and what is to be subtracted from its logarithm, as that of a mean is not the mean of logarithms.
 */
typedef struct gonio_i_apertures {
    const gonio_i_spread *spread; /* [count of the readings] */
    const double *offset;         /* [count][channels] */
} gonio_i_apertures;

/* A task. The options are never NULL. The basis meets the method's requirements. */
typedef struct gonio_i_reconstruct_task {
    gonio_context *context;
    const gonio_i_reconstruct_method *method;
    const gonio_basis *basis;
    const gonio_reconstruct_options *options;
    double eta;                         /* of the options, or the default */
    const gonio_i_apertures *apertures; /* NULL: points */
} gonio_i_reconstruct_task;

/* Coefficients c of one column from X c = b. */
typedef struct gonio_i_equations {
    size_t count;
    size_t components;
    const double *x;        /* [count][components]: rows of V */
    const double *b;        /* [count]: readings in the basis's space less m */
    const double *singular; /* [components]: S */
    double eta;             /* weight of the method's penalty */
} gonio_i_equations;

typedef struct gonio_i_solution {
    double *coefficients; /* [components], the caller's */
    size_t rank;          /* independent equations; below K no coefficients were written */
    double condition_number;
} gonio_i_solution;

/* The requirements of a method; false: none. */
typedef struct gonio_i_reconstruct_wants {
    bool log_mapping;       /* a basis of the log mapping */
    bool all_components;    /* of the basis */
    bool noise;             /* valid noise, floor and saturation in the options */
    bool colours;           /* readings of R, G, B */
    bool full_rank;         /* as many independent readings as coefficients */
    bool basis_of_mixtures; /* a basis with mixtures; the method is the default for it */
} gonio_i_reconstruct_wants;

struct gonio_i_reconstruct_method {
    const char *name;
    const char *summary;
    gonio_i_reconstruct_wants wants;
    /* From readings at directions. */
    gonio_status (*from_readings)(const gonio_i_reconstruct_task *task,
                                  const gonio_readings *readings,
                                  gonio_reconstruction **reconstruction);
    /* From rows of the basis: b[columns][count] in its space. */
    gonio_status (*from_rows)(const gonio_i_reconstruct_task *task, const size_t *rows,
                              size_t count, const double *b, gonio_reconstruction **reconstruction);
    /* For the functions of equations.h; NULL for methods with functions of their own. */
    gonio_status (*solve)(gonio_context *context, const gonio_i_equations *equations,
                          gonio_i_solution *solution);
};

/* The methods. */
#define GONIO_I_RECONSTRUCT_METHODS(METHOD) METHOD(least_squares) METHOD(ridge) METHOD(posterior)

#define GONIO_I_DECLARE_METHOD(name)                                                               \
    extern const gonio_i_reconstruct_method gonio_i_##name##_method;
GONIO_I_RECONSTRUCT_METHODS(GONIO_I_DECLARE_METHOD)

/* Whether the basis has all of rows[count]. Errors: _ARGUMENT. */
gonio_status gonio_i_reconstruct_check_rows(gonio_context *context, const gonio_basis *basis,
                                            const size_t *rows, size_t count);

/* Whether options state apertures, and whether they can be. Errors: _ARGUMENT. */
bool gonio_i_has_apertures(const gonio_reconstruct_options *options);
gonio_status gonio_i_check_half_angles(gonio_context *context,
                                       const gonio_reconstruct_options *options);

/* What is done with readings that are linear about their reconstruction. */
typedef gonio_status gonio_i_apertures_use(void *data, const gonio_i_apertures *apertures);

/* Finds how readings are linear through the apertures that the options of a task state, and uses
 * that once, while it is there. Errors: those of the method and of `use`. */
gonio_status gonio_i_find_apertures(const gonio_i_reconstruct_task *task,
                                    const gonio_readings *readings, gonio_i_apertures_use *use,
                                    void *data);

/* Carries out a task of readings through the apertures that its options state. */
gonio_status gonio_i_reconstruct_apertures(const gonio_i_reconstruct_task *task,
                                           const gonio_readings *readings,
                                           gonio_reconstruction **reconstruction);

/* Checks that basis and options meet the requirements of the method, and the readings unless NULL.
 * Errors: _ARGUMENT; _MISMATCH (spectra and a joint basis). */
gonio_status gonio_i_reconstruct_check(gonio_context *context,
                                       const gonio_i_reconstruct_method *method,
                                       const gonio_basis *basis, const gonio_readings *readings,
                                       const gonio_reconstruct_options *options);

#endif
