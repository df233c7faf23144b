/* Predicts a material in the plane of incidence from a few readings, with its uncertainty.
 *
 *     predict_with_deviations BASIS
 *
 * BASIS is from learn_and_plan. A simulated instrument reads a built-in material. */
#include <gonio/gonio.h>

#include <math.h>
#include <stdio.h>

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

/* The median of the green channel and its band of two deviations: the deviation is one of
 * ln(1 + rho/s). */
static void print_bands(const gonio_basis *basis, const gonio_reconstruction *made)
{
    const double s = gonio_log_scale(1);
    printf("theta_o   rho, 1/sr   from .. to (95 %%)\n");
    for (double theta_o = 0.0; theta_o < 80.0; theta_o += 10.0) {
        const gonio_pair pair = {{radians(45.0), 0.0}, {radians(theta_o), M_PI}};
        double value[3];
        double deviation[3];
        gonio_reconstruction_predict(basis, made, gonio_half_difference_from_pair(pair), value,
                                     deviation);
        const double g = log1p(value[1] / s);
        printf("%7.0f %11.4f   %.4f .. %.4f\n", theta_o, value[1],
               s * expm1(fmax(g - 2.0 * deviation[1], 0.0)), s * expm1(g + 2.0 * deviation[1]));
    }
}

int main(int argc, char **argv)
{
    gonio_context *context = NULL;
    gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    gonio_readings *readings = NULL;
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    gonio_reconstruction *made = NULL;
    const gonio_context_options talk = {.size = sizeof talk, .message = show};
    gonio_plan_options where;
    gonio_plan_options_default(&where);
    where.count = 8;
    gonio_instrument_options instrument;
    gonio_instrument_options_default(&instrument);
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.deviation = true;

    const bool done =
        argc == 2 && gonio_context_create(&context, &talk) == GONIO_OK &&
        gonio_basis_read(context, argv[1], &basis) == GONIO_OK &&
        gonio_plan_create(context, basis, &where, &plan) == GONIO_OK &&
        gonio_readings_create_from_plan(context, plan, &readings) == GONIO_OK &&
        gonio_material_open(context, "atlas:red-glossy-plastic", &material) == GONIO_OK &&
        gonio_table_load(context, material, &table) == GONIO_OK &&
        gonio_measure(context, readings, table, &instrument) == GONIO_OK &&
        gonio_reconstruct(context, basis, readings, &how, &made) == GONIO_OK;
    if (done) {
        print_bands(basis, made);
    }
    gonio_reconstruction_free(&made);
    gonio_table_free(&table);
    gonio_material_free(&material);
    gonio_readings_free(&readings);
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return done ? 0 : 1;
}
