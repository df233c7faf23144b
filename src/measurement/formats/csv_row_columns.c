/* Columns of CSV that say something of their row: see csv_finder.h. */
#include "csv_finder.h"
#include "csv_numbers.h"

#include <strings.h>

static void find_planned(const gonio_i_csv_finder *f)
{
    for (size_t k = 0; k < f->r->columns; k++) {
        if (f->name[k].kind == GONIO_I_PLANNED) {
            f->c->column[k].kind = GONIO_I_PLANNED;
        }
    }
}

/* Finds the first column of the time and of the mark of a row. */
static void find_time_and_mark(const gonio_i_csv_finder *f)
{
    bool any_mark = false;
    for (size_t k = 0; k < f->r->columns; k++) {
        gonio_i_csv_column *column = &f->c->column[k];
        if (f->name[k].kind == GONIO_I_TIME && !f->c->any_time) {
            *column = (gonio_i_csv_column){.kind = GONIO_I_TIME, .scale = f->name[k].seconds};
            f->c->any_time = true;
        } else if (f->name[k].kind == GONIO_I_MARK && !any_mark) {
            column->kind = GONIO_I_MARK;
            any_mark = true;
        }
    }
}

/* Finds the column that states the wavelength of the row's one value. */
static void find_row_wavelength(const gonio_i_csv_finder *f)
{
    gonio_i_csv_columns *c = f->c;
    for (size_t k = 0; k < f->r->columns && !c->by_wavelength; k++) {
        if (f->name[k].kind == GONIO_I_ROW_WAVELENGTH && f->family == GONIO_I_UNNAMED &&
            c->channels == 1) {
            c->column[k].kind = GONIO_I_ROW_WAVELENGTH;
            c->stated.wavelengths = f->name[k].wavelength_unit;
            c->by_wavelength = true;
            c->own = false;
        }
    }
}

/* Finds the column that states the polarisation of the light. */
static void find_polarisation(const gonio_i_csv_finder *f)
{
    gonio_i_csv_columns *c = f->c;
    for (size_t k = 0; k < f->r->columns && !c->by_polarisation && c->any_value; k++) {
        if (f->name[k].kind == GONIO_I_POLARISATION) {
            c->column[k].kind = GONIO_I_POLARISATION;
            c->by_polarisation = true;
            c->own = false;
        }
    }
}

/* Whether a column has polarisations that the detector sees. */
static bool is_analyser(const gonio_i_csv_finder *f, size_t column)
{
    static const char *const names[] = {"pol_o",
                                        "pol_r",
                                        "pol_s",
                                        "analyser",
                                        "analyzer",
                                        "polarisation_o",
                                        "polarization_o",
                                        "polarisation_r",
                                        "polarization_r",
                                        "detector polarisation",
                                        "detector polarization",
                                        NULL};
    int state = 0;
    return column < f->r->cells && gonio_i_csv_is_one_of(f->r->name[column], names) &&
           gonio_i_polarisation_of(f->r->cell[column], &state) && state != 0;
}

/* Refuses columns that make one reading of several rows in ways that are not read. */
static gonio_status refuse_parts(const gonio_i_csv_finder *f)
{
    for (size_t k = 0; k < f->r->columns && f->c->any_value; k++) {
        const char *name = f->r->name[k];
        if (is_analyser(f, k)) {
            return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                                "%s: column '%s' has the polarisation that the detector sees; add "
                                "the values of s and of p, and delete it",
                                f->r->path, name);
        }
        if (strncasecmp(name, "wavenumber", 10) == 0 && !f->c->by_wavelength) {
            return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                                "%s: column '%s' is not read; give wavelengths, 1e7 nm divided by "
                                "the wavenumber in 1/cm",
                                f->r->path, name);
        }
    }
    return GONIO_OK;
}

gonio_status gonio_i_csv_find_row_columns(const gonio_i_csv_finder *f)
{
    find_planned(f);
    find_time_and_mark(f);
    find_row_wavelength(f);
    gonio_i_csv_find_row_colours(f);
    find_polarisation(f);
    return refuse_parts(f);
}
