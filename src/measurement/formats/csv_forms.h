/* Numbers in cells with something behind them: a unit or a per cent sign, which all cells of the
 * column have, and an uncertainty. "98.5 %", "0.3 1/sr", "0.30 +/- 0.01", "(0.30 ± 0.01) 1/sr",
 * "0.312(5)". */
#ifndef GONIO_CSV_FORMS_H
#define GONIO_CSV_FORMS_H

#include "../../core/csv_reader.h"
#include "../readings.h"

enum { GONIO_I_UNIT_ROOM = 24 };

/* What the first number of a column has behind it. */
typedef struct gonio_i_csv_form {
    char unit[GONIO_I_UNIT_ROOM]; /* "" for none */
    bool spread;                  /* an uncertainty */
} gonio_i_csv_form;

typedef struct gonio_i_csv_forms {
    gonio_i_csv_form *column; /* [columns]; NULL: all cells are plain numbers */
} gonio_i_csv_forms;

/* Looks for the first number of each column that is read, and puts its unit behind the column's
 * name, as a line of units does. Errors: _FORMAT for a unit that is not understood or contradicts
 * the name; the message names the cell. _MEMORY. */
gonio_status gonio_i_csv_forms_find(gonio_i_csv_forms *forms, gonio_i_csv_reader *reader,
                                    const gonio_readings_options *options);

/* A cell as a number, with what its column has behind it; NaN if it is none. *spread: its
 * uncertainty, NaN for none. */
double gonio_i_csv_forms_number(const gonio_i_csv_forms *forms, const gonio_i_csv_reader *reader,
                                size_t column, double *spread);

/* Why a cell is no number, where it differs from the cells above. NULL: for no such reason. */
const char *gonio_i_csv_forms_problem(const gonio_i_csv_forms *forms,
                                      const gonio_i_csv_reader *reader, size_t column);

/* Whether numbers of a column have uncertainties. */
bool gonio_i_csv_forms_spread(const gonio_i_csv_forms *forms, size_t column);

void gonio_i_csv_forms_free(gonio_i_csv_forms *forms);

#endif
