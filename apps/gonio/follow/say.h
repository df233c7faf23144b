/* Messages of a run: errors, requests and notes. */
#ifndef GONIO_FOLLOW_SAY_H
#define GONIO_FOLLOW_SAY_H

#include "follower.h"

__attribute__((format(printf, 3, 4))) void follow_say(follower *f, gonio_message_level level,
                                                      const char *format, ...);

/* Says an error, which ends the run. Returns the status. */
gonio_status follow_fail(follower *f, gonio_status status, const char *path, const char *text);

/* Asks who runs the instrument for a direction again. */
void follow_say_repeat(follower *f, size_t wanted, const char *why);

/* Says what the reader of the readings notes, each kind of note once. */
void follow_say_notes(follower *f, const gonio_readings_view *readings);

#endif
