/* Random numbers: xoshiro256** (Blackman and Vigna 2018), seeded by SplitMix64; the same seed gives
 * the same numbers everywhere. */
#ifndef GONIO_RANDOM_H
#define GONIO_RANDOM_H

#include <stddef.h>
#include <stdint.h>

typedef struct gonio_i_random {
    uint64_t state[4];
} gonio_i_random;

/* `stream` gives independent sequences for one seed (restarts, directions ...). */
void gonio_i_random_seed(gonio_i_random *random, uint64_t seed, uint64_t stream);
uint64_t gonio_i_random_next(gonio_i_random *random);

/* Uniform in 0 .. n - 1, without bias; n > 0. */
uint64_t gonio_i_random_below(gonio_i_random *random, uint64_t n);

/* Uniform in (0, 1). */
double gonio_i_random_uniform(gonio_i_random *random);

/* Standard normal (Box and Muller 1958). */
double gonio_i_random_normal(gonio_i_random *random);

/* `count` different numbers below n, in ascending order; count <= n. `used` is scratch of n zeroed
 * bytes. */
void gonio_i_random_subset(gonio_i_random *random, size_t n, size_t count, unsigned char *used,
                           size_t *subset);

#endif
