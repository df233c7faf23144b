/* The settings of an instrument at which a run's directions are read: what cannot be read, how long
 * the rest takes, and its order. */
#ifndef GONIO_FOLLOW_SETTINGS_H
#define GONIO_FOLLOW_SETTINGS_H

#include "follower.h"

/* Finds the setting that reads a direction soonest after another one: as it is, otherwise turned
 * about the normal, otherwise its mirror image. False if the instrument has none. */
bool follow_setting(const follower *f, const double degrees[4], const gonio_setting *from,
                    gonio_setting *setting);

/* Where the axes are: at the direction that was read last, otherwise where a run starts from. */
void follow_place(follower *f, gonio_setting *place);

/* Seconds that the directions that are left take, with travel, changes of incidence and references.
 * NaN without an instrument. */
double follow_time_left(follower *f);

/* Seconds that the next direction takes, 0 if none is left. NaN without an instrument. */
double follow_time_of_next(follower *f);

/* The axes' positions for a direction in degrees, of the axes that the instrument has:
 * position[GONIO_MOST_AXES]. Returns how many; 0 without an instrument. */
size_t follow_positions(follower *f, const double degrees[4], double *position);

/* Says so if a plan names another instrument than the run does. */
void follow_note_instrument(follower *f, const gonio_readings *plan);

/* Checks that the directions of the plan can be read. Errors: _MISMATCH, with a message that
 * names the first. */
gonio_status follow_check_reach(follower *f);

/* Puts directions into the order of least time from where the axes are. degrees[count][4]. Errors:
 * _MEMORY, _CANCELLED. */
gonio_status follow_order(follower *f, double (*degrees)[4], size_t count);

#endif
