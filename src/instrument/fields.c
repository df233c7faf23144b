/* Objects of an instrument file as fields of structs: see fields.h. */
#include "fields.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/number.h"

enum { TEXT = 512 };

gonio_status gonio_i_fail_at(const gonio_i_place *place, const char *key, const char *format, ...)
{
    char text[TEXT];
    va_list arguments;
    va_start(arguments, format);
    gonio_i_print_list(text, sizeof text, format, arguments);
    va_end(arguments);
    const bool both = *place->where != '\0' && *key != '\0';
    const bool any = *place->where != '\0' || *key != '\0';
    return gonio_i_fail(place->context, GONIO_ERROR_FORMAT, "%s: %s%s%s%s%s", place->file,
                        place->where, both ? "." : "", key, any ? ": " : "", text);
}

/* The known keys, for a message about an unknown one. */
static void list_keys(const gonio_i_field *field, size_t count, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < count && used < size; k++) {
        const int more =
            snprintf(text + used, size - used, "%s%s", k > 0 ? ", " : "", field[k].key);
        used += more > 0 ? (size_t)more : 0;
    }
}

static gonio_status check_keys(const gonio_i_place *place, const json_t *object,
                               const gonio_i_field *field, size_t count)
{
    const char *key = NULL;
    json_t *value = NULL;
    char known[TEXT - 64];
    json_object_foreach((json_t *)object, key, value)
    {
        bool found = false;
        for (size_t k = 0; k < count; k++) {
            found = found || strcmp(field[k].key, key) == 0;
        }
        if (!found) {
            list_keys(field, count, known, sizeof known);
            return gonio_i_fail_at(place, key, "unknown key; known are %s", known);
        }
    }
    return GONIO_OK;
}

static gonio_status read_number(const gonio_i_place *place, const json_t *value,
                                const gonio_i_field *field, void *into)
{
    if (value == NULL) {
        return field->needed ? gonio_i_fail_at(place, field->key, "this key is missing") : GONIO_OK;
    }
    if (!json_is_number(value)) {
        return gonio_i_fail_at(place, field->key, "this is no number");
    }
    const double number = json_number_value(value);
    if (!(number >= field->low && number <= field->high)) {
        return gonio_i_fail_at(place, field->key, "%g is not between %g and %g", number, field->low,
                               field->high);
    }
    *(double *)(void *)((char *)into + field->offset) = number * field->unit;
    return GONIO_OK;
}

gonio_status gonio_i_read_fields(const gonio_i_place *place, const json_t *object,
                                 const gonio_i_field *field, size_t count, void *into)
{
    if (object == NULL) {
        return GONIO_OK;
    }
    if (!json_is_object(object)) {
        return gonio_i_fail_at(place, "", "this is no object {...}");
    }
    gonio_status status = check_keys(place, object, field, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        const json_t *value = json_object_get(object, field[k].key);
        if (field[k].number) {
            status = read_number(place, value, &field[k], into);
        } else if (field[k].needed && value == NULL) {
            status = gonio_i_fail_at(place, field[k].key, "this key is missing");
        }
    }
    return status;
}

gonio_status gonio_i_read_text(const gonio_i_place *place, const json_t *object, const char *key,
                               const char *otherwise, const char **text)
{
    const json_t *value = json_object_get(object, key);
    *text = otherwise;
    if (value == NULL) {
        return GONIO_OK;
    }
    if (!json_is_string(value)) {
        return gonio_i_fail_at(place, key, "this is no text in quotes");
    }
    *text = json_string_value(value);
    return GONIO_OK;
}

gonio_status gonio_i_read_flag(const gonio_i_place *place, const json_t *object, const char *key,
                               bool *value)
{
    const json_t *found = json_object_get(object, key);
    if (found != NULL && !json_is_boolean(found)) {
        return gonio_i_fail_at(place, key, "this is neither true nor false");
    }
    *value = found != NULL ? json_is_true(found) : *value;
    return GONIO_OK;
}

gonio_status gonio_i_read_word(const gonio_i_place *place, const json_t *object, const char *key,
                               const char *const *words, int *choice)
{
    const char *text = NULL;
    const gonio_status status = gonio_i_read_text(place, object, key, NULL, &text);
    char known[TEXT / 2] = "";
    if (status != GONIO_OK || text == NULL) {
        return status;
    }
    for (int k = 0; words[k] != NULL; k++) {
        if (strcmp(words[k], text) == 0) {
            *choice = k;
            return GONIO_OK;
        }
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", k > 0 ? ", " : "", words[k]);
    }
    return gonio_i_fail_at(place, key, "'%.40s' is not known; known are %s", text, known);
}

/* Row `row` of an array: one number, or an array of `columns`. False if it is something else. */
static bool read_row(const json_t *value, size_t columns, double *numbers)
{
    if (columns == 1 && json_is_number(value)) {
        numbers[0] = json_number_value(value);
        return isfinite(numbers[0]);
    }
    bool good = json_is_array(value) && json_array_size(value) == columns;
    for (size_t k = 0; k < columns && good; k++) {
        const json_t *number = json_array_get(value, k);
        good = json_is_number(number) && isfinite(json_number_value(number));
        numbers[k] = good ? json_number_value(number) : 0.0;
    }
    return good;
}

gonio_status gonio_i_read_numbers(const gonio_i_place *place, const json_t *object, const char *key,
                                  size_t columns, double **numbers, size_t *rows)
{
    const json_t *array = json_object_get(object, key);
    *numbers = NULL;
    *rows = 0;
    if (array == NULL) {
        return GONIO_OK;
    }
    const size_t count = json_array_size(array);
    if (!json_is_array(array) || count == 0) {
        return gonio_i_fail_at(place, key, "this is no array with anything in it");
    }
    double *read = gonio_i_allocate(place->context, count * columns, sizeof *read);
    if (read == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < count; k++) {
        if (!read_row(json_array_get(array, k), columns, read + k * columns)) {
            free(read);
            return columns == 1
                       ? gonio_i_fail_at(place, key, "entry %zu is no number", k + 1)
                       : gonio_i_fail_at(place, key, "entry %zu is no array of %zu numbers", k + 1,
                                         columns);
        }
    }
    *numbers = read;
    *rows = count;
    return GONIO_OK;
}
