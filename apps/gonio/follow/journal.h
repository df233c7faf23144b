/* The journal of a run: a file to which records are only appended. Each is on the disk before the
 * run goes on, so that whatever ends the program, a record that was appended is there when it is
 * started again. A record is a line: eight digits that check it, a word for its kind, and a text.
 * A last line that was not written whole is cut off. */
#ifndef GONIO_FOLLOW_JOURNAL_H
#define GONIO_FOLLOW_JOURNAL_H

#include <gonio/context.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct journal journal;

/* Takes a record, when a journal is read again. text has no line end. Returns a status that ends
 * the reading unless it is GONIO_OK. */
typedef gonio_status (*journal_reader)(void *user, const char *kind, const char *text);

/* What was found of an earlier run. */
typedef struct journal_found {
    size_t records;
    size_t cut;     /* bytes of a last line that was not whole */
    size_t damaged; /* lines that are not as they were written, and are passed over */
} journal_found;

/* Opens a journal, or makes it. Hands the records that it has to `reader`, in order. One program at
 * a time has it open. Errors: _IO; _FORMAT for a file that is no journal; those of `reader`. */
gonio_status journal_open(const char *path, journal_reader reader, void *user, journal_found *found,
                          journal **opened, char **problem);
void journal_close(journal **j);

/* Appends records, which are on the disk at the next flush. False if that fails: errno. */
bool journal_append(journal *j, const char *kind, const char *text);
bool journal_flush(journal *j);

#endif
