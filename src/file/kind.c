/* The kind of a file: asks the formats of every stage in order. */
#include <gonio/file.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../basis/basis.h"
#include "../core/file_head.h"
#include "../material/formats/format.h"
#include "../measurement/formats/format.h"
#include "../render/file_formats.h"
#include "../core/memory_stream.h"

typedef struct kind_row {
    gonio_kind kind;
    const char *name;
    const char *article; /* of the name in a sentence */
    /* The name of a file's format; NULL if it is none of this kind. */
    const char *(*format_of)(const gonio_i_file *file);
    /* The names of the formats that are read; NULL past the last. */
    const char *(*format_name)(int index);
} kind_row;

/* In the order in which they are asked. Bases and materials may both be HDF5 files. Texts are last,
 * because many files look like texts. */
static const kind_row kinds[] = {
    {GONIO_KIND_BASIS, "basis", "a ", gonio_i_basis_format_of, gonio_i_basis_format_name},
    {GONIO_KIND_MATERIAL, "material", "a ", gonio_i_material_format_of,
     gonio_i_material_format_name},
    {GONIO_KIND_IMAGE, "image", "an ", gonio_i_image_format_of, gonio_i_image_format_name},
    {GONIO_KIND_MESH, "mesh", "a ", gonio_i_mesh_format_of, gonio_i_mesh_format_name},
    {GONIO_KIND_READINGS, "readings", "", gonio_i_readings_format_of, gonio_i_readings_format_name},
};

enum { KINDS = sizeof kinds / sizeof *kinds };

static const kind_row *row_of(gonio_kind kind)
{
    for (int k = 0; k < KINDS; k++) {
        if (kinds[k].kind == kind) {
            return &kinds[k];
        }
    }
    return NULL;
}

const char *gonio_kind_name(gonio_kind kind)
{
    const kind_row *row = row_of(kind);
    return row != NULL ? row->name : NULL;
}

const char *gonio_kind_format(gonio_kind kind, int index)
{
    const kind_row *row = row_of(kind);
    return row != NULL && index >= 0 ? row->format_name(index) : NULL;
}

static gonio_kind first_of(const gonio_i_file *file, unsigned these, const char **format)
{
    for (int k = 0; k < KINDS; k++) {
        *format = (kinds[k].kind & these) != 0 ? kinds[k].format_of(file) : NULL;
        if (*format != NULL) {
            return kinds[k].kind;
        }
    }
    return GONIO_KIND_UNKNOWN;
}

/* Readings on a grid (Zemax) are a material where only these are wanted. */
static gonio_kind kind_of_readings(const gonio_i_file *file, unsigned wanted, const char **format)
{
    const char *material =
        (wanted & GONIO_KIND_MATERIAL) != 0 && (wanted & GONIO_KIND_READINGS) == 0
            ? gonio_i_material_format_of_readings(file)
            : NULL;
    *format = material != NULL ? material : *format;
    return material != NULL ? GONIO_KIND_MATERIAL : GONIO_KIND_READINGS;
}

/* An RGL .bsdf is a material and has readings in it: readings where only these are wanted. CSV is
 * what any text may be. */
static gonio_kind kind_of(const gonio_i_file *file, unsigned wanted, const char **format)
{
    const gonio_kind kind = first_of(file, ~0U, format);
    if (kind == GONIO_KIND_READINGS) {
        return kind_of_readings(file, wanted, format);
    }
    const char *readings = (wanted & GONIO_KIND_READINGS) != 0 && (kind & wanted) == 0
                               ? gonio_i_readings_format_of(file)
                               : NULL;
    if (readings == NULL || strcmp(readings, gonio_i_readings_csv.name) == 0) {
        return kind;
    }
    *format = readings;
    return GONIO_KIND_READINGS;
}

static bool is_built_in(const char *path)
{
    return strncmp(path, "atlas:", 6) == 0;
}

/* Whether a file can be read only once. */
static bool is_pipe(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

/* Reads the beginning of a file and finds its kind. Nothing is read of a built-in material or a
 * pipe.
 */
static gonio_status look(gonio_context *context, const char *path, unsigned wanted,
                         gonio_i_file *file, gonio_kind *kind, const char **format)
{
    if (is_built_in(path)) {
        *kind = GONIO_KIND_MATERIAL;
        *format = "built-in";
        return GONIO_OK;
    }
    if (is_pipe(path)) {
        *kind = GONIO_KIND_READINGS;
        *format = NULL;
        return GONIO_OK;
    }
    const gonio_status status = gonio_i_file_look(context, path, file);
    if (status == GONIO_OK) {
        *kind = kind_of(file, wanted, format);
    }
    return status;
}

gonio_status gonio_file_kind(gonio_context *context, const char *path, gonio_kind *kind,
                             const char **format)
{
    gonio_i_file file = {0};
    const char *found = NULL;
    const gonio_status status = look(context, path, ~0U, &file, kind, &found);
    if (status == GONIO_OK && format != NULL) {
        *format = found;
    }
    return status;
}

/* ---- a file of certain kinds ---- */

/* Files that people have and gonio does not read, by their first bytes, with what to do. */
typedef struct foreign_format {
    const char *bytes;
    size_t size;
    const char *words;
} foreign_format;

#define FOREIGN(bytes, words)                                                                      \
    {                                                                                              \
        bytes, sizeof bytes - 1, words                                                             \
    }

static const foreign_format foreign_formats[] = {
    FOREIGN("PK\x03\x04", "a workbook (.xlsx, .ods) or another ZIP archive, which gonio does not "
                          "read; save the sheet as CSV, or unpack it"),
    FOREIGN("\xD0\xCF\x11\xE0", "an old workbook (.xls), which gonio does not read; save the sheet "
                                "as CSV"),
    FOREIGN("MATLAB 5.0 MAT-file", "a MAT-file, which gonio does not read; save a table as CSV "
                                   "(writetable)"),
    FOREIGN("\x93NUMPY",
            "an array of NumPy, which gonio does not read; save it as CSV, with a line "
            "of column names (numpy.savetxt)"),
    FOREIGN("OPTIS - ", "a scattering file of Speos, which gonio does not read; export it as Zemax "
                        "BSDF, or as a table of theta_i, theta_o, phi_o and values"),
};

/* What a file is that is of none of the kinds; NULL: not known. */
static const char *what_is_foreign(const gonio_i_file *file)
{
    for (size_t k = 0; k < sizeof foreign_formats / sizeof *foreign_formats; k++) {
        if (gonio_i_file_begins(file, foreign_formats[k].bytes, foreign_formats[k].size)) {
            return foreign_formats[k].words;
        }
    }
    return NULL;
}

/* "a mesh (OBJ), not a material or readings". */
static void print_other(FILE *stream, const char *path, unsigned wanted, const kind_row *is,
                        const char *format)
{
    const char *between = ", not ";
    fprintf(stream, "%s%s (%s)", is->article, is->name, format);
    for (int k = 0; k < KINDS; k++) {
        if ((kinds[k].kind & wanted) != 0) {
            fprintf(stream, "%s%s%s", between, kinds[k].article, kinds[k].name);
            between = " or ";
        }
    }
    if (is->kind == GONIO_KIND_READINGS && (wanted & GONIO_KIND_MATERIAL) != 0) {
        fprintf(stream, "; 'gonio reconstruct %s -o NEW.bsdf' makes a material of readings", path);
    }
}

/* "not a material that gonio reads (MERL ...), nor readings (CSV, ...), judged by its content". */
static void print_unknown(FILE *stream, unsigned wanted)
{
    const char *begin = "not ";
    const char *end = " that gonio reads (";
    for (int k = 0; k < KINDS; k++) {
        if ((kinds[k].kind & wanted) == 0) {
            continue;
        }
        fprintf(stream, "%s%s%s%s", begin, kinds[k].article, kinds[k].name, end);
        for (int j = 0; kinds[k].format_name(j) != NULL; j++) {
            fprintf(stream, "%s%s", j > 0 ? ", " : "", kinds[k].format_name(j));
        }
        begin = "), nor ";
        end = " (";
    }
    fputs("), judged by its content", stream);
}

static char *explain(const gonio_i_file *file, unsigned wanted, gonio_kind kind, const char *format)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return NULL;
    }
    const char *foreign = kind == GONIO_KIND_UNKNOWN ? what_is_foreign(file) : NULL;
    if (foreign != NULL) {
        fputs(foreign, stream);
    } else if (kind == GONIO_KIND_UNKNOWN) {
        print_unknown(stream, wanted);
    } else {
        print_other(stream, file->path, wanted, row_of(kind), format);
    }
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static gonio_status refuse(gonio_context *context, const char *path, const gonio_i_file *file,
                           unsigned wanted, gonio_kind kind, const char *format)
{
    char *text = explain(file, wanted, kind, format);
    const gonio_status status =
        text == NULL ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory")
                     : gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: %s", path, text);
    free(text);
    return status;
}

gonio_status gonio_file_expect(gonio_context *context, const char *path, unsigned wanted,
                               gonio_kind *kind)
{
    gonio_i_file file = {0};
    gonio_kind found = GONIO_KIND_UNKNOWN;
    const char *format = NULL;
    const gonio_status status = look(context, path, wanted, &file, &found, &format);
    if (status != GONIO_OK) {
        return status;
    }
    if (found == GONIO_KIND_READINGS && format == NULL && (wanted & found) == 0) {
        return gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot read: not a regular file", path);
    }
    if (file.path != NULL && file.size == 0) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT, "%s: the file is empty", path);
    }
    /* An HDF5 file may be a truncated basis. The reader of bases gives a better message. */
    if ((wanted & GONIO_KIND_BASIS) != 0 && (wanted & GONIO_KIND_MATERIAL) == 0 &&
        gonio_i_basis_may_be(&file)) {
        found = GONIO_KIND_BASIS;
    }
    if ((wanted & found) == 0) {
        return refuse(context, path, &file, wanted, found, format);
    }
    *kind = found;
    return GONIO_OK;
}
