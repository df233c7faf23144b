/* The two halves of phi_d in MERL tables of 360 bins: phi_d and phi_d + pi are the same sample with
 * light and detector exchanged. full[GONIO_THETA_D_BINS][GONIO_I_MERL_FULL_CIRCLE] is the plane of
 * a channel and a theta_h, as stored. */
#ifndef GONIO_MERL_HALVES_H
#define GONIO_MERL_HALVES_H

#include <gonio/material.h>

enum { GONIO_I_MERL_FULL_CIRCLE = 2 * GONIO_PHI_D_BINS };

/* half[GONIO_THETA_D_BINS][GONIO_PHI_D_BINS]: the mean over the halves that have data; -1 without
 * data. */
void gonio_i_merl_fold(const double *full, double *half);

/* Sums over bins with data in both halves, begun with zeros. */
typedef struct gonio_i_merl_halves {
    double difference; /* squares of differences */
    double mean;       /* squares of means */
} gonio_i_merl_halves;

/* Adds a plane, whose numbers are 1/sr when they are scaled. */
void gonio_i_merl_compare_halves(const double *full, double scale, gonio_i_merl_halves *halves);

/* RMS of the difference as a share of the RMS of the mean; 0 without data. */
double gonio_i_merl_difference(const gonio_i_merl_halves *halves);

#endif
