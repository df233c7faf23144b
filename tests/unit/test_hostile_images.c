/* Images that claim more than they hold: a few hundred bytes are refused without asking for the
 * memory of what they claim. */
#include "../support.h"

#include <gonio/gonio.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>

#include "render_fixture.h"

/* A file being made. */
typedef struct made {
    uint8_t bytes[4096];
    size_t size;
} made;

static void put(made *m, const void *bytes, size_t size)
{
    assert_true(m->size + size <= sizeof m->bytes);
    memcpy(m->bytes + m->size, bytes, size);
    m->size += size;
}

static void put_number(made *m, int64_t number, size_t size)
{
    uint8_t bytes[8];
    for (size_t k = 0; k < sizeof bytes; k++) {
        bytes[k] = (uint8_t)((uint64_t)number >> (8 * k));
    }
    put(m, bytes, size);
}

static void put_attribute(made *m, const char *name, const char *type, const void *value,
                          size_t size)
{
    put(m, name, strlen(name) + 1);
    put(m, type, strlen(type) + 1);
    put_number(m, (int64_t)size, 4);
    put(m, value, size);
}

/* What an OpenEXR file says. */
typedef struct claims {
    int flags; /* 0x200 tiles, 0x800 deep, 0x1000 several parts */
    const char *type;
    int compression, width, height;
    uint32_t tile; /* its side */
    int mode;      /* levels: 1 smaller ones, 2 ripmaps */
    int chunks;    /* 0: not said */
} claims;

static void put_channels(made *m)
{
    static const char names[] = "BGR";
    made list = {.size = 0};
    for (int k = 0; k < 3; k++) {
        put(&list, (char[]){names[k], '\0'}, 2);
        put_number(&list, 1, 4); /* half floats */
        put_number(&list, 0, 4);
        put_number(&list, 1, 4);
        put_number(&list, 1, 4);
    }
    put_number(&list, 0, 1);
    put_attribute(m, "channels", "chlist", list.bytes, list.size);
}

static void put_window(made *m, const char *name, const claims *c)
{
    made window = {.size = 0};
    put_number(&window, 0, 8);
    put_number(&window, c->width - 1, 4);
    put_number(&window, c->height - 1, 4);
    put_attribute(m, name, "box2i", window.bytes, window.size);
}

static void put_parts_attributes(made *m, const claims *c)
{
    made number = {.size = 0};
    if (c->type != NULL) {
        put_attribute(m, "name", "string", "a", 1);
        put_attribute(m, "type", "string", c->type, strlen(c->type));
        put_attribute(m, "version", "int", "\1\0\0", 4);
        put_attribute(m, "maxSamplesPerPixel", "int", "\xff\xff\xff\x7f", 4);
    }
    if (c->chunks != 0) {
        put_number(&number, c->chunks, 4);
        put_attribute(m, "chunkCount", "int", number.bytes, number.size);
    }
    if ((c->flags & 0x200) != 0) {
        made tiles = {.size = 0};
        put_number(&tiles, c->tile, 4);
        put_number(&tiles, c->tile, 4);
        put_number(&tiles, c->mode, 1);
        put_attribute(m, "tiles", "tiledesc", tiles.bytes, tiles.size);
    }
}

static void put_head(made *m, const claims *c)
{
    const uint8_t compression = (uint8_t)c->compression;
    put(m, "\x76\x2f\x31\x01", 4);
    put_number(m, 2 | c->flags, 4);
    put_channels(m);
    put_attribute(m, "compression", "compression", &compression, 1);
    put_window(m, "dataWindow", c);
    put_window(m, "displayWindow", c);
    put_attribute(m, "lineOrder", "lineOrder", "", 1);
    put_attribute(m, "pixelAspectRatio", "float", "\0\0\x80\x3f", 4);
    put_attribute(m, "screenWindowCenter", "v2f", "\0\0\0\0\0\0\0", 8);
    put_attribute(m, "screenWindowWidth", "float", "\0\0\x80\x3f", 4);
    put_parts_attributes(m, c);
    put(m, "\0", (c->flags & 0x1000) != 0 ? 2 : 1);
}

/* The file is refused as one of a wrong format. `saying`: part of the message, if not NULL. */
static void assert_refused(const void *bytes, size_t size, const char *saying)
{
    char *folder = support_folder();
    char *path = path_in(folder, "image");
    gonio_image *image = NULL;
    write_file(path, bytes, size);
    const gonio_status status = gonio_image_read(telling, path, &image);
    if (status != GONIO_ERROR_FORMAT || strstr(support_message(), saying) == NULL) {
        fail_msg("%zu bytes, status %d: %s", size, (int)status, support_message());
    }
    assert_null(image);
    free(path);
    support_remove(folder);
}

static void sizes_of_openexr(void **state)
{
    (void)state;
    enum { TILES = 0x200, DEEP = 0x800, PARTS = 0x1000, MOST = INT32_MAX };
    static const claims all[] = {
        {.compression = 0, .width = 65536, .height = 65536},
        {.compression = 3, .width = 65536, .height = 65536},
        {.compression = 9, .width = 65536, .height = 65536},
        {.compression = 2, .width = MOST, .height = 1},
        {.flags = TILES, .compression = 3, .width = 65536, .height = 65536, .tile = 1},
        {.flags = TILES, .compression = 3, .width = 65536, .height = 65536, .tile = 1, .mode = 2},
        {.flags = TILES, .compression = 3, .width = 64, .height = 64, .tile = 1, .mode = 2},
        {.flags = TILES, .compression = 3, .width = 64, .height = 64, .tile = UINT32_MAX},
        {.flags = TILES, .compression = 3, .width = 64, .height = 64, .tile = INT32_MAX},
        {.flags = TILES, .compression = 3, .width = 64, .height = 64, .tile = 0},
        {.flags = DEEP, .type = "deepscanline", .width = 65536, .height = 65536, .chunks = MOST},
        {.flags = DEEP, .type = "deeptile", .width = 4, .height = 4, .chunks = MOST},
        {.flags = PARTS, .type = "scanlineimage", .width = 4, .height = 4, .chunks = MOST},
        {.flags = PARTS, .type = "scanlineimage", .width = 65536, .height = 65536, .chunks = -1},
        {.flags = PARTS, .type = "scanlineimage", .width = 65536, .height = 65536, .chunks = 9},
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        made m = {.size = 0};
        put_head(&m, &all[k]);
        assert_refused(m.bytes, m.size, "");
        put_number(&m, 0, 8);
        put_number(&m, -1, 8);
        assert_refused(m.bytes, m.size, "");
    }
}

/* A chunk that says how long it is: nothing, a byte, gigabytes, less than nothing. */
static void chunks_of_openexr(void **state)
{
    (void)state;
    static const int64_t lengths[] = {0, 1, INT32_MAX, -1, INT32_MIN};
    for (int compression = 0; compression < 10; compression++) {
        for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
            made m = {.size = 0};
            put_head(&m, &(claims){.compression = compression, .width = 8192, .height = 1});
            put_number(&m, (int64_t)m.size + 8, 8);
            put_number(&m, 0, 4);
            put_number(&m, lengths[k], 4);
            put(&m, "UUUUUUUU", 8);
            assert_refused(m.bytes, m.size, "cannot be read as OpenEXR");
        }
    }
}

/* Offsets behind the end of the file, before its beginning, and within its head. */
static void offsets_of_openexr(void **state)
{
    (void)state;
    static const int64_t offsets[] = {-1, INT64_MAX, INT64_MIN, 0, 8, 1 << 30};
    for (size_t k = 0; k < sizeof offsets / sizeof *offsets; k++) {
        made m = {.size = 0};
        put_head(&m, &(claims){.compression = 3, .width = 64, .height = 16});
        put_number(&m, offsets[k], 8);
        put(&m, "\0\0\0\0\xff\xff\xff\x7fUUUUUUUU", 16);
        assert_refused(m.bytes, m.size, "cannot be read as OpenEXR");
    }
}

static void sizes_of_radiance(void **state)
{
    (void)state;
    static const struct {
        const char *size, *data, *saying;
    } cases[] = {
        {"-Y 65536 +X 65536", "", "cut off"},
        {"-Y 65536 +X 65536", "\2\2\1\1\xff\1\xff\1", "cut off"},
        {"-Y 65537 +X 1", "", "each side must be 1 to"},
        {"-Y 2147483647 +X 2147483647", "", "each side must be 1 to"},
        {"-Y 99999999999999999999 +X 99999999999999999999", "", "each side must be 1 to"},
        {"-Y -1 +X -1", "", "its size is not given"},
        {"-Y 0 +X 4", "", "its size is not given"},
        {"-Y 4 +X 4294967297", "", "each side must be 1 to"},
        {"-Y 30000 +X 30000", "\1\1\1\xff\1\1\1\xff", "cut off"},
        {"-Y 1 +X 8", "\2\2\1\10\x88\1\x88\1\x88\1", "cut off"},
        {"-Y 1 +X 8", "\2\2\1\10\xff\1\xff\1\xff\1\xff\1", "cut off"},
        {"-Y 1 +X 4", "abcdabcdabcd", "cut off"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *file = gonio_i_format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n%s\n%s", cases[k].size,
                                    cases[k].data);
        assert_non_null(file);
        assert_refused(file, strlen(file), cases[k].saying);
        free(file);
    }
}

/* A count of 0 would read the same place for ever. */
static void runs_of_nothing(void **state)
{
    (void)state;
    static const char file[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n"
                               "\2\2\0\10\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
    assert_refused(file, sizeof file - 1, "cut off");
}

/* More than half a GiB cannot be had: what asks for it runs out of memory, which is another error.
 * The address sanitizer needs all of the address space. */
static int begin_with_little_memory(void **state)
{
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
    const rlim_t most = (rlim_t)1500 << 20;
    const struct rlimit limit = {most, RLIM_INFINITY};
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
#endif
    const struct itimerval time = {.it_value = {.tv_sec = 60}}; /* an endless loop ends here */
    setitimer(ITIMER_PROF, &time, NULL);
    return begin(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_of_openexr),   cmocka_unit_test(chunks_of_openexr),
        cmocka_unit_test(offsets_of_openexr), cmocka_unit_test(sizes_of_radiance),
        cmocka_unit_test(runs_of_nothing),
    };
    return cmocka_run_group_tests_name("hostile images", tests, begin_with_little_memory, end);
}
