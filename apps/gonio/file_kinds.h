/* What a file on the command line is. */
#ifndef GONIO_FILE_KINDS_H
#define GONIO_FILE_KINDS_H

#include <stdbool.h>

/* Whether a file is a plan or readings, by its content: text. */
bool tool_is_readings(const char *path);

#endif
