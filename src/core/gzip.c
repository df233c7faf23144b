/* Texts compressed with gzip: see gzip.h. */
#include "gzip.h"

#include <stdlib.h>
#include <string.h>

#include <zlib.h>

enum { GZIP_WINDOW = 15 + 16 /* the largest window, of gzip files only */, ROOM = 1 << 20 };

bool gonio_i_gzip_begins(const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    return size >= 3 && b[0] == 0x1f && b[1] == 0x8b && b[2] == Z_DEFLATED;
}

static bool begin(z_stream *stream, const void *bytes, size_t size)
{
    *stream = (z_stream){.next_in = (z_const Bytef *)bytes, .avail_in = (uInt)size};
    return inflateInit2(stream, GZIP_WINDOW) == Z_OK;
}

size_t gonio_i_gzip_head(const void *bytes, size_t size, char *text, size_t room)
{
    z_stream stream;
    if (!begin(&stream, bytes, size)) {
        return 0;
    }
    stream.next_out = (Bytef *)text;
    stream.avail_out = (uInt)room;
    inflate(&stream, Z_SYNC_FLUSH);
    inflateEnd(&stream);
    return room - stream.avail_out;
}

/* Tables compress to a tenth or so. A file that grows more than twentyfold, beyond what costs
 * little, was made to fill the memory: readings of short lines take fifteen times their text. */
static const size_t MOST_FREE = (size_t)16 << 20;
static const size_t MOST_COMPRESSION = 20;

/* A growing block of text. */
typedef struct growing {
    char *text;
    size_t length;
    size_t room;
} growing;

static bool make_room(growing *g)
{
    if (g->length < g->room) {
        return true;
    }
    const size_t room = g->room == 0 ? ROOM : 2 * g->room;
    char *more = realloc(g->text, room + 1);
    g->text = more != NULL ? more : g->text;
    g->room = more != NULL ? room : g->room;
    return more != NULL;
}

/* Whether only zeros remain: tapes are padded with zeros. */
static bool only_zeros(const z_stream *stream)
{
    uInt k = 0;
    while (k < stream->avail_in && stream->next_in[k] == 0) {
        k++;
    }
    return k == stream->avail_in;
}

/* A file is a sequence of compressed members, as when files are concatenated. Other data after the
 * last member is an error, so that no data is lost silently. */
static int begin_next(z_stream *stream)
{
    if (only_zeros(stream)) {
        return Z_STREAM_END;
    }
    return inflateReset(stream);
}

/* Returns Z_STREAM_END, or what went wrong; Z_OK beyond `most` bytes. */
static int inflate_all(z_stream *stream, size_t most, growing *g)
{
    int result = Z_OK;
    while (result == Z_OK && g->length <= most) {
        if (!make_room(g)) {
            return Z_MEM_ERROR;
        }
        const size_t room = g->room - g->length;
        stream->next_out = (Bytef *)g->text + g->length;
        stream->avail_out = (uInt)(room < ROOM ? room : ROOM);
        const uInt before = stream->avail_out;
        result = inflate(stream, Z_NO_FLUSH);
        g->length += before - stream->avail_out;
        result = result == Z_STREAM_END ? begin_next(stream) : result;
    }
    return result;
}

gonio_status gonio_i_gzip_text(gonio_context *context, const char *path, const void *bytes,
                               size_t size, size_t most, char **text, size_t *length)
{
    z_stream stream;
    growing g = {0};
    if (!begin(&stream, bytes, size)) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    const size_t plausible = MOST_FREE + MOST_COMPRESSION * size;
    most = plausible < most ? plausible : most;
    const int result = inflate_all(&stream, most, &g);
    inflateEnd(&stream);
    if (result == Z_STREAM_END && g.length <= most) {
        g.text[g.length] = '\0';
        *text = g.text;
        *length = g.length;
        return GONIO_OK;
    }
    free(g.text);
    if (result == Z_MEM_ERROR) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    if (g.length > most) {
        return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                            "%s: more than %zu MiB once decompressed, far more than its kind has; "
                            "decompress it first if you trust it",
                            path, most >> 20);
    }
    return gonio_i_fail(context, GONIO_ERROR_FORMAT,
                        "%s: a damaged or truncated gzip file; copy it again from its source",
                        path);
}
