/* Tensor trees of BSDF-XML: see tensor_tree.h. */
#include "tensor_tree.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DEPTH = 16, MOST_DIMENSIONS = 4, MOST_NODES = 1 << 24, MOST_NUMBERS = 1 << 28 };

/* A box: with children, or a grid of 2^grid numbers along each dimension. */
typedef struct node {
    int grid;     /* -1: children */
    size_t first; /* index of the first child, or of the first number */
} node;

struct gonio_i_tensor_tree {
    int dimensions;
    node *nodes;
    size_t count;
    size_t room;
    float *numbers;
    size_t filled;
    size_t space;
};

typedef struct reader {
    gonio_i_tensor_tree *tree;
    const char *next;
    const char *wrong;
} reader;

void gonio_i_tensor_tree_free(gonio_i_tensor_tree *tree)
{
    if (tree != NULL) {
        free(tree->nodes);
        free(tree->numbers);
        free(tree);
    }
}

/* ---- reading ---- */

static bool fail(reader *r, const char *wrong)
{
    r->wrong = r->wrong == NULL ? wrong : r->wrong;
    return false;
}

static void skip_blanks(reader *r)
{
    r->next += strspn(r->next, ", \t\r\n");
}

static bool take(reader *r, char c)
{
    skip_blanks(r);
    if (*r->next != c) {
        return false;
    }
    r->next++;
    return true;
}

/* Makes room for `more` nodes. Returns the index of the first; (size_t)-1 if out of memory. */
static size_t add_nodes(reader *r, size_t more)
{
    gonio_i_tensor_tree *t = r->tree;
    if (t->count + more > MOST_NODES) {
        fail(r, "a tensor tree of more than 16 million boxes");
        return (size_t)-1;
    }
    if (t->count + more > t->room) {
        const size_t room = 2 * (t->count + more);
        node *nodes = realloc(t->nodes, room * sizeof *nodes);
        if (nodes == NULL) {
            fail(r, "out of memory");
            return (size_t)-1;
        }
        t->nodes = nodes;
        t->room = room;
    }
    t->count += more;
    return t->count - more;
}

static bool add_number(reader *r, double number)
{
    gonio_i_tensor_tree *t = r->tree;
    if (t->filled == MOST_NUMBERS) {
        return fail(r, "a tensor tree of too many numbers");
    }
    if (t->filled == t->space) {
        const size_t space = t->space == 0 ? 4096 : 2 * t->space;
        float *numbers = realloc(t->numbers, space * sizeof *numbers);
        if (numbers == NULL) {
            return fail(r, "out of memory");
        }
        t->numbers = numbers;
        t->space = space;
    }
    t->numbers[t->filled++] = (float)fmax(number, 0.0);
    return true;
}

/* n of 2^(dimensions n) numbers; -1 for another count. */
static int find_grid(size_t count, int dimensions)
{
    for (int grid = 0; grid * dimensions < 30; grid++) {
        if ((size_t)1 << (grid * dimensions) == count) {
            return grid;
        }
    }
    return -1;
}

static bool read_grid(reader *r, size_t at)
{
    const size_t first = r->tree->filled;
    skip_blanks(r);
    while (*r->next != '}') {
        char *end = NULL;
        const double number = strtod(r->next, &end);
        if (end == r->next || !isfinite(number) || fabs(number) > 1e30) {
            return fail(r, "a tensor tree with something else than finite numbers");
        }
        r->next = end;
        if (!add_number(r, number)) {
            return false;
        }
        skip_blanks(r);
    }
    const int grid = find_grid(r->tree->filled - first, r->tree->dimensions);
    r->tree->nodes[at] = (node){grid, first};
    return grid >= 0 || fail(r, "a box of a tensor tree with a wrong number of values");
}

/* Recursion no deeper than MOST_DEPTH. */
static bool read_node(reader *r, size_t at, int depth) /* NOLINT(misc-no-recursion) */
{
    if (depth > MOST_DEPTH) {
        return fail(r, "a tensor tree more than 16 boxes deep");
    }
    if (!take(r, '{')) {
        return fail(r, "a tensor tree without '{' where a box begins");
    }
    skip_blanks(r);
    bool good = true;
    if (*r->next == '{') {
        const size_t children = (size_t)1 << r->tree->dimensions;
        const size_t first = add_nodes(r, children);
        good = first != (size_t)-1;
        for (size_t k = 0; k < children && good; k++) {
            good = read_node(r, first + k, depth + 1);
        }
        if (good) {
            r->tree->nodes[at] = (node){-1, first};
        }
    } else {
        good = read_grid(r, at);
    }
    return good && (take(r, '}') || fail(r, "a tensor tree without '}' where a box ends"));
}

gonio_i_tensor_tree *gonio_i_tensor_tree_read(const char *text, int dimensions, const char **wrong)
{
    gonio_i_tensor_tree *tree = calloc(1, sizeof *tree);
    reader r = {.tree = tree, .next = text};
    if (tree == NULL) {
        *wrong = "out of memory";
        return NULL;
    }
    tree->dimensions = dimensions;
    const size_t root = add_nodes(&r, 1);
    bool good = root != (size_t)-1 && read_node(&r, root, 0);
    skip_blanks(&r);
    if (good && *r.next != '\0') {
        good = fail(&r, "text after a tensor tree");
    }
    if (!good) {
        *wrong = r.wrong;
        gonio_i_tensor_tree_free(tree);
        return NULL;
    }
    return tree;
}

/* ---- looking up ---- */

/* Shirley and Chiu 1997: the concentric map from the disk to the square 0 .. 1. */
static void disk_to_square(double x, double y, double square[2])
{
    const double radius = hypot(x, y);
    double phi = atan2(y, x);
    phi += phi < -M_PI / 4.0 ? 2.0 * M_PI : 0.0;
    const int quarter = (int)((phi + M_PI / 4.0) / (M_PI / 2.0)) % 4;
    const double along = (phi - quarter * M_PI / 2.0) / (M_PI / 4.0) * radius;
    const double a[4] = {radius, -along, -radius, along};
    const double b[4] = {along, radius, -along, -radius};
    square[0] = 0.5 * (a[quarter] + 1.0);
    square[1] = 0.5 * (b[quarter] + 1.0);
}

/* Of a direction with `azimuth` subtracted from its own. */
static void map_direction(gonio_angles direction, double azimuth, double square[2])
{
    const double sine = sin(direction.theta);
    disk_to_square(sine * cos(direction.phi - azimuth), sine * sin(direction.phi - azimuth),
                   square);
}

double gonio_i_tensor_tree_value(const gonio_i_tensor_tree *tree, gonio_pair pair)
{
    double at[MOST_DIMENSIONS] = {0.0};
    const double travels = pair.incident.phi + M_PI;
    if (tree->dimensions == 3) {
        at[0] = 0.5 - 0.5 * sin(pair.incident.theta);
        map_direction(pair.outgoing, travels, at + 1);
    } else {
        map_direction((gonio_angles){pair.incident.theta, travels}, 0.0, at);
        map_direction(pair.outgoing, 0.0, at + 2);
    }
    for (int k = 0; k < tree->dimensions; k++) {
        at[k] = fmin(fmax(at[k], 0.0), 1.0 - 1e-12);
    }
    const node *here = &tree->nodes[0];
    while (here->grid < 0) {
        size_t child = 0;
        for (int k = 0; k < tree->dimensions; k++) {
            at[k] *= 2.0;
            const size_t upper = at[k] >= 1.0 ? 1 : 0;
            child |= upper << k;
            at[k] -= (double)upper;
        }
        here = &tree->nodes[here->first + child];
    }
    size_t number = 0;
    for (int k = 0; k < tree->dimensions; k++) {
        const double steps = (double)(1 << here->grid);
        number = (number << here->grid) + (size_t)(at[k] * steps);
    }
    return (double)tree->numbers[here->first + number];
}
