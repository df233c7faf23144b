/* Checks of results that were read from files: see kept_results.h. */
#include "kept_results.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ANY_LENGTH = 0, PIXEL_DIGITS = 32 };

/* ---- one value ---- */

/* A check of a value. The meaning of `limit` depends on the check. */
typedef bool fits(const json_t *value, size_t limit);

static bool is_number(const json_t *value, size_t limit)
{
    (void)limit;
    return json_is_number(value);
}

/* null is a number that is not finite. */
static bool is_number_or_null(const json_t *value, size_t limit)
{
    return json_is_null(value) || is_number(value, limit);
}

/* An index below the limit. */
static bool is_index(const json_t *value, size_t limit)
{
    return json_is_integer(value) && json_integer_value(value) >= 0 &&
           (uint64_t)json_integer_value(value) < limit;
}

static bool is_angle(const json_t *value, double most)
{
    return json_is_number(value) && json_number_value(value) >= 0.0 &&
           json_number_value(value) <= most;
}

/* ---- lists ---- */

/* A list of `count` values, of at least one for ANY_LENGTH, that all fit. */
static bool is_list(const json_t *list, size_t count, fits *each, size_t limit)
{
    const size_t length = json_array_size(list);
    bool good = json_is_array(list) && (count == ANY_LENGTH ? length > 0 : length == count);
    for (size_t k = 0; k < length && good; k++) {
        good = each(json_array_get(list, k), limit);
    }
    return good;
}

static size_t metrics(void)
{
    size_t count = 0;
    while (gonio_metric_describe((int)count) != NULL) {
        count++;
    }
    return count;
}

static bool is_error(const json_t *value, size_t limit)
{
    return is_list(value, metrics(), is_number_or_null, limit);
}

static bool are_errors(const json_t *value, size_t count)
{
    return is_list(value, count, is_error, 0);
}

/* As of a plan's swaps, which may begin without a finite one. */
static bool are_conditions(const json_t *value, size_t limit)
{
    return is_list(value, ANY_LENGTH, is_number_or_null, limit);
}

static bool are_numbers(const json_t *value, size_t limit)
{
    return is_list(value, ANY_LENGTH, is_number, limit);
}

/* `count` rows of the bivariate grid's three channels. */
static bool are_rows(const json_t *value, size_t count)
{
    return is_list(value, count, is_index, (size_t)GONIO_CELLS * GONIO_CHANNELS);
}

/* [cell, channel, theta_i, phi_i, theta_o, phi_o] in radians. */
static bool is_entry(const json_t *value, size_t limit)
{
    (void)limit;
    bool good = json_array_size(value) == 6 && is_index(json_array_get(value, 0), GONIO_CELLS) &&
                is_index(json_array_get(value, 1), GONIO_CHANNELS);
    for (size_t k = 2; k < 6 && good; k++) {
        good = is_angle(json_array_get(value, k), k % 2 == 0 ? M_PI / 2.0 : 2.0 * M_PI);
    }
    return good;
}

/* ---- fields ---- */

static bool complain(char *complaint, const char *field, const char *meaning)
{
    snprintf(complaint, GONIO_I_COMPLAINT, "'%s' is not %s", field, meaning);
    return false;
}

/* Whether a field is one value that fits. */
static bool has(const json_t *result, const char *field, fits *value, size_t limit,
                const char *meaning, char *complaint)
{
    return value(json_object_get(result, field), limit) || complain(complaint, field, meaning);
}

static bool has_condition(const json_t *result, char *complaint)
{
    return has(result, "condition", is_number_or_null, 0, "a condition number", complaint);
}

/* ---- the kinds ---- */

bool gonio_i_accept_spectrum(const gonio_i_study *study, const gonio_i_piece *p,
                             const json_t *result, char *complaint)
{
    (void)p;
    return has(result, "all", are_numbers, 0, "a list of variances", complaint) &&
           (is_list(json_object_get(result, "splits"), study->splits.count, are_numbers, 0) ||
            complain(complaint, "splits", "a list of variances for each split"));
}

bool gonio_i_accept_convergence(const gonio_i_study *study, const gonio_i_piece *p,
                                const json_t *result, char *complaint)
{
    (void)p;
    const json_t *rows = json_object_get(result, "rows");
    return (is_list(json_object_get(result, "starts"), GONIO_I_STARTS, are_conditions, 0) ||
            complain(complaint, "starts", "a list of condition numbers for each start")) &&
           (is_list(rows, GONIO_I_STARTS, are_rows, study->chosen[0].samples) ||
            complain(complaint, "rows", "a list of rows for each start"));
}

bool gonio_i_accept_directions(const gonio_i_study *study, const gonio_i_piece *p,
                               const json_t *result, char *complaint)
{
    return has_condition(result, complaint) &&
           (is_list(json_object_get(result, "entries"), study->chosen[p->index].samples, is_entry,
                    0) ||
            complain(complaint, "entries",
                     "a list of [cell, channel 0 to 2, theta_i, phi_i, theta_o, phi_o]"));
}

/* Errors for each number of samples; null for fewer than components. */
static bool are_grid_errors(const gonio_i_study *study, const gonio_i_piece *p,
                            const json_t *errors)
{
    const size_t tests = study->splits.split[p->split].test_count;
    bool good = json_is_array(errors) && json_array_size(errors) == study->grid_samples;
    for (size_t l = 0; l < study->grid_samples && good; l++) {
        const json_t *value = json_array_get(errors, l);
        good = study->grid_sample[l] < study->grid_component[p->index] ? json_is_null(value)
                                                                       : are_errors(value, tests);
    }
    return good;
}

bool gonio_i_accept_grid(const gonio_i_study *study, const gonio_i_piece *p, const json_t *result,
                         char *complaint)
{
    const json_t *conditions = json_object_get(result, "condition");
    return (is_list(conditions, study->grid_samples, is_number_or_null, 0) ||
            complain(complaint, "condition", "a list of condition numbers")) &&
           (are_grid_errors(study, p, json_object_get(result, "errors")) ||
            complain(complaint, "errors", "a list of errors for each number of samples")) &&
           has(result, "all", are_errors, study->splits.split[p->split].test_count,
               "a list of errors", complaint);
}

bool gonio_i_accept_method(const gonio_i_study *study, const gonio_i_piece *p, const json_t *result,
                           char *complaint)
{
    return has_condition(result, complaint) &&
           has(result, "errors", are_errors, study->splits.split[p->split].test_count,
               "a list of errors", complaint);
}

bool gonio_i_accept_left_out(const gonio_i_study *study, const gonio_i_piece *p,
                             const json_t *result, char *complaint)
{
    (void)study;
    (void)p;
    const json_t *conditions = json_object_get(result, "condition");
    return (is_list(conditions, GONIO_I_CHOSEN, is_number_or_null, 0) ||
            complain(complaint, "condition", "a list of condition numbers")) &&
           has(result, "errors", are_errors, GONIO_I_LEFT_OUT_SERIES, "a list of errors",
               complaint);
}

bool gonio_i_accept_quoted(const gonio_i_study *study, const gonio_i_piece *p, const json_t *result,
                           char *complaint)
{
    (void)study;
    (void)p;
    return has_condition(result, complaint) &&
           has(result, "error", is_error, 0, "the errors of one material", complaint);
}

/* ---- renderings ---- */

/* Whether eight hexadecimal digits are the bits of a finite float. */
static bool is_finite_float(const char *digits)
{
    unsigned exponent = 0;
    char head[5] = "";
    memcpy(head, digits, 4);
    return sscanf(head, "%4x", &exponent) == 1 && (exponent & 0x7f80) != 0x7f80;
}

static bool is_image(const json_t *value, size_t side)
{
    const char *text = json_string_value(value);
    const size_t digits = side * side * PIXEL_DIGITS;
    bool good = text != NULL && json_string_length(value) == digits &&
                strspn(text, "0123456789abcdef") == digits;
    for (size_t k = 0; good && k < digits; k += 8) {
        good = is_finite_float(text + k);
    }
    return good;
}

bool gonio_i_accept_images(const json_t *result, int side, char *complaint)
{
    return has_condition(result, complaint) &&
           has(result, "e6_percent", is_number_or_null, 0, "a number", complaint) &&
           has(result, "psnr_db", is_number_or_null, 0, "a number", complaint) &&
           has(result, "delta_e_itp", is_number, 0, "a number", complaint) &&
           has(result, "original", is_image, (size_t)side, "an image", complaint) &&
           has(result, "image", is_image, (size_t)side, "an image", complaint);
}
