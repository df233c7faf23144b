/* What is said of a run: messages, progress, requests, and its end. */
#ifndef GONIO_FOLLOW_PROGRESS_H
#define GONIO_FOLLOW_PROGRESS_H

#include "follower.h"

__attribute__((format(printf, 3, 4))) void follow_say(follower *f, gonio_message_level level,
                                                      const char *format, ...);

/* Says an error, which ends the run. Returns the status. */
gonio_status follow_fail(follower *f, gonio_status status, const char *path, const char *text);

/* Asks who runs the instrument for a direction again. */
void follow_say_repeat(follower *f, size_t wanted, const char *why);

/* Says what the reader of the readings notes, each kind of note once. */
void follow_say_notes(follower *f, const gonio_readings_view *readings);

/* One line, if there is an instrument: what is to be read and how long that takes. */
void follow_show_beginning(follower *f);

/* One line: how far the run is. */
void follow_show_progress(follower *f);

/* Says how the run ended, in a line or as JSON. Returns an exit code. */
int follow_report(follower *f, ending end);

#endif
