/* How far a run is, and how it ended. */
#ifndef GONIO_FOLLOW_PROGRESS_H
#define GONIO_FOLLOW_PROGRESS_H

#include "follower.h"

/* One line, if there is an instrument: what is to be read and how long that takes. */
void follow_show_beginning(follower *f);

/* One line: how far the run is. */
void follow_show_progress(follower *f);

/* Says how the run ended, in a line or as JSON. Returns an exit code. */
int follow_report(follower *f, ending end);

#endif
