/* What is tested: see subjects.h. */
#include "subjects.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <xxhash.h>

#include "core/core.h"

enum { MOST_SAMPLES = 999, DEEPEST = 8 };

/* While the subjects of one argument are listed. */
typedef struct finder {
    gonio_context *context;
    gonio_context *silent; /* for files that may be anything */
    const gonio_readings_options *how;
    const char *set;
    size_t prefix; /* characters of a path before the name in the set; 0: the base name alone */
    size_t left_out;
    benchmark_subjects *list;
} finder;

void benchmark_subjects_free(benchmark_subjects *list)
{
    for (size_t k = 0; k < list->count; k++) {
        free(list->subject[k].set);
        free(list->subject[k].name);
        free(list->subject[k].path);
    }
    free(list->subject);
    *list = (benchmark_subjects){0};
}

gonio_status benchmark_readings_open(gonio_context *context, const char *path, int sample,
                                     const gonio_readings_options *how, gonio_readings **readings)
{
    gonio_readings_options one;
    gonio_readings_options_default(&one);
    one.as = how->as;
    one.instrument = how->instrument;
    one.average_repeats = true;
    one.negative_to_zero = true;
    one.as.sample = sample > 0 ? sample : how->as.sample;
    gonio_readings *made = NULL;
    gonio_status status = gonio_readings_read(context, path, &one, &made);
    if (status == GONIO_OK) {
        status = gonio_readings_average_repeats(context, made);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_drop_empty_channels(context, made);
    }
    if (status != GONIO_OK) {
        gonio_readings_free(&made);
        return status;
    }
    *readings = made;
    return GONIO_OK;
}

/* ---- the list ---- */

uint64_t benchmark_hash(const char *path)
{
    XXH3_state_t *state = XXH3_createState();
    FILE *file = fopen(path, "rbe");
    unsigned char buffer[65536];
    uint64_t hash = XXH3_64bits(path, strlen(path)); /* of a built-in material */
    size_t length = 0;
    if (state != NULL && file != NULL && XXH3_64bits_reset(state) == XXH_OK) {
        while ((length = fread(buffer, 1, sizeof buffer, file)) > 0) {
            XXH3_64bits_update(state, buffer, length);
        }
        hash = XXH3_64bits_digest(state);
    }
    if (file != NULL) {
        fclose(file);
    }
    XXH3_freeState(state);
    return hash;
}

/* Takes `name`. */
static gonio_status add(const finder *f, const char *path, char *name, bool scattered, int sample)
{
    benchmark_subjects *list = f->list;
    benchmark_subject *more = reallocarray(list->subject, list->count + 1, sizeof *list->subject);
    if (more == NULL || name == NULL) {
        list->subject = more != NULL ? more : list->subject;
        free(name);
        return gonio_i_fail(f->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    list->subject = more;
    benchmark_subject *s = &more[list->count++];
    *s = (benchmark_subject){strdup(f->set), name,      strdup(path),
                             sample,         scattered, benchmark_hash(path)};
    return s->set != NULL && s->path != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

/* The name in the set, of a table without extension; NULL when out of memory. */
static char *name_of(const finder *f, const char *path, bool keep_extension, int sample)
{
    char *base = gonio_i_base_name(path, keep_extension);
    const char *slash = strrchr(path, '/');
    const int folder = f->prefix > 0 && slash != NULL && slash + 1 > path + f->prefix
                           ? (int)(slash + 1 - (path + f->prefix))
                           : 0;
    char number[16] = "";
    char *name = NULL;
    if (sample > 0) {
        snprintf(number, sizeof number, ":%d", sample);
    }
    if (base != NULL) {
        name = gonio_i_format("%.*s%s%s", folder, folder > 0 ? path + f->prefix : "", base, number);
    }
    free(base);
    return name;
}

/* ---- readings ---- */

static bool can_read(const finder *f, const char *path, int sample)
{
    gonio_readings *readings = NULL;
    const bool can =
        benchmark_readings_open(f->silent, path, sample, f->how, &readings) == GONIO_OK;
    gonio_readings_free(&readings);
    return can;
}

/* Formats of one sample take any number for it. */
static bool has_samples(const finder *f, const char *path)
{
    return f->how->as.sample == 0 && can_read(f, path, 0) && !can_read(f, path, INT_MAX);
}

static gonio_status add_samples(const finder *f, const char *path)
{
    gonio_status status = GONIO_OK;
    for (int sample = 1; sample <= MOST_SAMPLES && status == GONIO_OK; sample++) {
        if (can_read(f, path, sample)) {
            status = add(f, path, name_of(f, path, true, sample), true, sample);
        }
    }
    return status;
}

static gonio_status add_readings(finder *f, const char *path, bool needed)
{
    gonio_readings *readings = NULL;
    if (has_samples(f, path)) {
        return add_samples(f, path);
    }
    const gonio_status status =
        benchmark_readings_open(needed ? f->context : f->silent, path, 0, f->how, &readings);
    gonio_readings_free(&readings);
    if (status == GONIO_OK) {
        return add(f, path, name_of(f, path, true, 0), true, 0);
    }
    f->left_out++;
    return needed || status == GONIO_ERROR_MEMORY ? status : GONIO_OK;
}

/* ---- materials ---- */

static gonio_status add_material(finder *f, const char *path, bool needed)
{
    gonio_material *material = NULL;
    gonio_status status = gonio_material_open(needed ? f->context : f->silent, path, &material);
    const bool fine = status == GONIO_OK && !gonio_material_describe(material)->anisotropic;
    gonio_material_free(&material);
    if (fine) {
        return add(f, path, name_of(f, path, false, 0), false, 0);
    }
    f->left_out++;
    if (status == GONIO_OK && needed) {
        status = gonio_i_fail(f->context, GONIO_ERROR_DATA,
                              "%s: is anisotropic, which is not tested", path);
    }
    return needed || status == GONIO_ERROR_MEMORY ? status : GONIO_OK;
}

static gonio_status add_atlas(finder *f)
{
    gonio_status status = GONIO_OK;
    for (int k = 0; k < gonio_atlas_count() && status == GONIO_OK; k++) {
        char path[256];
        snprintf(path, sizeof path, "atlas:%s", gonio_atlas_name(k));
        status = add_material(f, path, true);
    }
    return status;
}

/* ---- files and folders ---- */

static gonio_status add_file(finder *f, const char *path, bool needed)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    gonio_status status =
        needed && f->how->as.format == NULL
            ? gonio_file_expect(f->context, path, GONIO_KIND_MATERIAL | GONIO_KIND_READINGS, &kind)
            : gonio_file_kind(f->silent, path, &kind, NULL);
    if (status != GONIO_OK) {
        return needed ? status : GONIO_OK;
    }
    if (kind == GONIO_KIND_MATERIAL) {
        return add_material(f, path, needed);
    }
    if (kind == GONIO_KIND_READINGS || (needed && f->how->as.format != NULL)) {
        return add_readings(f, path, needed);
    }
    f->left_out++;
    return GONIO_OK;
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static gonio_status add_folder(finder *f, const char *folder, int depth);

static gonio_status add_entry(finder *f, const char *path, int depth)
{
    struct stat about;
    if (stat(path, &about) != 0) {
        return GONIO_OK;
    }
    if (S_ISDIR(about.st_mode)) {
        return depth < DEEPEST ? add_folder(f, path, depth + 1) : GONIO_OK;
    }
    return S_ISREG(about.st_mode) ? add_file(f, path, false) : GONIO_OK;
}

/* What is in a folder, by name. */
static gonio_status add_folder(finder *f, const char *folder, int depth)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_visible, alphasort);
    gonio_status status = GONIO_OK;
    if (count < 0) {
        return gonio_i_fail(f->context, GONIO_ERROR_IO, "%s: cannot read: %s", folder,
                            strerror(errno));
    }
    for (int k = 0; k < count; k++) {
        char *path = gonio_i_format("%s/%s", folder, entries[k]->d_name);
        if (status == GONIO_OK) {
            status = path != NULL ? add_entry(f, path, depth) : GONIO_ERROR_MEMORY;
        }
        free(path);
        free(entries[k]);
    }
    free(entries);
    return status;
}

static gonio_status add_whole_folder(finder *f, const char *folder)
{
    const size_t before = f->list->count;
    f->prefix = strlen(folder) + 1;
    gonio_status status = add_folder(f, folder, 0);
    if (status == GONIO_OK && f->list->count == before) {
        status = gonio_i_fail(f->context, GONIO_ERROR_DATA,
                              "%s: no materials or readings in this folder", folder);
    } else if (status == GONIO_OK && f->left_out > 0) {
        gonio_i_note(f->context,
                     "%s: %zu files are left out: neither isotropic materials nor readings with "
                     "values",
                     folder, f->left_out);
    }
    return status;
}

/* Without the slashes at its end. */
static char *plain_path(const char *argument)
{
    size_t length = strlen(argument);
    while (length > 1 && argument[length - 1] == '/') {
        length--;
    }
    return strndup(argument, length);
}

static gonio_status add_argument(finder *f, const char *path)
{
    struct stat about;
    char *set = gonio_i_base_name(path, true);
    gonio_status status = GONIO_OK;
    f->set = set;
    if (set == NULL) {
        return gonio_i_fail(f->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    if (strncmp(path, "atlas:", 6) == 0) {
        f->set = "atlas";
        status = path[6] == '\0' ? add_atlas(f) : add_material(f, path, true);
    } else if (stat(path, &about) == 0 && S_ISDIR(about.st_mode)) {
        status = add_whole_folder(f, path);
    } else {
        status = add_file(f, path, true);
    }
    free(set);
    return status;
}

gonio_status benchmark_subjects_find(gonio_context *context, const char *const *arguments,
                                     size_t count, const gonio_readings_options *how,
                                     benchmark_subjects *list)
{
    gonio_context *silent = NULL;
    *list = (benchmark_subjects){0};
    gonio_status status = gonio_context_create(&silent, NULL);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        finder f = {.context = context, .silent = silent, .how = how, .list = list};
        char *path = plain_path(arguments[k]);
        status = path != NULL ? add_argument(&f, path) : GONIO_ERROR_MEMORY;
        free(path);
    }
    gonio_context_free(&silent);
    return status;
}
