/* A text that is printed to memory and then written whole: see text_output.h. */
#include "text_output.h"
#include "../core/memory_stream.h"

#include <stdlib.h>

gonio_status gonio_i_text_open(gonio_context *context, gonio_i_text_output *output)
{
    *output = (gonio_i_text_output){0};
    output->stream = gonio_i_memory_stream(&output->text, &output->size);
    if (output->stream == NULL || !gonio_i_plain_numbers_begin(&output->plain)) {
        if (output->stream != NULL) {
            fclose(output->stream);
        }
        free(output->text);
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    return GONIO_OK;
}

static gonio_status write_all(gonio_context *context, const gonio_i_text_output *output,
                              const char *path)
{
    gonio_i_output file;
    gonio_status status = gonio_i_output_open(context, path, &file);
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, &file, output->text, output->size);
    }
    return gonio_i_output_close(context, &file, status);
}

gonio_status gonio_i_text_close(gonio_context *context, gonio_i_text_output *output,
                                const char *path, gonio_status status)
{
    const bool failed = ferror(output->stream) != 0;
    const bool closed = fclose(output->stream) == 0;
    gonio_i_plain_numbers_end(&output->plain);
    if (status == GONIO_OK && (failed || !closed)) {
        status = gonio_i_fail(context, GONIO_ERROR_MEMORY, "%s: out of memory", path);
    }
    if (status == GONIO_OK) {
        status = write_all(context, output, path);
    }
    free(output->text);
    return status;
}
