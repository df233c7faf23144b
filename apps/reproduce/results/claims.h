/* The paper's claims, the results, and whether they agree, by stated rules. */
#ifndef GONIO_REPRODUCE_CLAIMS_H
#define GONIO_REPRODUCE_CLAIMS_H

#include "summary.h"

typedef enum gonio_i_verdict {
    GONIO_I_AGREES,
    GONIO_I_DIFFERS,
    GONIO_I_NOT_TESTED /* these materials or this run do not have it */
} gonio_i_verdict;

typedef struct gonio_i_claim {
    gonio_i_experiment experiment;
    char *what;
    char *paper; /* what the paper says */
    char *found;
    double value; /* found, as a number; NaN if it is not one number */
    const char *rule;
    gonio_i_verdict verdict;
} gonio_i_claim;

enum { GONIO_I_MOST_CLAIMS = 48 };

typedef struct gonio_i_claims {
    size_t count;
    gonio_i_claim claim[GONIO_I_MOST_CLAIMS];
    bool failed; /* out of memory */
} gonio_i_claims;

/* Those of the wanted experiments. To be freed in any case. Errors: _MEMORY. */
gonio_status gonio_i_make_claims(gonio_context *context, const gonio_i_study *study,
                                 const gonio_i_results *results, const gonio_i_findings *findings,
                                 gonio_i_claims *claims);
void gonio_i_claims_free(gonio_i_claims *claims);

/* "agrees", "differs", "not tested". */
const char *gonio_i_verdict_name(gonio_i_verdict verdict);

#endif
