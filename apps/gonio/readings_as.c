/* The option --as: see readings_as.h. */
#include "readings_as.h"

#include <stdlib.h>
#include <string.h>

const char *tool_as;

/* An item of the list. */
typedef struct item {
    const char *file; /* as typed, not ended; NULL: no name */
    size_t file_length;
    const char *text;
    size_t length;
} item;

/* The item at the beginning of a text. Its last colon ends the name of a file. */
static item item_at(const char *at)
{
    item i = {.text = at, .length = strcspn(at, ",")};
    const char *colon = memrchr(at, ':', i.length);
    if (colon != NULL) {
        i.file = at;
        i.file_length = (size_t)(colon - at);
        i.text = colon + 1;
        i.length -= i.file_length + 1;
    }
    return i;
}

static bool is_named(const item *i, const char *path)
{
    return strlen(path) == i->file_length && strncmp(i->file, path, i->file_length) == 0;
}

/* Whether an argument or another option has this name. */
static bool is_on_command_line(const tool *t, const item *i)
{
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    bool found = false;
    for (size_t k = 0; k < count; k++) {
        found = found || is_named(i, arguments[k]);
    }
    for (const struct poptOption *o = t->table; o->longName != NULL || o->arg != NULL; o++) {
        const bool text = (o->argInfo & POPT_ARG_MASK) == POPT_ARG_STRING && o->arg != NULL;
        const char *value = text ? *(const char **)o->arg : NULL;
        found = found || (value != NULL && is_named(i, value));
    }
    return found;
}

/* Copies the items of a file, with commas between them, to list[strlen(tool_as) + 1]. t: NULL to
 * take any name of a file. */
static gonio_status list_items(const tool *t, const char *path, char *list)
{
    bool applies = true;
    size_t used = 0;
    for (const char *at = tool_as; *at != '\0';) {
        const item i = item_at(at);
        if (t != NULL && i.file != NULL && !is_on_command_line(t, &i)) {
            tool_refuse(t, "--as names '%.*s', which is none of the files", (int)i.file_length,
                        i.file);
            return GONIO_ERROR_ARGUMENT;
        }
        applies = i.file != NULL ? is_named(&i, path) : applies;
        if (applies) {
            list[used] = ',';
            used += used > 0;
            memcpy(list + used, i.text, i.length);
            used += i.length;
        }
        at = i.text + i.length;
        at += *at == ',';
    }
    list[used] = '\0';
    return GONIO_OK;
}

gonio_status tool_convention_of(const tool *t, const char *path, gonio_convention *as)
{
    char *list = tool_as != NULL ? malloc(strlen(tool_as) + 1) : NULL;
    if (list == NULL) {
        return tool_as != NULL ? GONIO_ERROR_MEMORY : GONIO_OK;
    }
    gonio_status status = list_items(t, path, list);
    if (status == GONIO_OK) {
        status = gonio_convention_parse(t->context, list, as);
    }
    free(list);
    return status;
}

bool tool_has_convention(const char *path)
{
    char *list = tool_as != NULL ? malloc(strlen(tool_as) + 1) : NULL;
    const bool has = list != NULL && list_items(NULL, path, list) == GONIO_OK && list[0] != '\0';
    free(list);
    return has;
}
