/* The conventions of a file's numbers (units, angles, kinds of values), as words and sentences. */
#ifndef GONIO_CONVENTION_H
#define GONIO_CONVENTION_H

#include <stdio.h>

#include <gonio/measurement.h>

typedef struct gonio_i_choice {
    const char *word;
    int value;
    const char *sentence; /* NULL: not worth saying */
} gonio_i_choice;

enum { GONIO_I_CONVENTION_KEYS = 6, GONIO_I_MOST_CHOICES = 7 };

/* The keys of conventions that are choices. */
typedef struct gonio_i_convention_key {
    const char *name;
    size_t offset;                                /* in gonio_convention */
    gonio_i_choice choices[GONIO_I_MOST_CHOICES]; /* up to the first without a word */
} gonio_i_convention_key;

extern const gonio_i_convention_key gonio_i_convention_keys[GONIO_I_CONVENTION_KEYS];

int *gonio_i_convention_field(gonio_convention *convention, const gonio_i_convention_key *key);

/* The convention in force: the stated one, where `given` says nothing else. */
gonio_convention gonio_i_convention_of(const gonio_convention *stated,
                                       const gonio_convention *given);

/* Prints what is known: "angles in degrees, phi_o = phi_i on the mirror's side, reflectance
 * factors". */
void gonio_i_convention_print(const gonio_convention *convention, FILE *stream);

#endif
