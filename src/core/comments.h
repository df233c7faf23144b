/* The comment lines of a table as texts. Some have the form "key: value". */
#ifndef GONIO_COMMENTS_H
#define GONIO_COMMENTS_H

#include "core.h"

typedef struct gonio_i_comments {
    size_t count;
    char **line; /* without the leading '#' and blanks */
} gonio_i_comments;

/* Text is copied. Numbers are printed with decimal points in any locale. False when out of memory.
 */
bool gonio_i_comments_add(gonio_i_comments *comments, const char *format, ...) GONIO_I_PRINTF(2, 3);
bool gonio_i_comments_add_text(gonio_i_comments *comments, const char *text, size_t length);
bool gonio_i_comments_copy(gonio_i_comments *to, const gonio_i_comments *from);
void gonio_i_comments_free(gonio_i_comments *comments);

/* The text after "key:"; NULL if there is none. */
const char *gonio_i_comments_value(const gonio_i_comments *comments, const char *key);

/* Removes the comments that begin with "key:". */
void gonio_i_comments_drop(gonio_i_comments *comments, const char *key);

#endif
