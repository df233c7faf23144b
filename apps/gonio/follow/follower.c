/* The clock of a run that is followed: see follower.h. */
#include "follower.h"

#include <math.h>

#include "../duration.h"

/* Seconds that repeats are waited for, at least, and in times of a reading. */
static const double LEAST_PATIENCE = 60.0;
static const double PATIENCE = 10.0;

double follow_elapsed(const follower *f)
{
    return f->before + tool_seconds() - f->began;
}

double follow_patience(const follower *f)
{
    if (f->idle > 0.0) {
        return f->idle;
    }
    return run_unread(&f->run) == 0 ? fmax(LEAST_PATIENCE, PATIENCE * run_reading_time(&f->run))
                                    : (double)INFINITY;
}
