/* Text files in the making: see text_file.h. */
#include "text_file.h"

#include <stdlib.h>

#include "run_folder.h"
#include "core/memory_stream.h"

static void release(gonio_i_text *text)
{
    if (text->stream != NULL) {
        fclose(text->stream);
    }
    if (text->plain != (locale_t)0) {
        uselocale(text->before);
        freelocale(text->plain);
    }
    free(text->text);
    *text = (gonio_i_text){0};
}

gonio_status gonio_i_text_begin(gonio_context *context, gonio_i_text *text)
{
    *text = (gonio_i_text){0};
    text->stream = gonio_i_memory_stream(&text->text, &text->size);
    text->plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (text->stream == NULL || text->plain == (locale_t)0) {
        release(text);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    text->before = uselocale(text->plain);
    return GONIO_OK;
}

gonio_status gonio_i_text_end(gonio_context *context, gonio_i_text *text, const char *folder,
                              const char *name, gonio_status status)
{
    char *path = gonio_i_format("%s/%s", folder, name);
    const bool whole = path != NULL && fflush(text->stream) == 0 && ferror(text->stream) == 0;
    if (status == GONIO_OK) {
        status = whole ? gonio_i_write_text(context, path, text->text)
                       : gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", name);
    }
    free(path);
    release(text);
    return status;
}
