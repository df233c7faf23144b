/* Reads a material one direction at a time, the best next one each time, until the error to expect
 * is small enough.
 *
 *     next_in_a_loop BASIS
 *
 * BASIS is from learn_and_plan. read_at() stands for an instrument. */
#include <gonio/gonio.h>

#include <stdio.h>

enum { MOST = 12, CHANNELS = 3 };
static const double target = 5.0; /* E6, per cent */

static void show(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

static void read_at(const gonio_table *sample, gonio_pair at, double value[CHANNELS])
{
    gonio_table_value(sample, gonio_half_difference_from_pair(at), value);
}

/* Reads and asks what to read next; `pair` has the first direction. */
static gonio_status measure(gonio_context *context, const gonio_basis *basis,
                            const gonio_table *sample, gonio_pair *pair)
{
    double value[MOST][CHANNELS];
    gonio_plan_options one;
    gonio_plan_options_default(&one);
    one.count = 1;
    one.target = target;
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    gonio_status status = GONIO_OK;
    bool more = true;
    for (size_t n = 1; status == GONIO_OK && more && n < MOST; n++) {
        gonio_readings *readings = NULL;
        gonio_plan *next = NULL;
        double error = 0.0;
        read_at(sample, pair[n - 1], value[n - 1]);
        const gonio_readings_arrays arrays = {.size = sizeof arrays,
                                              .count = n,
                                              .channels = CHANNELS,
                                              .pair = pair,
                                              .value = value[0]};
        status = gonio_readings_create(context, &arrays, NULL, &readings);
        if (status == GONIO_OK) {
            status = gonio_plan_next(context, basis, readings, &how, &one, &error, NULL, &next);
        }
        more = next != NULL; /* NULL: the target is met */
        if (more) {
            pair[n] = next->entries[0].pair;
        }
        printf("%zu readings: expected error (E6) %.1f %%%s\n", n, error, more ? "" : ", enough");
        gonio_plan_free(&next);
        gonio_readings_free(&readings);
    }
    return status;
}

int main(int argc, char **argv)
{
    gonio_pair pair[MOST] = {{{0.7, 0.0}, {0.3, 0.0}}}; /* radians: any to begin with */
    gonio_context *context = NULL;
    gonio_basis *basis = NULL;
    gonio_material *material = NULL;
    gonio_table *sample = NULL;
    const gonio_context_options talk = {.size = sizeof talk, .message = show};
    const bool done = argc == 2 && gonio_context_create(&context, &talk) == GONIO_OK &&
                      gonio_basis_read(context, argv[1], &basis) == GONIO_OK &&
                      gonio_material_open(context, "atlas:gold-polished", &material) == GONIO_OK &&
                      gonio_table_load(context, material, &sample) == GONIO_OK &&
                      measure(context, basis, sample, pair) == GONIO_OK;
    gonio_table_free(&sample);
    gonio_material_free(&material);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return done ? 0 : 1;
}
