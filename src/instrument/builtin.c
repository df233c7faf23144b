/* The instruments that come with the library: the files of data/instruments. To add one, write a
 * file there, and add a line here and in builtin_files.S. */
#include "builtin.h"

#include <string.h>

#include <gonio/instrument.h>

#define FILES(FILE)                                                                                \
    FILE(in_plane, "in-plane", "an in-plane goniometer: four incidences, a detector on an arc")    \
    FILE(two_arms, "two-arms",                                                                     \
         "a hemispherical scatterometer with a light arm and a detector arm")                      \
    FILE(four_axis, "four-axis", "a fixed light, a sample on three axes and a turning detector")

#define DECLARE(symbol, word, summary)                                                             \
    extern const char gonio_i_file_##symbol[];                                                     \
    extern const char gonio_i_file_##symbol##_end[];
FILES(DECLARE)

#define ENTRY(symbol, word, summary)                                                               \
    {word, summary, gonio_i_file_##symbol, gonio_i_file_##symbol##_end},
static const struct {
    const char *word;
    const char *summary;
    const char *begin;
    const char *end;
} files[] = {FILES(ENTRY)};

enum { COUNT = sizeof files / sizeof *files };

const char *gonio_i_builtin_instrument(const char *word, size_t *size)
{
    for (int k = 0; k < COUNT; k++) {
        if (strcmp(files[k].word, word) == 0) {
            *size = (size_t)(files[k].end - files[k].begin);
            return files[k].begin;
        }
    }
    return NULL;
}

const char *gonio_instrument_word(int index)
{
    return index >= 0 && index < COUNT ? files[index].word : NULL;
}

const char *gonio_instrument_summary(int index)
{
    return index >= 0 && index < COUNT ? files[index].summary : NULL;
}
