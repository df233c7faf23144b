/* Files of readings: the table of formats, and what all formats share. */
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../core/number.h"
#include "../core/output.h"
#include "../core/text_encoding.h"
#include "../core/text_file.h"
#include "formats/format.h"
#include "../core/memory_stream.h"

#define ROW(name) &gonio_i_readings_##name,
static const gonio_i_readings_format *const formats[] = {GONIO_I_READINGS_FORMATS(ROW)};

static const char grid_name[] = "half/difference 90 x 90 x 180";

/* ---- reading ---- */

enum { FORMATS = sizeof formats / sizeof *formats };

/* Whether this is a table of gonio's own, whatever its other comments look like. */
static bool is_own(const char *text, size_t size)
{
    static const char *const first[] = {"# gonio readings", "# gonio plan"};
    bool own = false;
    for (size_t k = 0; k < sizeof first / sizeof *first; k++) {
        const size_t length = strlen(first[k]);
        own = own || (size >= length && memcmp(text, first[k], length) == 0);
    }
    return own;
}

/* The number of the format that a text looks like, of which CSV is the last; FORMATS if of none. */
static size_t recognise(const char *text, size_t size)
{
    size_t k = is_own(text, size) ? FORMATS - 1 : 0;
    while (k < FORMATS && !formats[k]->recognises(text, size)) {
        k++;
    }
    return k;
}

const char *gonio_i_readings_format_of(const gonio_i_file *file)
{
    char head[GONIO_I_HEAD + 1];
    const size_t size = gonio_i_text_plain_head(file->head, file->head_size, head, sizeof head);
    const size_t found = file->size > 0 ? recognise(head, size) : FORMATS;
    return found < FORMATS ? formats[found]->name : NULL;
}

const char *gonio_i_readings_format_name(int index)
{
    return index < FORMATS ? formats[index]->name : NULL;
}

const char *gonio_readings_format_word(int index)
{
    return index >= 0 && index < FORMATS ? formats[index]->word : NULL;
}

/* The format that the user names, otherwise the one that recognises the text, otherwise CSV. */
static const gonio_i_readings_format *find_format(const char *word, const char *text, size_t size)
{
    size_t k = 0;
    while (word != NULL && k < FORMATS && strcmp(word, formats[k]->word) != 0) {
        k++;
    }
    k = word != NULL ? k : recognise(text, size);
    return formats[k < FORMATS ? k : FORMATS - 1];
}

/* The number of a "key: number" comment; 0 if there is no such comment. */
static gonio_status read_number(gonio_context *context, const gonio_readings *readings,
                                const char *key, int base, uint64_t *number)
{
    const char *text = gonio_i_comments_value(&readings->comment, key);
    if (text == NULL) {
        *number = 0;
        return GONIO_OK;
    }
    char *end = NULL;
    errno = 0;
    *number = strtoull(text, &end, base);
    if (!isxdigit((unsigned char)*text) || *end != '\0' || errno != 0 || *number == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: '# %s: %.60s' is not what gonio plan writes; restore it, or "
                            "delete the line",
                            readings->path, key, text);
    }
    return GONIO_OK;
}

/* Reads what the comments say of the plan. */
static gonio_status read_comments(gonio_context *context, gonio_readings *readings)
{
    const char *grid = gonio_i_comments_value(&readings->comment, "grid");
    if (grid != NULL && strcmp(grid, grid_name) != 0) {
        return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                            "%s: made for the grid '%s'; this gonio works on '%s'", readings->path,
                            grid, grid_name);
    }
    uint64_t components = 0;
    gonio_status status = read_number(context, readings, "basis", 16, &readings->basis);
    if (status == GONIO_OK) {
        status = read_number(context, readings, "components", 10, &components);
    }
    readings->components = (size_t)components;
    return status;
}

static gonio_status read_text(gonio_i_readings_file *file, gonio_readings *readings)
{
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        return gonio_i_fail(file->context, GONIO_ERROR_MEMORY, "%s: out of memory", file->path);
    }
    const gonio_i_readings_format *format =
        find_format(readings->options.as.format, file->text, file->size);
    gonio_status status = format->read(file, readings);
    gonio_i_plain_numbers_end(&plain);
    if (status == GONIO_OK) {
        status = read_comments(file->context, readings);
    }
    return status == GONIO_OK
               ? gonio_i_readings_finish(file->context, readings, readings->options.values_needed)
               : status;
}

/* Reads a text, which is released; status: of what came before. */
static gonio_status read_taken(gonio_i_readings_file *file, gonio_readings *made,
                               gonio_status status, gonio_readings **readings)
{
    if (status == GONIO_OK) {
        status = gonio_i_text_make_plain(file->context, file->path, &file->text, &file->size);
    }
    if (status == GONIO_OK) {
        status = read_text(file, made);
    }
    free(file->text);
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}

gonio_status gonio_readings_read(gonio_context *context, const char *path,
                                 const gonio_readings_options *options, gonio_readings **readings)
{
    gonio_i_readings_file file = {.context = context, .path = path};
    gonio_readings *made = NULL;
    gonio_status status = gonio_i_readings_new(context, path, options, &made);
    if (status == GONIO_OK) {
        status = gonio_i_text_read(context, path, &file.text, &file.size);
    }
    return read_taken(&file, made, status, readings);
}

gonio_status gonio_readings_read_text(gonio_context *context, const char *name, const char *text,
                                      size_t size, const gonio_readings_options *options,
                                      gonio_readings **readings)
{
    gonio_i_readings_file file = {.context = context, .path = name, .size = size};
    gonio_readings *made = NULL;
    gonio_status status = gonio_i_readings_new(context, name, options, &made);
    if (status == GONIO_OK) {
        file.text = gonio_i_allocate(context, size + 1, 1);
        status = file.text == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    if (status == GONIO_OK) {
        memcpy(file.text, text, size);
    }
    return read_taken(&file, made, status, readings);
}

/* ---- writing ---- */

static bool has_extension(const char *path, const gonio_i_readings_format *format)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash != NULL ? slash : path, '.');
    bool found = false;
    for (int k = 0; k < 2 && dot != NULL && format->extensions[k] != NULL; k++) {
        found = found || strcasecmp(format->extensions[k], dot) == 0;
    }
    return found;
}

static const gonio_i_readings_format *format_to_write(const char *path)
{
    for (int k = 0; k < FORMATS; k++) {
        if (formats[k]->print != NULL && has_extension(path, formats[k])) {
            return formats[k];
        }
    }
    return &gonio_i_readings_csv;
}

static gonio_status print_text(gonio_context *context, const gonio_readings *readings,
                               const char *command, const char *path, char **text, size_t *size)
{
    gonio_i_plain_numbers plain;
    FILE *stream = gonio_i_memory_stream(text, size);
    const bool ready = stream != NULL && gonio_i_plain_numbers_begin(&plain);
    gonio_status status = GONIO_ERROR_MEMORY;
    if (ready) {
        status = format_to_write(path)->print(context, readings, command, stream);
        gonio_i_plain_numbers_end(&plain);
    }
    const bool whole = stream != NULL && fclose(stream) == 0;
    return ready && whole ? status
                          : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
}

gonio_status gonio_readings_write(gonio_context *context, const gonio_readings *readings,
                                  const char *command, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    gonio_i_output output;
    gonio_status status = print_text(context, readings, command, path, &text, &size);
    if (status == GONIO_OK) {
        status = gonio_i_output_open(context, path, &output);
    }
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, &output, text, size);
        status = gonio_i_output_close(context, &output, status);
    }
    free(text);
    return status;
}
