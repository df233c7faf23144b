/* A run: what is wanted, what has come, and what of it counts.
 *
 * A run is a plan and the lines that arrived, in their order, and nothing else: lines read again
 * from a journal make the same run. Each line belongs to the direction of the plan that it was read
 * at, to within a degree; rotations about the normal and the mirror image in azimuth are the same
 * direction. A line that cannot be understood is kept in the journal and counted. */
#ifndef GONIO_FOLLOW_RUN_H
#define GONIO_FOLLOW_RUN_H

#include <gonio/measurement.h>
#include <jansson.h>

#include "wanted_places.h"

#define RUN_NOWHERE SIZE_MAX

/* A direction to read. */
typedef struct run_wanted {
    double degrees[4]; /* theta_i, phi_i, theta_o, phi_o */
    size_t row;        /* that read it last; RUN_NOWHERE: none */
    bool dropped;      /* another plan took the place of it */
    bool asked;        /* read again, please */
    bool asked_once;   /* it was asked for before */
} run_wanted;

/* A line that arrived and holds a reading, or one of the reference or the dark level. */
typedef struct run_row {
    char *text;
    size_t line;     /* of the file */
    double seconds;  /* since the run began, pauses left out */
    double time;     /* that the line states, seconds; NaN: none */
    size_t wanted;   /* its direction; RUN_NOWHERE: none of the plan */
    bool of_sample;  /* no reference and no dark level */
    bool set_aside;  /* another row took the place of it */
    size_t unlike;   /* an earlier row of its direction, of another value, that counts too;
                      * RUN_NOWHERE: none */
    gonio_pair pair; /* of the sample */
    size_t channels;
    double *value; /* [channels] */
} run_row;

/* What became of a line. */
typedef enum run_fate {
    RUN_KNOWN,   /* a comment, the names of columns, an empty line, or a line that came before */
    RUN_READING, /* a new row */
    RUN_COPY,    /* a row with the same text at another line: left out */
    RUN_UNCLEAR, /* not understood: run.problem says why */
    RUN_USELESS, /* the names of columns are not understood: nothing can be read */
} run_fate;

typedef struct run {
    gonio_context *context;     /* for errors of memory */
    const char *path;           /* for messages */
    gonio_readings_options how; /* to read lines with */
    run_wanted *wanted;         /* [wanted_count], in the order of the plan */
    size_t wanted_count;
    run_row *row; /* [rows], in the order in which they came */
    size_t rows;
    size_t rows_room;
    char *head;           /* comments and names of columns, with line ends; "" so far */
    char *names;          /* the line of names; NULL so far */
    json_t *seen;         /* by "LINE:TEXT": all lines but comments */
    json_t *text;         /* by text: the last row that has it */
    wanted_places places; /* of `wanted` */
    size_t asked;         /* how many directions are asked for */
    size_t unread;        /* the first direction that was never read nor dropped */
    double latest;        /* the last time that a row stated, seconds; NaN: none so far */
    size_t unclear;
    size_t copies;
    size_t backwards; /* rows whose time is before that of the row before */
    size_t unordered; /* rows that came before their turn */
    double seconds;   /* of the row that came last */
    char *problem;    /* of the last line that was not understood */
} run;

/* Begins a run of a plan. To be ended in any case. Errors: _MEMORY. */
gonio_status run_begin(run *r, const gonio_readings *plan, const gonio_readings_options *how,
                       const char *path);
void run_end(run *r);

/* Takes a line. *status: _MEMORY, or GONIO_OK. */
run_fate run_take(run *r, size_t line, double seconds, const char *text, gonio_status *status);

/* Puts other directions in the place of those that were not read. degrees[count][4]. Errors:
 * _MEMORY. */
gonio_status run_replace(run *r, const double (*degrees)[4], size_t count);

/* Asks for a direction once more, once. Returns whether it was not asked for before. */
bool run_ask(run *r, size_t wanted);

/* How many directions are to be read, those that are asked for again included. And the next one;
 * RUN_NOWHERE if none is left: first those asked for again. */
size_t run_left(const run *r);
size_t run_next(const run *r);

/* Directions that were never read. */
size_t run_unread(const run *r);

/* The directions that are to be read, in order: wanted[run_left]. Returns how many. */
size_t run_list_open(const run *r, size_t *wanted);

/* Rows that count as readings of the sample. */
size_t run_counted(const run *r);

/* Directions that were read, and rows that others took the place of. */
size_t run_directions_read(const run *r);
size_t run_set_aside(const run *r);

/* The mean time of a reading, seconds; NaN: not known. Lines that come together say nothing of it.
 */
double run_reading_time(const run *r);

/* The readings that count, as the text of a file: head and rows; the caller frees it. line_row, if
 * not NULL, [rows + lines of the head + 1] is filled with the row of each line of the text, from 1.
 * NULL when out of memory. */
char *run_text(const run *r, size_t *size, size_t **line_row);

/* A number for the directions of a plan: the same for the same plan. */
uint64_t run_fingerprint(const gonio_readings *plan);

#endif
