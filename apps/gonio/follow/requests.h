/* What a run asks for: repeats of readings that are doubted, and another plan of the rest. */
#ifndef GONIO_FOLLOW_REQUESTS_H
#define GONIO_FOLLOW_REQUESTS_H

#include "follower.h"

/* Asks for a direction again, the first time. */
void follow_ask(follower *f, size_t wanted, const char *why);

/* Asks for what the verdict doubts. */
void follow_ask_for_doubts(follower *f);

/* Plans the rest again if that is wanted and there are enough new readings. */
void follow_adapt(follower *f);

#endif
