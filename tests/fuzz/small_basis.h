/* A basis of a few cells, learned from three made-up materials that have data in no others. */
#ifndef FUZZ_SMALL_BASIS_H
#define FUZZ_SMALL_BASIS_H

#include "fuzz.h"

enum { SMALL_MATERIALS = 3 };

/* Data in one cell of `step` squared; brighter towards theta_h = 0, each in its own way. */
typedef struct small_material {
    double width;
    int step;
} small_material;

static inline gonio_status small_slab(void *self, gonio_context *context, int theta_h, double *rho)
{
    const small_material *m = self;
    (void)context;
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const gonio_bin bin = {theta_h, k / GONIO_PHI_D_BINS, k % GONIO_PHI_D_BINS};
        const bool data =
            bin.theta_h % m->step == 0 && bin.theta_d % m->step == 0 && gonio_bin_is_valid(bin);
        const double lobe = exp(-(double)(theta_h * theta_h) / (m->width * m->width));
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            rho[c * GONIO_SLAB_BINS + k] =
                data ? 0.1 + 0.05 * c + lobe * (1.0 + 0.01 * (bin.theta_d + c)) : -1.0;
        }
    }
    return GONIO_OK;
}

static inline gonio_basis *small_basis(gonio_representation representation,
                                       gonio_channel_model channels, int step, size_t mixtures)
{
    static small_material made[SMALL_MATERIALS] = {{3.0, 0}, {20.0, 0}, {60.0, 0}};
    static const char *const name[SMALL_MATERIALS] = {"a", "b", "c"};
    const gonio_database_options how = {
        .size = sizeof how, .representation = representation, .channels = channels};
    gonio_basis_options learning;
    gonio_material *material[SMALL_MATERIALS] = {NULL};
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    for (int k = 0; k < SMALL_MATERIALS; k++) {
        made[k].step = step;
        const gonio_material_source source = {
            .size = sizeof source, .read_slab = small_slab, .self = &made[k]};
        check(gonio_material_create(NULL, name[k], "made", &source, &material[k]) == GONIO_OK,
              "a material is made");
    }
    check(gonio_database_create_from_materials(NULL, (const gonio_material *const *)material,
                                               SMALL_MATERIALS, &how, &database) == GONIO_OK,
          "a database is made");
    gonio_basis_options_default(&learning);
    learning.components = 2;
    learning.mixtures = mixtures;
    check(gonio_basis_learn(NULL, database, &learning, &basis) == GONIO_OK, "a basis is learned");
    gonio_database_free(&database);
    for (int k = 0; k < SMALL_MATERIALS; k++) {
        gonio_material_free(&material[k]);
    }
    return basis;
}

#endif
