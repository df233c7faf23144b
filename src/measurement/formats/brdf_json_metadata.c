/* The metadata of BRDF JSON, within the published schema: written from what gonio knows of
 * readings, and comments read back. */
#include <stdlib.h>
#include <string.h>

#include "brdf_json.h"
#include "json_text.h"
#include "../../core/memory_stream.h"

static const char schema[] = "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/"
                             "BRDF_JSON_schema/brdf_json_schema_v1.0.json";

/* ---- writing ---- */

static void print_text(FILE *stream, const char *text)
{
    char *printed = gonio_i_json_quote(text);
    fputs(printed != NULL ? printed : "\"\"", stream);
    free(printed);
}

/* The lines of the comments as one text, which the caller frees. NULL: out of memory. */
static char *join(const gonio_i_comments *comments)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gonio_i_memory_stream(&text, &size);
    if (stream == NULL) {
        return NULL;
    }
    const char *between = "";
    for (size_t k = 0; k < comments->count; k++) {
        const char *line = comments->line[k];
        if (strncmp(line, "program:", 8) != 0 && strncmp(line, "command:", 8) != 0) {
            fprintf(stream, "%s%s", between, line);
            between = "\n";
        }
    }
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

bool gonio_i_brdf_json_print_metadata(const gonio_readings *readings, const char *command,
                                      FILE *stream)
{
    char *comments = join(&readings->comment);
    if (comments == NULL) {
        return false;
    }
    fprintf(stream,
            "  \"metadata\": {\n    \"schema\": \"%s\",\n    \"type\": \"BRDF\",\n    "
            "\"software\": {\"name\": \"gonio\", \"version\": ",
            schema);
    print_text(stream, gonio_version());
    if (command != NULL) {
        fputs(", \"comments\": ", stream);
        print_text(stream, command);
    }
    fputs("}", stream);
    if (*comments != '\0') {
        fputs(",\n    \"comments\": ", stream);
        print_text(stream, comments);
    }
    fputs("\n  },\n", stream);
    free(comments);
    return true;
}

/* ---- reading ---- */

static bool is_own(const json_t *metadata)
{
    const json_t *software = gonio_i_json_member(metadata, "software");
    const char *name = json_string_value(gonio_i_json_member(software, "name"));
    return name != NULL && strcmp(name, "gonio") == 0;
}

gonio_status gonio_i_brdf_json_read_comments(const gonio_i_readings_file *file, const json_t *root,
                                             gonio_readings *readings)
{
    const json_t *metadata = gonio_i_json_member(root, "metadata");
    const char *line = json_string_value(gonio_i_json_member(metadata, "comments"));
    bool done = true;
    while (done && is_own(metadata) && line != NULL) {
        const size_t length = strcspn(line, "\n");
        done = gonio_i_comments_add_text(&readings->comment, line, length);
        line = line[length] != '\0' ? line + length + 1 : NULL;
    }
    return done ? GONIO_OK
                : gonio_i_fail(file->context, GONIO_ERROR_MEMORY, "%s: out of memory", file->path);
}
