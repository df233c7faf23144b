/* Writing a figure: see figure_writer.h. */
#include "figure_writer.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csv.h>
#include <jansson.h>

#include "gnuplot.h"
#include "../run/run_folder.h"
#include "core/memory_stream.h"

/* ---- text ---- */

/* A copy on one line that is UTF-8 all through; NULL when out of memory. */
static char *tidy(const char *text)
{
    char *copy = strdup(text);
    json_t *valid = json_string(text); /* NULL for what is not UTF-8 */
    for (char *c = copy; c != NULL && *c != '\0'; c++) {
        if (iscntrl((unsigned char)*c)) {
            *c = ' ';
        } else if (valid == NULL && (*c & 0x80) != 0) {
            *c = '?';
        }
    }
    json_decref(valid);
    return copy;
}

/* Puts text in single quotes, in which gnuplot interprets only a quote: no commands in
 * `backquotes`, no escapes. gnuplot's own way to write a quote fails at the beginning of a text, so
 * a typographic quote replaces it. */
static void put_literal(FILE *script, const char *text, bool is_format)
{
    fputc('\'', script);
    for (const char *c = text; *c != '\0'; c++) {
        if (*c == '\'') {
            fputs("\xe2\x80\x99", script);
        } else {
            fputs(is_format && *c == '%' ? "%" : "", script);
            fputc(*c, script);
        }
    }
    fputc('\'', script);
}

void gonio_i_begin_panels(FILE *script, size_t count, double bottom, const char *title)
{
    fprintf(script, "  set multiplot layout 1,%zu margins 0.01,0.99,%.4g,%s spacing 0.02,0", count,
            bottom, title != NULL ? "0.86" : "0.9");
    if (title != NULL) {
        fputs(" title ", script);
        gonio_i_put_quoted(script, title);
        fputs(" noenhanced", script);
    }
    fputc('\n', script);
}

void gonio_i_end_panels(FILE *script)
{
    fputs("  unset multiplot\n", script);
}

void gonio_i_put_quoted(FILE *script, const char *text)
{
    char *line = tidy(text);
    put_literal(script, line != NULL ? line : "", false);
    free(line);
}

/* Cuts long text between characters. */
static void shorten(char *text)
{
    size_t length = strlen(text);
    if (length > GONIO_I_LONGEST_TIC) {
        length = GONIO_I_LONGEST_TIC - 3;
        while (length > 0 && (text[length] & 0xC0) == 0x80) {
            length--;
        }
        strcpy(text + length, "...");
    }
}

void gonio_i_put_tic(FILE *script, const char *text)
{
    char *line = tidy(text);
    if (line != NULL) {
        shorten(line);
    }
    put_literal(script, line != NULL ? line : "", true);
    free(line);
}

void gonio_i_put_cell(FILE *data, const char *text)
{
    char *line = tidy(text);
    if (line != NULL) {
        csv_fwrite(data, line, strlen(line));
    }
    free(line);
}

/* Prints a number in the fewest digits that read back exactly. */
void gonio_i_put_number(FILE *data, double value)
{
    char text[32];
    if (!isfinite(value)) {
        fputs("NaN", data);
        return;
    }
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    fputs(text, data);
}

/* ---- axes ---- */

static char *heading_of(const gonio_i_axis *axis)
{
    return axis->unit != NULL ? gonio_i_format("%s (%s)", axis->name, axis->unit)
                              : strdup(axis->name);
}

void gonio_i_put_heading(FILE *data, const gonio_i_axis *axis)
{
    char *heading = heading_of(axis);
    gonio_i_put_cell(data, heading != NULL ? heading : "");
    free(heading);
}

/* gnuplot labels the decades of a logarithmic axis only, too few for a short one. */
static void put_tics(FILE *script, const char *axis, const gonio_i_range *range)
{
    static const double few[] = {1.0, 2.0, 5.0};
    static const double many[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0};
    const double decades = log10(range->high / range->low);
    const bool is_short = decades < 1.1;
    const double *steps = is_short ? many : few;
    const size_t count = is_short ? sizeof many / sizeof *many : sizeof few / sizeof *few;
    const char *word = "";
    if (!(decades < 2.6)) {
        return;
    }
    const int last = (int)ceil(log10(range->high));
    for (int decade = (int)floor(log10(range->low)); decade <= last; decade++) {
        for (size_t k = 0; k < count; k++) {
            fprintf(script, "set %stics %s(%.10g)\n", axis, word, steps[k] * pow(10.0, decade));
            word = "add ";
        }
    }
}

void gonio_i_put_axis(FILE *script, const char *axis, const gonio_i_axis *a,
                      const gonio_i_range *range)
{
    const bool given = a->low != 0.0 || a->high != 0.0;
    const gonio_i_range shown = given ? (gonio_i_range){a->low, a->high} : *range;
    char *heading = heading_of(a);
    fprintf(script, "set %slabel ", axis);
    gonio_i_put_quoted(script, heading != NULL ? heading : "");
    free(heading);
    fputs(strcmp(axis, "x") == 0 ? " offset 0,0.3\n" : "\n", script);
    if (given) {
        fprintf(script, "set %srange [%.10g:%.10g]\n", axis, a->low, a->high);
    }
    if (a->logarithmic) {
        fprintf(script, "set logscale %s\n", axis);
    }
    if (a->logarithmic && shown.low > 0.0 && shown.low < shown.high) {
        put_tics(script, axis, &shown);
    }
}

gonio_status gonio_i_find_range(gonio_context *context, const char *figure,
                                const gonio_i_axis *axis, const double *values, size_t count,
                                gonio_i_range *range)
{
    for (size_t k = 0; values != NULL && k < count; k++) {
        if (isfinite(values[k])) {
            range->low = fmin(range->low, values[k]);
            range->high = fmax(range->high, values[k]);
        }
    }
    if (axis->logarithmic && (range->low <= 0.0 || axis->low < 0.0)) {
        return gonio_i_fail(context, GONIO_ERROR_DATA,
                            "figure %s: %s is %g, which a logarithmic axis cannot show", figure,
                            axis->name, fmin(range->low, axis->low));
    }
    return GONIO_OK;
}

/* ---- the script ---- */

static const char style[] =
    "reset\n"
    "set encoding utf8\n"
    "set datafile separator comma\n"
    "set datafile missing 'NaN'\n"
    "\n"
    "# Okabe and Ito's colours, told apart by markers and dashes too.\n"
    "set linetype 1 lc rgb '#0072B2' lw 1.6 dt 1 pt 7 ps 0.7\n"
    "set linetype 2 lc rgb '#D55E00' lw 1.6 dt (12,4) pt 5 ps 0.65\n"
    "set linetype 3 lc rgb '#009E73' lw 1.6 dt (12,4,3,4) pt 9 ps 0.8\n"
    "set linetype 4 lc rgb '#CC79A7' lw 1.6 dt (4,3) pt 13 ps 0.9\n"
    "set linetype 5 lc rgb '#000000' lw 1.6 dt (18,4) pt 2 ps 0.7\n"
    "set linetype 6 lc rgb '#E69F00' lw 1.6 dt (12,4,3,4,3,4) pt 11 ps 0.8\n"
    "set linetype 7 lc rgb '#56B4E9' lw 1.6 dt (2,3) pt 4 ps 0.7\n"
    "set linetype cycle 7\n"
    "\n"
    "set border 3 lw 0.8 lc rgb '#404040'\n"
    "set tics nomirror out scale 0.5 textcolor rgb '#202020'\n"
    "set format '%h'\n"
    "set grid lw 0.5 lt 1 dt 1 lc rgb '#E3E3E3'\n"
    "set key outside bottom center horizontal Left reverse samplen 3 width 1 height 0.8 "
    "noenhanced\n";

static bool is_file_name(const char *name)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
    return *name != '\0' && strlen(name) <= 100 && name[strspn(name, plain)] == '\0';
}

static void release(gonio_i_figure_output *output)
{
    if (output->plain != (locale_t)0) {
        uselocale(output->before);
        freelocale(output->plain);
    }
    free(output->data_text);
    free(output->script_text);
    *output = (gonio_i_figure_output){0};
}

/* Closes the texts. Returns whether they are complete. */
static bool close_texts(gonio_i_figure_output *output)
{
    FILE *const streams[] = {output->data, output->script};
    bool fine = true;
    for (int k = 0; k < 2; k++) {
        fine = fine && streams[k] != NULL && ferror(streams[k]) == 0;
        fine = (streams[k] == NULL || fclose(streams[k]) == 0) && fine;
    }
    return fine;
}

gonio_status gonio_i_figure_output_begin(gonio_context *context, const char *name,
                                         const char *title, gonio_i_figure_output *output)
{
    if (!is_file_name(name)) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "a figure's name is of letters, digits, '-' and '_', not '%s'", name);
    }
    *output = (gonio_i_figure_output){.context = context, .name = name};
    output->data = gonio_i_memory_stream(&output->data_text, &output->data_size);
    output->script = gonio_i_memory_stream(&output->script_text, &output->script_size);
    output->plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (output->data == NULL || output->script == NULL || output->plain == (locale_t)0) {
        close_texts(output);
        release(output);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "figure %s: out of memory", name);
    }
    output->before = uselocale(output->plain);
    fprintf(output->script,
            "# Run 'gnuplot %s.gp' here to draw %s.svg, .pdf and .png from %s.csv.\n", name, name,
            name);
    fputs(style, output->script);
    if (title != NULL) {
        fputs("set title ", output->script);
        gonio_i_put_quoted(output->script, title);
        fputs(" noenhanced\n", output->script);
    }
    return GONIO_OK;
}

void gonio_i_figure_output_begin_drawing(gonio_i_figure_output *output, int width, int height)
{
    enum { PNG_WIDTH = 1600, FONT = 12 };
    const double zoom = (double)PNG_WIDTH / width;
    FILE *s = output->script;
    fprintf(s,
            "\ndo for [format in 'svg pdf png'] {\n"
            "  if (format eq 'svg') { set terminal svg size %d,%d noenhanced font 'sans-serif,%d' "
            "background 'white' }\n"
            "  if (format eq 'pdf') { set terminal pdfcairo size %.4fin,%.4fin noenhanced "
            "font 'sans-serif,%d' fontscale 0.75 linewidth 1.7 background 'white' }\n",
            width, height, FONT, width / 96.0, height / 96.0, FONT);
    fprintf(s,
            "  if (format eq 'png') { set terminal pngcairo size %d,%.0f noenhanced "
            "font 'sans-serif,%d' fontscale %.4g linewidth %.4g pointscale %.4g "
            "background 'white' }\n"
            "  set output '%s.'.format\n",
            PNG_WIDTH, height * zoom, FONT, 0.75 * zoom, zoom, zoom, output->name);
}

void gonio_i_figure_output_end_drawing(gonio_i_figure_output *output)
{
    fputs("}\nset output\n", output->script);
}

/* ---- the files ---- */

static const char *const endings[] = {"csv", "gp", "svg", "pdf", "png"};

enum { TEXTS = 2, FILES = sizeof endings / sizeof *endings };

/* Moves the first `count` files from the folder where they were made to their places. */
static gonio_status put_in_place(const gonio_i_figure_output *output, const char *from,
                                 const char *to, int count)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < count && status == GONIO_OK; k++) {
        char *made = gonio_i_format("%s/%s.%s", from, output->name, endings[k]);
        char *place = gonio_i_format("%s/%s.%s", to, output->name, endings[k]);
        if (made == NULL || place == NULL) {
            status = gonio_i_fail(output->context, GONIO_ERROR_MEMORY, "out of memory");
        } else if (rename(made, place) != 0) {
            status = gonio_i_fail(output->context, GONIO_ERROR_IO, "%s: cannot write: %s", place,
                                  strerror(errno));
        }
        free(made);
        free(place);
    }
    return status;
}

static void remove_workshop(const gonio_i_figure_output *output, const char *workshop)
{
    for (int k = 0; k < FILES; k++) {
        char *path = gonio_i_format("%s/%s.%s", workshop, output->name, endings[k]);
        if (path != NULL) {
            unlink(path);
        }
        free(path);
    }
    rmdir(workshop);
}

static gonio_status write_texts(const gonio_i_figure_output *output, const char *workshop)
{
    const char *const texts[TEXTS] = {output->data_text, output->script_text};
    gonio_status status = gonio_i_make_folder(output->context, workshop);
    for (int k = 0; k < TEXTS && status == GONIO_OK; k++) {
        char *path = gonio_i_format("%s/%s.%s", workshop, output->name, endings[k]);
        status = path != NULL ? gonio_i_write_text(output->context, path, texts[k])
                              : gonio_i_fail(output->context, GONIO_ERROR_MEMORY, "out of memory");
        free(path);
    }
    return status;
}

/* Replaces the date in a PDF file by 1970, because some versions of cairo ignore SOURCE_DATE_EPOCH.
 * The length stays, so that the file's table of offsets stays right. */
static void forget_day(char *pdf, size_t size)
{
    static const char key[] = "/CreationDate (D:";
    static const char day[] = "19700101000000";
    char *found = memmem(pdf, size, key, sizeof key - 1);
    if (found != NULL && (size_t)(pdf + size - found) >= sizeof key + sizeof day) {
        memcpy(found + sizeof key - 1, day, sizeof day - 1);
    }
}

static gonio_status forget_days(const gonio_i_figure_output *output, const char *workshop)
{
    struct stat status;
    char *path = gonio_i_format("%s/%s.pdf", workshop, output->name);
    const int descriptor = path != NULL ? open(path, O_RDWR | O_CLOEXEC) : -1;
    char *pdf = MAP_FAILED;
    if (descriptor >= 0 && fstat(descriptor, &status) == 0) {
        pdf = mmap(NULL, (size_t)status.st_size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    }
    const bool fine = pdf != MAP_FAILED;
    if (fine) {
        forget_day(pdf, (size_t)status.st_size);
        munmap(pdf, (size_t)status.st_size);
    } else {
        gonio_i_fail(output->context, GONIO_ERROR_IO, "%s.pdf: gnuplot has not drawn it: %s",
                     output->name, strerror(errno));
    }
    if (descriptor >= 0) {
        close(descriptor);
    }
    free(path);
    return fine ? GONIO_OK : GONIO_ERROR_IO;
}

static void note_undrawn(const gonio_i_figure_output *output, gonio_i_figures *figures)
{
    if (!figures->undrawn) {
        gonio_i_note(output->context,
                     "no figures were drawn, because gnuplot is not on PATH: install it "
                     "(gnuplot-nox) and, in %s, run: for f in *.gp; do gnuplot $f; done",
                     figures->folder);
    }
    figures->undrawn = true;
}

/* Data and script stay even if gnuplot fails, so that people can see why. */
static gonio_status draw(const gonio_i_figure_output *output, gonio_i_figures *figures,
                         const char *workshop)
{
    bool found = false;
    char *script = gonio_i_format("%s.gp", output->name);
    if (script == NULL) {
        return gonio_i_fail(output->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    gonio_status drawn = gonio_i_gnuplot(output->context, workshop, script, &found);
    free(script);
    if (drawn == GONIO_OK && found) {
        drawn = forget_days(output, workshop);
    } else if (drawn == GONIO_OK) {
        note_undrawn(output, figures);
    }
    const gonio_status status =
        put_in_place(output, workshop, figures->folder, drawn == GONIO_OK && found ? FILES : TEXTS);
    return drawn != GONIO_OK ? drawn : status;
}

/* Files are made in a folder of their own, to appear together when they are whole. */
static gonio_status make_files(const gonio_i_figure_output *output, gonio_i_figures *figures)
{
    char *workshop = gonio_i_format("%s/%s.part", figures->folder, output->name);
    if (workshop == NULL) {
        return gonio_i_fail(output->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    gonio_status status = gonio_i_make_folder(output->context, figures->folder);
    if (status == GONIO_OK) {
        status = write_texts(output, workshop);
        if (status == GONIO_OK) {
            status = draw(output, figures, workshop);
        }
        remove_workshop(output, workshop);
    }
    free(workshop);
    return status;
}

gonio_status gonio_i_figure_output_end(gonio_i_figure_output *output, gonio_i_figures *figures,
                                       gonio_status status)
{
    if (!close_texts(output) && status == GONIO_OK) {
        status = gonio_i_fail(output->context, GONIO_ERROR_MEMORY, "figure %s: out of memory",
                              output->name);
    }
    if (status == GONIO_OK) {
        status = make_files(output, figures);
    }
    release(output);
    return status;
}
