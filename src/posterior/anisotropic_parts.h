/* The parts of an anisotropic estimate (anisotropic.h), for the files that make and use them. */
#ifndef GONIO_ANISOTROPIC_PARTS_H
#define GONIO_ANISOTROPIC_PARTS_H

#include "anisotropic.h"

/* A solved column under a hypothesis. */
typedef struct gonio_i_solution {
    const gonio_i_sites *sites;
    const gonio_i_azimuth_point *azimuth; /* [n]: of the sites */
    gonio_i_fit fit;
    double *linear;   /* [K]: z + h^2 (1 - share) F' S^-1 (y - F z) */
    size_t samples;   /* that count */
    double *weight;   /* [samples]: q */
    double *move;     /* [samples][K]: a (z_j - z) */
    double *answered; /* [samples][n]: S^-1 a F (z_j - z) */
} gonio_i_solution;

typedef struct gonio_i_part {
    gonio_i_hypothesis hypothesis;
    gonio_i_sites **sites;           /* [columns]; the same where columns have the same readings */
    gonio_i_azimuth_point **azimuth; /* [columns]; the same */
    gonio_i_solution *solution;      /* [columns] */
} gonio_i_part;

struct gonio_i_anisotropic {
    gonio_context *context; /* of the call that makes it */
    const gonio_i_oriented_columns *given;
    const gonio_i_prior *prior;
    gonio_i_stretches stretches;
    size_t columns;
    size_t most; /* readings of a column */
    size_t parts;
    gonio_i_part part[GONIO_I_MOST_HYPOTHESES];
    size_t *outlying; /* [columns] */
    double *gain;     /* [columns]: in score, of setting outliers aside */
    bool judge;       /* outliers are wrong readings, and are set aside */
};

#endif
