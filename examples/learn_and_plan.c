/* Learns a basis from built-in materials and plans where to measure a new one.
 *
 *     learn_and_plan BASIS PLAN
 *
 * BASIS and PLAN are the files that it writes. Real work learns from measured materials: give their
 * paths in place of "atlas:NAME". */
#include <gonio/gonio.h>

#include <stdio.h>
#include <string.h>

enum { MATERIALS = 6, READINGS = 10 };

/* Says what went wrong; the context calls it. */
static void show(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    (void)level;
    fprintf(stderr, "%s\n", text);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: learn_and_plan BASIS PLAN\n");
        return 2;
    }
    char names[MATERIALS][64];
    const char *paths[MATERIALS];
    for (int k = 0; k < MATERIALS; k++) {
        snprintf(names[k], sizeof names[k], "atlas:%s", gonio_atlas_name(k));
        paths[k] = names[k];
    }
    gonio_context *context = NULL;
    gonio_database *database = NULL;
    gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    const gonio_context_options talk = {.size = sizeof talk, .message = show};
    /* Sectors of phi_d, each channel a column of its own, and mixtures of the materials: what
     * `gonio learn` makes, with fewer mixtures. */
    gonio_database_options grid;
    gonio_database_options_default(&grid);
    grid.representation = GONIO_SECTORED;
    grid.channels = GONIO_SEPARATE;
    gonio_basis_options how;
    gonio_basis_options_default(&how);
    how.mixtures = 60;
    gonio_plan_options wanted;
    gonio_plan_options_default(&wanted);
    wanted.count = READINGS;

    const bool done =
        gonio_context_create(&context, &talk) == GONIO_OK &&
        gonio_database_create(context, paths, MATERIALS, &grid, &database) == GONIO_OK &&
        gonio_basis_learn(context, database, &how, &basis) == GONIO_OK &&
        gonio_basis_write(context, basis, NULL, argv[1]) == GONIO_OK &&
        gonio_plan_create(context, basis, &wanted, &plan) == GONIO_OK &&
        gonio_plan_write(context, plan, NULL, argv[2]) == GONIO_OK;
    for (size_t k = 0; done && k < plan->count; k++) {
        printf("reading %zu: expected error (E6) %.2f %%\n", k + 1, plan->expected[k]);
    }
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
    gonio_database_free(&database);
    gonio_context_free(&context);
    return done ? 0 : 1;
}
