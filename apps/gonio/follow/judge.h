/* What the readings of a run say so far: the error to expect, readings that the others contradict,
 * and where to read next. */
#ifndef GONIO_FOLLOW_JUDGE_H
#define GONIO_FOLLOW_JUDGE_H

#include <gonio/reconstruct.h>

#include "run.h"

/* What is judged by. The basis is the caller's; NULL: nothing can be said. */
typedef struct judge {
    gonio_context *context; /* for errors and progress; */
    gonio_context *silent;  /* without notes */
    const gonio_basis *basis;
    gonio_reconstruct_options how;
    gonio_plan_options plan; /* of the rest */
} judge;

/* A reading that the others contradict. */
typedef struct judge_doubt {
    size_t row;
    double ratio; /* to what the others predict */
} judge_doubt;

typedef struct judge_verdict {
    double expected; /* E6, per cent; NaN: not known */
    size_t doubts;
    judge_doubt *doubt; /* [doubts], the caller's */
} judge_verdict;

/* Judges the rows that count. Readings that cannot be reconstructed from give an error of NaN, with
 * a message. Errors: _MEMORY, _CANCELLED. */
gonio_status judge_run(const judge *j, const run *r, judge_verdict *verdict);

/* Plans as many directions as are not read yet, given the readings so far, and puts them in the
 * place of these: gonio_plan_next. *degrees: what was planned, [count][4], which the caller frees.
 * Errors: _MEMORY, _CANCELLED, those of gonio_plan_next. */
gonio_status judge_plan(const judge *j, const run *r, double (**degrees)[4], size_t *count);

#endif
