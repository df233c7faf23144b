/* Anisotropic materials of formulas that neither the built-in materials nor a prior uses. Models
 * are judged by them: a prior of random materials knows the formulas of the built-in ones. */
#ifndef GONIO_BENCH_OTHER_GRAIN_H
#define GONIO_BENCH_OTHER_GRAIN_H

#include <stdbool.h>
#include <stddef.h>

#include <gonio/direction.h>

int other_grain_count(void);

/* NULL if the index is out of range. */
const char *other_grain_name(int index);

/* Whether it begins with other:. */
bool other_grain_is(const char *path);

/* Values of other:NAME, 1/sr, [count][3]; ends the program if there is none of the name. Values are
 * the same with the directions exchanged. */
void other_grain_values(const char *path, const gonio_pair *pair, size_t count, double *value);

#endif
