/* BSDF-XML as blocks of numbers: see bsdf_xml_parse.h. Parsed by expat. Entities are not expanded:
 * a file that declares any is refused. */
#include "bsdf_xml_parse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <expat.h>

#include "../../core/core.h"
#include "../../core/text_file.h"

enum { MOST_DEPTH = 64, CHUNK = 1 << 24 /* bytes that are parsed at a time */ };

typedef struct parse {
    gonio_context *context;
    const char *path;
    gonio_i_xml *xml;
    XML_Parser parser;
    gonio_status status;
    size_t depth;
    char *text; /* of the innermost element */
    size_t length;
    size_t room;
    gonio_i_xml_block now; /* what is being read */
} parse;

int gonio_i_xml_dimensions(const gonio_i_xml *xml)
{
    static const char name[] = "TensorTree";
    const char *digit = xml->structure + sizeof name - 1;
    const bool tree = strncmp(xml->structure, name, sizeof name - 1) == 0 && digit[1] == '\0';
    return tree && (*digit == '3' || *digit == '4') ? *digit - '0' : 0;
}

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
    return p->xml->bases > 0 ? &p->xml->basis[p->xml->bases - 1] : NULL;
}

static void begin_basis(parse *p)
{
    if (p->xml->bases == GONIO_I_XML_BASES) {
        stop(p, GONIO_ERROR_FORMAT, "more than 16 angle bases");
        return;
    }
    p->xml->basis[p->xml->bases++] = (gonio_i_klems){0};
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
    if (basis == NULL || basis->rings == 0 || !(patches >= 1.0 && patches <= GONIO_I_XML_PATCHES)) {
        stop(p, GONIO_ERROR_FORMAT, "a number of patches that is not 1 to 4096");
        return;
    }
    basis->patches[basis->rings - 1] = (size_t)patches;
}

/* ---- blocks ---- */

static void set_structure(parse *p)
{
    copy_text(p, p->xml->structure);
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

/* How many numbers there can be: parts between what separates. */
static size_t count_parts(const char *text, size_t length)
{
    size_t count = 0;
    for (size_t k = 0; k < length; k++) {
        count += !separates(text[k]) && (k == 0 || separates(text[k - 1]));
    }
    return count;
}

static void read_matrix(parse *p, gonio_i_xml_block *b)
{
    const size_t room = count_parts(p->text, p->length);
    if (room > (size_t)GONIO_I_XML_PATCHES * GONIO_I_XML_PATCHES) {
        stop(p, GONIO_ERROR_FORMAT, "scattering data of more numbers than 4096 x 4096");
        return;
    }
    b->value = gonio_i_allocate(p->context, room, sizeof *b->value);
    if (b->value == NULL) {
        p->status = GONIO_ERROR_MEMORY;
        XML_StopParser(p->parser, XML_FALSE);
    } else if (p->length > 0 && !parse_numbers(p, b->value, room, &b->count)) {
        stop(p, GONIO_ERROR_FORMAT, "scattering data with something else than finite numbers");
    }
}

static void read_tree(parse *p, int dimensions, gonio_i_xml_block *b)
{
    const char *wrong = NULL;
    b->tree = gonio_i_tensor_tree_read(p->length > 0 ? p->text : "", dimensions, &wrong);
    if (b->tree == NULL) {
        stop(p, GONIO_ERROR_FORMAT, wrong);
    }
}

/* Drops blocks that are not of reflection. */
static void add_block(parse *p)
{
    gonio_i_xml *x = p->xml;
    if (strncasecmp(p->now.direction, "Reflection", strlen("Reflection")) != 0) {
        return;
    }
    if (x->blocks == GONIO_I_XML_BLOCKS) {
        stop(p, GONIO_ERROR_FORMAT, "more than 1024 blocks of scattering data");
        return;
    }
    gonio_i_xml_block *all = realloc(x->block, (x->blocks + 1) * sizeof *all);
    if (all == NULL) {
        stop(p, GONIO_ERROR_MEMORY, "out of memory");
        return;
    }
    x->block = all;
    gonio_i_xml_block *b = &all[x->blocks++];
    *b = p->now;
    const int dimensions = gonio_i_xml_dimensions(x);
    if (dimensions > 0) {
        read_tree(p, dimensions, b);
    } else {
        read_matrix(p, b);
    }
}

static void begin_block(parse *p)
{
    p->now = (gonio_i_xml_block){0};
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

/* Refuses entities, which these files do not need. */
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

/* A message that says what is wrong with the XML. */
static const char *name_error(enum XML_Error code)
{
    const bool ends = code == XML_ERROR_NO_ELEMENTS || code == XML_ERROR_UNCLOSED_TOKEN ||
                      code == XML_ERROR_UNCLOSED_CDATA_SECTION;
    return ends ? "the file is cut short here; copy it again from its source"
                : XML_ErrorString(code);
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
            stop(p, GONIO_ERROR_FORMAT, name_error(XML_GetErrorCode(p->parser)));
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

gonio_status gonio_i_xml_read(gonio_context *context, const char *path, gonio_i_xml *xml)
{
    parse p = {.context = context, .path = path, .xml = xml};
    const gonio_status status = parse_file(&p);
    free(p.text);
    return status;
}

void gonio_i_xml_free(gonio_i_xml *xml)
{
    for (size_t k = 0; k < xml->blocks; k++) {
        free(xml->block[k].value);
        gonio_i_tensor_tree_free(xml->block[k].tree);
    }
    free(xml->block);
    *xml = (gonio_i_xml){0};
}
