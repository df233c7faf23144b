/* BSDF-XML files, as WINDOW and Radiance have them: the reflection of one side in a Klems basis.
 *
 * WindowElement/Optical/Layer/DataDefinition holds AngleBasis, rings of patches; WavelengthData a
 * block for each wavelength and direction, with ScatteringData, means of the BRDF over pairs of
 * patches in 1/sr: a row an outgoing patch and a column an incident one, or the other way round
 * where IncidentDataStructure is Rows. The front is read, the back where there is none. Channels:
 * CIE-X, Visible and CIE-Z become R, G, B; wavelengths in numbers stay wavelengths; otherwise
 * Visible, or the first. ScatteringDataType does not tell reflection from transmission.
 *
 * XML is parsed by expat. Entities are not expanded: a file that declares any is refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <expat.h>

#include "../../core/core.h"
#include "../../core/number.h"
#include "../../core/text_file.h"
#include "../colour.h"
#include "format.h"
#include "klems.h"

enum {
    MOST_DEPTH = 64,
    MOST_BASES = 16,
    MOST_BLOCKS = 1024,
    MOST_PATCHES = 4096, /* of a basis */
    CHUNK = 1 << 24      /* bytes that are parsed at a time */
};

/* ScatteringData of a wavelength and a direction, as read. */
typedef struct block {
    char wavelength[GONIO_I_KLEMS_NAME];
    char unit[GONIO_I_KLEMS_NAME];
    char direction[GONIO_I_KLEMS_NAME];
    char column[GONIO_I_KLEMS_NAME]; /* names of bases */
    char row[GONIO_I_KLEMS_NAME];
    double *value;
    size_t count;
} block;

typedef struct parse {
    gonio_context *context;
    const char *path;
    XML_Parser parser;
    gonio_status status;
    size_t depth;
    char *text; /* of the innermost element */
    size_t length;
    size_t room;
    char structure[GONIO_I_KLEMS_NAME];
    gonio_i_klems basis[MOST_BASES];
    size_t bases;
    block now; /* what is being read */
    block *blocks;
    size_t count;
} parse;

/* ---- parsing ---- */

static void stop(parse *p, gonio_status status, const char *message)
{
    if (p->status == GONIO_OK) {
        p->status = gonio_i_fail(p->context, status, "%s: line %lu: %s", p->path,
                                 (unsigned long)XML_GetCurrentLineNumber(p->parser), message);
        XML_StopParser(p->parser, XML_FALSE);
    }
}

static const char *without_prefix(const char *name)
{
    const char *colon = strrchr(name, ':');
    return colon != NULL ? colon + 1 : name;
}

/* The text without blanks at its ends, cut to fit. */
static void copy_text(const parse *p, char to[GONIO_I_KLEMS_NAME])
{
    static const char blanks[] = " \t\r\n";
    const char *text = p->length > 0 ? p->text : "";
    text += strspn(text, blanks);
    size_t size = strlen(text);
    while (size > 0 && strchr(blanks, text[size - 1]) != NULL) {
        size--;
    }
    size = size < GONIO_I_KLEMS_NAME ? size : GONIO_I_KLEMS_NAME - 1;
    memcpy(to, text, size);
    to[size] = '\0';
}

static double text_as_number(const parse *p)
{
    char text[GONIO_I_KLEMS_NAME];
    char *end = NULL;
    copy_text(p, text);
    const double value = strtod(text, &end);
    return end != text && *end == '\0' ? value : NAN;
}

/* ---- angle bases ---- */

static gonio_i_klems *basis_of(parse *p)
{
    return p->bases > 0 ? &p->basis[p->bases - 1] : NULL;
}

static void begin_basis(parse *p)
{
    if (p->bases == MOST_BASES) {
        stop(p, GONIO_ERROR_FORMAT, "more than 16 angle bases");
        return;
    }
    p->basis[p->bases++] = (gonio_i_klems){0};
}

static void begin_ring(parse *p)
{
    gonio_i_klems *basis = basis_of(p);
    if (basis == NULL || basis->rings == GONIO_I_KLEMS_RINGS) {
        stop(p, GONIO_ERROR_FORMAT, "a ring of patches outside a basis, or more than 64 of them");
        return;
    }
    basis->rings++;
}

static void name_basis(parse *p)
{
    if (basis_of(p) != NULL) {
        copy_text(p, basis_of(p)->name);
    }
}

static void set_bound(parse *p, size_t above)
{
    gonio_i_klems *basis = basis_of(p);
    const double bound = text_as_number(p);
    if (basis == NULL || basis->rings == 0 || !(bound >= 0.0 && bound <= 90.0)) {
        stop(p, GONIO_ERROR_FORMAT, "a polar angle of a ring that is not 0 to 90 degrees");
        return;
    }
    basis->bound[basis->rings - 1 + above] = bound;
}

static void set_lower(parse *p)
{
    set_bound(p, 0);
}

static void set_upper(parse *p)
{
    set_bound(p, 1);
}

static void set_patches(parse *p)
{
    gonio_i_klems *basis = basis_of(p);
    const double patches = text_as_number(p);
    if (basis == NULL || basis->rings == 0 || !(patches >= 1.0 && patches <= MOST_PATCHES)) {
        stop(p, GONIO_ERROR_FORMAT, "a number of patches that is not 1 to 4096");
        return;
    }
    basis->patches[basis->rings - 1] = (size_t)patches;
}

/* ---- blocks ---- */

static void set_structure(parse *p)
{
    copy_text(p, p->structure);
}

static void set_wavelength(parse *p)
{
    copy_text(p, p->now.wavelength);
}

static void set_direction(parse *p)
{
    copy_text(p, p->now.direction);
}

static void set_column(parse *p)
{
    copy_text(p, p->now.column);
}

static void set_row(parse *p)
{
    copy_text(p, p->now.row);
}

static bool separates(char c)
{
    return c == ',' || c == ';' || c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Numbers with commas or blanks between them. */
static bool parse_numbers(parse *p, double *value, size_t room, size_t *count)
{
    const char *next = p->text;
    *count = 0;
    while (true) {
        while (separates(*next)) {
            next++;
        }
        if (*next == '\0') {
            return true;
        }
        char *end = NULL;
        const double number = strtod(next, &end);
        if (end == next || !isfinite(number) || !(separates(*end) || *end == '\0') ||
            *count == room) {
            return false;
        }
        value[(*count)++] = number;
        next = end;
    }
}

static bool starts_with(const char *text, const char *start)
{
    return strncasecmp(text, start, strlen(start)) == 0;
}

/* Keeps reflection only. */
static void add_block(parse *p)
{
    if (!starts_with(p->now.direction, "Reflection")) {
        return;
    }
    if (p->count == MOST_BLOCKS) {
        stop(p, GONIO_ERROR_FORMAT, "more than 1024 blocks of scattering data");
        return;
    }
    block *all = realloc(p->blocks, (p->count + 1) * sizeof *all);
    if (all == NULL) {
        stop(p, GONIO_ERROR_MEMORY, "out of memory");
        return;
    }
    p->blocks = all;
    block *b = &all[p->count];
    *b = p->now;
    const size_t room = p->length / 2 + 1;
    b->value = gonio_i_allocate(p->context, room, sizeof *b->value);
    if (b->value == NULL) {
        p->status = GONIO_ERROR_MEMORY;
        XML_StopParser(p->parser, XML_FALSE);
        return;
    }
    p->count++;
    if (p->length > 0 && !parse_numbers(p, b->value, room, &b->count)) {
        stop(p, GONIO_ERROR_FORMAT, "scattering data with something else than finite numbers");
    }
}

static void begin_block(parse *p)
{
    p->now = (block){0};
}

/* What to do where an element begins and ends. */
typedef struct element {
    const char *name;
    void (*begin)(parse *p);
    void (*end)(parse *p);
} element;

static const element elements[] = {
    {"AngleBasis", begin_basis, NULL},
    {"AngleBasisName", NULL, name_basis},
    {"AngleBasisBlock", begin_ring, NULL},
    {"LowerTheta", NULL, set_lower},
    {"UpperTheta", NULL, set_upper},
    {"nPhis", NULL, set_patches},
    {"IncidentDataStructure", NULL, set_structure},
    {"WavelengthData", begin_block, NULL},
    {"Wavelength", NULL, set_wavelength},
    {"WavelengthDataDirection", NULL, set_direction},
    {"ColumnAngleBasis", NULL, set_column},
    {"RowAngleBasis", NULL, set_row},
    {"ScatteringData", NULL, add_block},
};

static const element *find_element(const char *name)
{
    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++) {
        if (strcmp(elements[k].name, without_prefix(name)) == 0) {
            return &elements[k];
        }
    }
    return NULL;
}

static void XMLCALL on_begin(void *user, const XML_Char *name, const XML_Char **attributes)
{
    parse *p = user;
    const element *e = find_element(name);
    p->length = 0;
    if (++p->depth > MOST_DEPTH) {
        stop(p, GONIO_ERROR_FORMAT, "elements more than 64 deep");
    } else if (e != NULL && e->begin != NULL) {
        e->begin(p);
    }
    for (size_t k = 0; attributes[k] != NULL && attributes[k + 1] != NULL; k += 2) {
        if (e != NULL && strcmp(e->name, "Wavelength") == 0 && strcmp(attributes[k], "unit") == 0) {
            strncpy(p->now.unit, attributes[k + 1], sizeof p->now.unit - 1);
        }
    }
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    parse *p = user;
    const element *e = find_element(name);
    if (e != NULL && e->end != NULL) {
        e->end(p);
    }
    p->length = 0;
    p->depth--;
}

static void XMLCALL on_text(void *user, const XML_Char *text, int length)
{
    parse *p = user;
    const size_t size = (size_t)length;
    if (p->length + size + 1 > p->room) {
        const size_t room = 2 * (p->length + size + 1);
        char *more = realloc(p->text, room);
        if (more == NULL) {
            stop(p, GONIO_ERROR_MEMORY, "out of memory");
            return;
        }
        p->text = more;
        p->room = room;
    }
    memcpy(p->text + p->length, text, size);
    p->length += size;
    p->text[p->length] = '\0';
}

/* Whatever an entity stands for, these files have none. */
static void XMLCALL on_entity(void *user, const XML_Char *name, int is_parameter,
                              const XML_Char *value, int value_length, const XML_Char *base,
                              const XML_Char *system, const XML_Char *public, const XML_Char *kind)
{
    (void)name;
    (void)is_parameter;
    (void)value;
    (void)value_length;
    (void)base;
    (void)system;
    (void)public;
    (void)kind;
    stop(user, GONIO_ERROR_FORMAT, "an entity is declared; gonio does not expand entities");
}

static void parse_text(parse *p, const char *text, size_t size)
{
    XML_SetUserData(p->parser, p);
    XML_SetElementHandler(p->parser, on_begin, on_end);
    XML_SetCharacterDataHandler(p->parser, on_text);
    XML_SetEntityDeclHandler(p->parser, on_entity);
    for (size_t first = 0; p->status == GONIO_OK; first += CHUNK) {
        const bool last = size - first <= CHUNK;
        const size_t count = last ? size - first : CHUNK;
        if (XML_Parse(p->parser, text + first, (int)count, last) == XML_STATUS_ERROR) {
            stop(p, GONIO_ERROR_FORMAT, XML_ErrorString(XML_GetErrorCode(p->parser)));
        }
        if (last) {
            return;
        }
    }
}

static gonio_status parse_file(parse *p)
{
    char *text = NULL;
    size_t size = 0;
    gonio_status status = gonio_i_text_read(p->context, p->path, &text, &size);
    if (status != GONIO_OK) {
        return status;
    }
    p->parser = XML_ParserCreate(NULL);
    if (p->parser == NULL) {
        status = gonio_i_fail(p->context, GONIO_ERROR_MEMORY, "out of memory");
    } else {
        parse_text(p, text, size);
        status = p->status;
        XML_ParserFree(p->parser);
    }
    free(text);
    return status;
}

static void free_parse(parse *p)
{
    for (size_t k = 0; k < p->count; k++) {
        free(p->blocks[k].value);
    }
    free(p->blocks);
    free(p->text);
}

/* ---- the material ---- */

typedef struct klems_brdf {
    gonio_i_klems incident;
    gonio_i_klems outgoing;
    size_t incidents; /* patches */
    size_t outgoings;
    size_t channels;
    double *wavelength; /* [channels], nm; NULL for colours or grey */
    double *value;      /* [incidents][outgoings][channels] */
} klems_brdf;

static void release(void *self)
{
    klems_brdf *k = self;
    free(k->wavelength);
    free(k->value);
    free(k);
}

static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const klems_brdf *k = self;
    (void)context;
    for (size_t n = 0; n < count; n++) {
        const size_t in = gonio_i_klems_patch(&k->incident, pairs[n].incident, true);
        const size_t out = gonio_i_klems_patch(&k->outgoing, pairs[n].outgoing, false);
        const bool inside = in < k->incidents && out < k->outgoings;
        for (size_t c = 0; c < k->channels; c++) {
            values[n * k->channels + c] =
                inside ? k->value[(in * k->outgoings + out) * k->channels + c] : NAN;
        }
    }
    return GONIO_OK;
}

/* ---- choosing what to read ---- */

/* The chosen blocks, a channel each. */
typedef struct choice {
    const char *side; /* "Reflection Front" or "Reflection Back" */
    size_t channels;
    const block *channel[MOST_BLOCKS];
    bool colours; /* channels are X, Y, Z */
    bool spectral;
} choice;

static const block *find_block(const parse *p, const char *side, const char *wavelength)
{
    for (size_t k = 0; k < p->count; k++) {
        if (strcasecmp(p->blocks[k].direction, side) == 0 &&
            (wavelength == NULL || strcasecmp(p->blocks[k].wavelength, wavelength) == 0)) {
            return &p->blocks[k];
        }
    }
    return NULL;
}

/* In nm; NAN if it is no number. */
static double wavelength_of(const block *b)
{
    char *end = NULL;
    const double value = strtod(b->wavelength, &end);
    const bool micro = starts_with(b->unit, "Micro") || starts_with(b->unit, "um");
    const bool number = end != b->wavelength && *end == '\0' && value > 0.0 && isfinite(value);
    return number && !starts_with(b->unit, "Integral") ? value * (micro ? 1000.0 : 1.0) : NAN;
}

static void choose_wavelengths(const parse *p, choice *c)
{
    for (size_t k = 0; k < p->count; k++) {
        const block *b = &p->blocks[k];
        if (strcasecmp(b->direction, c->side) == 0 && !isnan(wavelength_of(b))) {
            c->channel[c->channels++] = b;
        }
    }
    c->spectral = c->channels > 0;
}

static bool choose(const parse *p, choice *c)
{
    static const char *const sides[] = {"Reflection Front", "Reflection Back"};
    for (int k = 0; k < 2 && c->side == NULL; k++) {
        c->side = find_block(p, sides[k], NULL) != NULL ? sides[k] : NULL;
    }
    if (c->side == NULL) {
        return false;
    }
    const block *visible = find_block(p, c->side, "Visible");
    const block *x = find_block(p, c->side, "CIE-X");
    const block *y = find_block(p, c->side, "CIE-Y");
    const block *z = find_block(p, c->side, "CIE-Z");
    y = y != NULL ? y : visible;
    c->colours = x != NULL && y != NULL && z != NULL;
    if (c->colours) {
        c->channels = 3;
        c->channel[0] = x;
        c->channel[1] = y;
        c->channel[2] = z;
        return true;
    }
    choose_wavelengths(p, c);
    if (!c->spectral) {
        c->channels = 1;
        c->channel[0] = visible != NULL ? visible : find_block(p, c->side, NULL);
    }
    return true;
}

/* ---- from blocks to the material ---- */

static gonio_status find_basis(const parse *p, const char *name, gonio_i_klems *basis)
{
    for (size_t k = 0; k < p->bases; k++) {
        if (strcmp(p->basis[k].name, name) == 0 && p->basis[k].rings > 0) {
            *basis = p->basis[k];
            return GONIO_OK;
        }
    }
    const gonio_i_klems *known = gonio_i_klems_named(name);
    if (known == NULL) {
        return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                            "%s: the angle basis '%s' is not defined", p->path, name);
    }
    *basis = *known;
    return GONIO_OK;
}

static gonio_status check_basis(const parse *p, const gonio_i_klems *basis)
{
    for (size_t k = 0; k < basis->rings; k++) {
        if (basis->patches[k] == 0 || basis->bound[k + 1] <= basis->bound[k]) {
            return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                                "%s: the rings of the angle basis '%s' do not ascend, or one has "
                                "no patches",
                                p->path, basis->name);
        }
    }
    if (gonio_i_klems_patches(basis) > MOST_PATCHES) {
        return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                            "%s: the angle basis '%s' has more than %d patches", p->path,
                            basis->name, MOST_PATCHES);
    }
    return GONIO_OK;
}

static void fill_values(const choice *c, bool columns, klems_brdf *k)
{
    for (size_t in = 0; in < k->incidents; in++) {
        for (size_t out = 0; out < k->outgoings; out++) {
            double *to = k->value + (in * k->outgoings + out) * k->channels;
            const size_t at = columns ? out * k->incidents + in : in * k->outgoings + out;
            for (size_t n = 0; n < k->channels; n++) {
                to[n] = c->channel[n]->value[at];
            }
            if (c->colours) {
                const double xyz[3] = {to[0], to[1], to[2]};
                gonio_i_xyz_to_rgb(xyz, to);
            }
        }
    }
}

static gonio_status check_blocks(const parse *p, const choice *c, const klems_brdf *k)
{
    for (size_t n = 0; n < c->channels; n++) {
        const block *b = c->channel[n];
        if (strcmp(b->column, c->channel[0]->column) != 0 ||
            strcmp(b->row, c->channel[0]->row) != 0 || b->count != k->incidents * k->outgoings) {
            return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                                "%s: %s %s has %zu numbers; its angle bases need %zu x %zu",
                                p->path, b->direction, b->wavelength, b->count, k->incidents,
                                k->outgoings);
        }
    }
    return GONIO_OK;
}

static gonio_status keep_wavelengths(const parse *p, const choice *c, klems_brdf *k)
{
    if (!c->spectral) {
        return GONIO_OK;
    }
    k->wavelength = gonio_i_allocate(p->context, c->channels, sizeof *k->wavelength);
    for (size_t n = 0; n < c->channels && k->wavelength != NULL; n++) {
        k->wavelength[n] = wavelength_of(c->channel[n]);
    }
    return k->wavelength != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
}

static gonio_status read_bases(const parse *p, const choice *c, bool columns, klems_brdf *k)
{
    const block *b = c->channel[0];
    gonio_status status = find_basis(p, columns ? b->column : b->row, &k->incident);
    if (status == GONIO_OK) {
        status = find_basis(p, columns ? b->row : b->column, &k->outgoing);
    }
    if (status == GONIO_OK) {
        status = check_basis(p, &k->incident);
    }
    if (status == GONIO_OK) {
        status = check_basis(p, &k->outgoing);
    }
    k->incidents = gonio_i_klems_patches(&k->incident);
    k->outgoings = gonio_i_klems_patches(&k->outgoing);
    return status;
}

static gonio_status make_material(const parse *p, const choice *c, klems_brdf *k)
{
    const bool columns = starts_with(p->structure, "Columns");
    if (!columns && !starts_with(p->structure, "Rows")) {
        return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                            "%s: the data structure '%s'; gonio reads matrices (Columns, Rows)",
                            p->path, p->structure);
    }
    k->channels = c->channels;
    gonio_status status = read_bases(p, c, columns, k);
    if (status == GONIO_OK) {
        status = check_blocks(p, c, k);
    }
    if (status == GONIO_OK) {
        status = keep_wavelengths(p, c, k);
    }
    if (status != GONIO_OK) {
        return status;
    }
    k->value =
        gonio_i_allocate(p->context, k->incidents * k->outgoings * k->channels, sizeof *k->value);
    if (k->value == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    fill_values(c, columns, k);
    return GONIO_OK;
}

static char *describe(const choice *c, const klems_brdf *k)
{
    char channels[GONIO_I_KLEMS_NAME + 32];
    if (c->spectral) {
        snprintf(channels, sizeof channels, "%zu wavelengths", k->channels);
    } else {
        snprintf(channels, sizeof channels, "%s",
                 c->colours ? "CIE X, Y, Z" : c->channel[0]->wavelength);
    }
    return gonio_i_format("BSDF-XML %s, %s, %zu x %zu patches, %s", c->side, k->incident.name,
                          k->incidents, k->outgoings, channels);
}

static gonio_status read_xml(parse *p, choice *c, klems_brdf *k, char **description)
{
    gonio_status status = parse_file(p);
    if (status != GONIO_OK) {
        return status;
    }
    if (!choose(p, c)) {
        return gonio_i_fail(p->context, GONIO_ERROR_FORMAT,
                            "%s: no reflection data; gonio does not read transmission", p->path);
    }
    status = make_material(p, c, k);
    if (status == GONIO_OK) {
        *description = describe(c, k);
        status = *description != NULL
                     ? GONIO_OK
                     : gonio_i_fail(p->context, GONIO_ERROR_MEMORY, "out of memory");
    }
    return status;
}

static gonio_status open_xml(gonio_context *context, const gonio_i_file *file,
                             gonio_material_source *source, char **description)
{
    parse *p = gonio_i_allocate(context, 1, sizeof *p);
    choice *c = gonio_i_allocate(context, 1, sizeof *c);
    klems_brdf *k = gonio_i_allocate(context, 1, sizeof *k);
    gonio_i_plain_numbers plain;
    gonio_status status = GONIO_ERROR_MEMORY;
    if (p != NULL && c != NULL && k != NULL && gonio_i_plain_numbers_begin(&plain)) {
        p->context = context;
        p->path = file->path;
        status = read_xml(p, c, k, description);
        gonio_i_plain_numbers_end(&plain);
    }
    if (p != NULL) {
        free_parse(p);
    }
    free(p);
    free(c);
    if (status != GONIO_OK) {
        if (k != NULL) {
            release(k);
        }
        return status;
    }
    *source = (gonio_material_source){.evaluate = evaluate,
                                      .release = release,
                                      .self = k,
                                      .channels = k->channels,
                                      .wavelength = k->wavelength,
                                      .anisotropic = true};
    return GONIO_OK;
}

static bool probe(const gonio_i_file *file)
{
    return memmem(file->head, file->head_size, "<WindowElement", 14) != NULL ||
           memmem(file->head, file->head_size, ":WindowElement", 14) != NULL;
}

const gonio_i_format_reader gonio_i_bsdf_xml_reader = {"BSDF-XML", probe, open_xml};
