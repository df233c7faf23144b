/* Reading readings and plans as CSV: see docs/plan-and-readings.md. Cells are parsed straight into
 * numbers. The text is kept, so that other columns can be written again as they are. */
#include <stdlib.h>
#include <string.h>

#include "csv_blocks.h"
#include "csv_kept.h"
#include "csv_layout.h"
#include "csv_rows.h"
#include "csv_unit_row.h"
#include "format.h"

/* Whether the text begins with column names between commas, semicolons or tabs, has names of angles
 * in another layout (csv_layout.h), is scans in blocks (csv_blocks.h), or is empty. The reader
 * checks the names. */
static bool recognises(const char *text, size_t size)
{
    gonio_i_csv_lines lines;
    const char *line = NULL;
    size_t length = 0;
    if (memchr(text, '\0', size) != NULL) {
        return false;
    }
    if (gonio_i_csv_are_blocks(text, size) || gonio_i_csv_layout_is_other(text, size)) {
        return true;
    }
    gonio_i_csv_lines_begin(&lines, text, size, NULL);
    return gonio_i_csv_lines_next(&lines, &line, &length) &&
           (length == 0 || strcspn(line, ",;\t") < length ||
            memmem(line, length, "_deg", 4) != NULL);
}

/* ---- the file as a whole ---- */

/* The convention that holds unless the user gives another. */
static gonio_convention convention_of(const gonio_i_csv_columns *columns, int usual_values)
{
    const int usual = usual_values != 0 ? usual_values : GONIO_VALUE_BRDF;
    gonio_convention stated = columns->stated;
    stated.angles = stated.angles != 0 ? stated.angles : GONIO_DEGREES;
    stated.values = stated.values != 0 ? stated.values : usual;
    return stated;
}

static bool is_convention_given(const gonio_convention *as)
{
    return as->angles != 0 || as->values != 0 || as->mirror != 0 || as->wavelengths != 0 ||
           as->zeros != 0;
}

/* From here on the columns have wavelengths in nm. */
static void take_nanometres(gonio_i_csv_columns *columns, const gonio_readings *readings)
{
    for (size_t k = 0; k < columns->count && readings->wavelength != NULL; k++) {
        gonio_i_csv_column *column = &columns->column[k];
        if (column->kind == GONIO_I_VALUE || column->kind == GONIO_I_DEVIATION) {
            column->wavelength = readings->wavelength[column->index];
        }
    }
}

/* Says what was made of polarised light, in columns or in rows. */
static gonio_status note_polarisation(const gonio_i_csv_source *s)
{
    static const char *const said[] = {
        "the values of s and of p polarisation are averaged",
        "the values of s and of p polarisation are averaged, where there are both",
        "the values are of one polarisation only; they are taken as those of unpolarised light"};
    const gonio_i_csv_columns *c = s->columns;
    const size_t rows = s->polarised[0] + s->polarised[2];
    const bool one = s->polarised[0] == 0 || s->polarised[2] == 0;
    gonio_status status = GONIO_OK;
    if (c->polarised > 0) {
        const int which = c->averaged == c->polarised ? 0 : c->averaged > 0 ? 1 : 2;
        status = gonio_i_readings_note(s->context, s->readings, "%s", said[which]);
    }
    if (rows > 0 && status == GONIO_OK) {
        status = gonio_i_readings_note(s->context, s->readings, "%s", said[one ? 2 : 1]);
    }
    return status;
}

/* Says which cells and lines were taken for no values. */
static gonio_status note_what_is_skipped(gonio_i_csv_source *s)
{
    gonio_status status = GONIO_OK;
    if (s->marks > 0) {
        status = gonio_i_readings_note(s->context, s->readings,
                                       "%zu cell%s such as '%s' taken as not read", s->marks,
                                       s->marks > 1 ? "s" : "", s->mark);
    }
    if (status == GONIO_OK && s->reader.remarks > 0) {
        status = gonio_i_readings_note(s->context, s->readings,
                                       "%zu line%s of words among the rows left out (first: line "
                                       "%zu)",
                                       s->reader.remarks, s->reader.remarks > 1 ? "s" : "",
                                       s->reader.first_remark);
    }
    return status;
}

/* Writes the notes that the import cannot know. */
static gonio_status write_notes(gonio_i_csv_source *s)
{
    gonio_status status = note_what_is_skipped(s);
    if (s->readings->options.directions_only) {
        return status;
    }
    status = status == GONIO_OK ? note_polarisation(s) : status;
    status = status == GONIO_OK ? gonio_i_csv_words_note(s) : status;
    if (status == GONIO_OK && s->columns->unclear != NULL) {
        status = gonio_i_readings_note(
            s->context, s->readings,
            s->columns->stated.values == 0
                ? "the comment '%.60s' is not understood as a unit of values; --as values=... says "
                  "what they are"
                : "the comment '%.60s' is not used: the names of columns say another unit",
            s->columns->unclear);
    }
    return status == GONIO_OK ? gonio_i_csv_others_note(&s->others, &s->reader, s->readings)
                              : status;
}

/* The number of lines, at most as many as fit into the text. Arrays that need not grow are not
 * copied. */
static size_t expected_rows(const gonio_i_csv_reader *reader)
{
    const char *end = reader->text + reader->size;
    size_t lines = 1;
    for (const char *at = reader->text; (at = memchr(at, '\n', (size_t)(end - at))) != NULL; at++) {
        lines++;
    }
    const size_t most = reader->size / reader->columns + 1;
    return lines < most ? lines : most;
}

static void begin_import(gonio_i_csv_source *s, gonio_i_csv_kept *kept, const char *taken_as)
{
    const gonio_convention stated = convention_of(s->columns, s->readings->usual_values);
    gonio_i_import_begin(&s->in, s->context, s->readings, taken_as, &stated);
    s->in.quiet = s->columns->own && !is_convention_given(&s->readings->options.as);
    s->in.keep_unmeasured = true;
    kept->rewrite_angles = !s->columns->own_angles || s->in.how.angles != GONIO_DEGREES ||
                           s->in.how.mirror == GONIO_MIRROR_0;
    s->readings->keep_angles = kept->rewrite_angles || gonio_i_csv_has_parts(s->columns);
}

/* Imports rows of one wavelength, colour or polarisation each, whose readings are known only at the
 * end. */
static gonio_status import_long(gonio_i_csv_source *s)
{
    const gonio_i_csv_columns *c = s->columns;
    s->table.context = s->context;
    s->table.numbered = c->by_colour                                ? GONIO_CHANNELS
                        : c->by_wavelength || c->wavelength != NULL ? 0
                                                                    : c->channels;
    gonio_status status = gonio_i_csv_take_rows(s);
    s->in.how.scale = c->by_polarisation ? GONIO_SCALE_LINEAR : s->in.how.scale;
    status = status == GONIO_OK ? gonio_i_long_table_import(&s->table, &s->in) : status;
    gonio_i_long_table_free(&s->table);
    return status;
}

static gonio_status import_wide(gonio_i_csv_source *s)
{
    const gonio_status status =
        gonio_i_import_channels(&s->in, s->columns->channels, s->columns->wavelength);
    if (status != GONIO_OK) {
        return status;
    }
    take_nanometres(s->columns, s->readings);
    s->readings->expected = expected_rows(&s->reader);
    return gonio_i_csv_take_rows(s);
}

static gonio_status import_rows(gonio_i_csv_source *s, gonio_i_csv_kept *kept)
{
    char taken_as[GONIO_I_TAKEN_ROOM] = "";
    begin_import(s, kept, taken_as);
    gonio_i_csv_describe(&s->reader, s->columns, s->in.how.mirror, taken_as);
    gonio_status status = gonio_i_csv_others_begin(&s->others, s->context, s->columns);
    if (status == GONIO_OK) {
        status = gonio_i_csv_has_parts(s->columns) ? import_long(s) : import_wide(s);
    }
    status = status == GONIO_OK ? write_notes(s) : status;
    gonio_i_csv_others_free(&s->others);
    return gonio_i_import_end(&s->in, status);
}

/* Drops the kept text: rows of which several are one reading cannot be written over. */
static void drop_kept(gonio_readings *readings)
{
    readings->attachment.release(readings->attachment.data);
    readings->attachment = (gonio_i_attachment){NULL, NULL};
}

/* The readings keep the text from here on. */
static gonio_i_csv_kept *keep(gonio_i_readings_file *file, gonio_readings *readings)
{
    gonio_i_csv_kept *kept = gonio_i_allocate(file->context, 1, sizeof *kept);
    if (kept != NULL) {
        *kept = (gonio_i_csv_kept){.text = file->text, .size = file->size};
        readings->attachment = (gonio_i_attachment){kept, gonio_i_csv_kept_free};
        file->text = NULL;
    }
    return kept;
}

/* Finds values with uncertainties in their cells, which no other column may have too. */
static gonio_status find_spreads(gonio_i_csv_source *s)
{
    gonio_i_csv_columns *c = s->columns;
    const bool others = c->any_deviation;
    for (size_t k = 0; k < c->count; k++) {
        if (c->column[k].kind != GONIO_I_VALUE || !gonio_i_csv_forms_spread(&s->forms, k)) {
            continue;
        }
        c->any_deviation = true;
        if (others) {
            return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                                "%s: column '%s' has uncertainties in its cells, and there is a "
                                "column of them; delete one",
                                s->reader.path, s->reader.name[k]);
        }
    }
    return GONIO_OK;
}

static gonio_status read_table(gonio_i_csv_source *s, gonio_i_csv_kept *kept)
{
    const gonio_readings_options *options = &s->readings->options;
    gonio_status status = gonio_i_csv_take_units(&s->reader);
    if (status == GONIO_OK) {
        status = gonio_i_csv_forms_find(&s->forms, &s->reader, options);
    }
    if (status == GONIO_OK) {
        status = gonio_i_csv_columns_find(&s->reader, options, &kept->columns);
    }
    if (status == GONIO_OK) {
        s->columns = &kept->columns;
        status = find_spreads(s);
    }
    if (status == GONIO_OK) {
        status = import_rows(s, kept);
    }
    gonio_i_csv_forms_free(&s->forms);
    if (status == GONIO_OK && !gonio_i_comments_copy(&s->readings->comment, &s->reader.comment)) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->reader.path);
    }
    return status;
}

static gonio_status make_plain(gonio_i_readings_file *file)
{
    if (gonio_i_csv_are_blocks(file->text, file->size)) {
        return gonio_i_csv_blocks_make_plain(file->context, file->path, &file->text, &file->size);
    }
    const char *begin = file->text + strspn(file->text, " \t\r\n");
    if (*begin == '{' || *begin == '[') {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: JSON, but not BRDF JSON: an object 'data' with columns theta_i, "
                            "phi_i, theta_r, phi_r and BRDF; or write it as CSV",
                            file->path);
    }
    if (gonio_i_csv_layout_lacks_names(file->text, file->size)) {
        return gonio_i_fail(file->context, GONIO_ERROR_FORMAT,
                            "%s: begins with numbers, not with names of columns; put a line of "
                            "names above, such as theta_i,phi_i,theta_o,phi_o,brdf",
                            file->path);
    }
    return gonio_i_csv_layout_make_plain(file->context, file->path, &file->text, &file->size);
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    gonio_i_csv_source s = {.context = file->context, .readings = readings};
    gonio_status status = make_plain(file);
    gonio_i_csv_kept *kept = status == GONIO_OK ? keep(file, readings) : NULL;
    if (kept == NULL) {
        return status != GONIO_OK ? status : GONIO_ERROR_MEMORY;
    }
    status = gonio_i_csv_open(file->context, file->path, kept->text, kept->size, &s.reader);
    s.reader.remarks_allowed = true;
    if (status == GONIO_OK) {
        status = read_table(&s, kept);
        gonio_i_csv_close(&s.reader);
    }
    if (status == GONIO_OK && gonio_i_csv_has_parts(&kept->columns)) {
        drop_kept(readings);
    }
    return status;
}

const gonio_i_readings_format gonio_i_readings_csv = {.word = "csv",
                                                      .name = "CSV",
                                                      .recognises = recognises,
                                                      .read = read,
                                                      .print = gonio_i_csv_print};
