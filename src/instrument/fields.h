/* Objects of an instrument file as fields of structs: numbers with their limits, and the other keys
 * that an object may have. */
#ifndef GONIO_FIELDS_H
#define GONIO_FIELDS_H

#include <stddef.h>

#include "instrument.h"

/* A key of an object. */
typedef struct gonio_i_field {
    const char *key;
    bool number; /* false: read elsewhere, only known here */
    bool needed;
    size_t offset;    /* of the double in the struct */
    double low, high; /* what the number may be, in the file's unit */
    double unit;      /* what one of the file's units is here */
} gonio_i_field;

/* Where an object is, for messages: "rig.json: axes.beta". */
typedef struct gonio_i_place {
    gonio_context *context;
    const char *file;
    const char *where; /* "" for the file itself */
} gonio_i_place;

/* Fails with "FILE: WHERE.KEY: ..." (key may be ""). Returns _FORMAT. */
gonio_status gonio_i_fail_at(const gonio_i_place *place, const char *key, const char *format, ...)
    GONIO_I_PRINTF(3, 4);

/* Sets the numbers of an object; those without a key stay. NULL: no object, and nothing is set.
 * Errors: _FORMAT for unknown or missing keys, other things than numbers, numbers out of range. */
gonio_status gonio_i_read_fields(const gonio_i_place *place, const json_t *object,
                                 const gonio_i_field *field, size_t count, void *into);

/* The string of a key; `otherwise` if it is missing. Errors: _FORMAT for something else. */
gonio_status gonio_i_read_text(const gonio_i_place *place, const json_t *object, const char *key,
                               const char *otherwise, const char **text);

/* True or false; *value stays where the key is missing. */
gonio_status gonio_i_read_flag(const gonio_i_place *place, const json_t *object, const char *key,
                               bool *value);

/* The place of a word in a list that ends with NULL; *choice stays where the key is missing. */
gonio_status gonio_i_read_word(const gonio_i_place *place, const json_t *object, const char *key,
                               const char *const *words, int *choice);

/* An array of numbers, or of `columns` numbers each, as [rows][columns]; NULL and 0 where the key
 * is missing. The caller frees it. */
gonio_status gonio_i_read_numbers(const gonio_i_place *place, const json_t *object, const char *key,
                                  size_t columns, double **numbers, size_t *rows);

#endif
