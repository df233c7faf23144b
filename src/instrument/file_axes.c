/* The axes of an instrument file, and its table of reachable directions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../core/csv.h"
#include "file_parts.h"

#define DEGREE (M_PI / 180.0)

enum { ANGLES = 4, MOST_POSITIONS = 4096, MOST_DIRECTIONS = 100000, ROOM = 64 };

static const gonio_i_field axis_fields[] = {
    {"from_deg", true, false, offsetof(gonio_axis, low), -720.0, 720.0, DEGREE},
    {"to_deg", true, false, offsetof(gonio_axis, high), -720.0, 720.0, DEGREE},
    {"positions_deg", false, false, 0, 0.0, 0.0, 0.0},
    {"step_deg", true, false, offsetof(gonio_axis, step), 0.0, 360.0, DEGREE},
    {"speed_deg_per_s", true, false, offsetof(gonio_axis, speed), 1e-6, 1e6, DEGREE},
    {"settling_s", true, false, offsetof(gonio_axis, settling), 0.0, 86400.0, 1.0},
};

enum { AXIS_FIELDS = sizeof axis_fields / sizeof *axis_fields };

static gonio_status check_positions(const gonio_i_place *place, const gonio_axis *axis)
{
    for (size_t k = 0; k < axis->positions; k++) {
        if (fabs(axis->position[k]) > 4.0 * M_PI) {
            return gonio_i_fail_at(place, "positions_deg", "entry %zu is beyond two turns", k + 1);
        }
        if (k > 0 && !(axis->position[k] > axis->position[k - 1])) {
            return gonio_i_fail_at(place, "positions_deg",
                                   "entry %zu is not above the one before it", k + 1);
        }
    }
    return axis->positions <= MOST_POSITIONS
               ? GONIO_OK
               : gonio_i_fail_at(place, "positions_deg", "more than %d positions", MOST_POSITIONS);
}

/* Positions in place of a range. */
static gonio_status take_positions(const gonio_i_place *place, const json_t *object,
                                   gonio_axis *axis, double *positions)
{
    for (size_t k = 0; k < axis->positions; k++) {
        positions[k] *= DEGREE;
    }
    axis->position = positions;
    axis->low = positions[0];
    axis->high = positions[axis->positions - 1];
    if (json_object_get(object, "from_deg") != NULL || json_object_get(object, "to_deg") != NULL ||
        json_object_get(object, "step_deg") != NULL) {
        return gonio_i_fail_at(place, "positions_deg",
                               "give positions, or a range with from_deg and to_deg, not both");
    }
    return check_positions(place, axis);
}

static gonio_status check_range(const gonio_i_place *place, const json_t *object,
                                const gonio_axis *axis)
{
    const bool whole =
        json_object_get(object, "from_deg") != NULL && json_object_get(object, "to_deg") != NULL;
    if (!whole) {
        return gonio_i_fail_at(place, "", "from_deg and to_deg are needed, or positions_deg");
    }
    if (axis->low > axis->high) {
        return gonio_i_fail_at(place, "from_deg", "%g is above to_deg, %g", axis->low / DEGREE,
                               axis->high / DEGREE);
    }
    if (axis->step > axis->high - axis->low && axis->high > axis->low) {
        return gonio_i_fail_at(place, "step_deg", "%g is more than the whole range of %g degrees",
                               axis->step / DEGREE, (axis->high - axis->low) / DEGREE);
    }
    return GONIO_OK;
}

static gonio_status read_axis(const gonio_i_place *file, const json_t *object, gonio_axis *axis,
                              double **positions)
{
    char where[ROOM];
    const gonio_i_place place = {file->context, file->file, where};
    snprintf(where, sizeof where, "axes.%.40s", axis->name);
    gonio_status status = gonio_i_read_fields(&place, object, axis_fields, AXIS_FIELDS, axis);
    if (status == GONIO_OK) {
        status =
            gonio_i_read_numbers(&place, object, "positions_deg", 1, positions, &axis->positions);
    }
    if (status != GONIO_OK) {
        return status;
    }
    return axis->positions > 0 ? take_positions(&place, object, axis, *positions)
                               : check_range(&place, object, axis);
}

/* ---- the axes that kinematics know, or any ---- */

/* The axes of the kinematics, in their order; those of the file where it may name any. */
static gonio_status name_axes(const gonio_i_place *file, const json_t *axes,
                              gonio_instrument *instrument)
{
    const gonio_i_known_axis *known = instrument->kinematics->axis;
    const char *key = NULL;
    json_t *value = NULL;
    size_t count = 0;
    for (; known[count].name != NULL; count++) {
        instrument->axis[count].name = known[count].name;
    }
    if (count == 0 && json_object_size(axes) > GONIO_MOST_AXES) {
        return gonio_i_fail_at(file, "axes", "more than %d axes", GONIO_MOST_AXES);
    }
    if (known[0].name == NULL) {
        json_object_foreach((json_t *)axes, key, value)
        {
            instrument->axis[count++].name = key;
        }
    }
    instrument->view.axes = count;
    return GONIO_OK;
}

/* Whether every axis of the file is one of the kinematics', and none that is needed is missing. */
static gonio_status check_axes(const gonio_i_place *file, const json_t *axes,
                               const gonio_instrument *instrument)
{
    const gonio_i_place place = {file->context, file->file, "axes"};
    gonio_i_field field[GONIO_MOST_AXES];
    const gonio_i_known_axis *known = instrument->kinematics->axis;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        field[k] = (gonio_i_field){.key = instrument->axis[k].name,
                                   .needed = known[0].name != NULL && known[k].needed};
    }
    return gonio_i_read_fields(&place, axes, field, instrument->view.axes, NULL);
}

/* The positions of all axes share a block. */
static gonio_status keep_positions(gonio_context *context, gonio_instrument *instrument,
                                   double *listed[GONIO_MOST_AXES])
{
    size_t all = 1;
    for (size_t k = 0; k < instrument->view.axes; k++) {
        all += listed[k] != NULL ? instrument->axis[k].positions : 0;
    }
    instrument->position = gonio_i_allocate(context, all, sizeof *instrument->position);
    double *next = instrument->position;
    for (size_t k = 0; k < instrument->view.axes && next != NULL; k++) {
        gonio_axis *axis = &instrument->axis[k];
        if (listed[k] != NULL) {
            memcpy(next, listed[k], axis->positions * sizeof *next);
            axis->position = next;
            next += axis->positions;
        }
    }
    return instrument->position != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status read_all_axes(const gonio_i_place *file, const json_t *axes,
                                  gonio_instrument *instrument)
{
    double *listed[GONIO_MOST_AXES] = {NULL};
    gonio_status status = name_axes(file, axes, instrument);
    if (status == GONIO_OK) {
        status = check_axes(file, axes, instrument);
    }
    for (size_t k = 0; k < instrument->view.axes && status == GONIO_OK; k++) {
        gonio_axis *axis = &instrument->axis[k];
        const json_t *object = json_object_get(axes, axis->name);
        axis->present = object != NULL;
        status = object != NULL ? read_axis(file, object, axis, &listed[k]) : GONIO_OK;
    }
    if (status == GONIO_OK) {
        status = keep_positions(file->context, instrument, listed);
    }
    for (size_t k = 0; k < GONIO_MOST_AXES; k++) {
        free(listed[k]);
    }
    return status;
}

/* ---- the table of reachable directions ---- */

/* Row `row` of numbers in degrees: the four angles, then the axes; without axes the angles are the
 * axes. */
static gonio_status take_row(const gonio_i_place *place, const double *number, size_t row,
                             bool angles_are_axes, gonio_instrument *instrument)
{
    gonio_setting *to = &instrument->row[row];
    const double *axis = angles_are_axes ? number : number + ANGLES;
    to->pair.incident = gonio_i_signed_direction(number[0] * DEGREE, number[1] * DEGREE);
    to->pair.outgoing = gonio_i_signed_direction(number[2] * DEGREE, number[3] * DEGREE);
    if (!(fabs(number[0]) < 90.0 && fabs(number[2]) < 90.0)) {
        return gonio_i_fail_at(place, "directions", "entry %zu is at or below the horizon",
                               row + 1);
    }
    for (size_t k = 0; k < instrument->view.axes; k++) {
        to->axis[k] = axis[k] * DEGREE;
    }
    return GONIO_OK;
}

/* Without axes the angles are axes that move at once. */
static void make_angles_axes(gonio_instrument *instrument)
{
    static const char *const names[ANGLES] = {"theta_i", "phi_i", "theta_o", "phi_o"};
    instrument->view.axes = ANGLES;
    for (size_t k = 0; k < ANGLES; k++) {
        instrument->axis[k] =
            (gonio_axis){.name = names[k], .low = -4.0 * M_PI, .high = 4.0 * M_PI, .present = true};
    }
}

/* The numbers of a table in a CSV file: [rows][4 + axes]. */
static gonio_status read_table_file(const gonio_i_place *place, const char *path, size_t columns,
                                    const gonio_instrument *instrument, double **numbers,
                                    size_t *rows)
{
    static const char *const angle[ANGLES] = {"theta_i_deg", "phi_i_deg", "theta_o_deg",
                                              "phi_o_deg"};
    gonio_i_csv *csv = NULL;
    gonio_status status = gonio_i_csv_read(place->context, path, &csv);
    *rows = status == GONIO_OK ? csv->rows : 0;
    *numbers = status == GONIO_OK
                   ? gonio_i_allocate(place->context, *rows * columns + 1, sizeof **numbers)
                   : NULL;
    status = status == GONIO_OK && *numbers == NULL ? GONIO_ERROR_MEMORY : status;
    for (size_t k = 0; k < columns && status == GONIO_OK; k++) {
        const char *name = k < ANGLES ? angle[k] : instrument->axis[k - ANGLES].name;
        const int column = gonio_i_csv_column(csv, name);
        if (column < 0) {
            status = gonio_i_fail_at(place, "directions", "%s has no column %s", path, name);
        }
        for (size_t row = 0; row < *rows && status == GONIO_OK; row++) {
            if (!gonio_i_csv_number(csv, row, (size_t)column, &(*numbers)[row * columns + k])) {
                status = gonio_i_fail_at(place, "directions", "%s:%zu: no number in column %s",
                                         path, csv->line[row], name);
            }
        }
    }
    gonio_i_csv_free(&csv);
    return status;
}

/* Whether a name stays in the folder of the file that names it, or below. */
static bool stays_beside(const char *name)
{
    bool stays = *name != '/' && *name != '\0';
    for (const char *part = name; part != NULL && stays; part = strchr(part, '/')) {
        part += *part == '/' ? 1 : 0;
        stays = strncmp(part, "..", 2) != 0 || (part[2] != '/' && part[2] != '\0');
    }
    return stays;
}

/* The path of a file that an instrument file names: beside it. */
static char *path_beside(const char *file, const char *name)
{
    const char *slash = strrchr(file, '/');
    return slash == NULL ? gonio_i_format("%s", name)
                         : gonio_i_format("%.*s/%s", (int)(slash - file), file, name);
}

static gonio_status read_rows(const gonio_i_place *file, const json_t *root, size_t columns,
                              const gonio_instrument *instrument, double **numbers, size_t *rows)
{
    const json_t *directions = json_object_get(root, "directions");
    if (!json_is_string(directions)) {
        return gonio_i_read_numbers(file, root, "directions", columns, numbers, rows);
    }
    if (!stays_beside(json_string_value(directions))) {
        return gonio_i_fail_at(file, "directions", "'%s' is not a name of a file beside this one",
                               json_string_value(directions));
    }
    char *path = path_beside(file->file, json_string_value(directions));
    const gonio_status status =
        path != NULL ? read_table_file(file, path, columns, instrument, numbers, rows)
                     : GONIO_ERROR_MEMORY;
    free(path);
    return status;
}

static gonio_status read_table(const gonio_i_place *file, const json_t *root,
                               gonio_instrument *instrument)
{
    const bool angles_are_axes = instrument->view.axes == 0;
    const size_t columns = ANGLES + instrument->view.axes;
    double *numbers = NULL;
    size_t rows = 0;
    gonio_status status = read_rows(file, root, columns, instrument, &numbers, &rows);
    if (angles_are_axes) {
        make_angles_axes(instrument);
    }
    if (status == GONIO_OK && (rows == 0 || rows > MOST_DIRECTIONS)) {
        status = gonio_i_fail_at(file, "directions", "%zu directions; a table has 1 to %d", rows,
                                 MOST_DIRECTIONS);
    }
    if (status == GONIO_OK) {
        instrument->row = gonio_i_allocate(file->context, rows, sizeof *instrument->row);
        instrument->view.directions = rows;
        status = instrument->row != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    }
    for (size_t row = 0; row < rows && status == GONIO_OK; row++) {
        status = take_row(file, numbers + row * columns, row, angles_are_axes, instrument);
    }
    free(numbers);
    return status == GONIO_OK ? gonio_i_table_index(file->context, instrument) : status;
}

gonio_status gonio_i_read_axes(const gonio_i_place *place, const json_t *root,
                               gonio_instrument *instrument)
{
    const bool table = instrument->kinematics->axis[0].name == NULL;
    const json_t *axes = json_object_get(root, "axes");
    if (axes == NULL && !table) {
        return gonio_i_fail_at(place, "axes", "this key is missing");
    }
    if (axes != NULL && !json_is_object(axes)) {
        return gonio_i_fail_at(place, "axes", "this is no object {...}");
    }
    if (!table && json_object_get(root, "directions") != NULL) {
        return gonio_i_fail_at(place, "directions", "only for the kinematics 'table'");
    }
    gonio_status status = read_all_axes(place, axes, instrument);
    if (status == GONIO_OK && table) {
        status = read_table(place, root, instrument);
    }
    instrument->view.axis = instrument->axis;
    return status;
}
