/* A field g over the cells of a basis as a material. */
#ifndef GONIO_FIELD_H
#define GONIO_FIELD_H

#include <gonio/reconstruct.h>

/* The largest g: its exponential is finite. */
#define GONIO_I_LARGEST_LOG 600.0

/* As gonio_reconstruction_material, which calls it for a reconstruction with a field. */
gonio_status gonio_i_field_material(gonio_context *context, const gonio_basis *basis,
                                    const gonio_reconstruction *reconstruction, const char *name,
                                    gonio_material **material);

/* The value of a field (or of a deviation) in a column at any directions. */
double gonio_i_field_at(const gonio_basis *basis, const double *field, int channel,
                        gonio_half_difference at);

/* Directions whose rows are looked up at a time. */
enum { GONIO_I_PREDICTED = 512 };

/* As gonio_reconstruction_predict, value[count][columns], of a reconstruction with a field from a
 * basis of separate channels. Errors: _MEMORY. */
gonio_status gonio_i_predict_many(gonio_context *context, const gonio_basis *basis,
                                  const gonio_reconstruction *reconstruction,
                                  const gonio_pair *pairs, size_t count, double *value);

#endif
