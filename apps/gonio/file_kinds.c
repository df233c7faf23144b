/* What a file on the command line is: see file_kinds.h. */
#include "file_kinds.h"

#include <stdio.h>
#include <string.h>

bool tool_is_readings(const char *path)
{
    char head[8192];
    FILE *file = strncmp(path, "atlas:", 6) != 0 ? fopen(path, "rbe") : NULL;
    const size_t size = file != NULL ? fread(head, 1, sizeof head, file) : 0;
    if (file != NULL) {
        fclose(file);
    }
    const bool hdf5 = size >= 4 && memcmp(head, "\211HDF", 4) == 0;
    return size > 0 && !hdf5 && memchr(head, '\0', size) == NULL;
}
