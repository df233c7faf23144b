/* Image files: OpenEXR, Radiance and PNG. */
#include "../support.h"

#include <gonio/gonio.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mutations.h"
#include "render_fixture.h"

static void openexr_comes_back_as_it_was(void **state)
{
    (void)state;
    char *folder = support_folder();
    char *path = path_in(folder, "image.exr");
    gonio_image *image = NULL;
    gonio_image *back = NULL;
    assert_int_equal(gonio_image_create(NULL, 37, 53, &image), GONIO_OK);
    for (int k = 0; k < 37 * 53 * 4; k++) {
        image->rgba[k] = (float)(k * 0.37 - 50.0);
    }
    assert_int_equal(gonio_image_write_exr(NULL, image, path), GONIO_OK);
    assert_int_equal(gonio_image_read(NULL, path, &back), GONIO_OK);
    assert_int_equal(back->width, 37);
    assert_int_equal(back->height, 53);
    assert_memory_equal(back->rgba, image->rgba, sizeof(float) * 37 * 53 * 4);
    gonio_image_free(&image);
    gonio_image_free(&back);
    free(path);
    support_remove(folder);
}

/* A file of a MiB that claims 8000 x 7000 pixels, for which memory is not asked. Its window is two
 * corners of four bytes each. */
static void small_images_with_many_pixels(void **state)
{
    (void)state;
    enum { PADDING = 1000000 };
    static const unsigned char window[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0x3f, 0x1f, 0, 0, 0x57, 0x1b};
    char *folder = support_folder();
    char *path = path_in(folder, "image.exr");
    gonio_image *image = NULL;
    size_t size = 0;
    assert_int_equal(gonio_image_create(NULL, 37, 53, &image), GONIO_OK);
    assert_int_equal(gonio_image_write_exr(NULL, image, path), GONIO_OK);
    gonio_image_free(&image);
    unsigned char *bytes = read_bytes(path, &size);
    bytes = realloc(bytes, size + PADDING);
    assert_non_null(bytes);
    memset(bytes + size, 0, PADDING);
    static const char name[] = "dataWindow\0box2i\0\20\0\0";
    unsigned char *at = memmem(bytes, size, name, sizeof name);
    assert_non_null(at);
    memcpy(at + sizeof name, window, sizeof window);
    write_bytes(path, bytes, size + PADDING);
    free(bytes);
    gonio_context *context = support_context();
    assert_int_equal(gonio_image_read(context, path, &image), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "8000 x 7000 pixels"));
    gonio_context_free(&context);
    free(path);
    support_remove(folder);
}

/* Shared exponent: a component is mantissa * 2^(exponent - 136). */
static void radiance_images_are_read(void **state)
{
    (void)state;
    static const char file[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n"
                               "\x80\x40\x20\x81\x00\x00\x00\x00";
    char *folder = support_folder();
    char *path = path_in(folder, "image.hdr");
    gonio_image *image = NULL;
    write_file(path, file, sizeof file - 1);
    assert_int_equal(gonio_image_read(NULL, path, &image), GONIO_OK);
    assert_int_equal(image->width, 2);
    assert_close((double)image->rgba[0], 1.0, 1e-6);
    assert_close((double)image->rgba[1], 0.5, 1e-6);
    assert_close((double)image->rgba[2], 0.25, 1e-6);
    assert_close((double)image->rgba[3], 1.0, 0.0);
    gonio_image_free(&image);
    free(path);
    support_remove(folder);
}

static gonio_status read_image(const void *file, size_t size, gonio_image **image)
{
    char *folder = support_folder();
    char *path = path_in(folder, "image");
    write_file(path, file, size);
    const gonio_status status = gonio_image_read(telling, path, image);
    free(path);
    support_remove(folder);
    return status;
}

/* Pixels are radiance times all that EXPOSURE and COLORCORR say. */
static void radiance_images_are_exposed(void **state)
{
    (void)state;
    static const char file[] = "#?RADIANCE\nEXPOSURE= 4\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0.5\n"
                               "COLORCORR=1 2 0.25\n\n-Y 1 +X 1\n\x80\x40\x20\x81";
    static const char bad[] = "#?RADIANCE\nEXPOSURE=0\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
                              "\x80\x40\x20\x81";
    gonio_image *image = NULL;
    assert_int_equal(read_image(file, sizeof file - 1, &image), GONIO_OK);
    assert_close((double)image->rgba[0], 0.5, 1e-7);
    assert_close((double)image->rgba[1], 0.125, 1e-7);
    assert_close((double)image->rgba[2], 0.5, 1e-7);
    gonio_image_free(&image);
    assert_int_equal(read_image(bad, sizeof bad - 1, &image), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "'EXPOSURE=0'"));
}

/* Two lines of nine pixels, the components coded as a run and as bytes. */
static void coded_radiance_images_are_read_or_refused(void **state)
{
    (void)state;
    static const char file[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 9\n"
                               "\2\2\0\11\x89\x80\x11\1\2\3\4\5\6\7\10\11"
                               "\x89\0\x89\x81"
                               "\2\2\0\11\x84\x80\x85\x40\x89\1\x89\0\x89\x81";
    char fixed[sizeof file];
    gonio_image *image = NULL;
    memcpy(fixed, file, sizeof file);
    *(char *)memchr(fixed, 0x11, sizeof fixed) = 9; /* a count of bytes, not of a run */
    assert_int_equal(read_image(fixed, sizeof fixed - 1, &image), GONIO_OK);
    assert_close((double)image->rgba[0], 1.0, 1e-7);
    assert_close((double)image->rgba[4 * 8 + 1], 9.0 / 128.0, 1e-7);
    assert_close((double)image->rgba[4 * (9 + 3)], 1.0, 1e-7);
    assert_close((double)image->rgba[4 * (9 + 4)], 0.5, 1e-7);
    gonio_image_free(&image);
    assert_int_equal(read_image(file, sizeof file - 1, &image), GONIO_ERROR_FORMAT);
    for (size_t size = 1; size < sizeof fixed - 1; size++) {
        assert_int_equal(read_image(fixed, size, &image), GONIO_ERROR_FORMAT);
    }
}

static void put_attribute(FILE *f, const char *name, const char *type, const void *data,
                          uint32_t size)
{
    fwrite(name, 1, strlen(name) + 1, f);
    fwrite(type, 1, strlen(type) + 1, f);
    fwrite(&size, 1, sizeof size, f);
    fwrite(data, 1, size, f);
}

enum { WIDTH = 16 };

/* A file of a line of pixels: half floats B, G, R and a float Z beside them; little-endian, as the
 * format is. Its header claims width x height pixels. The caller frees it. */
static char *mixed_channels(int32_t width, int32_t height, size_t *size)
{
    static const char channels[] = "B\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
                                   "G\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
                                   "R\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
                                   "Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    const int32_t window[4] = {0, 0, width - 1, height - 1};
    static const float one = 1.0F;
    static const float centre[2] = {0.0F, 0.0F};
    /* 0.25, 1.5, the least above 0, for B, G, R */
    static const uint16_t half[3] = {0x3400, 0x3e00, 0x0001};
    char *text = NULL;
    FILE *f = open_memstream(&text, size);
    assert_non_null(f);
    fwrite("\x76\x2f\x31\x01\2\0\0\0", 1, 8, f);
    put_attribute(f, "channels", "chlist", channels, sizeof channels);
    put_attribute(f, "compression", "compression", "", 1);
    put_attribute(f, "dataWindow", "box2i", window, sizeof window);
    put_attribute(f, "displayWindow", "box2i", window, sizeof window);
    put_attribute(f, "lineOrder", "lineOrder", "", 1);
    put_attribute(f, "pixelAspectRatio", "float", &one, sizeof one);
    put_attribute(f, "screenWindowCenter", "v2f", centre, sizeof centre);
    put_attribute(f, "screenWindowWidth", "float", &one, sizeof one);
    fputc(0, f);
    fflush(f);
    const uint64_t offset = *size + sizeof offset;
    const int32_t chunk[2] = {0, WIDTH * (3 * 2 + 4)};
    fwrite(&offset, 1, sizeof offset, f);
    fwrite(chunk, 1, sizeof chunk, f);
    for (int k = 0; k < 3 * WIDTH; k++) {
        fwrite(&half[k / WIDTH], 1, sizeof *half, f);
    }
    for (int k = 0; k < WIDTH; k++) {
        fwrite(&one, 1, sizeof one, f);
    }
    fclose(f);
    return text;
}

static void openexr_of_mixed_channels_is_read(void **state)
{
    (void)state;
    size_t size = 0;
    char *text = mixed_channels(WIDTH, 1, &size);
    gonio_image *image = NULL;
    assert_int_equal(read_image(text, size, &image), GONIO_OK);
    for (int k = 0; k < WIDTH; k++) {
        assert_close((double)image->rgba[4 * k], ldexp(1.0, -24), 0.0);
        assert_close((double)image->rgba[4 * k + 1], 1.5, 0.0);
        assert_close((double)image->rgba[4 * k + 2], 0.25, 0.0);
        assert_close((double)image->rgba[4 * k + 3], 1.0, 0.0);
    }
    gonio_image_free(&image);
    free(text);
}

/* 100 bytes do not ask for gigabytes. */
static void openexr_that_claims_more_than_it_holds_is_refused(void **state)
{
    (void)state;
    size_t size = 0;
    char *text = mixed_channels(20000, 20000, &size);
    gonio_image *image = NULL;
    assert_int_equal(read_image(text, size, &image), GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), "20000 x 20000 pixels in "));
    assert_null(image);
    free(text);
}

/* The signature and the size; that browsers show them is tested with the page. */
static void pictures_are_png(void **state)
{
    (void)state;
    static const unsigned char head[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,
                                         0,    0,   13,  'I', 'H',  'D',  'R',  0,    0,
                                         0,    7,   0,   0,   0,    5,    8};
    gonio_image *image = NULL;
    char *folder = support_folder();
    char path[256];
    unsigned char found[sizeof head];
    snprintf(path, sizeof path, "%s/a.png", folder);
    assert_int_equal(gonio_image_create(NULL, 7, 5, &image), GONIO_OK);
    const gonio_tone tone = gonio_tone_measure(image, 0.18);
    assert_int_equal(gonio_image_write_png(NULL, image, &tone, path), GONIO_OK);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(found, 1, sizeof found, file), sizeof found);
    fclose(file);
    assert_memory_equal(found, head, sizeof head);
    assert_int_equal(gonio_image_write_png(NULL, image, &tone, "/nonexistent/a.png"),
                     GONIO_ERROR_IO);
    gonio_image_free(&image);
    support_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(openexr_comes_back_as_it_was),
        cmocka_unit_test(small_images_with_many_pixels),
        cmocka_unit_test(radiance_images_are_read),
        cmocka_unit_test(radiance_images_are_exposed),
        cmocka_unit_test(coded_radiance_images_are_read_or_refused),
        cmocka_unit_test(openexr_of_mixed_channels_is_read),
        cmocka_unit_test(openexr_that_claims_more_than_it_holds_is_refused),
        cmocka_unit_test(pictures_are_png),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
