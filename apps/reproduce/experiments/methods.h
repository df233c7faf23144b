/* The methods that Fig. 3(b) compares. To add one, add a line to the table in methods.c. */
#ifndef GONIO_REPRODUCE_METHODS_H
#define GONIO_REPRODUCE_METHODS_H

#include "setup.h"

enum { GONIO_I_OWN_SIZE = -1 };

typedef struct gonio_i_method_entry {
    const char *name;  /* for files and programs */
    const char *label; /* for people */
    /* The basis that it learns. */
    gonio_representation representation;
    gonio_channel_model channels;
    gonio_mapping mapping;
    int chosen; /* the size is the study's chosen[]; or GONIO_I_OWN_SIZE */
    bool without_mean;
    bool quoted;       /* the paper quotes its errors for single materials; one method only */
    const char *plan;  /* gonio_plan_method_name; the reconstruction follows from it */
    gonio_i_size size; /* then; 0 components: as many as materials */
} gonio_i_method_entry;

/* The number of methods that a study compares: a quick one has none of the full grid. */
size_t gonio_i_methods(const gonio_i_study *study);
const gonio_i_method_entry *gonio_i_method_at(size_t index);

/* K and L of a method, at most what the materials of a split allow. */
gonio_i_size gonio_i_method_size(const gonio_i_study *study, const gonio_i_method_entry *method);

/* The method that the paper compares with, and its size for a basis of this many materials. */
const gonio_i_method_entry *gonio_i_quoted_method(void);
gonio_i_size gonio_i_quoted_size(size_t materials);

#endif
