/* The columns of readings as CSV: see csv_columns.h. */
#include "csv_columns.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "../../plan/plan_file.h"
#include "../rules.h"

typedef enum family { COLOUR, WAVELENGTH, UNNAMED } family;

/* What a column's name says, if it is one of values or deviations. */
typedef struct value_name {
    family family;
    size_t index;      /* of a colour; of unnamed channels their order counts */
    double wavelength; /* nm */
    bool deviation;
} value_name;

static bool parse_ending(const char *text, bool *deviation)
{
    *deviation = strcasecmp(text, "_deviation_per_sr") == 0;
    return *deviation || strcasecmp(text, "_per_sr") == 0;
}

static bool parse_colour(const char *name, value_name *v)
{
    static const char letters[] = "RGB";
    const char *letter = *name != '\0' ? strchr(letters, toupper((unsigned char)*name)) : NULL;
    v->family = COLOUR;
    v->index = letter != NULL ? (size_t)(letter - letters) : 0;
    return letter != NULL && parse_ending(name + 1, &v->deviation);
}

static bool parse_wavelength(const char *name, value_name *v)
{
    char *end = NULL;
    v->family = WAVELENGTH;
    v->wavelength = strtod(name, &end);
    return isdigit((unsigned char)*name) && v->wavelength > 0.0 && v->wavelength < 1e6 &&
           strncasecmp(end, "nm", 2) == 0 && parse_ending(end + 2, &v->deviation);
}

static bool parse_unnamed(const char *name, value_name *v)
{
    v->family = UNNAMED;
    return strncasecmp(name, "value", 5) == 0 &&
           parse_ending(name + 5 + strspn(name + 5, "0123456789"), &v->deviation);
}

static bool parse_name(const char *name, value_name *v)
{
    *v = (value_name){0};
    return parse_colour(name, v) || parse_wavelength(name, v) || parse_unnamed(name, v);
}

/* The names of the first columns of each family; NULL if there are none. */
typedef struct families {
    const char *first[3];
} families;

static families find_families(const gonio_i_csv_reader *r)
{
    families found = {{NULL}};
    for (size_t k = 0; k < r->columns; k++) {
        value_name v;
        if (parse_name(r->name[k], &v) && !v.deviation && found.first[v.family] == NULL) {
            found.first[v.family] = r->name[k];
        }
    }
    return found;
}

static gonio_status find_angles(const gonio_i_csv_reader *r, gonio_i_csv_columns *c)
{
    for (size_t angle = 0; angle < 4; angle++) {
        size_t k = 0;
        while (k < r->columns && strcasecmp(r->name[k], gonio_i_angle_names[angle]) != 0) {
            k++;
        }
        if (k == r->columns) {
            return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                "%s: no column '%s'; theta_i_deg, phi_i_deg, theta_o_deg and "
                                "phi_o_deg are needed",
                                r->path, gonio_i_angle_names[angle]);
        }
        c->column[k] = (gonio_i_csv_column){.kind = GONIO_I_ANGLE, .index = angle};
    }
    return GONIO_OK;
}

static void add_value(gonio_i_csv_columns *c, size_t k, const value_name *v)
{
    const size_t index = v->family == COLOUR ? v->index : c->channels++;
    if (v->family == WAVELENGTH) {
        c->wavelength[index] = v->wavelength;
    }
    c->column[k] = (gonio_i_csv_column){GONIO_I_VALUE, index, v->wavelength};
    c->any_value = true;
}

static void find_values(const gonio_i_csv_reader *r, family kept, gonio_i_csv_columns *c)
{
    c->channels = kept == COLOUR ? GONIO_CHANNELS : 0;
    for (size_t k = 0; k < r->columns; k++) {
        value_name v;
        if (parse_name(r->name[k], &v) && !v.deviation && v.family == kept) {
            add_value(c, k, &v);
        }
    }
}

/* Deviations belong to the values of the same name; of others they are other columns. */
static void find_deviations(const gonio_i_csv_reader *r, family kept, gonio_i_csv_columns *c)
{
    size_t unnamed = 0;
    for (size_t k = 0; k < r->columns; k++) {
        value_name v;
        if (!parse_name(r->name[k], &v) || !v.deviation || v.family != kept) {
            continue;
        }
        const size_t place = v.family == COLOUR ? v.index : unnamed++;
        for (size_t j = 0; j < r->columns; j++) {
            const gonio_i_csv_column *value = &c->column[j];
            if (value->kind == GONIO_I_VALUE &&
                (v.family == WAVELENGTH ? value->wavelength == v.wavelength
                                        : value->index == place)) {
                c->column[k] = (gonio_i_csv_column){GONIO_I_DEVIATION, value->index, v.wavelength};
                c->any_deviation = true;
            }
        }
    }
}

static gonio_status check_channels(const gonio_i_csv_reader *r, const families *found,
                                   bool values_needed, const gonio_i_csv_columns *c)
{
    if (found->first[COLOUR] != NULL && found->first[WAVELENGTH] != NULL) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: columns of colours (%s) and of wavelengths (%s); delete one kind",
                            r->path, found->first[COLOUR], found->first[WAVELENGTH]);
    }
    if (values_needed && !c->any_value) {
        return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                            "%s: no column of values (R_per_sr, G_per_sr, B_per_sr, or "
                            "400nm_per_sr ...): a plan that was not measured yet?",
                            r->path);
    }
    for (size_t k = 0; k < c->channels && c->wavelength != NULL; k++) {
        for (size_t j = 0; j < k; j++) {
            if (c->wavelength[j] == c->wavelength[k]) {
                return gonio_i_fail(r->context, GONIO_ERROR_FORMAT,
                                    "%s: two columns of %g nm; delete one", r->path,
                                    c->wavelength[k]);
            }
        }
    }
    return GONIO_OK;
}

/* The column of a name that says which channel was planned. */
static void find_planned(const gonio_i_csv_reader *r, gonio_i_csv_columns *c)
{
    for (size_t k = 0; k < r->columns; k++) {
        if (strcasecmp(r->name[k], "channel") == 0) {
            c->column[k].kind = GONIO_I_PLANNED;
        }
    }
}

static gonio_status find_columns(const gonio_i_csv_reader *r, bool values_needed,
                                 gonio_i_csv_columns *c)
{
    const families found = find_families(r);
    const family kept = found.first[WAVELENGTH] != NULL ? WAVELENGTH
                        : found.first[COLOUR] != NULL   ? COLOUR
                        : found.first[UNNAMED] != NULL  ? UNNAMED
                                                        : COLOUR;
    if (kept == WAVELENGTH) {
        c->wavelength = gonio_i_allocate(r->context, r->columns, sizeof *c->wavelength);
        if (c->wavelength == NULL) {
            return GONIO_ERROR_MEMORY;
        }
    }
    const gonio_status status = find_angles(r, c);
    if (status != GONIO_OK) {
        return status;
    }
    find_values(r, kept, c);
    find_deviations(r, kept, c);
    find_planned(r, c);
    return check_channels(r, &found, values_needed, c);
}

gonio_status gonio_i_csv_columns_find(const gonio_i_csv_reader *reader, bool values_needed,
                                      gonio_i_csv_columns *columns)
{
    *columns = (gonio_i_csv_columns){.count = reader->columns};
    columns->column = gonio_i_allocate(reader->context, reader->columns, sizeof *columns->column);
    const gonio_status status =
        columns->column != NULL ? find_columns(reader, values_needed, columns) : GONIO_ERROR_MEMORY;
    if (status != GONIO_OK) {
        gonio_i_csv_columns_free(columns);
    }
    return status;
}

void gonio_i_csv_columns_free(gonio_i_csv_columns *columns)
{
    free(columns->column);
    free(columns->wavelength);
    *columns = (gonio_i_csv_columns){0};
}

void gonio_i_csv_name_channel(const gonio_readings *readings, int channel,
                              char name[GONIO_I_NAME_ROOM])
{
    const bool colour = gonio_readings_are_colours(readings) && channel < GONIO_CHANNELS;
    if (channel == GONIO_ALL_CHANNELS || colour) {
        snprintf(name, GONIO_I_NAME_ROOM, "%s", gonio_i_planned_channel_name(channel));
    } else if (readings->wavelength != NULL && (size_t)channel < readings->channels) {
        snprintf(name, GONIO_I_NAME_ROOM, "%.10gnm", readings->wavelength[channel]);
    } else {
        snprintf(name, GONIO_I_NAME_ROOM, "%d", channel + 1);
    }
}

void gonio_i_csv_kept_free(void *data)
{
    gonio_i_csv_kept *kept = data;
    gonio_i_csv_columns_free(&kept->columns);
    free(kept->text);
    free(kept);
}

const gonio_i_csv_kept *gonio_i_csv_kept_of(const gonio_readings *readings)
{
    return readings->attachment.release == gonio_i_csv_kept_free ? readings->attachment.data : NULL;
}
