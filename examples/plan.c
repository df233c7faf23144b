#include <gonio/gonio.h>
#include <stdio.h>

int main(void)
{
    gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.count = 20;
    if (gonio_basis_read(NULL, "merl.gonio", &basis) == GONIO_OK &&
        gonio_plan_create(NULL, basis, &options, &plan) == GONIO_OK) {
        printf("%zu readings, expected error %.2f %%\n", plan->count,
               plan->expected[plan->count - 1]);
    }
    gonio_plan_free(&plan);
    gonio_basis_free(&basis);
}
