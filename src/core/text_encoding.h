/* Texts as programs save them, made plain: UTF-16 (of either byte order, with a byte-order mark or
 * plainly ASCII) becomes UTF-8, and a carriage return that stands alone the end of a line. */
#ifndef GONIO_TEXT_ENCODING_H
#define GONIO_TEXT_ENCODING_H

#include "core.h"

/* Changes a text in place or puts a new block in its place, followed by a 0 as the old one was.
 * Halves of characters become U+FFFD. Errors: _MEMORY; the text is as it was then. */
gonio_status gonio_i_text_make_plain(gonio_context *context, const char *path, char **text,
                                     size_t *size);

/* The same of a text's beginning: as much as there is room for in to[room], the last byte 0.
 * Returns the size. */
size_t gonio_i_text_plain_head(const char *text, size_t size, char *to, size_t room);

#endif
