/* The columns of readings as CSV: see csv_columns.h. */
#include "csv_columns.h"

#include <stdlib.h>
#include <string.h>

#include "../rules.h"

/* The search for columns. */
typedef struct finder {
    const gonio_i_csv_reader *r;
    const gonio_readings_options *options;
    gonio_i_csv_columns *c;
    gonio_i_column_name *name; /* [columns] */
    gonio_i_strength strongest;
    gonio_i_family family; /* of the channels that are read */
    int quantity;
} finder;

static gonio_status refuse_two(const finder *f, const char *what, size_t a, size_t b)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: two columns of %s, '%s' and '%s'; delete or rename one", f->r->path,
                        what, f->r->name[a], f->r->name[b]);
}

/* Checks that columns agree in their unit. unit: of one column; *stated: of those before, 0 for
 * none.
 */
static gonio_status agree(const finder *f, const char *what, const char *key, size_t k, int unit,
                          int *stated, size_t *by)
{
    if (unit != 0 && *stated != 0 && unit != *stated) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: the %s of columns '%s' and '%s' differ in their unit; give one "
                            "unit, or state it by --as %s=...",
                            f->r->path, what, f->r->name[*by], f->r->name[k], key);
    }
    *by = unit != 0 ? k : *by;
    *stated = unit != 0 ? unit : *stated;
    return GONIO_OK;
}

/* The text after the key of a comment "key: ...", in any letter case; NULL for another key. */
static const char *text_behind(const char *comment, const char *key)
{
    const size_t length = strlen(key);
    const bool same = strncasecmp(comment, key, length) == 0 && comment[length] == ':';
    return same ? comment + length + 1 + strspn(comment + length + 1, " ") : NULL;
}

/* The text of the first comment with one of the keys, which end with NULL. */
static const char *comment_of(const finder *f, const char *const *keys)
{
    const char *text = NULL;
    for (size_t k = 0; k < f->r->comment.count && text == NULL; k++) {
        for (size_t j = 0; keys[j] != NULL && text == NULL; j++) {
            text = text_behind(f->r->comment.line[k], keys[j]);
        }
    }
    return text;
}

/* ---- angles ---- */

/* Chooses the column of each angle. gonio's own names come before others. */
static gonio_status choose_angles(const finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    for (size_t k = 0; k < none; k++) {
        if (f->name[k].kind != GONIO_I_ANGLE) {
            continue;
        }
        size_t *at = &chosen[f->name[k].index];
        if (*at == none || (f->name[k].own && !f->name[*at].own)) {
            *at = k;
        } else if (f->name[k].own == f->name[*at].own) {
            return refuse_two(f, "the same angle", *at, k);
        }
    }
    return GONIO_OK;
}

static gonio_status refuse_missing(const finder *f, size_t angle)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: no column '%s'; theta_i_deg, phi_i_deg, theta_o_deg and phi_o_deg "
                        "are needed",
                        f->r->path, gonio_i_angle_names[angle]);
}

static gonio_status check_angles(const finder *f, const size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    for (size_t angle = 0; angle < 4; angle++) {
        const bool replaced = angle % 2 == 1 && f->c->difference_gives != 0;
        if (chosen[angle] == f->r->columns && !replaced) {
            return refuse_missing(f, angle);
        }
    }
    return GONIO_OK;
}

static gonio_status find_angles(const finder *f)
{
    static const char *const keys[] = {"angles", "angle unit", "angle units",
                                       "unit",   "units",      NULL};
    const size_t none = f->r->columns;
    size_t chosen[GONIO_I_ANGLE_COLUMNS] = {none, none, none, none, none};
    size_t by = 0;
    gonio_status status = choose_angles(f, chosen);
    if (chosen[GONIO_I_AZIMUTH_DIFFERENCE] != none) {
        f->c->difference_gives = chosen[3] == none ? 3 : chosen[1] == none ? 1 : 0;
    }
    status = status == GONIO_OK ? check_angles(f, chosen) : status;
    f->c->own_angles = f->c->difference_gives == 0;
    for (size_t angle = 0; angle < GONIO_I_ANGLE_COLUMNS && status == GONIO_OK; angle++) {
        const size_t k = chosen[angle];
        if (k == none || (angle == GONIO_I_AZIMUTH_DIFFERENCE && f->c->difference_gives == 0)) {
            continue;
        }
        f->c->column[k] = (gonio_i_csv_column){.kind = GONIO_I_ANGLE, .index = angle};
        f->c->own_angles = f->c->own_angles && f->name[k].own;
        if (f->options->as.angles == GONIO_AS_STATED) {
            status = agree(f, "angles", "angles", k, f->name[k].unit, &f->c->stated.angles, &by);
        }
    }
    const char *comment = comment_of(f, keys);
    if (f->c->stated.angles == 0 && comment != NULL) {
        f->c->stated.angles = gonio_i_angle_unit_in(comment);
    }
    return status;
}

/* ---- values ---- */

/* The first certain column of a family; the number of columns if there is none. */
static size_t first_certain(const finder *f, gonio_i_family family)
{
    size_t k = 0;
    while (k < f->r->columns && !(f->name[k].kind == GONIO_I_VALUE && f->name[k].family == family &&
                                  f->name[k].strength == GONIO_I_CERTAIN)) {
        k++;
    }
    return k;
}

/* The rank of a family: wavelengths come before colours, colours before unnamed channels. */
static int rank(gonio_i_family family)
{
    return family == GONIO_I_WAVELENGTH ? 2 : family == GONIO_I_COLOUR ? 1 : 0;
}

/* Whether a name is surer than those before. A name of only a channel and a unit, as gonio's, comes
 * before one that names a quantity. */
static bool is_surer(const finder *f, const gonio_i_column_name *n)
{
    if (n->strength != f->strongest) {
        return n->strength > f->strongest;
    }
    return rank(n->family) > rank(f->family) ||
           (n->family == f->family && n->quantity == 0 && f->quantity != 0);
}

/* Chooses the family and the quantity of the values: those of the surest name. */
static gonio_status choose_family(finder *f)
{
    const size_t colour = first_certain(f, GONIO_I_COLOUR);
    const size_t wavelength = first_certain(f, GONIO_I_WAVELENGTH);
    if (colour < f->r->columns && wavelength < f->r->columns) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: columns of colours (%s) and of wavelengths (%s); delete one kind",
                            f->r->path, f->r->name[colour], f->r->name[wavelength]);
    }
    f->family = GONIO_I_COLOUR;
    for (size_t k = 0; k < f->r->columns; k++) {
        const gonio_i_column_name *n = &f->name[k];
        if (n->kind == GONIO_I_VALUE && is_surer(f, n)) {
            f->strongest = n->strength;
            f->family = n->family;
            f->quantity = n->quantity;
        }
    }
    return GONIO_OK;
}

static bool is_chosen(const finder *f, const gonio_i_column_name *n)
{
    return n->kind == GONIO_I_VALUE && n->family == f->family &&
           (n->quantity == f->quantity || n->quantity == 0) &&
           (n->strength > GONIO_I_BARE || f->strongest == GONIO_I_BARE);
}

static gonio_status add_value(const finder *f, size_t k, size_t *unit_by, size_t *wave_by)
{
    gonio_i_csv_columns *c = f->c;
    const gonio_i_column_name *n = &f->name[k];
    const size_t index = n->family == GONIO_I_COLOUR ? n->index : c->channels++;
    gonio_status status = GONIO_OK;
    if (n->family == GONIO_I_WAVELENGTH) {
        c->wavelength[index] = n->wavelength;
    }
    c->column[k] = (gonio_i_csv_column){GONIO_I_VALUE, index, n->wavelength, 0.0};
    c->any_value = true;
    c->own = c->own && n->own;
    if (f->options->as.values == GONIO_AS_STATED) {
        status = agree(f, "values", "values", k, n->unit, &c->stated.values, unit_by);
    }
    if (status == GONIO_OK && f->options->as.wavelengths == GONIO_AS_STATED) {
        status = agree(f, "wavelengths", "wavelengths", k, n->wavelength_unit,
                       &c->stated.wavelengths, wave_by);
    }
    return status;
}

/* Takes the kind of values from a comment if the names do not state it. */
static void take_value_comment(gonio_i_csv_columns *c, const char *comment)
{
    const int kind = comment != NULL ? gonio_i_value_kind_in(comment) : 0;
    const bool by_name = c->stated.values != 0;
    const bool of_angles = comment != NULL && kind == 0 && gonio_i_angle_unit_in(comment) != 0;
    c->stated.values = by_name ? c->stated.values : kind;
    const bool heeded = by_name ? kind == 0 || kind == c->stated.values : kind != 0;
    c->unclear = heeded || of_angles ? NULL : comment;
}

static gonio_status find_values(const finder *f)
{
    static const char *const keys[] = {"values", "unit", "units", "value unit", "quantity", NULL};
    gonio_i_csv_columns *c = f->c;
    gonio_status status = GONIO_OK;
    size_t unit_by = 0;
    size_t wave_by = 0;
    c->channels = f->family == GONIO_I_COLOUR ? GONIO_CHANNELS : 0;
    for (size_t k = 0; k < f->r->columns && status == GONIO_OK; k++) {
        if (is_chosen(f, &f->name[k])) {
            status = add_value(f, k, &unit_by, &wave_by);
        }
    }
    take_value_comment(c, comment_of(f, keys));
    return status;
}

/* ---- deviations, by the key of their channel ---- */

typedef struct keyed {
    double key; /* colour, wavelength or number */
    size_t column;
} keyed;

typedef struct key_list {
    size_t count;
    keyed *item; /* [count], ascending */
} key_list;

static double key_of(const gonio_i_column_name *n)
{
    return n->family == GONIO_I_WAVELENGTH ? n->wavelength : (double)n->index;
}

static int compare_keys(const void *a, const void *b)
{
    const keyed *x = a;
    const keyed *y = b;
    const int order = (x->key > y->key) - (x->key < y->key);
    return order != 0 ? order : (x->column > y->column) - (x->column < y->column);
}

static gonio_status list_values(const finder *f, key_list *list)
{
    list->count = 0;
    list->item = gonio_i_allocate(f->r->context, f->r->columns, sizeof *list->item);
    if (list->item == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < f->r->columns; k++) {
        if (f->c->column[k].kind == GONIO_I_VALUE) {
            list->item[list->count++] = (keyed){key_of(&f->name[k]), k};
        }
    }
    qsort(list->item, list->count, sizeof *list->item, compare_keys);
    return GONIO_OK;
}

static gonio_status refuse_twice(const finder *f, const key_list *list)
{
    for (size_t k = 1; k < list->count; k++) {
        const keyed *a = &list->item[k - 1];
        if (a->key == list->item[k].key) {
            char what[64] = "values";
            if (f->family == GONIO_I_WAVELENGTH) {
                snprintf(what, sizeof what, "%.10g %s", a->key,
                         f->c->stated.wavelengths == GONIO_MICROMETRES ? "um" : "nm");
            } else if (f->family == GONIO_I_COLOUR) {
                snprintf(what, sizeof what, "%c", "RGB"[(int)a->key]);
            }
            return refuse_two(f, what, a->column, list->item[k].column);
        }
    }
    return GONIO_OK;
}

static int compare_to_key(const void *key, const void *item)
{
    const double wanted = *(const double *)key;
    const double has = ((const keyed *)item)->key;
    return (wanted > has) - (wanted < has);
}

/* The column of values that a deviation belongs to; the number of columns if there is none. A
 * deviation without a channel belongs to the only channel. */
static size_t value_of(const finder *f, const key_list *list, const gonio_i_column_name *n)
{
    const double key = key_of(n);
    const bool same = n->family == f->family &&
                      (n->quantity == 0 || f->quantity == 0 || n->quantity == f->quantity);
    const bool only = list->count == 1 && n->family == GONIO_I_UNNAMED && n->index == 0 &&
                      (n->quantity == 0 || n->quantity == f->quantity);
    const keyed *found = only ? list->item
                         : same && list->count > 0
                             ? bsearch(&key, list->item, list->count, sizeof(keyed), compare_to_key)
                             : NULL;
    return found != NULL ? found->column : f->r->columns;
}

static void add_deviation(const finder *f, size_t k, size_t value, bool *taken)
{
    const gonio_i_column_name *n = &f->name[k];
    gonio_i_csv_columns *c = f->c;
    const bool percent = n->unit == GONIO_VALUE_PERCENT;
    const bool relative = n->relative || (percent && c->stated.values != GONIO_VALUE_PERCENT);
    c->column[k] =
        (gonio_i_csv_column){GONIO_I_DEVIATION, c->column[value].index, c->column[value].wavelength,
                             !relative ? 0.0
                             : percent ? 0.01
                                       : 1.0};
    c->any_deviation = true;
    c->own = c->own && n->own;
    taken[c->column[value].index] = true;
}

static void try_deviation(const finder *f, size_t k, const key_list *list, bool *taken)
{
    const size_t value = value_of(f, list, &f->name[k]);
    if (value < f->r->columns && !taken[f->c->column[value].index]) {
        add_deviation(f, k, value, taken);
    }
}

/* Finds the deviations of the values that are read. Of two for the same values, gonio's own name
 * comes first. */
static gonio_status find_deviations(const finder *f)
{
    key_list list;
    bool *taken = gonio_i_allocate(f->r->context, f->c->channels + 1, sizeof *taken);
    gonio_status status = taken != NULL ? list_values(f, &list) : GONIO_ERROR_MEMORY;
    if (status != GONIO_OK) {
        free(taken);
        return status;
    }
    status = refuse_twice(f, &list);
    for (int own = 1; own >= 0 && status == GONIO_OK; own--) {
        for (size_t k = 0; k < f->r->columns; k++) {
            if (f->name[k].kind == GONIO_I_DEVIATION && f->name[k].own == (own == 1)) {
                try_deviation(f, k, &list, taken);
            }
        }
    }
    free(list.item);
    free(taken);
    return status;
}

/* ---- all ---- */

/* The name of a column that is not read but holds a number; NULL if there is none. */
static const char *number_not_read(const finder *f)
{
    double value = 0.0;
    for (size_t k = 0; k < f->r->cells; k++) {
        if (f->c->column[k].kind == GONIO_I_OTHER && f->r->name[k][0] != '\0' &&
            strcasecmp(f->r->name[k], "expected_e6_percent") != 0 &&
            strncasecmp(f->r->name[k], "axis_", 5) != 0 &&
            gonio_i_csv_is_number(f->r->cell[k], f->r->delimiter, &value)) {
            return f->r->name[k];
        }
    }
    return NULL;
}

static gonio_status refuse_no_values(const finder *f)
{
    const char *number = number_not_read(f);
    return number != NULL
               ? gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                              "%s: no column of values: '%s' is not understood; name values "
                              "R_per_sr, G_per_sr, B_per_sr, 400nm_per_sr ... or value_per_sr",
                              f->r->path, number)
               : gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                              "%s: no column of values (R_per_sr, G_per_sr, B_per_sr, or "
                              "400nm_per_sr ...): a plan that was not measured yet?",
                              f->r->path);
}

static void find_planned(const finder *f)
{
    for (size_t k = 0; k < f->r->columns; k++) {
        if (f->name[k].kind == GONIO_I_PLANNED) {
            f->c->column[k].kind = GONIO_I_PLANNED;
        }
    }
}

/* Finds the first column of the time and of the mark of a row. */
static void find_time_and_mark(const finder *f)
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
static void find_row_wavelength(const finder *f)
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

/* Orders the columns: angles first, then the channel, so that errors come in this order. Marks come
 * before values, deviations behind them. */
static gonio_status order_columns(const finder *f)
{
    gonio_i_csv_columns *c = f->c;
    c->read = gonio_i_allocate(f->r->context, c->count, sizeof *c->read);
    for (gonio_i_column_kind kind = GONIO_I_ANGLE; c->read != NULL && kind <= GONIO_I_DEVIATION;
         kind++) {
        for (size_t k = 0; k < c->count; k++) {
            if (c->column[k].kind == kind) {
                c->read[c->reads++] = k;
            }
        }
    }
    return c->read != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status choose_columns(finder *f)
{
    gonio_status status = find_angles(f);
    if (status == GONIO_OK) {
        status = choose_family(f);
    }
    if (status == GONIO_OK && f->strongest != 0 && f->family == GONIO_I_WAVELENGTH) {
        f->c->wavelength = gonio_i_allocate(f->r->context, f->c->count, sizeof(double));
        status = f->c->wavelength != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    f->c->own = f->c->own_angles;
    if (status == GONIO_OK) {
        status = find_values(f);
    }
    if (status == GONIO_OK) {
        status = find_deviations(f);
    }
    find_planned(f);
    find_time_and_mark(f);
    find_row_wavelength(f);
    if (status == GONIO_OK && f->options->values_needed && !f->c->any_value) {
        status = refuse_no_values(f);
    }
    return status == GONIO_OK ? order_columns(f) : status;
}

gonio_status gonio_i_csv_columns_find(const gonio_i_csv_reader *reader,
                                      const gonio_readings_options *options,
                                      gonio_i_csv_columns *columns)
{
    *columns = (gonio_i_csv_columns){.count = reader->columns};
    finder f = {.r = reader, .options = options, .c = columns};
    columns->column = gonio_i_allocate(reader->context, reader->columns, sizeof *columns->column);
    f.name = gonio_i_allocate(reader->context, reader->columns, sizeof *f.name);
    gonio_status status = columns->column != NULL && f.name != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < reader->columns && status == GONIO_OK; k++) {
        f.name[k] = gonio_i_column_name_of(reader->name[k]);
    }
    status = status == GONIO_OK ? choose_columns(&f) : status;
    free(f.name);
    if (status != GONIO_OK) {
        gonio_i_csv_columns_free(columns);
    }
    return status;
}

void gonio_i_csv_columns_free(gonio_i_csv_columns *columns)
{
    free(columns->column);
    free(columns->wavelength);
    free(columns->read);
    *columns = (gonio_i_csv_columns){0};
}

/* ---- a line of units ---- */

/* Whether a row is one of units: it has a unit of angles, and no number except 1. */
static bool is_unit_row(const gonio_i_csv_reader *r)
{
    bool angle = false;
    for (size_t k = 0; k < r->cells; k++) {
        double number = 0.0;
        if (gonio_i_csv_is_number(r->cell[k], r->delimiter, &number) && number != 1.0) {
            return false;
        }
        angle = angle || gonio_i_angle_unit_in(r->cell[k]) != 0;
    }
    return angle;
}

gonio_status gonio_i_csv_take_units(gonio_i_csv_reader *reader)
{
    gonio_status status = gonio_i_csv_next(reader);
    if (status == GONIO_OK && is_unit_row(reader)) {
        return gonio_i_csv_units_behind_names(reader);
    }
    gonio_i_csv_again(reader);
    return status;
}
