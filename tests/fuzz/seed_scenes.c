/* Seeds: images and meshes. */
#include "fuzz.h"

#include <openexr.h>

#include "seeds.h"

enum { SIDE = 8, VALUES = SIDE * SIDE * 4 };

/* ---- OpenEXR ---- */

typedef struct kind {
    const char *name;
    const char *channels; /* a letter each */
    exr_compression_t compression;
    exr_pixel_type_t type;
    bool tiled;
} kind;

static const kind kinds[] = {
    {"none", "ABGR", EXR_COMPRESSION_NONE, EXR_PIXEL_FLOAT, false},
    {"rle", "BGR", EXR_COMPRESSION_RLE, EXR_PIXEL_HALF, false},
    {"zips", "BGRZ", EXR_COMPRESSION_ZIPS, EXR_PIXEL_HALF, false},
    {"zip", "Y", EXR_COMPRESSION_ZIP, EXR_PIXEL_FLOAT, false},
    {"piz", "BGR", EXR_COMPRESSION_PIZ, EXR_PIXEL_HALF, false},
    {"pxr24", "BGR", EXR_COMPRESSION_PXR24, EXR_PIXEL_FLOAT, false},
    {"b44", "BGR", EXR_COMPRESSION_B44, EXR_PIXEL_HALF, false},
    {"b44a", "ABGR", EXR_COMPRESSION_B44A, EXR_PIXEL_HALF, false},
    {"tiled-zip", "BGR", EXR_COMPRESSION_ZIP, EXR_PIXEL_HALF, true},
    {"tiled-piz", "ABGR", EXR_COMPRESSION_PIZ, EXR_PIXEL_HALF, true},
    {"tiled-none", "Y", EXR_COMPRESSION_NONE, EXR_PIXEL_UINT, true},
};

static void must(exr_result_t code)
{
    check(code == EXR_ERR_SUCCESS, exr_get_error_code_as_string(code));
}

static void write_head(exr_context_t exr, const kind *k)
{
    int part = 0;
    must(exr_add_part(exr, "x", k->tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part));
    must(exr_initialize_required_attr_simple(exr, part, SIDE, SIDE, k->compression));
    if (k->tiled) {
        must(exr_set_tile_descriptor(exr, part, SIDE / 2, SIDE / 2, EXR_TILE_ONE_LEVEL,
                                     EXR_TILE_ROUND_DOWN));
    }
    for (const char *c = k->channels; *c != '\0'; c++) {
        const char name[2] = {*c, '\0'};
        must(exr_add_channel(exr, part, name, k->type, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    }
    must(exr_write_header(exr));
}

/* All channels of a block hold the same numbers. */
static void write_block(exr_context_t exr, const exr_chunk_info_t *chunk, const kind *k)
{
    static uint8_t values[VALUES * sizeof(float)];
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    const int size = k->type == EXR_PIXEL_HALF ? 2 : 4;
    for (size_t n = 0; n < VALUES; n++) {
        const float value = 0.25F + 0.01F * (float)n;
        const uint16_t half = (uint16_t)(0x3400 + 3 * n);
        memcpy(values + n * (size_t)size, size == 2 ? (const void *)&half : &value, (size_t)size);
    }
    must(exr_encoding_initialize(exr, 0, chunk, &encoder));
    for (int c = 0; c < encoder.channel_count; c++) {
        exr_coding_channel_info_t *channel = &encoder.channels[c];
        channel->encode_from_ptr = values;
        channel->user_pixel_stride = size;
        channel->user_line_stride = size * SIDE;
        channel->user_bytes_per_element = (int16_t)size;
        channel->user_data_type = (uint16_t)k->type;
    }
    must(exr_encoding_choose_default_routines(exr, 0, &encoder));
    must(exr_encoding_run(exr, 0, &encoder));
    must(exr_encoding_destroy(exr, &encoder));
}

static void seed_exr(const kind *k)
{
    char path[4096];
    exr_context_t exr = NULL;
    exr_chunk_info_t chunk;
    int32_t lines = SIDE;
    seed_path(path, "image", k->name);
    must(exr_start_write(&exr, path, EXR_WRITE_FILE_DIRECTLY, NULL));
    write_head(exr, k);
    for (int tile = 0; k->tiled && tile < 4; tile++) {
        must(exr_write_tile_chunk_info(exr, 0, tile % 2, tile / 2, 0, 0, &chunk));
        write_block(exr, &chunk, k);
    }
    if (!k->tiled) {
        must(exr_get_scanlines_per_chunk(exr, 0, &lines));
    }
    for (int y = 0; !k->tiled && y < SIDE; y += lines) {
        must(exr_write_scanline_chunk_info(exr, 0, y, &chunk));
        write_block(exr, &chunk, k);
    }
    must(exr_finish(&exr));
}

/* ---- Radiance ---- */

static void seed_radiance(void)
{
    static const char head[] = "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n"
                               "COLORCORR=1 2 1\n\n-Y 2 +X 8\n";
    uint8_t bytes[256];
    size_t size = sizeof head - 1;
    memcpy(bytes, head, size);
    for (size_t k = 0; k < 2 * SIDE * 4; k++) {
        bytes[size + k] = (uint8_t)(100 + k);
    }
    seed_bytes("image", "flat.hdr", bytes, size + (size_t)2 * SIDE * 4);
    for (int row = 0; row < 2; row++) {
        static const uint8_t start[4] = {2, 2, 0, SIDE};
        memcpy(bytes + size, start, sizeof start);
        size += sizeof start;
        for (int c = 0; c < 4; c++) {
            const uint8_t run[] = {128 + 5, (uint8_t)(120 + c), 3, 7, 8, 9};
            memcpy(bytes + size, run, sizeof run);
            size += sizeof run;
        }
    }
    seed_bytes("image", "coded.hdr", bytes, size);
}

/* ---- meshes ---- */

static const struct {
    const char *name;
    const char *text;
} meshes[] = {
    {"plain.obj", "# a tetrahedron\no x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"
                  "f 1 3 4\nf -3 -2 -1\n"},
    {"normals.obj", "mtllib x.mtl\nusemtl y\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 1.0\nvt 0 0\n"
                    "vn 0 0 1\ns 1\ng a b\nf 1/1/1 2/1/1 3/1/1 4/1/1\nl 1 2\np 1\nf 1//1 2//1 \\\n"
                    "3//1\n"},
    {"text.ply", "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\n"
                 "property float y\nproperty double z\nproperty float nx\nproperty float ny\n"
                 "property float nz\nelement face 2\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n"
                 "3 0 1 2\n"},
};

static void seed_binary_ply(const char *encoding, bool big)
{
    char text[512];
    char name[64];
    const int head = snprintf(text, sizeof text,
                              "ply\nformat %s 1.0\nelement vertex 3\nproperty short x\n"
                              "property short y\nproperty short z\nelement face 1\n"
                              "property list uchar ushort vertex_index\nend_header\n",
                              encoding);
    static const uint8_t values[] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0,
                                     0, 1, 0, 0, 0, 3, 0, 0, 1, 0, 2, 0};
    memcpy(text + head, values, sizeof values);
    for (size_t k = 0; big && k + 1 < sizeof values; k += 2) {
        k += k == 18 ? 1 : 0; /* the count is a byte */
        text[(size_t)head + k] = (char)values[k + 1];
        text[(size_t)head + k + 1] = (char)values[k];
    }
    snprintf(name, sizeof name, "%s.ply", encoding);
    seed_bytes("mesh", name, text, (size_t)head + sizeof values);
}

void seed_scenes(void)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        seed_exr(&kinds[k]);
    }
    seed_radiance();
    for (size_t k = 0; k < sizeof meshes / sizeof *meshes; k++) {
        seed_text("mesh", meshes[k].name, meshes[k].text);
    }
    seed_binary_ply("binary_little_endian", false);
    seed_binary_ply("binary_big_endian", true);
}
