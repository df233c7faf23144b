/* Where readings come from: a file that grows, standard input, or a command. Each line is taken the
 * same way: into the journal first. */
#ifndef GONIO_FOLLOW_SOURCES_H
#define GONIO_FOLLOW_SOURCES_H

#include "follower.h"

/* Takes what the file has that is new, or waits a moment. INPUT_ENDED: no more will come. */
ending follow_take_from_file(follower *f);

/* Has the command read the next direction. */
ending follow_take_from_command(follower *f);

#endif
