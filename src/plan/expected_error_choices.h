/* The readings that a plan of least expected error may choose from: the rows of a basis, or listed
 * directions. */
#ifndef GONIO_EXPECTED_ERROR_CHOICES_H
#define GONIO_EXPECTED_ERROR_CHOICES_H

#include "expected_error_plan.h"

typedef struct gonio_i_choices {
    gonio_context *context;
    gonio_i_prior *prior;
    size_t rows;
    size_t components;          /* of f below: K, or the rank of the candidates' covariance */
    float *f;                   /* [rows][components]: of the prior */
    double *mean;               /* [rows]: of g */
    double *loss;               /* [rows]: weight of the squared error of g there */
    bool *allowed;              /* [rows]: whether it may be chosen */
    gonio_half_difference *at;  /* [rows] */
    gonio_pair *pair;           /* [rows]: where azimuths count; NULL elsewhere */
    const gonio_i_known *known; /* NULL: nothing */
    const double *covariance;   /* [components][components]: of what f multiplies; NULL: I */
    double *own_covariance;     /* the same if it is the choices' own, or NULL */
    double noise;               /* standard deviation of a reading, log units */
} gonio_i_choices;

/* Standard deviation of a reading that plans reckon with, log units. */
extern const double gonio_i_noise_of_readings;

/* The covariance of the remainder that plans among pairs of directions reckon with. */
double gonio_i_planned_remainder(const gonio_i_place *a, const gonio_i_place *b);

/* f, mean, loss, allowed and at, for p->rows rows of p->components. Errors: _MEMORY. */
gonio_status gonio_i_choices_allocate(gonio_i_choices *p);

/* All rows of the basis. p->context, p->prior and p->known are set before. To be freed in any case.
 * Errors: _MEMORY. */
gonio_status gonio_i_choices_of_rows(gonio_i_choices *p, gonio_metric metric);

/* The directions options->candidates, at most a hundred thousand. Of candidates that are the same
 * direction only the first is allowed. The remainder between them is part of f, unless something is
 * known and the plan does not go on. If it does, the directions that were read are further rows,
 * which are not allowed. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_choices_of_candidates(gonio_i_choices *p, const gonio_plan_options *options);

/* Sets the covariance to that after readings at the last p->known->count rows, whatever their
 * values are. Errors: _MEMORY, _NUMERICAL. */
gonio_status gonio_i_choices_after_readings(gonio_i_choices *p);

/* Excludes directions that were read, of p->known. Errors: _MEMORY. */
gonio_status gonio_i_choices_leave_out_read(gonio_i_choices *p);

/* How many may be chosen. */
size_t gonio_i_choices_count(const gonio_i_choices *p);

void gonio_i_choices_free(gonio_i_choices *p);

#endif
