/* OpenEXR images, by the C library of OpenEXR (OpenEXRCore). */
#include <endian.h>
#include <limits.h>
#include <math.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#include "../core/output.h"
#include "image.h"

enum { PIXEL_BYTES = GONIO_IMAGE_CHANNELS * sizeof(float) };

/* The user data of callbacks. */
typedef struct stream {
    gonio_context *context;
    const char *path;
    const gonio_i_bytes *bytes; /* read */
    gonio_i_output *output;     /* written */
    gonio_status status;        /* of writing */
    char message[256];          /* the library's first message */
} stream;

static stream *stream_of(exr_const_context_t exr)
{
    void *user = NULL;
    exr_get_user_data(exr, &user);
    return user;
}

static void on_error(exr_const_context_t exr, exr_result_t code, const char *message)
{
    stream *s = stream_of(exr);
    (void)code;
    if (s != NULL && s->message[0] == '\0' && message != NULL) {
        strncpy(s->message, message, sizeof s->message - 1);
    }
}

static gonio_status fail(const stream *s, exr_result_t code)
{
    if (code == EXR_ERR_OUT_OF_MEMORY) {
        return gonio_i_fail(s->context, GONIO_ERROR_MEMORY, "%s: out of memory", s->path);
    }
    return gonio_i_fail(s->context, GONIO_ERROR_FORMAT, "%s: cannot be read as OpenEXR: %s",
                        s->path,
                        s->message[0] != '\0' ? s->message : exr_get_default_error_message(code));
}

/* ---- reading ---- */

static int64_t read_bytes(exr_const_context_t exr, void *user, void *buffer, uint64_t size,
                          uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const stream *s = user;
    (void)exr;
    (void)error;
    if (offset >= s->bytes->size) {
        return 0;
    }
    const uint64_t left = s->bytes->size - offset;
    const uint64_t count = size < left ? size : left;
    memcpy(buffer, s->bytes->data + offset, count);
    return (int64_t)count;
}

static int64_t size_of_bytes(exr_const_context_t exr, void *user)
{
    (void)exr;
    return (int64_t)((const stream *)user)->bytes->size;
}

/* The place of a channel's values in a pixel; -1 for an unused channel. */
static int place_of(const char *name)
{
    static const char names[] = "RGBA";
    if (strcmp(name, "Y") == 0) {
        return 0;
    }
    const char *at = strlen(name) == 1 ? strchr(names, name[0]) : NULL;
    return at != NULL ? (int)(at - names) : -1;
}

typedef struct channels {
    bool colour, grey, alpha;
} channels;

static channels find_channels(const exr_attr_chlist_t *list)
{
    bool found[GONIO_IMAGE_CHANNELS] = {false};
    bool grey = false;
    for (int k = 0; k < list->num_channels; k++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[k];
        const bool whole = entry->x_sampling == 1 && entry->y_sampling == 1;
        const int place = place_of(entry->name.str);
        if (whole && strcmp(entry->name.str, "Y") == 0) {
            grey = true;
        } else if (whole && place >= 0) {
            found[place] = true;
        }
    }
    const bool colour = found[0] && found[1] && found[2];
    return (channels){colour, grey && !colour, found[3]};
}

/* IEEE 754 binary16. */
static float half_to_float(uint16_t half)
{
    const int exponent = half >> 10 & 31;
    const int mantissa = half & 1023;
    const float size = exponent == 31  ? mantissa != 0 ? NAN : INFINITY
                       : exponent == 0 ? ldexpf((float)mantissa, -24)
                                       : ldexpf((float)(mantissa + 1024), exponent - 25);
    return (half & 0x8000) != 0 ? -size : size;
}

static float value_of(const uint8_t *from, exr_pixel_type_t type)
{
    uint16_t half = 0;
    uint32_t word = 0;
    float value = 0.0F;
    if (type == EXR_PIXEL_HALF) {
        memcpy(&half, from, sizeof half);
        return half_to_float(le16toh(half));
    }
    memcpy(&word, from, sizeof word);
    word = le32toh(word);
    memcpy(&value, &word, sizeof value);
    return type == EXR_PIXEL_FLOAT ? value : (float)word;
}

/* Copies one line of a channel to its place. */
static void unpack_line(const exr_coding_channel_info_t *channel, const uint8_t *from, int line)
{
    uint8_t *to = channel->decode_to_ptr;
    if (to == NULL) {
        return;
    }
    to += (ptrdiff_t)line * channel->user_line_stride;
    for (int x = 0; x < channel->width; x++, to += channel->user_pixel_stride) {
        const float value = value_of(from + (ptrdiff_t)x * channel->bytes_per_element,
                                     (exr_pixel_type_t)channel->data_type);
        memcpy(to, &value, sizeof value);
    }
}

/* Unpacks a chunk: lines, in each the channels. The library's own unpacking assumes that all
 * channels are wanted if three of them are half floats. */
static exr_result_t unpack(exr_decode_pipeline_t *decoder)
{
    const uint8_t *from = decoder->unpacked_buffer;
    size_t left = decoder->chunk.unpacked_size;
    if (from == NULL) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    for (int y = 0; y < decoder->chunk.height; y++) {
        for (int k = 0; k < decoder->channel_count; k++) {
            const exr_coding_channel_info_t *channel = &decoder->channels[k];
            const size_t size = (size_t)channel->width * (size_t)channel->bytes_per_element;
            if (channel->height == 0 || (decoder->chunk.start_y + y) % channel->y_samples != 0) {
                continue;
            }
            if (size > left) {
                return EXR_ERR_CORRUPT_CHUNK;
            }
            unpack_line(channel, from, y);
            from += size;
            left -= size;
        }
    }
    return EXR_ERR_SUCCESS;
}

/* Chunks are parts of an image: a small file with a single one of hundreds of megabytes was made to
 * fill the memory. Of a chunk that is not compressed, the library reads what there is and leaves
 * the rest of its memory as it was. */
static bool is_plausible(const exr_chunk_info_t *chunk)
{
    enum { MOST_FREE = 128 << 20, MOST_COMPRESSION = 100 };
    const bool whole =
        chunk->compression != EXR_COMPRESSION_NONE || chunk->packed_size == chunk->unpacked_size;
    return whole && chunk->unpacked_size <= MOST_FREE + chunk->packed_size * MOST_COMPRESSION;
}

/* The library says that memory is out where data of B44 end early. */
static exr_result_t judge(exr_result_t code, const exr_chunk_info_t *chunk)
{
    const bool is_b44 =
        chunk->compression == EXR_COMPRESSION_B44 || chunk->compression == EXR_COMPRESSION_B44A;
    if (code != EXR_ERR_OUT_OF_MEMORY || !is_b44) {
        return code;
    }
    void *volatile trial = malloc(chunk->unpacked_size);
    const bool has_room = trial != NULL;
    free(trial);
    return has_room ? EXR_ERR_CORRUPT_CHUNK : code;
}

/* Decodes one chunk whose first pixel is at column x, row y of the image. */
static exr_result_t decode(exr_context_t exr, const exr_chunk_info_t *chunk, int x, int y,
                           channels wanted, gonio_image *image, bool first,
                           exr_decode_pipeline_t *decoder)
{
    if (!is_plausible(chunk)) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    exr_result_t code = first ? exr_decoding_initialize(exr, 0, chunk, decoder)
                              : exr_decoding_update(exr, 0, chunk, decoder);
    if (code != EXR_ERR_SUCCESS) {
        return code;
    }
    float *pixel =
        image->rgba + ((size_t)y * (size_t)image->width + (size_t)x) * GONIO_IMAGE_CHANNELS;
    for (int k = 0; k < decoder->channel_count; k++) {
        exr_coding_channel_info_t *channel = &decoder->channels[k];
        const int place = place_of(channel->channel_name);
        const bool is_grey = strcmp(channel->channel_name, "Y") == 0;
        const bool take = place == 3 || (place >= 0 && is_grey == wanted.grey);
        channel->decode_to_ptr = take && channel->x_samples == 1 && channel->y_samples == 1
                                     ? (uint8_t *)(pixel + place)
                                     : NULL;
        channel->user_pixel_stride = PIXEL_BYTES;
        channel->user_line_stride = image->width * PIXEL_BYTES;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    code = first ? exr_decoding_choose_default_routines(exr, 0, decoder) : EXR_ERR_SUCCESS;
    decoder->unpack_and_convert_fn = unpack;
    return code == EXR_ERR_SUCCESS ? judge(exr_decoding_run(exr, 0, decoder), chunk) : code;
}

static exr_result_t decode_lines(exr_context_t exr, const exr_attr_box2i_t *window, channels wanted,
                                 gonio_image *image)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(exr, 0, &lines);
    for (int y = 0; y < image->height && code == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(exr, 0, window->min.y + y, &chunk);
        if (code == EXR_ERR_SUCCESS) {
            code = decode(exr, &chunk, 0, y, wanted, image, y == 0, &decoder);
        }
    }
    exr_decoding_destroy(exr, &decoder);
    return code;
}

static exr_result_t decode_tiles(exr_context_t exr, channels wanted, gonio_image *image)
{
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t width = 0;
    int32_t height = 0;
    exr_result_t code = exr_get_tile_sizes(exr, 0, 0, 0, &width, &height);
    if (code == EXR_ERR_SUCCESS && (width < 1 || height < 1)) {
        code = EXR_ERR_INVALID_ATTR;
    }
    bool first = true;
    for (int y = 0; code == EXR_ERR_SUCCESS && y < image->height; y += height) {
        for (int x = 0; code == EXR_ERR_SUCCESS && x < image->width; x += width) {
            exr_chunk_info_t chunk;
            code = exr_read_tile_chunk_info(exr, 0, x / width, y / height, 0, 0, &chunk);
            if (code == EXR_ERR_SUCCESS) {
                code = decode(exr, &chunk, x, y, wanted, image, first, &decoder);
                first = false;
            }
        }
    }
    exr_decoding_destroy(exr, &decoder);
    return code;
}

/* Copies grey to all colours. Without A, pixels are opaque. */
static void complete(channels found, gonio_image *image)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < pixels; k++) {
        float *pixel = image->rgba + k * GONIO_IMAGE_CHANNELS;
        pixel[1] = found.grey ? pixel[0] : pixel[1];
        pixel[2] = found.grey ? pixel[0] : pixel[2];
        pixel[3] = found.alpha ? pixel[3] : 1.0F;
    }
}

/* Bytes of a pixel in all channels of a file, or here if that is more. */
static int64_t bytes_of_pixel(const exr_attr_chlist_t *list)
{
    int64_t bytes = 0;
    for (int k = 0; k < list->num_channels; k++) {
        bytes += list->entries[k].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    }
    return bytes > PIXEL_BYTES ? bytes : PIXEL_BYTES;
}

/* Whether a file can hold so many bytes of pixels. No compression makes an image a thousand times
 * smaller, but of one colour, which may be of 512 MiB: 8192 x 4096 pixels. */
static bool can_hold(const gonio_i_bytes *bytes, int64_t unpacked)
{
    enum { MOST_COMPRESSION = 1000, PLAIN = 512 << 20, HEAD = 1 << 20 };
    const int64_t more = (int64_t)bytes->size - HEAD;
    return unpacked <= PLAIN + (more > 0 ? more * MOST_COMPRESSION : 0);
}

static gonio_status read_pixels(const stream *s, exr_context_t exr, const exr_attr_box2i_t *window,
                                const exr_attr_chlist_t *list, bool tiled, gonio_image **image)
{
    const channels found = find_channels(list);
    const int64_t width = (int64_t)window->max.x - window->min.x + 1;
    const int64_t height = (int64_t)window->max.y - window->min.y + 1;
    if (width < 1 || height < 1 || width > GONIO_MOST_PIXELS || height > GONIO_MOST_PIXELS) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s: an image of %lld x %lld pixels: each side must be 1 to %d",
                            s->path, (long long)width, (long long)height, GONIO_MOST_PIXELS);
    }
    if (!can_hold(s->bytes, width * height * bytes_of_pixel(list))) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s: an image of %lld x %lld pixels in %zu bytes: damaged or cut off",
                            s->path, (long long)width, (long long)height, s->bytes->size);
    }
    gonio_image *made = NULL;
    const gonio_status status = gonio_image_create(s->context, (int)width, (int)height, &made);
    if (status != GONIO_OK) {
        return status;
    }
    const exr_result_t code =
        tiled ? decode_tiles(exr, found, made) : decode_lines(exr, window, found, made);
    if (code != EXR_ERR_SUCCESS) {
        gonio_image_free(&made);
        return fail(s, code);
    }
    complete(found, made);
    *image = made;
    return GONIO_OK;
}

static gonio_status read_part(const stream *s, exr_context_t exr, gonio_image **image)
{
    exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *list = NULL;
    exr_result_t code = exr_get_storage(exr, 0, &storage);
    code = code == EXR_ERR_SUCCESS ? exr_get_data_window(exr, 0, &window) : code;
    code = code == EXR_ERR_SUCCESS ? exr_get_channels(exr, 0, &list) : code;
    if (code != EXR_ERR_SUCCESS) {
        return fail(s, code);
    }
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s: deep OpenEXR data; gonio reads images of scan lines or tiles",
                            s->path);
    }
    const channels found = find_channels(list);
    if (!found.colour && !found.grey) {
        return gonio_i_fail(s->context, GONIO_ERROR_FORMAT,
                            "%s: has no channels R, G, B (or Y) of full size", s->path);
    }
    return read_pixels(s, exr, &window, list, storage == EXR_STORAGE_TILED, image);
}

gonio_status gonio_i_read_exr(gonio_context *context, const char *path, const gonio_i_bytes *bytes,
                              gonio_image **image)
{
    stream s = {.context = context, .path = path, .bytes = bytes};
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.error_handler_fn = on_error;
    how.user_data = &s;
    how.read_fn = read_bytes;
    how.size_fn = size_of_bytes;
    exr_context_t exr = NULL;
    const exr_result_t code = exr_start_read(&exr, path, &how);
    const gonio_status status =
        code == EXR_ERR_SUCCESS ? read_part(&s, exr, image) : fail(&s, code);
    exr_finish(&exr);
    return status;
}

/* ---- writing ---- */

static int64_t write_bytes(exr_const_context_t exr, void *user, const void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    stream *s = user;
    (void)exr;
    (void)error;
    if (s->status == GONIO_OK) {
        s->status = gonio_i_output_write_at(s->context, s->output, buffer, size, (off_t)offset);
    }
    return s->status == GONIO_OK ? (int64_t)size : -1;
}

static exr_result_t write_head(exr_context_t exr, const gonio_image *image)
{
    static const char *const names[GONIO_IMAGE_CHANNELS] = {"R", "G", "B", "A"};
    int part = 0;
    exr_result_t code = exr_add_part(exr, "gonio", EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS) {
        code = exr_initialize_required_attr_simple(exr, part, image->width, image->height,
                                                   EXR_COMPRESSION_ZIP);
    }
    for (int k = 0; k < GONIO_IMAGE_CHANNELS && code == EXR_ERR_SUCCESS; k++) {
        code = exr_add_channel(exr, part, names[k], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    return code == EXR_ERR_SUCCESS ? exr_write_header(exr) : code;
}

static exr_result_t encode(exr_context_t exr, const gonio_image *image, int y,
                           exr_encode_pipeline_t *encoder)
{
    exr_chunk_info_t chunk;
    exr_result_t code = exr_write_scanline_chunk_info(exr, 0, y, &chunk);
    if (code == EXR_ERR_SUCCESS) {
        code = y == 0 ? exr_encoding_initialize(exr, 0, &chunk, encoder)
                      : exr_encoding_update(exr, 0, &chunk, encoder);
    }
    const float *line = image->rgba + (size_t)y * (size_t)image->width * GONIO_IMAGE_CHANNELS;
    for (int k = 0; code == EXR_ERR_SUCCESS && k < encoder->channel_count; k++) {
        exr_coding_channel_info_t *channel = &encoder->channels[k];
        channel->encode_from_ptr = (const uint8_t *)(line + place_of(channel->channel_name));
        channel->user_pixel_stride = PIXEL_BYTES;
        channel->user_line_stride = image->width * PIXEL_BYTES;
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (code == EXR_ERR_SUCCESS && y == 0) {
        code = exr_encoding_choose_default_routines(exr, 0, encoder);
    }
    return code == EXR_ERR_SUCCESS ? exr_encoding_run(exr, 0, encoder) : code;
}

static exr_result_t write_image(exr_context_t exr, const gonio_image *image)
{
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t lines = 0;
    exr_result_t code = write_head(exr, image);
    if (code == EXR_ERR_SUCCESS) {
        code = exr_get_scanlines_per_chunk(exr, 0, &lines);
    }
    for (int y = 0; y < image->height && code == EXR_ERR_SUCCESS; y += lines) {
        code = encode(exr, image, y, &encoder);
    }
    exr_encoding_destroy(exr, &encoder);
    return code;
}

gonio_status gonio_image_write_exr(gonio_context *context, const gonio_image *image,
                                   const char *path)
{
    gonio_i_output output;
    const gonio_status opened = gonio_i_output_open(context, path, &output);
    if (opened != GONIO_OK) {
        return opened;
    }
    stream s = {.context = context, .path = path, .output = &output};
    exr_context_initializer_t how = EXR_DEFAULT_CONTEXT_INITIALIZER;
    how.error_handler_fn = on_error;
    how.user_data = &s;
    how.write_fn = write_bytes;
    exr_context_t exr = NULL;
    exr_result_t code = exr_start_write(&exr, path, EXR_WRITE_FILE_DIRECTLY, &how);
    if (code == EXR_ERR_SUCCESS) {
        code = write_image(exr, image);
    }
    const exr_result_t closed = exr_finish(&exr);
    code = code == EXR_ERR_SUCCESS ? closed : code;
    if (s.status == GONIO_OK && code != EXR_ERR_SUCCESS) {
        s.status =
            gonio_i_fail(context, GONIO_ERROR_IO, "%s: cannot write: %s", path,
                         s.message[0] != '\0' ? s.message : exr_get_default_error_message(code));
    }
    return gonio_i_output_close(context, &output, s.status);
}
