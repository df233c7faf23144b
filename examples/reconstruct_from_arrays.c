/* Reconstructs a whole BRDF from readings that are arrays in memory.
 *
 *     reconstruct_from_arrays BASIS MATERIAL
 *
 * BASIS is from learn_and_plan; MATERIAL is the MERL table that it writes. */
#include <gonio/gonio.h>

#include <math.h>
#include <stdio.h>

enum { READINGS = 6, CHANNELS = 3 };

static void show(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

static double radians(double degrees)
{
    return degrees * M_PI / 180.0;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: reconstruct_from_arrays BASIS MATERIAL\n");
        return 2;
    }
    /* theta_i, theta_o, phi_o in degrees, phi_i is 0; then R, G, B in 1/sr: a red gloss paint. */
    static const double read[READINGS][6] = {
        {15, 15, 180, 0.55, 0.46, 0.45}, {30, 20, 180, 0.24, 0.14, 0.13},
        {45, 0, 0, 0.15, 0.05, 0.04},    {60, 40, 90, 0.15, 0.05, 0.04},
        {60, 60, 180, 1.15, 1.05, 1.00}, {75, 30, 0, 0.14, 0.05, 0.04}};
    gonio_pair pair[READINGS];
    double value[READINGS][CHANNELS];
    for (int k = 0; k < READINGS; k++) {
        pair[k] =
            (gonio_pair){{radians(read[k][0]), 0.0}, {radians(read[k][1]), radians(read[k][2])}};
        for (int c = 0; c < CHANNELS; c++) {
            value[k][c] = read[k][3 + c];
        }
    }
    const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                          .count = READINGS,
                                          .channels = CHANNELS,
                                          .pair = pair,
                                          .value = value[0]};
    gonio_context *context = NULL;
    gonio_basis *basis = NULL;
    gonio_readings *readings = NULL;
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    const gonio_context_options talk = {.size = sizeof talk, .message = show};
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.method = "posterior"; /* works with any number of readings at any directions */

    const bool done =
        gonio_context_create(&context, &talk) == GONIO_OK &&
        gonio_basis_read(context, argv[1], &basis) == GONIO_OK &&
        gonio_readings_create(context, &arrays, NULL, &readings) == GONIO_OK &&
        gonio_reconstruct(context, basis, readings, &how, &made) == GONIO_OK &&
        gonio_reconstruction_material(context, basis, made, "red-gloss", &material) == GONIO_OK &&
        gonio_material_write_merl(context, material, argv[2]) == GONIO_OK;
    if (done) {
        printf("%s from %d readings; expected error (E6) %.1f %%\n", argv[2], READINGS,
               made->predicted_e6);
    }
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return done ? 0 : 1;
}
