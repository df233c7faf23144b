/* A text file in the making, with decimal points whatever the locale. */
#ifndef GONIO_REPRODUCE_TEXT_FILE_H
#define GONIO_REPRODUCE_TEXT_FILE_H

#include <locale.h>
#include <stdio.h>

#include "core/core.h"

typedef struct gonio_i_text {
    FILE *stream;
    char *text;
    size_t size;
    locale_t plain, before;
} gonio_i_text;

/* Begins a text; until its end the calling thread prints numbers plainly. Errors: _MEMORY. */
gonio_status gonio_i_text_begin(gonio_context *context, gonio_i_text *text);

/* If `status` is GONIO_OK, writes the file FOLDER/NAME; releases all in any case. Errors: _IO,
 * _MEMORY. */
gonio_status gonio_i_text_end(gonio_context *context, gonio_i_text *text, const char *folder,
                              const char *name, gonio_status status);

#endif
