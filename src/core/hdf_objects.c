/* HDF5 files and the groups in them: the superblock, and finding objects by name. */
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hdf_messages.h"

/* ---- the superblock ---- */

/* Versions 0 and 1, behind the version: four versions and a reserved byte around the sizes of
 * addresses and lengths, sizes of nodes and flags, the base address, an unused one, the end,
 * another unused one, and the root group's entry, whose second number is its header. */
static bool read_old_superblock(gonio_i_hdf_cursor *c, uint64_t version, gonio_i_hdf_file *file)
{
    gonio_i_hdf_take(c, 4);
    const bool wide = gonio_i_hdf_number(c, 1) == 8 && gonio_i_hdf_number(c, 1) == 8;
    gonio_i_hdf_take(c, version == 1 ? 13 : 9);
    const uint64_t base = gonio_i_hdf_number(c, 8);
    gonio_i_hdf_take(c, 8);
    const uint64_t end = gonio_i_hdf_number(c, 8);
    gonio_i_hdf_take(c, 16);
    file->root = gonio_i_hdf_number(c, 8);
    return wide && base == 0 && end <= file->size && !c->failed;
}

/* Versions 2 and 3: sizes of addresses and lengths, flags, base address, extension, end, root. */
static bool read_new_superblock(gonio_i_hdf_cursor *c, gonio_i_hdf_file *file)
{
    const bool wide = gonio_i_hdf_number(c, 1) == 8 && gonio_i_hdf_number(c, 1) == 8;
    gonio_i_hdf_take(c, 1);
    const uint64_t base = gonio_i_hdf_number(c, 8);
    gonio_i_hdf_take(c, 8);
    const uint64_t end = gonio_i_hdf_number(c, 8);
    file->root = gonio_i_hdf_number(c, 8);
    return wide && base == 0 && end <= file->size && !c->failed;
}

static bool read_superblock(gonio_i_hdf_file *file)
{
    static const unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
    gonio_i_hdf_cursor c = gonio_i_hdf_from(file, 0);
    const unsigned char *first = gonio_i_hdf_take(&c, sizeof signature);
    if (first == NULL || memcmp(first, signature, sizeof signature) != 0) {
        return false;
    }
    const uint64_t version = gonio_i_hdf_number(&c, 1);
    return version <= 1   ? read_old_superblock(&c, version, file)
           : version <= 3 ? read_new_superblock(&c, file)
                          : false;
}

/* ---- the file ---- */

static bool map(int descriptor, gonio_i_hdf_file *file)
{
    struct stat about;
    if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size <= 0) {
        return false;
    }
    void *mapped = mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapped == MAP_FAILED) {
        return false;
    }
    file->bytes = mapped;
    file->size = (size_t)about.st_size;
    return true;
}

gonio_i_hdf_file *gonio_i_hdf_open(const char *path)
{
    gonio_i_hdf_file *file = calloc(1, sizeof *file);
    const int descriptor = file != NULL ? open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK) : -1;
    const bool mapped = descriptor >= 0 && map(descriptor, file);
    if (descriptor >= 0) {
        close(descriptor);
    }
    if (!mapped || !read_superblock(file)) {
        gonio_i_hdf_close(file);
        return NULL;
    }
    return file;
}

void gonio_i_hdf_close(gonio_i_hdf_file *file)
{
    if (file != NULL && file->bytes != NULL) {
        munmap((void *)file->bytes, file->size);
    }
    free(file);
}

gonio_i_hdf_object gonio_i_hdf_root(const gonio_i_hdf_file *file)
{
    return (gonio_i_hdf_object){file, file->root};
}

/* ---- groups as symbol tables ---- */

/* A search for a name among the entries below a B-tree. */
typedef struct search {
    const gonio_i_hdf_file *file;
    const char *name;
    size_t length;
    gonio_i_hdf_cursor names; /* the heap that entries refer to */
    size_t steps;             /* that are left: no file has more nodes and entries than bytes */
    uint64_t found;
} search;

static bool is_name(const search *s, uint64_t offset)
{
    gonio_i_hdf_cursor name = s->names;
    gonio_i_hdf_take(&name, offset);
    return !name.failed && name.left > s->length && memcmp(name.at, s->name, s->length) == 0 &&
           name.at[s->length] == '\0';
}

/* A node of symbols: SNOD, version, count; entries of name, header, kind of cache (2: a link to
 * another name, which is not followed) and room for that. */
static void search_symbols(search *s, uint64_t address)
{
    enum { SOFT_LINK = 2 };
    gonio_i_hdf_cursor c = gonio_i_hdf_from(s->file, address);
    gonio_i_hdf_expect(&c, "SNOD");
    gonio_i_hdf_take(&c, 2);
    uint64_t count = gonio_i_hdf_number(&c, 2);
    for (; count > 0 && !c.failed && s->found == GONIO_I_HDF_NOWHERE && s->steps > 0; count--) {
        const uint64_t name = gonio_i_hdf_number(&c, 8);
        const uint64_t header = gonio_i_hdf_number(&c, 8);
        const uint64_t cache = gonio_i_hdf_number(&c, 4);
        gonio_i_hdf_take(&c, 20);
        s->steps--;
        if (!c.failed && cache != SOFT_LINK && is_name(s, name)) {
            s->found = header;
        }
    }
}

/* A node of a B-tree: TREE, 0 for groups, level, count, two siblings; keys between children. */
static void search_tree(search *s, uint64_t address, uint64_t level)
{
    gonio_i_hdf_cursor c = gonio_i_hdf_from(s->file, address);
    gonio_i_hdf_expect(&c, "TREE");
    const bool good = gonio_i_hdf_number(&c, 1) == 0 && gonio_i_hdf_number(&c, 1) == level;
    uint64_t count = gonio_i_hdf_number(&c, 2);
    gonio_i_hdf_take(&c, 16);
    for (; good && count > 0 && s->found == GONIO_I_HDF_NOWHERE && s->steps > 0; count--) {
        gonio_i_hdf_take(&c, 8);
        const uint64_t child = gonio_i_hdf_number(&c, 8);
        s->steps--;
        if (c.failed) {
            return;
        }
        if (level > 0) {
            search_tree(s, child, level - 1);
        } else {
            search_symbols(s, child);
        }
    }
}

static uint64_t level_of(const gonio_i_hdf_file *file, uint64_t address)
{
    enum { MOST_LEVELS = 16 };
    gonio_i_hdf_cursor c = gonio_i_hdf_from(file, address);
    gonio_i_hdf_take(&c, 5);
    const uint64_t level = gonio_i_hdf_number(&c, 1);
    return level < MOST_LEVELS ? level : 0;
}

/* The addresses of a B-tree and of a heap: HEAP, version, its size, an unused number, its address.
 */
static uint64_t find_symbol(gonio_i_hdf_cursor body, search *s)
{
    const uint64_t tree = gonio_i_hdf_number(&body, 8);
    const uint64_t heap = gonio_i_hdf_number(&body, 8);
    gonio_i_hdf_cursor c = gonio_i_hdf_from(s->file, heap);
    gonio_i_hdf_expect(&c, "HEAP");
    gonio_i_hdf_take(&c, 4);
    const uint64_t size = gonio_i_hdf_number(&c, 8);
    gonio_i_hdf_take(&c, 8);
    const uint64_t address = gonio_i_hdf_number(&c, 8);
    if (!body.failed && !c.failed) {
        s->names = gonio_i_hdf_block(s->file, address, size);
        search_tree(s, tree, level_of(s->file, tree));
    }
    return s->found;
}

/* ---- groups with links in their header ---- */

/* Version, flags, perhaps a kind (0: an object of this file), an order and a character set; the
 * length of the name in 1, 2, 4 or 8 bytes, the name, the header. NOWHERE for another name. */
static uint64_t read_link(gonio_i_hdf_cursor body, const search *s)
{
    enum { ORDERED = 0x04, KIND = 0x08, CHARACTERS = 0x10 };
    const uint64_t version = gonio_i_hdf_number(&body, 1);
    const uint64_t flags = gonio_i_hdf_number(&body, 1);
    const uint64_t kind = flags & KIND ? gonio_i_hdf_number(&body, 1) : 0;
    gonio_i_hdf_take(&body, (flags & ORDERED ? 8U : 0U) + (flags & CHARACTERS ? 1U : 0U));
    const uint64_t length = gonio_i_hdf_number(&body, (size_t)1 << (flags & 3U));
    const unsigned char *name = gonio_i_hdf_take(&body, length);
    const uint64_t header = gonio_i_hdf_number(&body, 8);
    const bool same = !body.failed && version == 1 && kind == 0 && length == s->length &&
                      memcmp(name, s->name, s->length) == 0;
    return same ? header : GONIO_I_HDF_NOWHERE;
}

static uint64_t find_link(gonio_i_hdf_object group, const search *s)
{
    gonio_i_hdf_messages messages;
    gonio_i_hdf_cursor body;
    uint64_t found = GONIO_I_HDF_NOWHERE;
    gonio_i_hdf_messages_begin(group, &messages);
    while (found == GONIO_I_HDF_NOWHERE &&
           gonio_i_hdf_messages_next(&messages, GONIO_I_HDF_LINK, &body)) {
        found = read_link(body, s);
    }
    return found;
}

/* ---- paths ---- */

bool gonio_i_hdf_find(gonio_i_hdf_object group, const char *path, gonio_i_hdf_object *found)
{
    gonio_i_hdf_object at = group;
    for (path += strspn(path, "/"); *path != '\0'; path += strspn(path, "/")) {
        search s = {.file = at.file,
                    .name = path,
                    .length = strcspn(path, "/"),
                    .steps = at.file->size,
                    .found = GONIO_I_HDF_NOWHERE};
        gonio_i_hdf_cursor body;
        at.address = gonio_i_hdf_message(at, GONIO_I_HDF_SYMBOLS, &body) ? find_symbol(body, &s)
                                                                         : find_link(at, &s);
        if (at.address >= at.file->size) {
            return false;
        }
        path += s.length;
    }
    *found = at;
    return true;
}
