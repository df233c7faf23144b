/* A run that is followed: its state, which the files of this folder share. */
#ifndef GONIO_FOLLOW_FOLLOWER_H
#define GONIO_FOLLOW_FOLLOWER_H

#include "../planning_options.h"
#include "follow.h"
#include "journal.h"
#include "judge.h"
#include "line_source.h"
#include "run.h"

/* Why a run ended. */
typedef enum ending {
    GOING_ON,
    ALL_READ,
    TARGET_MET,
    TIME_UP,
    INPUT_ENDED,
    NOTHING_CAME,
    INTERRUPTED
} ending;

/* Values beyond which a reading is unusual, 1/sr. */
typedef struct follow_limits {
    double saturation; /* this or more; infinite: none */
    double dark;       /* below this */
    double lit;        /* at most this: no light */
} follow_limits;

typedef struct follower {
    tool *t;
    const follow_options *o;
    run run;
    judge judge;
    judge_verdict verdict;
    gonio_basis *basis;
    planning_inputs inputs;
    journal *journal;
    char *journal_path;
    line_source source;
    uint64_t plan;        /* fingerprint of the plan, */
    uint64_t plan_basis;  /* fingerprint of the basis that the plan states */
    uint64_t plan_before; /* and of that of the journal; 0: there was none */
    double began;         /* the clock at the beginning, */
    double before;        /* and the seconds that earlier parts of the run took */
    double budget;        /* seconds; infinite: none */
    double target;        /* per cent; 0: none */
    double idle;          /* seconds without a line after which it ends; 0: not given */
    double idle_since;
    gonio_setting place; /* of the axes after the first `placed` rows */
    size_t placed;
    follow_limits limits;
    size_t at_dark;       /* readings at the dark level of the instrument, */
    size_t dark_in_a_row; /* and how many came last */
    size_t adapted_at;    /* rows when the rest was planned last */
    size_t fresh;         /* rows that are not judged yet */
    size_t failures;      /* of the command, one after another */
    bool said_waiting;
    uint64_t *said; /* [said_count]: kinds of notes on the readings that were said */
    size_t said_count;
    size_t outside; /* readings at no direction of the plan, of which the first few are told */
    bool said_pending;
    bool said_repeats;
    bool said_values;
    gonio_status status; /* of the run: what fails sets it, and the run ends */
} follower;

/* Seconds of the run so far, pauses left out. */
double follow_elapsed(const follower *f);

/* Seconds without a line after which a run ends: for ever, unless it is given or only repeats are
 * left. */
double follow_patience(const follower *f);

#endif
