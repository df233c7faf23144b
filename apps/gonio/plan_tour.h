/* A plan as an instrument makes it, in the order of its lines: settings, times, and what they are
 * spent on. */
#ifndef GONIO_PLAN_TOUR_H
#define GONIO_PLAN_TOUR_H

#include <gonio/instrument.h>
#include <gonio/measurement.h>
#include <jansson.h>
#include <stdio.h>

#include "command_line.h"

typedef struct plan_tour {
    const gonio_readings *plan; /* the caller's */
    size_t count;
    gonio_setting *setting; /* [count] */
    double *time;           /* [count], s: the end of each reading */
    double duration;        /* s, which are spent on the next four: */
    double exposures;
    double moves;
    double incidence_changes;
    double references;
    size_t changes; /* of incidence */
    size_t unlike;  /* lines whose axes do not read their angles, */
    size_t line;    /* and the first of them */
} plan_tour;

/* Finds the tour of a plan: at the positions of its columns axis_NAME_deg if it has them for all
 * axes, otherwise at the settings that are reached soonest. To be freed in any case. Errors:
 * _MISMATCH for directions that the instrument cannot read, with what keeps them out; those of
 * reading `path` again. */
gonio_status plan_tour_make(tool *t, const gonio_instrument *instrument, const gonio_readings *plan,
                            const char *path, plan_tour *tour);
void plan_tour_free(plan_tour *tour);

/* Prints how long it takes and warns of lines whose axes do not read their angles. */
void plan_tour_print(tool *t, FILE *stream, const char *path, const plan_tour *tour);

/* The same as JSON; the caller's. */
json_t *plan_tour_json(const char *path, const plan_tour *tour);

/* Draws FOLDER/tour.svg, .pdf and .png: the positions of the axes over time. Errors: those of
 * figures. */
gonio_status plan_tour_draw(gonio_context *context, const gonio_instrument *instrument,
                            const plan_tour *tour, const char *folder);

#endif
