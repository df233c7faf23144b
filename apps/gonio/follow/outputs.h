/* The files that a run writes again and again: the readings that count, and a plan of the rest. */
#ifndef GONIO_FOLLOW_OUTPUTS_H
#define GONIO_FOLLOW_OUTPUTS_H

#include "follower.h"

/* Writes the readings that count. Failures set the status of the run. */
void follow_save(follower *f);

/* Writes what is left to be read, in order, if that is wanted. */
void follow_save_remaining(follower *f);

#endif
