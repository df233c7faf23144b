/* Numbers with something behind them: see csv_forms.h. */
#include "csv_forms.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "csv_columns.h"
#include "csv_names.h"
#include "csv_numbers.h"
#include "csv_unit_row.h"

enum { CELL_ROOM = 96 };

/* ---- one cell ---- */

/* A cell taken apart. */
typedef struct parts {
    double number;
    double spread; /* NaN: none */
    bool both;     /* the number and its uncertainty have the sign of per cent */
    char unit[GONIO_I_UNIT_ROOM];
} parts;

/* Takes a decimal number, not one in words. NULL if there is none. */
static const char *take_number(const char *at, double *number)
{
    const char *digit = at + strspn(at, "+-");
    digit += *digit == '.';
    char *end = NULL;
    if (digit - at > 2 || !isdigit((unsigned char)*digit) || tolower(digit[1]) == 'x') {
        return NULL;
    }
    *number = strtod(at, &end);
    return end != at && isfinite(*number) ? end : NULL;
}

/* The sign between a value and its uncertainty, and blanks; NULL if it is not there. */
static const char *skip_sign(const char *at)
{
    static const char *const signs[] = {"\xc2\xb1", "\xb1", "+/-", "+-"};
    at = gonio_i_skip_blanks(at);
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        if (strncmp(at, signs[k], strlen(signs[k])) == 0) {
            return gonio_i_skip_blanks(at + strlen(signs[k]));
        }
    }
    return NULL;
}

/* Takes the uncertainty of the last digits, "(5)" behind 0.312, and an exponent behind it. NULL if
 * it is not there. */
static const char *take_last_digits(const char *from, const char *at, parts *p)
{
    const size_t length = *at == '(' ? strspn(at + 1, "0123456789") : 0;
    if (length == 0 || length > 4 || at[length + 1] != ')' || memchr(from, 'e', at - from) ||
        memchr(from, 'E', at - from)) {
        return NULL;
    }
    const char *point = memchr(from, '.', (size_t)(at - from));
    const double places = point != NULL ? (double)(at - point - 1) : 0.0;
    double scale = 1.0;
    const char *behind = at + length + 2;
    char *end = (char *)behind;
    if (*behind == 'e' || *behind == 'E') {
        const long power = strtol(behind + 1, &end, 10);
        scale = labs(power) < 300 ? pow(10.0, (double)power) : NAN;
    }
    p->spread = strtod(at + 1, NULL) * pow(10.0, -places) * scale;
    p->number *= scale;
    return isfinite(scale) ? end : NULL;
}

/* Copies a cell with decimal points. False for one that is too long to be a number. */
static bool copy_plain(const char *cell, char delimiter, char text[CELL_ROOM])
{
    const size_t length = strlen(cell);
    if (length >= CELL_ROOM) {
        return false;
    }
    memcpy(text, cell, length + 1);
    for (char *at = text; delimiter != ',' && *at != '\0'; at++) {
        const bool inside = *at == ',' && isdigit((unsigned char)at[1]);
        *at = inside ? '.' : *at;
    }
    return true;
}

/* "98.5 % +/- 0.5 %": where the uncertainty is, if both have the sign; NULL otherwise. */
static const char *skip_per_cent(const char *at)
{
    const char *behind =
        *gonio_i_skip_blanks(at) == '%' ? skip_sign(gonio_i_skip_blanks(at) + 1) : NULL;
    const char *end = behind != NULL ? strchr(behind, '%') : NULL;
    return end != NULL && *gonio_i_skip_blanks(end + 1) == '\0' ? behind : NULL;
}

/* Takes the uncertainty behind a number and what closes the bracket before it. NULL: none of it
 * fits. */
static const char *take_spread(const char *from, const char *at, bool open, parts *p)
{
    const char *digits = take_last_digits(from, at, p);
    const char *behind = digits == NULL ? skip_sign(at) : NULL;
    p->both = behind == NULL && digits == NULL && !open && skip_per_cent(at) != NULL;
    behind = p->both ? skip_per_cent(at) : behind;
    at = digits != NULL ? digits : at;
    if (behind != NULL) {
        at = take_number(behind, &p->spread);
    }
    at = at != NULL ? gonio_i_skip_blanks(at) : NULL;
    if (open && at != NULL) {
        at = *at == ')' ? gonio_i_skip_blanks(at + 1) : NULL;
    }
    return at;
}

/* Whether "0.30 ± 3 %" leaves open what the per cent are of. */
static bool is_unclear(const parts *p, bool open)
{
    return !isnan(p->spread) && !open && !p->both && strchr(p->unit, '%') != NULL;
}

/* Whether a text may be a unit, and is not the rest of a wrong number. */
static bool is_unit(const char *text)
{
    return *text == '\0' || isalpha((unsigned char)*text) || (unsigned char)*text >= 0x80 ||
           strchr("%[(/", *text) != NULL || strncmp(text, "1/", 2) == 0;
}

/* Takes a cell apart. False if it is no number with something behind it. */
static bool take_apart(const char *cell, char delimiter, parts *p)
{
    char text[CELL_ROOM];
    *p = (parts){.spread = NAN};
    if (!copy_plain(cell, delimiter, text)) {
        return false;
    }
    const char *from = gonio_i_skip_blanks(text);
    const bool open = *from == '(';
    from = gonio_i_skip_blanks(from + open);
    const char *at = take_number(from, &p->number);
    at = at != NULL ? take_spread(from, at, open, p) : NULL;
    if (at == NULL || strlen(at) >= sizeof p->unit || (p->spread < 0.0)) {
        return false;
    }
    memcpy(p->unit, at, strlen(at) + 1);
    for (size_t k = strlen(p->unit); k > 0 && p->unit[k - 1] == ' '; k--) {
        p->unit[k - 1] = '\0';
    }
    return is_unit(p->unit) && !is_unclear(p, open);
}

double gonio_i_csv_forms_number(const gonio_i_csv_forms *forms, const gonio_i_csv_reader *reader,
                                size_t column, double *spread)
{
    const char *cell = reader->cell[column];
    const gonio_i_csv_form *form = forms->column != NULL ? &forms->column[column] : NULL;
    const bool bare = form == NULL || form->unit[0] == '\0';
    double number = NAN;
    parts p;
    *spread = NAN;
    if (bare && gonio_i_csv_is_number(cell, reader->delimiter, &number)) {
        return number;
    }
    if (form == NULL || !take_apart(cell, reader->delimiter, &p) ||
        strcmp(p.unit, form->unit) != 0 || (!isnan(p.spread) && !form->spread)) {
        return NAN;
    }
    *spread = p.spread;
    return p.number;
}

const char *gonio_i_csv_forms_problem(const gonio_i_csv_forms *forms,
                                      const gonio_i_csv_reader *reader, size_t column)
{
    static const gonio_i_csv_form plain = {.unit = ""};
    const gonio_i_csv_form *form = forms->column != NULL ? &forms->column[column] : &plain;
    const char *cell = reader->cell[column];
    double number = 0.0;
    parts p;
    if (gonio_i_csv_is_number(cell, reader->delimiter, &number)) {
        return form->unit[0] == '\0' || !isfinite(number)
                   ? NULL
                   : "has no unit or per cent sign, but the column's first number has";
    }
    if (!take_apart(cell, reader->delimiter, &p)) {
        const bool unclear = skip_sign(cell + strcspn(cell, "+\xc2\xb1")) != NULL;
        return unclear ? "leaves open what its uncertainty is; write (0.30 +/- 0.01), and per cent "
                         "behind brackets or behind the number"
                       : NULL;
    }
    if (strcmp(p.unit, form->unit) != 0) {
        return form->unit[0] == '\0'
                   ? "is not a finite number as the column's first one is: there is "
                     "something behind it"
                   : "has not the unit of the column's first number";
    }
    return isnan(p.spread) ? NULL : "has an uncertainty, but the column's first number has none";
}

bool gonio_i_csv_forms_spread(const gonio_i_csv_forms *forms, size_t column)
{
    return forms->column != NULL && forms->column[column].spread;
}

/* ---- the columns ---- */

static gonio_status refuse_unit(const gonio_i_csv_reader *r, const gonio_i_csv_reader *scan,
                                size_t column, const char *problem)
{
    return gonio_i_fail(r->context, GONIO_ERROR_FORMAT, "%s:%zu: %.40s '%.40s' %s", r->path,
                        scan->line, r->name[column], scan->cell[column], problem);
}

/* Whether a unit of values goes with a name that states one. */
static bool agrees(const gonio_i_column_name *before, const gonio_i_column_name *after,
                   const char *unit)
{
    const int said = gonio_i_value_kind_in(unit);
    const bool cosine = said == GONIO_VALUE_BRDF && after->unit == GONIO_VALUE_COSINE;
    return (said == after->unit || cosine) &&
           (before->strength != GONIO_I_CERTAIN || before->unit == after->unit);
}

/* Checks that a unit is one of the column's quantity and says nothing else. */
static gonio_status check_unit(const gonio_i_csv_reader *r, const gonio_i_csv_reader *scan,
                               size_t column, const char *unit)
{
    char name[GONIO_I_UNIT_ROOM + 128];
    const gonio_i_column_name before = gonio_i_column_name_of(r->name[column]);
    const int length = snprintf(name, sizeof name, "%s (%s)", r->name[column], unit);
    const gonio_i_column_name after = length > 0 && (size_t)length < sizeof name
                                          ? gonio_i_column_name_of(name)
                                          : (gonio_i_column_name){0};
    const bool logarithm = after.scale != 0 && after.scale == gonio_i_value_scale_in(unit);
    const bool unit_known = after.kind == GONIO_I_ROW_WAVELENGTH ? after.wavelength_unit != 0
                                                                 : after.unit != 0 || logarithm;
    if (after.kind != before.kind || after.index != before.index ||
        after.wavelength != before.wavelength || after.family != before.family || !unit_known) {
        return refuse_unit(r, scan, column, "is not a finite number in a unit that is known");
    }
    const bool values = after.kind == GONIO_I_VALUE && !logarithm;
    return values && !agrees(&before, &after, unit)
               ? refuse_unit(r, scan, column, "has another unit than the column's name")
               : GONIO_OK;
}

/* The search: the columns whose first number was not seen yet. */
typedef struct search {
    gonio_i_csv_reader *reader;
    gonio_i_csv_reader scan; /* the same text, read ahead */
    gonio_i_csv_forms *forms;
    size_t count;
    size_t *column; /* [count] */
} search;

static bool is_wanted(const gonio_readings_options *options, const char *name)
{
    const gonio_i_column_name meaning = gonio_i_column_name_of(name);
    const gonio_i_column_kind kind = meaning.kind;
    const bool value = kind == GONIO_I_VALUE || kind == GONIO_I_DEVIATION;
    if (kind == GONIO_I_ANGLE && meaning.index == GONIO_I_NAMED_GEOMETRY) {
        return false;
    }
    return kind == GONIO_I_ANGLE || (!options->directions_only && value) ||
           kind == GONIO_I_ROW_WAVELENGTH;
}

static gonio_status take_form(search *s, size_t column, const parts *p)
{
    gonio_i_csv_forms *forms = s->forms;
    if (forms->column == NULL) {
        forms->column =
            gonio_i_allocate(s->reader->context, s->reader->columns, sizeof *forms->column);
    }
    if (forms->column == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(forms->column[column].unit, p->unit, sizeof p->unit);
    forms->column[column].spread = !isnan(p->spread);
    return p->unit[0] != '\0' ? check_unit(s->reader, &s->scan, column, p->unit) : GONIO_OK;
}

/* Looks at the cell of a column. *known: nothing more is to be learned of it. */
static gonio_status look_at_cell(search *s, size_t column, bool *known)
{
    const char *cell = s->scan.cell[column];
    const char delimiter = s->scan.delimiter;
    double number = 0.0;
    parts p;
    *known = !gonio_i_csv_is_empty(cell) && !gonio_i_csv_is_mark(cell);
    return *known && !gonio_i_csv_is_number(cell, delimiter, &number) &&
                   !gonio_i_csv_is_angle(cell, delimiter, &number) &&
                   take_apart(cell, delimiter, &p)
               ? take_form(s, column, &p)
               : GONIO_OK;
}

static gonio_status look_at_row(search *s)
{
    gonio_status status = GONIO_OK;
    size_t kept = 0;
    for (size_t k = 0; k < s->count && status == GONIO_OK; k++) {
        bool known = false;
        status = look_at_cell(s, s->column[k], &known);
        if (!known) {
            s->column[kept++] = s->column[k];
        }
    }
    s->count = kept;
    return status;
}

/* Rows that cannot be read are for the reader to refuse: here nothing is said of them. */
static gonio_status look_at_rows(search *s)
{
    gonio_status status = GONIO_OK;
    s->scan.remarks_allowed = s->reader->remarks_allowed;
    bool more = gonio_i_csv_take_units(&s->scan) == GONIO_OK;
    while (more && s->count > 0 && status == GONIO_OK) {
        more = gonio_i_csv_next(&s->scan) == GONIO_OK && s->scan.cells > 0;
        status = more ? look_at_row(s) : GONIO_OK;
    }
    return status;
}

/* Puts units behind the names. */
static gonio_status name_units(const gonio_i_csv_forms *forms, gonio_i_csv_reader *reader)
{
    char **unit = gonio_i_allocate(reader->context, reader->columns, sizeof *unit);
    if (unit == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < reader->columns; k++) {
        unit[k] = forms->column[k].unit;
    }
    const gonio_status status = gonio_i_csv_units_behind_names(reader, unit);
    free(unit);
    return status;
}

gonio_status gonio_i_csv_forms_find(gonio_i_csv_forms *forms, gonio_i_csv_reader *reader,
                                    const gonio_readings_options *options)
{
    search s = {.reader = reader, .forms = forms};
    *forms = (gonio_i_csv_forms){NULL};
    s.column = gonio_i_allocate(reader->context, reader->columns, sizeof *s.column);
    gonio_status status = s.column != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < reader->columns && status == GONIO_OK; k++) {
        if (is_wanted(options, reader->name[k])) {
            s.column[s.count++] = k;
        }
    }
    if (status == GONIO_OK) {
        status = gonio_i_csv_open(NULL, reader->path, reader->text, reader->size, &s.scan);
    }
    if (status == GONIO_OK) {
        status = look_at_rows(&s);
        gonio_i_csv_close(&s.scan);
    }
    free(s.column);
    return status == GONIO_OK && forms->column != NULL ? name_units(forms, reader) : status;
}

void gonio_i_csv_forms_free(gonio_i_csv_forms *forms)
{
    free(forms->column);
    forms->column = NULL;
}
