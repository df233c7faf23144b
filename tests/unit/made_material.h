/* Materials made for the tests. */
#ifndef MADE_MATERIAL_H
#define MADE_MATERIAL_H

#include <stdlib.h>
#include <string.h>

#include <gonio/gonio.h>

/* The same in all valid bins, but for holes without data. */
typedef struct made_constant {
    double rho[GONIO_CHANNELS];
    bool (*is_hole)(gonio_bin bin); /* NULL for none */
} made_constant;

static gonio_status made_read_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    const made_constant *made = self;
    (void)context;
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const bool data = gonio_bin_is_valid(bin) && (made->is_hole == NULL || !made->is_hole(bin));
        for (int channel = 0; channel < GONIO_CHANNELS; channel++) {
            rho[channel * GONIO_SLAB_BINS + k] = data ? made->rho[channel] : -1.0;
        }
    }
    return GONIO_OK;
}

static inline gonio_material *made_material(made_constant values)
{
    gonio_material *material = NULL;
    made_constant *self = malloc(sizeof *self);
    assert_non_null(self);
    *self = values;
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = made_read_slab, .release = free, .self = self};
    assert_int_equal(gonio_material_create(NULL, "made", "made for a test", &source, &material),
                     GONIO_OK);
    return material;
}

static inline gonio_table *made_table(const gonio_material *material)
{
    gonio_table *table = NULL;
    assert_int_equal(gonio_table_load(NULL, material, &table), GONIO_OK);
    return table;
}

#endif
