/* What the commands share: see tool.h. */
#include "tool.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

int tool_threads = 0;
int tool_quiet = 0;

struct poptOption tool_common_options[] = {
    {"threads", '\0', POPT_ARG_INT, &tool_threads, 0, "Use at most N threads (default: all)", "N"},
    {"quiet", 'q', POPT_ARG_NONE, &tool_quiet, 0, "Only errors, no notes and no progress", NULL},
    POPT_TABLEEND};

/* Set by the first interrupt; the work then ends at its next progress report and tidies up. */
static volatile sig_atomic_t interrupted = 0;

static void on_interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- messages and progress ---- */

static void clear_progress(tool *t)
{
    if (t->progress_visible) {
        fputs("\r\033[K", stderr);
        t->progress_visible = false;
    }
}

static void on_message(void *user, gonio_message_level level, const char *text)
{
    tool *t = user;
    if (level != GONIO_MESSAGE_ERROR && tool_quiet) {
        return;
    }
    clear_progress(t);
    const char *kind = level == GONIO_MESSAGE_ERROR     ? ""
                       : level == GONIO_MESSAGE_WARNING ? "warning: "
                                                        : "note: ";
    fprintf(stderr, "gonio %s: %s%s\n", t->name, kind, text);
}

/* In minutes when there is no need for more. */
static void draw_time_left(double seconds)
{
    if (seconds >= 120.0) {
        fprintf(stderr, ", %.0f min left", seconds / 60.0);
    } else {
        fprintf(stderr, ", %.0f s left", seconds);
    }
}

static void draw_progress(const char *task, double fraction, double elapsed)
{
    enum { WIDTH = 30 };
    char bar[WIDTH + 1];
    const int full = (int)(fraction * WIDTH);
    for (int k = 0; k < WIDTH; k++) {
        bar[k] = k < full ? '#' : '.';
    }
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r\033[K%s [%s] %3.0f%% %.0f s", task, bar, 100.0 * fraction, elapsed);
    if (fraction > 0.02 && elapsed > 5.0) {
        draw_time_left(elapsed * (1.0 - fraction) / fraction);
    }
    fflush(stderr);
}

/* A bar on a terminal once the work has taken a second, ten times a second. */
static int on_progress(void *user, const char *task, double fraction)
{
    tool *t = user;
    const double time = now();
    if (t->progress_start == 0.0) {
        t->progress_start = time;
    }
    if (fraction >= 1.0) {
        clear_progress(t);
        t->progress_start = 0.0;
    } else if (!tool_quiet && time - t->progress_start > 1.0 && time - t->progress_shown > 0.1 &&
               isatty(STDERR_FILENO)) {
        draw_progress(task, fraction, time - t->progress_start);
        t->progress_shown = time;
        t->progress_visible = true;
    }
    return interrupted != 0;
}

/* ---- the command line ---- */

static bool is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "-_./:=,+%@";
    return *word != '\0' && word[strspn(word, plain)] == '\0';
}

/* The command line as typed, quoted where the shell would need it. */
static char *join(int argc, const char **argv)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        return NULL;
    }
    fputs("gonio", stream);
    for (int k = 0; k < argc; k++) {
        if (is_plain(argv[k])) {
            fprintf(stream, " %s", argv[k]);
            continue;
        }
        fputs(" '", stream);
        for (const char *c = argv[k]; *c != '\0'; c++) {
            if (*c == '\'') {
                fputs("'\\''", stream);
            } else {
                fputc(*c == '\n' || *c == '\r' ? ' ' : *c, stream);
            }
        }
        fputc('\'', stream);
    }
    fclose(stream);
    return text;
}

int tool_usage_error(const tool *t, const char *format, ...)
{
    va_list arguments;
    fprintf(stderr, "gonio %s: ", t->name);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fprintf(stderr, " (see gonio %s -h)\n", t->name);
    return EXIT_USAGE;
}

static int parse(tool *t, const char *text)
{
    int code = 0;
    while ((code = poptGetNextOpt(t->options)) > 0) {
        if (code == 'h') {
            poptPrintHelp(t->options, stdout, 0);
            printf("\n%s\n", text);
            return 0;
        }
    }
    if (code < -1) {
        return tool_usage_error(t, "%s: %s", poptBadOption(t->options, POPT_BADOPTION_NOALIAS),
                                poptStrerror(code));
    }
    if (tool_threads < 0) {
        return tool_usage_error(t, "--threads cannot be negative");
    }
    return -1;
}

/* Whether an option's value is a string, which popt gives as a copy that is the caller's to free.
 */
static bool holds_string(const struct poptOption *option)
{
    return (option->argInfo & POPT_ARG_MASK) == POPT_ARG_STRING && option->arg != NULL;
}

static bool is_end(const struct poptOption *option)
{
    return option->longName == NULL && option->shortName == '\0' && option->arg == NULL;
}

static void remember_defaults(tool *t)
{
    for (int k = 0; k < TOOL_MOST_OPTIONS && !is_end(&t->table[k]); k++) {
        t->defaults[k] = holds_string(&t->table[k]) ? *(const char **)t->table[k].arg : NULL;
    }
}

static void free_strings(tool *t)
{
    for (int k = 0; k < TOOL_MOST_OPTIONS && !is_end(&t->table[k]); k++) {
        if (holds_string(&t->table[k])) {
            char **value = t->table[k].arg;
            if (*value != t->defaults[k]) {
                free(*value);
                *value = NULL;
            }
        }
    }
}

int tool_begin(tool *t, int argc, const char **argv, const struct poptOption *table,
               const char *usage, const char *text)
{
    *t = (tool){.table = table, .name = argv[0], .command_line = join(argc, argv)};
    remember_defaults(t);
    if (asprintf(&t->title, "gonio %s", argv[0]) < 0) {
        t->title = NULL;
        return EXIT_DATA;
    }
    argv[0] = t->title; /* what the help calls the program */
    t->options = poptGetContext(t->title, argc, argv, table, 0);
    poptSetOtherOptionHelp(t->options, usage);
    const int code = parse(t, text);
    if (code >= 0) {
        return code;
    }
    const gonio_context_options options = {on_message, on_progress, t, tool_threads};
    signal(SIGINT, on_interrupt);
    signal(SIGTERM, on_interrupt);
    signal(SIGXFSZ, SIG_IGN); /* a file-size limit becomes an error like a full disk */
    signal(SIGPIPE, SIG_IGN);
    return gonio_context_create(&t->context, &options) == GONIO_OK ? -1 : EXIT_DATA;
}

void tool_end(tool *t)
{
    clear_progress(t);
    gonio_context_free(&t->context);
    poptFreeContext(t->options);
    free_strings(t);
    free(t->title);
    free(t->command_line);
}

const char **tool_arguments(const tool *t, size_t *count)
{
    const char **arguments = poptGetArgs(t->options);
    *count = 0;
    while (arguments != NULL && arguments[*count] != NULL) {
        (*count)++;
    }
    return arguments;
}

int tool_exit_code(gonio_status status)
{
    return status == GONIO_OK ? 0 : status == GONIO_ERROR_ARGUMENT ? EXIT_USAGE : EXIT_DATA;
}

int tool_check_output(const tool *t, const char *output, const char *const *inputs, size_t count)
{
    struct stat out;
    if (output == NULL || *output == '\0') {
        return tool_usage_error(t, "no output: give -o FILE");
    }
    for (size_t k = 0; stat(output, &out) == 0 && k < count; k++) {
        struct stat in;
        if (inputs[k] != NULL && stat(inputs[k], &in) == 0 && in.st_dev == out.st_dev &&
            in.st_ino == out.st_ino && S_ISREG(in.st_mode)) {
            return tool_usage_error(t, "%s is an input: give another name for the output", output);
        }
    }
    return 0;
}

int tool_check_count(const tool *t, const char *option, long value, long least)
{
    return value < least
               ? tool_usage_error(t, "%s: %ld is too small, at least %ld", option, value, least)
               : 0;
}

/* ---- the built-in basis ---- */

static bool make_folder(const char *path)
{
    return mkdir(path, 0777) == 0 || errno == EEXIST;
}

/* $XDG_CACHE_HOME/gonio or ~/.cache/gonio, made if need be; NULL if that cannot be. */
static char *cache_folder(void)
{
    const char *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    char *folder = NULL;
    int length = -1;
    if (cache != NULL && cache[0] == '/') {
        length = asprintf(&folder, "%s/gonio", cache);
    } else if (home != NULL && home[0] != '\0') {
        length = asprintf(&folder, "%s/.cache/gonio", home);
    }
    if (length < 0) {
        return NULL;
    }
    for (char *slash = strchr(folder + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        const bool made = make_folder(folder);
        *slash = '/';
        if (!made) {
            break;
        }
    }
    if (!make_folder(folder)) {
        free(folder);
        return NULL;
    }
    return folder;
}

static gonio_status learn_atlas(tool *t, bool paper, gonio_basis **basis)
{
    const gonio_database_options kind = {.representation = paper ? GONIO_BIVARIATE : GONIO_SECTORED,
                                         .channels = paper ? GONIO_JOINT : GONIO_SEPARATE};
    const gonio_basis_options how = {.mixtures = paper ? 0 : GONIO_DEFAULT_MIXTURES};
    const int count = gonio_atlas_count();
    char **paths = calloc((size_t)count, sizeof *paths);
    gonio_status status = paths == NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    for (int k = 0; k < count && status == GONIO_OK; k++) {
        status = asprintf(&paths[k], "atlas:%s", gonio_atlas_name(k)) < 0 ? GONIO_ERROR_MEMORY
                                                                          : GONIO_OK;
    }
    gonio_database *database = NULL;
    if (status == GONIO_OK) {
        status = gonio_database_create(t->context, (const char *const *)paths, (size_t)count, &kind,
                                       &database);
    }
    if (status == GONIO_OK) {
        status = gonio_basis_learn(t->context, database, &how, basis);
    }
    gonio_database_free(&database);
    for (int k = 0; paths != NULL && k < count; k++) {
        free(paths[k]);
    }
    free(paths);
    return status;
}

static gonio_status make_builtin(tool *t, const char *path, bool paper)
{
    gonio_basis *basis = NULL;
    if (!tool_quiet) {
        on_message(t, GONIO_MESSAGE_NOTE,
                   "no BASIS given: learning one from the built-in materials (once; kept in the "
                   "cache)");
    }
    gonio_status status = learn_atlas(t, paper, &basis);
    if (status == GONIO_OK) {
        status = gonio_basis_write(
            t->context, basis,
            paper ? "gonio learn atlas: --grid bivariate" : "gonio learn atlas:", path);
    }
    gonio_basis_free(&basis);
    return status;
}

/* To be raised when gonio learn makes something else of the same materials, so that what an earlier
 * build left in the cache is not taken for it. */
enum { RECIPE = 3 };

gonio_status tool_builtin_basis(tool *t, bool paper, char **path)
{
    char *folder = cache_folder();
    if (folder == NULL) {
        on_message(t, GONIO_MESSAGE_ERROR,
                   "no cache folder for the built-in basis: set XDG_CACHE_HOME, or make a basis "
                   "with 'gonio learn atlas: -o FILE' and give it as BASIS");
        return GONIO_ERROR_IO;
    }
    const int length = asprintf(path, "%s/atlas-%s-%d%s.gonio", folder, gonio_version(), RECIPE,
                                paper ? "-bivariate" : "");
    free(folder);
    if (length < 0) {
        return GONIO_ERROR_MEMORY;
    }
    const gonio_status status = access(*path, F_OK) == 0 ? GONIO_OK : make_builtin(t, *path, paper);
    if (status != GONIO_OK) {
        free(*path);
    }
    return status;
}

/* Whether a method of planning or reconstructing works on the paper's kind of basis. */
static bool is_papers(const char *method)
{
    return method != NULL && *method != '\0' && strcmp(method, "expected-error") != 0 &&
           strcmp(method, "posterior") != 0;
}

gonio_status tool_basis(tool *t, const char *path, const char *method, gonio_basis **basis)
{
    if (path != NULL) {
        return gonio_basis_read(t->context, path, basis);
    }
    char *builtin = NULL;
    gonio_status status = tool_builtin_basis(t, is_papers(method), &builtin);
    if (status == GONIO_OK) {
        status = gonio_basis_read(t->context, builtin, basis);
        free(builtin);
    }
    return status;
}

const double tool_incidence_deg[TOOL_INCIDENCES] = {0.0, 30.0, 45.0, 60.0, 75.0, 85.0};

int tool_albedos(const gonio_table *table, double albedo[TOOL_INCIDENCES][GONIO_CHANNELS],
                 double *largest)
{
    int where = 0;
    *largest = 0.0;
    for (int k = 0; k < TOOL_INCIDENCES; k++) {
        gonio_table_albedo(table, tool_incidence_deg[k] * M_PI / 180.0, albedo[k]);
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            if (albedo[k][c] > *largest) {
                *largest = albedo[k][c];
                where = k;
            }
        }
    }
    return where;
}

json_t *tool_json_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

int tool_print_json(const tool *t, json_t *json)
{
    if (json == NULL) {
        fprintf(stderr, "gonio %s: no JSON: a name is not UTF-8, or out of memory\n", t->name);
        return EXIT_DATA;
    }
    json_dumpf(json, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(10));
    putchar('\n');
    json_decref(json);
    return 0;
}

void tool_note_suspicion(const char *command, const char *path, const char *suspicion)
{
    if (suspicion != NULL && !tool_quiet) {
        fprintf(
            stderr,
            "gonio %s: note: %s: the readings are far likelier if %s (--believe: do not look)\n",
            command, path, suspicion);
    }
}

const char *tool_plural(size_t count)
{
    return count == 1 ? "" : "s";
}

bool tool_is_readings(const char *path)
{
    char head[8192];
    FILE *file = strncmp(path, "atlas:", 6) != 0 ? fopen(path, "rbe") : NULL;
    const size_t size = file != NULL ? fread(head, 1, sizeof head, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    const bool hdf5 = size >= 4 && memcmp(head, "\211HDF", 4) == 0;
    return size > 0 && !hdf5 && memchr(head, '\0', size) == NULL;
}
