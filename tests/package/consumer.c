/* A small program against the installed library: learns from five built-in materials and plans. */
#include <gonio/gonio.h>

#include <stdio.h>

int main(void)
{
    char names[5][64];
    const char *paths[5];
    for (int k = 0; k < 5; k++) {
        snprintf(names[k], sizeof names[k], "atlas:%s", gonio_atlas_name(k));
        paths[k] = names[k];
    }
    gonio_context *context = NULL;
    gonio_recipe recipe;
    gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    gonio_plan_options options;
    gonio_recipe_paper(&recipe);
    gonio_plan_options_default(&options);
    options.count = 8;
    int code = 1;
    if (gonio_context_create(&context, NULL) == GONIO_OK &&
        gonio_learn(context, paths, 5, &recipe, &basis) == GONIO_OK &&
        gonio_plan_create(context, basis, &options, &plan) == GONIO_OK) {
        printf("gonio %s: %zu readings, condition number %.3f\n", gonio_version(), plan->count,
               plan->condition_number);
        code = plan->condition_number < 100.0 ? 0 : 1;
    }
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
    return code;
}
