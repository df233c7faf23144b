/* The option --as: what the numbers of files of readings stand for. */
#ifndef GONIO_READINGS_AS_H
#define GONIO_READINGS_AS_H

#include "command_line.h"

/* The list as it was typed; NULL without the option. Items are separated by commas. One that begins
 * with a file's name and a colon, and those after it, are of that file alone:
 * "values=factor,scan.txt:format=fred,angles=radians". */
extern const char *tool_as;
#define TOOL_READINGS_OPTIONS                                                                      \
    {                                                                                              \
        "as", '\0', POPT_ARG_STRING, &tool_as, 0,                                                  \
            "Units and conventions of readings, where gonio takes them wrongly: "                  \
            "angles=degrees|radians|gon, values=brdf|factor|percent|cosine|factor-cosine|"         \
            "relative|counts, scale=linear|log10|ln|db, "                                          \
            "mirror=180|0, "                                                                       \
            "wavelengths=nm|um|m, zeros=missing|dark, sample=NUMBER, format=NAME; separated by "   \
            "commas; FILE: before a word begins those of one file",                                \
            "LIST"                                                                                 \
    }

/* Sets what --as says of a file. Errors: _ARGUMENT, also for a file that the command line does not
 * name otherwise; _MEMORY. */
gonio_status tool_convention_of(const tool *t, const char *path, gonio_convention *as);

/* Whether --as says anything of a file. */
bool tool_has_convention(const char *path);

#endif
