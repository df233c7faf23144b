/* The lines of tables with angles along both sides: see crossed.h. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <gonio/measurement.h>

#include "../../core/csv_reader.h"
#include "crossed.h"
#include "csv_numbers.h"

enum { TEXT_ROOM = 128 };

bool gonio_i_line_text(gonio_i_line line, size_t room, char *text)
{
    if (line.length >= room) {
        return false;
    }
    memcpy(text, line.at, line.length);
    text[line.length] = '\0';
    return true;
}

gonio_i_line gonio_i_unquoted(gonio_i_line cell)
{
    const bool quoted = cell.length > 1 && *cell.at == '"' && cell.at[cell.length - 1] == '"';
    return quoted ? gonio_i_trimmed((gonio_i_line){cell.at + 1, cell.length - 2}) : cell;
}

bool gonio_i_cell_number(gonio_i_line cell, char separator, double *number)
{
    char text[TEXT_ROOM];
    return gonio_i_line_text(gonio_i_unquoted(cell), sizeof text, text) &&
           (gonio_i_csv_is_number(text, separator, number) ||
            gonio_i_csv_is_angle(text, separator, number)) &&
           isfinite(*number);
}

/* ---- axes ---- */

static gonio_i_axis axis_of_name(const gonio_i_column_name *name)
{
    const bool angle = name->kind == GONIO_I_ANGLE && !name->complement &&
                       name->index < GONIO_I_SETTINGS && name->index != GONIO_I_SAMPLE_ROTATION;
    return angle ? (gonio_i_axis){(int)name->index, name->unit}
           : name->kind == GONIO_I_ROW_WAVELENGTH
               ? (gonio_i_axis){GONIO_I_WAVELENGTH_AXIS, name->wavelength_unit}
               : (gonio_i_axis){GONIO_I_NO_AXIS, 0};
}

gonio_i_axis gonio_i_axis_of(gonio_i_line line)
{
    char text[TEXT_ROOM];
    if (line.length == 0 || !gonio_i_line_text(gonio_i_unquoted(line), sizeof text - 2, text)) {
        return (gonio_i_axis){GONIO_I_NO_AXIS, 0};
    }
    if (strcasecmp(text, "nm") == 0) {
        return (gonio_i_axis){GONIO_I_WAVELENGTH_AXIS, GONIO_NANOMETRES};
    }
    gonio_i_column_name name = gonio_i_column_name_of(text);
    if (name.kind == GONIO_I_OTHER && *text != '\0') {
        strcat(text, " o");
        name = gonio_i_column_name_of(text);
    }
    return axis_of_name(&name);
}

bool gonio_i_axes_of_corner(gonio_i_line corner, gonio_i_axis *down, gonio_i_axis *across)
{
    corner = gonio_i_unquoted(corner);
    for (size_t k = 0; k < corner.length && corner.length < TEXT_ROOM; k++) {
        if (strchr("\\/|", corner.at[k]) == NULL) {
            continue;
        }
        *down = gonio_i_axis_of(gonio_i_trimmed((gonio_i_line){corner.at, k}));
        *across = gonio_i_axis_of(
            gonio_i_trimmed((gonio_i_line){corner.at + k + 1, corner.length - k - 1}));
        if (down->index != GONIO_I_NO_AXIS && across->index != GONIO_I_NO_AXIS) {
            return true;
        }
    }
    return false;
}

/* ---- lines of one number ---- */

/* Parts names from the one number among them. False if there is not one. */
static bool part_number(const char *text, gonio_i_words *names, double *number)
{
    gonio_i_words words;
    size_t numbers = 0;
    gonio_i_words_split(text, &words);
    *names = (gonio_i_words){.whole = words.whole};
    for (size_t k = 0; k < words.count; k++) {
        if (words.word[k].text[0] != '\0') {
            names->word[names->count++] = words.word[k];
        } else {
            *number = words.word[k].number;
            numbers++;
        }
    }
    const char *digit = strpbrk(text, "0123456789");
    const bool negative = digit != NULL && digit > text && digit[-1] == '-' &&
                          (digit == text + 1 || !isalnum((unsigned char)digit[-2]));
    *number = negative ? -*number : *number;
    return words.whole && numbers == 1;
}

bool gonio_i_setting_of(gonio_i_line line, gonio_i_axis *axis, double *number)
{
    char text[TEXT_ROOM];
    gonio_i_words names;
    gonio_i_column_name name = {0};
    while (line.length > 0 && strchr(",;\t ", line.at[line.length - 1]) != NULL) {
        line.length--;
    }
    if (line.length == 0 || !gonio_i_line_text(line, sizeof text, text)) {
        return false;
    }
    for (char *at = text; *at != '\0'; at++) {
        const bool decimal = *at == ',' && at > text && isdigit((unsigned char)at[-1]) &&
                             isdigit((unsigned char)at[1]);
        *at = decimal ? '.' : *at == '"' ? ' ' : *at;
    }
    if (!part_number(text, &names, number)) {
        return false;
    }
    bool known = gonio_i_take_angle_name(&names, &name);
    if (!known) {
        name = (gonio_i_column_name){0};
        known = gonio_i_take_value_name("", &names, &name) && name.kind == GONIO_I_ROW_WAVELENGTH;
    }
    *axis = known ? axis_of_name(&name) : (gonio_i_axis){GONIO_I_NO_AXIS, 0};
    return axis->index != GONIO_I_NO_AXIS;
}

/* ---- geometries ---- */

/* Takes a number of degrees, with or without their sign; NULL if there is none. */
static const char *take_degrees(const char *at, double *number)
{
    const bool negative = *at == '-';
    const char *digits = at + (*at == '-' || *at == '+');
    const size_t length = strspn(digits, "0123456789.");
    if (length == 0 || length > 12) {
        return NULL;
    }
    *number = (negative ? -1.0 : 1.0) * strtod(digits, NULL);
    at = digits + length;
    at += strncmp(at, "\xc2\xb0", 2) == 0 ? 2 : 0;
    return at;
}

bool gonio_i_geometry_of(gonio_i_line line, gonio_i_settings *s)
{
    char text[TEXT_ROOM];
    double second = 0.0;
    *s = (gonio_i_settings){0};
    if (!gonio_i_line_text(gonio_i_unquoted(line), sizeof text, text)) {
        return false;
    }
    const char *at = text;
    const bool prefixed = *at == 'r' || *at == 'R';
    at = take_degrees(at + prefixed, &s->angle[0]);
    if (at == NULL) {
        return false;
    }
    at += strspn(at, " ");
    const bool between = *at == '/' || *at == ':';
    at += between ? 1 : 0;
    at += strspn(at, " ");
    const bool aspecular = strncasecmp(at, "as", 2) == 0;
    if (!aspecular && (prefixed || !between)) {
        return false;
    }
    at += aspecular ? 2 : 0;
    at = take_degrees(at + strspn(at, " "), &second);
    const size_t index = aspecular ? GONIO_I_ASPECULAR : 2;
    s->angle[index] = second;
    s->bits = 1U | 1U << index;
    return at != NULL && *at == '\0' && s->angle[0] >= 0.0;
}

gonio_status gonio_i_refuse_aspecular(gonio_context *context, const char *path)
{
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: reflectance factors or per cent? A line '# unit: reflectance factor' "
                        "or '# unit: %%' says it, or --as values=factor or --as values=percent",
                        path);
}
