/* The records of a run: what of it goes into the journal, and what comes back from there. */
#ifndef GONIO_FOLLOW_RECORDS_H
#define GONIO_FOLLOW_RECORDS_H

#include "follower.h"

/* Opens the journal and takes the run that it holds. Errors: those of journal_open, with a message.
 */
gonio_status follow_open_journal(follower *f);

/* Appends a record, which is on the disk at the next flush. Failures set the status of the run. */
__attribute__((format(printf, 3, 4))) void follow_record(follower *f, const char *kind,
                                                         const char *format, ...);
void follow_flush(follower *f);

#endif
