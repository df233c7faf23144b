/* The columns of readings as CSV: see csv_columns.h. */
#include "csv_columns.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../rules.h"
#include "csv_factor_names.h"
#include "csv_keys.h"
#include "csv_numbers.h"

typedef gonio_i_csv_finder finder;

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

static bool has_cosine(const gonio_i_column_name *n)
{
    return n->unit == GONIO_VALUE_COSINE || n->unit == GONIO_VALUE_FACTOR_COSINE;
}

/* Whether a name is that of values as they are: no logarithms, without the cosine, of
 * unpolarised light. */
static bool is_plain(const gonio_i_column_name *n)
{
    return n->scale == 0 && !has_cosine(n) && n->polarisation == 0;
}

/* Whether a name is surer than those before. A name of only a channel and a unit, as gonio's, comes
 * before one that names a quantity, and the BRDF before what is made of it. */
static bool is_surer(const finder *f, const gonio_i_column_name *n)
{
    if (n->strength != f->strongest) {
        return n->strength > f->strongest;
    }
    return rank(n->family) > rank(f->family) ||
           (n->family == f->family &&
            ((n->quantity == 0 && f->quantity != 0) ||
             (is_plain(n) && (f->scale != 0 || f->cosine || f->polarised))));
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
            f->scale = n->scale;
            f->cosine = has_cosine(n);
            f->polarised = n->polarisation != 0;
        }
    }
    return GONIO_OK;
}

static bool is_chosen(const finder *f, size_t column)
{
    const gonio_i_column_name *n = &f->name[column];
    return n->kind == GONIO_I_VALUE && n->family == f->family &&
           (n->quantity == f->quantity || n->quantity == 0) && n->scale == f->scale &&
           has_cosine(n) == f->cosine && (n->polarisation != 0) == f->polarised &&
           (n->strength > GONIO_I_BARE || f->strongest == GONIO_I_BARE);
}

/* other: the column before of the other polarisation; the number of columns for none. */
static gonio_status add_value(const finder *f, size_t k, size_t other, size_t *unit_by,
                              size_t *wave_by)
{
    gonio_i_csv_columns *c = f->c;
    const gonio_i_column_name *n = &f->name[k];
    const bool second = other < f->r->columns;
    const size_t index = n->family == GONIO_I_COLOUR ? n->index
                         : second                    ? c->column[other].index
                                                     : c->channels++;
    gonio_status status = GONIO_OK;
    if (n->family == GONIO_I_WAVELENGTH) {
        c->wavelength[index] = n->wavelength;
    }
    c->column[k] = (gonio_i_csv_column){.kind = GONIO_I_VALUE,
                                        .index = index,
                                        .wavelength = n->wavelength,
                                        .second = second,
                                        .factor = n->factor};
    c->polarised += n->polarisation != 0;
    c->averaged += second ? 2 : 0;
    c->stated.scale = n->scale;
    c->any_value = true;
    c->own = c->own && n->own;
    if (f->options->as.values == GONIO_AS_STATED) {
        status = gonio_i_csv_agree(f, "values", "values", k, n->unit, &c->stated.values, unit_by);
    }
    if (status == GONIO_OK && f->options->as.wavelengths == GONIO_AS_STATED) {
        status = gonio_i_csv_agree(f, "wavelengths", "wavelengths", k, n->wavelength_unit,
                                   &c->stated.wavelengths, wave_by);
    }
    return status;
}

/* Takes the kind of values from a comment if the names do not state it. */
static void take_value_comment(gonio_i_csv_columns *c, const char *comment)
{
    const int kind = comment != NULL ? gonio_i_value_kind_in(comment) : 0;
    const int scale = comment != NULL ? gonio_i_value_scale_in(comment) : 0;
    const bool by_name = c->stated.values != 0;
    const bool of_angles = comment != NULL && kind == 0 && gonio_i_angle_unit_in(comment) != 0;
    c->stated.values = by_name ? c->stated.values : kind;
    c->stated.scale = c->stated.scale != 0 || by_name ? c->stated.scale : scale;
    const bool heeded = by_name ? kind == 0 || kind == c->stated.values : kind != 0 || scale != 0;
    c->unclear = heeded || of_angles ? NULL : comment;
}

/* Takes the factor in a comment on values. */
static gonio_status take_comment_factor(const finder *f, const char *comment)
{
    char rest[128];
    double factor = 0.0;
    const bool scaled = comment != NULL && gonio_i_take_factor(comment, sizeof rest, rest, &factor);
    const bool unclear = comment != NULL && !scaled && gonio_i_value_kind_in(comment) != 0 &&
                         gonio_i_value_scale_in(comment) == 0 && gonio_i_names_product(comment);
    for (size_t k = 0; k < f->r->columns && (scaled || unclear); k++) {
        gonio_i_csv_column *column = &f->c->column[k];
        const bool stated = f->name[k].strength == GONIO_I_CERTAIN && column->factor == 0.0;
        if (column->kind == GONIO_I_VALUE && (unclear || stated)) {
            return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                                "%s: the comment '%.60s' and column '%s' leave open whether values "
                                "are to be multiplied; put the factor into the column's unit: BRDF "
                                "[1e-3 1/sr]",
                                f->r->path, comment, f->r->name[k]);
        }
        column->factor =
            column->kind == GONIO_I_VALUE && column->factor == 0.0 ? factor : column->factor;
    }
    return GONIO_OK;
}

static gonio_status add_values(const finder *f, const size_t *other)
{
    gonio_status status = GONIO_OK;
    size_t unit_by = 0;
    size_t wave_by = 0;
    f->c->channels = f->family == GONIO_I_COLOUR ? GONIO_CHANNELS : 0;
    for (size_t k = 0; k < f->r->columns && status == GONIO_OK; k++) {
        if (is_chosen(f, k)) {
            status = add_value(f, k, other[k], &unit_by, &wave_by);
        }
    }
    return status;
}

static gonio_status find_values(const finder *f)
{
    static const char *const words[] = {"values", "unit", "units", "value unit", "quantity", NULL};
    gonio_i_csv_keys chosen = {0};
    size_t *other = gonio_i_allocate(f->r->context, f->r->columns, sizeof *other);
    gonio_status status =
        other != NULL ? gonio_i_csv_list_keys(f, is_chosen, &chosen) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        gonio_i_csv_find_partners(f, &chosen, other);
        status = add_values(f, other);
    }
    const char *comment = gonio_i_csv_comment_of(f, words);
    take_value_comment(f->c, comment);
    status = status == GONIO_OK ? take_comment_factor(f, comment) : status;
    free(chosen.item);
    free(other);
    return status;
}

/* ---- deviations, by the key of their channel ---- */

/* Whether a column has values that no column before it has of the other polarisation. */
static bool is_first(const finder *f, size_t column)
{
    return f->c->column[column].kind == GONIO_I_VALUE && !f->c->column[column].second;
}

static gonio_status refuse_twice(const finder *f, const gonio_i_csv_keys *list)
{
    for (size_t k = 1; k < list->count; k++) {
        const gonio_i_csv_keyed *a = &list->item[k - 1];
        if (a->key == list->item[k].key) {
            char what[64] = "values";
            if (f->family == GONIO_I_WAVELENGTH) {
                snprintf(what, sizeof what, "%.10g %s", a->key,
                         f->c->stated.wavelengths == GONIO_MICROMETRES ? "um" : "nm");
            } else if (f->family == GONIO_I_COLOUR) {
                snprintf(what, sizeof what, "%c", "RGB"[(int)a->key]);
            }
            return gonio_i_csv_refuse_two(f, what, a->column, list->item[k].column);
        }
    }
    return GONIO_OK;
}

static int compare_to_key(const void *key, const void *item)
{
    const double wanted = *(const double *)key;
    const double has = ((const gonio_i_csv_keyed *)item)->key;
    return (wanted > has) - (wanted < has);
}

/* The column of values that a deviation belongs to; the number of columns if there is none. A
 * deviation without a channel belongs to the only channel. */
static size_t value_of(const finder *f, const gonio_i_csv_keys *list, const gonio_i_column_name *n)
{
    const double key = gonio_i_csv_key_of(n);
    const bool same = n->family == f->family &&
                      (n->quantity == 0 || f->quantity == 0 || n->quantity == f->quantity);
    const bool only = list->count == 1 && n->family == GONIO_I_UNNAMED && n->index == 0 &&
                      (n->quantity == 0 || n->quantity == f->quantity);
    const gonio_i_csv_keyed *found =
        only ? list->item
        : same && list->count > 0
            ? bsearch(&key, list->item, list->count, sizeof(gonio_i_csv_keyed), compare_to_key)
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
        (gonio_i_csv_column){.kind = GONIO_I_DEVIATION,
                             .index = c->column[value].index,
                             .wavelength = c->column[value].wavelength,
                             .factor = n->unit != 0 ? n->factor : c->column[value].factor,
                             .scale = !relative ? 0.0
                                      : percent ? 0.01
                                                : 1.0,
                             .linear = n->scale != f->scale && (n->quantity != 0 || n->unit != 0)};
    c->any_deviation = true;
    c->own = c->own && n->own;
    taken[c->column[value].index] = true;
}

static void try_deviation(const finder *f, size_t k, const gonio_i_csv_keys *list, bool *taken)
{
    const size_t value = value_of(f, list, &f->name[k]);
    const bool other = (f->name[k].scale != 0 && f->name[k].scale != f->scale) ||
                       (has_cosine(&f->name[k]) && !f->cosine);
    if (!other && value < f->r->columns && !taken[f->c->column[value].index]) {
        add_deviation(f, k, value, taken);
    }
}

/* Finds the deviations of the values that are read. Of two for the same values, gonio's own name
 * comes first. */
static gonio_status find_deviations(const finder *f)
{
    gonio_i_csv_keys list;
    bool *taken = gonio_i_allocate(f->r->context, f->c->channels + 1, sizeof *taken);
    gonio_status status =
        taken != NULL ? gonio_i_csv_list_keys(f, is_first, &list) : GONIO_ERROR_MEMORY;
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

/* Whether there are columns X, Y and Z, which are colours, or places of something. */
static bool has_tristimulus(const finder *f)
{
    bool found[3] = {false};
    for (size_t k = 0; k < f->r->columns; k++) {
        const char *name = f->r->name[k] + (strncasecmp(f->r->name[k], "CIE ", 4) == 0 ||
                                                    strncasecmp(f->r->name[k], "CIE_", 4) == 0
                                                ? 4
                                                : 0);
        const char letter = name[0] != '\0' && name[1] == '\0' ? (char)(name[0] | 0x20) : '\0';
        if (letter >= 'x' && letter <= 'z') {
            found[letter - 'x'] = true;
        }
    }
    return found[0] && found[1] && found[2];
}

static gonio_status refuse_no_values(const finder *f)
{
    const char *number = number_not_read(f);
    if (number != NULL && gonio_i_names_product(number)) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: '%s' leaves open whether its values are or were multiplied; put "
                            "the factor into the unit: BRDF [1e-3 1/sr]",
                            f->r->path, number);
    }
    if (number != NULL && has_tristimulus(f)) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: X, Y and Z are not taken for values, as they may be places; give "
                            "tristimulus values as linear sRGB in R_per_sr, G_per_sr, B_per_sr, or "
                            "Y alone as value_per_sr",
                            f->r->path);
    }
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
    gonio_status status = gonio_i_csv_find_angles(f);
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
    status = status == GONIO_OK ? gonio_i_csv_find_row_columns(f) : status;
    if (status == GONIO_OK && f->options->values_needed && !f->c->any_value) {
        status = refuse_no_values(f);
    }
    return status == GONIO_OK ? order_columns(f) : status;
}

/* Where only directions are wanted, all but angles, times and marks is something else. */
static void forget_values(const finder *f)
{
    for (size_t k = 0; f->name != NULL && k < f->r->columns; k++) {
        const gonio_i_column_kind kind = f->name[k].kind;
        const bool kept = kind == GONIO_I_ANGLE || kind == GONIO_I_TIME || kind == GONIO_I_MARK;
        f->name[k].kind = kept ? kind : GONIO_I_OTHER;
    }
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
    if (options->directions_only) {
        forget_values(&f);
    }
    status = status == GONIO_OK ? choose_columns(&f) : status;
    free(f.name);
    if (status != GONIO_OK) {
        gonio_i_csv_columns_free(columns);
    }
    return status;
}

bool gonio_i_csv_has_parts(const gonio_i_csv_columns *columns)
{
    return columns->by_wavelength || columns->by_colour || columns->by_polarisation;
}

void gonio_i_csv_columns_free(gonio_i_csv_columns *columns)
{
    free(columns->column);
    free(columns->wavelength);
    free(columns->read);
    *columns = (gonio_i_csv_columns){0};
}
