/* Texts as programs save them, made plain: see text_encoding.h. */
#include "text_encoding.h"

#include <stdlib.h>
#include <string.h>

typedef enum byte_order { NOT_UTF16, LITTLE, BIG } byte_order;

typedef struct utf16 {
    const unsigned char *at;
    const unsigned char *end;
    byte_order order;
} utf16;

enum { MOST_BYTES_OF_ONE = 4, REPLACEMENT = 0xfffd };

static bool is_plain_byte(unsigned char c)
{
    return (c >= ' ' && c < 0x7f) || c == '\t' || c == '\n' || c == '\r';
}

/* Whether every other byte of the beginning is an ASCII character, and those between are 0. */
static bool alternates(const unsigned char *bytes, size_t size, size_t first)
{
    enum { LEAST = 16, MOST = 64 };
    const size_t looked = size < MOST ? size & ~(size_t)1 : MOST;
    bool good = looked >= LEAST;
    for (size_t k = 0; k < looked && good; k += 2) {
        good = is_plain_byte(bytes[k + first]) && bytes[k + 1 - first] == 0;
    }
    return good;
}

static utf16 open_utf16(const char *text, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)text;
    const bool little_mark = size >= 2 && bytes[0] == 0xff && bytes[1] == 0xfe;
    const bool big_mark = size >= 2 && bytes[0] == 0xfe && bytes[1] == 0xff;
    utf16 u = {bytes + (little_mark || big_mark ? 2 : 0), bytes + size, NOT_UTF16};
    if (little_mark || alternates(bytes, size, 0)) {
        u.order = LITTLE;
    } else if (big_mark || alternates(bytes, size, 1)) {
        u.order = BIG;
    }
    return u;
}

static unsigned next_unit(utf16 *u)
{
    const unsigned char *at = u->at;
    if (u->end - at < 2) {
        u->at = u->end;
        return REPLACEMENT;
    }
    u->at += 2;
    return u->order == LITTLE ? at[0] | (unsigned)at[1] << 8 : at[1] | (unsigned)at[0] << 8;
}

static unsigned next_character(utf16 *u)
{
    const unsigned first = next_unit(u);
    if (first < 0xd800 || first > 0xdfff) {
        return first;
    }
    const unsigned char *back = u->at;
    const unsigned second = first < 0xdc00 && u->at < u->end ? next_unit(u) : 0;
    if (second >= 0xdc00 && second <= 0xdfff) {
        return 0x10000 + ((first - 0xd800) << 10) + (second - 0xdc00);
    }
    u->at = back;
    return REPLACEMENT;
}

static char *put_utf8(char *to, unsigned c)
{
    if (c < 0x80) {
        *to++ = (char)c;
    } else if (c < 0x800) {
        *to++ = (char)(0xc0 | c >> 6);
        *to++ = (char)(0x80 | (c & 0x3f));
    } else {
        if (c < 0x10000) {
            *to++ = (char)(0xe0 | c >> 12);
        } else {
            *to++ = (char)(0xf0 | c >> 18);
            *to++ = (char)(0x80 | (c >> 12 & 0x3f));
        }
        *to++ = (char)(0x80 | (c >> 6 & 0x3f));
        *to++ = (char)(0x80 | (c & 0x3f));
    }
    return to;
}

/* As much as fits in front of the last byte, which becomes 0. */
static size_t to_utf8(utf16 *u, char *to, size_t room)
{
    char *at = to;
    while (u->at < u->end && (size_t)(at - to) + MOST_BYTES_OF_ONE < room) {
        at = put_utf8(at, next_character(u));
    }
    *at = '\0';
    return (size_t)(at - to);
}

static void end_lines(char *text, size_t size)
{
    char *end = text + size;
    for (char *at = memchr(text, '\r', size); at != NULL;
         at = memchr(at, '\r', (size_t)(end - at))) {
        if (at + 1 == end || at[1] != '\n') {
            *at = '\n';
        }
        at++;
    }
}

gonio_status gonio_i_text_make_plain(gonio_context *context, const char *path, char **text,
                                     size_t *size)
{
    utf16 u = open_utf16(*text, *size);
    if (u.order != NOT_UTF16) {
        const size_t room = *size / 2 * 3 + 2 * MOST_BYTES_OF_ONE;
        char *plain = malloc(room);
        if (plain == NULL) {
            return gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
        }
        *size = to_utf8(&u, plain, room);
        free(*text);
        *text = plain;
    }
    end_lines(*text, *size);
    return GONIO_OK;
}

size_t gonio_i_text_plain_head(const char *text, size_t size, char *to, size_t room)
{
    utf16 u = open_utf16(text, size);
    if (u.order != NOT_UTF16) {
        size = to_utf8(&u, to, room);
    } else {
        size = size < room ? size : room - 1;
        memcpy(to, text, size);
        to[size] = '\0';
    }
    end_lines(to, size);
    return size;
}
