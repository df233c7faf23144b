/* The line of units below the names: see csv_unit_row.h. */
#include "csv_unit_row.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "csv_names.h"
#include "csv_numbers.h"

/* Whether a row is one of units: it has a unit of angles, and no number except 1. */
static bool is_unit_row(const gonio_i_csv_reader *r)
{
    bool angle = false;
    for (size_t k = 0; k < r->cells; k++) {
        double number = 0.0;
        if ((gonio_i_csv_is_number(r->cell[k], r->delimiter, &number) && number != 1.0) ||
            gonio_i_csv_is_angle(r->cell[k], r->delimiter, &number)) {
            return false;
        }
        const bool unit = gonio_i_angle_unit_in(r->cell[k]) != 0;
        if (unit && strtod(r->cell[k], NULL) != 0.0) {
            return false; /* 0.3 rad */
        }
        angle = angle || unit;
    }
    return angle;
}

/* Whether a row has a word, and neither a number nor what stands for one that is missing. */
static bool is_row_of_words(const gonio_i_csv_reader *r)
{
    bool word = false;
    for (size_t k = 0; k < r->cells; k++) {
        double number = 0.0;
        const char *cell = r->cell[k];
        if (gonio_i_csv_is_number(cell, r->delimiter, &number) || strpbrk(cell, "0123456789")) {
            return false;
        }
        word = word || (*cell != '\0' && strcasecmp(cell, "NA") != 0);
    }
    return word;
}

gonio_status gonio_i_csv_take_units(gonio_i_csv_reader *reader)
{
    gonio_status status = gonio_i_csv_next(reader);
    if (status == GONIO_OK && is_unit_row(reader)) {
        status = gonio_i_csv_units_behind_names(reader, reader->cell);
        if (status != GONIO_OK) {
            return status;
        }
        status = gonio_i_csv_next(reader); /* plotting programs write a line of comments below */
        if (status == GONIO_OK && is_row_of_words(reader)) {
            return GONIO_OK;
        }
    }
    gonio_i_csv_again(reader);
    return status;
}
