/* Tensor trees of BSDF-XML: BRDFs of variable resolution, as Radiance makes them.
 *
 * The BRDF over a unit cube of 3 dimensions (isotropic) or 4. A box is divided in halves along all
 * dimensions at once where the resolution requires it. Directions are mapped from the unit disk to
 * the square by Shirley and Chiu's concentric map. 4: the incident direction as light travels
 * (towards the light + 180 degrees), then the outgoing one. 3: (1 - sin theta_i)/2, then the
 * outgoing direction, rotated so that light travels along azimuth 0. */
#ifndef GONIO_TENSOR_TREE_H
#define GONIO_TENSOR_TREE_H

#include <gonio/context.h>
#include <gonio/direction.h>

typedef struct gonio_i_tensor_tree gonio_i_tensor_tree;

/* Reads the text of a tree, {...} with 2^dimensions trees or 2^(dimensions n) numbers in it, the
 * last dimension fastest; of trees the first dimension is the lowest bit. Negative numbers are 0.
 * NULL, and *wrong what is wrong with it, for bad text, too many or too deep trees, or no memory.
 * Numbers have decimal points: the caller sees to the locale. */
gonio_i_tensor_tree *gonio_i_tensor_tree_read(const char *text, int dimensions, const char **wrong);
void gonio_i_tensor_tree_free(gonio_i_tensor_tree *tree);

/* The value at a pair of directions above the horizon, constant in each of the tree's boxes. */
double gonio_i_tensor_tree_value(const gonio_i_tensor_tree *tree, gonio_pair pair);

#endif
