/* Random numbers: see random.h. */
#include "random.h"

#include <math.h>

static uint64_t split_mix(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

void gonio_i_random_seed(gonio_i_random *random, uint64_t seed, uint64_t stream)
{
    uint64_t state = seed;
    uint64_t mixed = split_mix(&state) ^ (stream * UINT64_C(0xd1342543de82ef95));
    for (int k = 0; k < 4; k++) {
        random->state[k] = split_mix(&mixed);
    }
}

static uint64_t rotate_left(uint64_t x, int k)
{
    return (x << k) | (x >> (64 - k));
}

uint64_t gonio_i_random_next(gonio_i_random *random)
{
    uint64_t *s = random->state;
    const uint64_t result = rotate_left(s[1] * 5, 7) * 9;
    const uint64_t t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate_left(s[3], 45);
    return result;
}

uint64_t gonio_i_random_below(gonio_i_random *random, uint64_t n)
{
    const uint64_t unbiased = UINT64_MAX - UINT64_MAX % n;
    uint64_t x = gonio_i_random_next(random);
    while (x >= unbiased) {
        x = gonio_i_random_next(random);
    }
    return x % n;
}

double gonio_i_random_uniform(gonio_i_random *random)
{
    return ((double)(gonio_i_random_next(random) >> 11) + 0.5) * 0x1p-53;
}

double gonio_i_random_normal(gonio_i_random *random)
{
    const double radius = sqrt(-2.0 * log(gonio_i_random_uniform(random)));
    return radius * cos(2.0 * M_PI * gonio_i_random_uniform(random));
}

void gonio_i_random_subset(gonio_i_random *random, size_t n, size_t count, unsigned char *used,
                           size_t *subset)
{
    /* Floyd's algorithm: one number drawn for each chosen. */
    for (size_t j = n - count; j < n; j++) {
        const size_t drawn = (size_t)gonio_i_random_below(random, j + 1);
        used[used[drawn] ? j : drawn] = 1;
    }
    size_t k = 0;
    for (size_t j = 0; j < n; j++) {
        if (used[j]) {
            subset[k++] = j;
        }
    }
}
