/* The search for the columns of readings as CSV: see csv_finder.h. */
#include "csv_finder.h"

#include <string.h>

gonio_status gonio_i_csv_refuse_two(const gonio_i_csv_finder *f, const char *what, size_t a,
                                    size_t b)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: two columns of %s, '%s' and '%s'; delete or rename one", f->r->path,
                        what, f->r->name[a], f->r->name[b]);
}

gonio_status gonio_i_csv_agree(const gonio_i_csv_finder *f, const char *what, const char *key,
                               size_t k, int unit, int *stated, size_t *by)
{
    if (unit != 0 && *stated != 0 && unit != *stated) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: the %s of columns '%s' and '%s' differ in their unit; give one "
                            "unit, or state it by --as %s=...",
                            f->r->path, what, f->r->name[*by], f->r->name[k], key);
    }
    *by = unit != 0 ? k : *by;
    *stated = unit != 0 ? unit : *stated;
    return GONIO_OK;
}

/* The text after the key of a comment "key: ...", in any letter case; NULL for another key. */
static const char *text_behind(const char *comment, const char *key)
{
    const size_t length = strlen(key);
    const bool same = strncasecmp(comment, key, length) == 0 && comment[length] == ':';
    return same ? comment + length + 1 + strspn(comment + length + 1, " ") : NULL;
}

const char *gonio_i_csv_comment_of(const gonio_i_csv_finder *f, const char *const *keys)
{
    const char *text = NULL;
    for (size_t k = 0; k < f->r->comment.count && text == NULL; k++) {
        for (size_t j = 0; keys[j] != NULL && text == NULL; j++) {
            text = text_behind(f->r->comment.line[k], keys[j]);
        }
    }
    return text;
}
