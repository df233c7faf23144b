/* OBJ meshes (Wavefront): the lines of corners, normals and faces. All others, which name materials
 * and other files among them, are passed over. */
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "../core/number.h"
#include "mesh.h"

enum { VECTOR = 3, HOMOGENEOUS = 4 };

/* Vectors of lines v or vn, in their order. */
typedef struct vectors {
    float *value; /* [count][VECTOR] */
    size_t count, room;
} vectors;

typedef struct reading {
    gonio_i_mesh_making *making;
    char *text, *end; /* each line ends in a zero */
    size_t line;      /* from 1 */
    vectors position, normal;
    size_t positions, normals; /* of those, before the line at hand */
    uint32_t *place;           /* [places]: a table of corners by their hash, from 1; 0 is empty */
    size_t places;             /* a power of two, more than twice the corners */
} reading;

static gonio_status fail(const reading *r, const char *what)
{
    return gonio_i_fail(r->making->context, GONIO_ERROR_FORMAT, "%s:%zu: cannot be read as OBJ: %s",
                        r->making->path, r->line, what);
}

static gonio_status out_of_memory(const reading *r)
{
    return gonio_i_fail(r->making->context, GONIO_ERROR_MEMORY, "%s: too large: out of memory",
                        r->making->path);
}

/* ---- lines ---- */

/* Ends each line by a zero. One that a backslash continues becomes one with the next. */
static void separate_lines(char *text, size_t size)
{
    for (char *end = memchr(text, '\n', size); end != NULL;
         end = memchr(end + 1, '\n', size - (size_t)(end + 1 - text))) {
        char *last = end > text && end[-1] == '\r' ? end - 1 : end;
        const bool goes_on = last > text && last[-1] == '\\';
        if (last < end) {
            *last = ' ';
        }
        if (goes_on) {
            last[-1] = ' ';
        }
        *end = goes_on ? ' ' : '\0';
    }
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static const char *skip_blanks(const char *text)
{
    while (is_blank(*text)) {
        text++;
    }
    return text;
}

/* What stands behind a word at the beginning of a line; NULL if it begins otherwise. */
static const char *after(const char *line, const char *word)
{
    const size_t length = strlen(word);
    line = skip_blanks(line);
    return strncmp(line, word, length) == 0 && is_blank(line[length]) ? line + length : NULL;
}

typedef gonio_status line_reader(reading *r, const char *line);

static gonio_status for_each_line(reading *r, line_reader *read)
{
    gonio_status status = GONIO_OK;
    r->line = 1;
    for (char *line = r->text; line < r->end && status == GONIO_OK; line += strlen(line) + 1) {
        status = read(r, line);
        if (status == GONIO_OK && r->line % GONIO_I_MESH_PROGRESS == 0) {
            status = gonio_i_progress(r->making->context, "reading the mesh",
                                      (double)(line - r->text) / (double)(r->end - r->text));
        }
        r->line++;
    }
    return status;
}

/* ---- corners and normals ---- */

/* Up to `most` numbers; stops at what is none. */
static int read_numbers(const char *text, int most, double *numbers)
{
    int count = 0;
    for (text = skip_blanks(text); count < most && *text != '\0'; text = skip_blanks(text)) {
        char *end = NULL;
        numbers[count] = strtod(text, &end);
        if (end == text) {
            break;
        }
        text = end;
        count++;
    }
    return count;
}

static gonio_status add_vector(const reading *r, vectors *all, const double *numbers)
{
    if (all->count == all->room) {
        const size_t room = all->room > 0 ? 2 * all->room : 1024;
        float *larger = reallocarray(all->value, room, VECTOR * sizeof *larger);
        if (larger == NULL) {
            return out_of_memory(r);
        }
        all->value = larger;
        all->room = room;
    }
    for (int k = 0; k < VECTOR; k++) {
        all->value[VECTOR * all->count + (size_t)k] = (float)numbers[k] + 0.0F; /* no -0 */
    }
    all->count++;
    return GONIO_OK;
}

/* A corner may have a fourth number, by which it is divided, or a colour, three more. */
static gonio_status read_vector(reading *r, const char *line)
{
    enum { MOST = 6 };
    double numbers[MOST];
    const char *corner = after(line, "v");
    const char *normal = after(line, "vn");
    if (corner == NULL && normal == NULL) {
        return GONIO_OK;
    }
    const int count = read_numbers(corner != NULL ? corner : normal, MOST, numbers);
    if (count < VECTOR) {
        return fail(r, "three numbers are expected");
    }
    for (int k = 0; k < VECTOR && corner != NULL && count == HOMOGENEOUS; k++) {
        numbers[k] /= numbers[VECTOR] != 0.0 ? numbers[VECTOR] : 1.0;
    }
    return add_vector(r, corner != NULL ? &r->position : &r->normal, numbers);
}

/* ---- corners of the mesh ---- */

/* The bits of a corner's position and normal; a normal of zeros for none. */
typedef struct corner {
    uint32_t position[VECTOR];
    uint32_t normal[VECTOR];
} corner;

static corner corner_at(const gonio_mesh *mesh, size_t index)
{
    corner c;
    memcpy(c.position, mesh->position + VECTOR * index, sizeof c.position);
    memcpy(c.normal, mesh->normal + VECTOR * index, sizeof c.normal);
    return c;
}

/* Where a corner is in the table, or would be. */
static size_t find_place(const reading *r, const corner *wanted)
{
    size_t at = XXH3_64bits(wanted, sizeof *wanted) & (r->places - 1);
    while (r->place[at] != 0) {
        const corner there = corner_at(r->making->mesh, r->place[at] - 1);
        if (memcmp(&there, wanted, sizeof there) == 0) {
            break;
        }
        at = (at + 1) & (r->places - 1);
    }
    return at;
}

static gonio_status grow_table(reading *r)
{
    const gonio_mesh *mesh = r->making->mesh;
    if (2 * (mesh->corners + 1) < r->places) {
        return GONIO_OK;
    }
    free(r->place);
    r->places = r->places > 0 ? 2 * r->places : 1024;
    r->place = gonio_i_allocate(r->making->context, r->places, sizeof *r->place);
    if (r->place == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    for (size_t k = 0; k < mesh->corners; k++) {
        const corner known = corner_at(mesh, k);
        r->place[find_place(r, &known)] = (uint32_t)k + 1;
    }
    return GONIO_OK;
}

/* The mesh's corner with these numbers, which is added if there is none: files that repeat a corner
 * for each of its faces have smooth normals as well. */
static gonio_status join_corner(reading *r, const float *position, const float *normal,
                                uint32_t *index)
{
    corner wanted = {0};
    memcpy(wanted.position, position, sizeof wanted.position);
    if (normal != NULL) {
        memcpy(wanted.normal, normal, sizeof wanted.normal);
    }
    gonio_status status = grow_table(r);
    if (status != GONIO_OK) {
        return status;
    }
    uint32_t *place = &r->place[find_place(r, &wanted)];
    if (*place == 0) {
        status = gonio_i_mesh_add_corner(r->making, position, normal);
        *place = status == GONIO_OK ? (uint32_t)r->making->mesh->corners : 0;
    }
    *index = *place - 1;
    return status;
}

/* ---- faces ---- */

/* A number of a list, from 1 on, or back from the last so far; NULL if there is no such one. */
static const float *look_up(const vectors *all, long number, size_t so_far)
{
    const long last = (long)so_far;
    const long index = number > 0 ? number - 1 : number < 0 ? last + number : -1;
    return index >= 0 && (size_t)index < all->count ? all->value + VECTOR * (size_t)index : NULL;
}

/* An item of a face: corner, corner/texture, corner//normal, corner/texture/normal. */
static gonio_status read_item(reading *r, const char **text)
{
    char *end = NULL;
    uint32_t index = 0;
    const float *position = look_up(&r->position, strtol(*text, &end, 10), r->positions);
    const float *normal = NULL;
    bool good = end != *text && position != NULL;
    if (good && *end == '/') {
        const char *texture = end + 1;
        (void)strtol(texture, &end, 10);
        if (*end == '/') {
            const char *number = end + 1;
            normal = look_up(&r->normal, strtol(number, &end, 10), r->normals);
            good = normal != NULL || end == number;
        }
    }
    if (!good || (*end != '\0' && !is_blank(*end))) {
        return fail(r, "a face names a corner that does not exist");
    }
    *text = skip_blanks(end);
    const gonio_status status = join_corner(r, position, normal, &index);
    return status == GONIO_OK ? gonio_i_mesh_add_to_polygon(r->making, index) : status;
}

static gonio_status read_face(reading *r, const char *line)
{
    gonio_status status = GONIO_OK;
    r->positions += after(line, "v") != NULL ? 1U : 0U;
    r->normals += after(line, "vn") != NULL ? 1U : 0U;
    const char *text = after(line, "f");
    if (text == NULL) {
        return GONIO_OK;
    }
    for (text = skip_blanks(text); *text != '\0' && *text != '#' && status == GONIO_OK;) {
        status = read_item(r, &text);
    }
    return status == GONIO_OK ? gonio_i_mesh_end_polygon(r->making) : status;
}

/* Corners may stand behind the faces that name them. So they are read first. */
static gonio_status read_text(reading *r)
{
    gonio_i_plain_numbers numbers;
    if (!gonio_i_plain_numbers_begin(&numbers)) {
        return out_of_memory(r);
    }
    gonio_status status = for_each_line(r, read_vector);
    if (status == GONIO_OK) {
        status = for_each_line(r, read_face);
    }
    gonio_i_plain_numbers_end(&numbers);
    return status;
}

gonio_status gonio_i_read_obj(gonio_i_mesh_making *making, const gonio_i_bytes *bytes)
{
    reading r = {.making = making};
    r.text = gonio_i_allocate(making->context, bytes->size + 1, 1);
    if (r.text == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(r.text, bytes->data, bytes->size);
    r.end = r.text + bytes->size;
    separate_lines(r.text, bytes->size);
    const gonio_status status = read_text(&r);
    free(r.position.value);
    free(r.normal.value);
    free(r.place);
    free(r.text);
    return status;
}
