/* One trial: a basis, a plan, readings of test materials, and the errors of the reconstructions. */
#ifndef GONIO_REPRODUCE_HELD_OUT_H
#define GONIO_REPRODUCE_HELD_OUT_H

#include "methods.h"

/* A basis of some materials, and other materials to test it on. */
typedef struct gonio_i_trial {
    const gonio_i_collection *collection;
    const size_t *test; /* [tests] materials */
    size_t tests;
    gonio_basis *basis; /* bivariate, joint; all of its components are used */
    const gonio_basis_view *view;
    double *vectors; /* V, [rows][components] */
} gonio_i_trial;

/* Learns a basis of the materials subset[count] (NULL: all). To be freed in any case. */
gonio_status gonio_i_trial_begin(gonio_context *context, const gonio_i_collection *collection,
                                 const size_t *subset, size_t count, size_t components,
                                 const size_t *test, size_t tests, gonio_i_trial *trial);
void gonio_i_trial_end(gonio_i_trial *trial);

/* errors[tests] of reconstructions by least squares from `count` noise-free readings, rows of the
 * basis; NaN where they have fewer independent ones than there are components. */
gonio_status gonio_i_trial_rows(gonio_context *context, const gonio_i_trial *trial,
                                const size_t *rows, size_t count, gonio_error *errors);

/* The same from all rows: c = V'(b - m), as V is orthonormal. */
gonio_status gonio_i_trial_all_rows(gonio_context *context, const gonio_i_trial *trial,
                                    gonio_error *errors);

/* Plans, then reconstructs as gonio_i_trial_rows. `condition`: the plan's condition number. */
gonio_status gonio_i_trial_plan(gonio_context *context, const gonio_i_trial *trial,
                                const char *method, size_t samples, uint64_t seed,
                                double *condition, gonio_error *errors);

/* errors[split->test_count] of a method on a split, by whole tables unless the basis is the
 * paper's.
 */
gonio_status gonio_i_trial_method(gonio_context *context, const gonio_i_collection *collection,
                                  const gonio_i_method_entry *method, gonio_i_size size,
                                  const gonio_i_split *split, uint64_t seed, double *condition,
                                  gonio_error *errors);

/* A callback that gets each test material and its reconstruction. An error ends the trial. */
typedef struct gonio_i_viewer {
    gonio_status (*show)(void *user, const gonio_material *original, const gonio_material *made);
    void *user;
} gonio_i_viewer;

/* gonio_i_trial_tables with a callback for each material. */
gonio_status gonio_i_trial_seen(gonio_context *context, const gonio_i_collection *collection,
                                const gonio_i_method_entry *method, gonio_i_size size,
                                const gonio_i_split *split, uint64_t seed,
                                const gonio_i_viewer *viewer, double *condition,
                                gonio_error *errors);

/* The same for any basis, by whole tables. It is slower than the functions for the paper's basis.
 * Bases of the full grid are large, and the collection's cache has room for one: for one thread at
 * a time. */
gonio_status gonio_i_trial_tables(gonio_context *context, const gonio_i_collection *collection,
                                  const gonio_i_method_entry *method, gonio_i_size size,
                                  const gonio_i_split *split, uint64_t seed, double *condition,
                                  gonio_error *errors);

#endif
