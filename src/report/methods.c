/* The methods that Fig. 3(b) compares: see methods.h. */
#include "methods.h"

/* The paper's representation, learning and reconstruction. */
#define PAPER(plan_method, index)                                                                  \
    .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT, .learn = gonio_basis_learn,        \
    .plan = (plan_method), .solve = gonio_reconstruct_rows, .chosen = (index)

/* Name, label, what it learns, plan, reconstruction, size. */
static const gonio_i_method_entry methods[] = {
    {.name = "condition-80", .label = "condition number", PAPER("condition", 0)},
    {.name = "condition-120", .label = "condition number", PAPER("condition", 1)},
    {.name = "condition-170", .label = "condition number", PAPER("condition", 2)},
    {.name = "random-80", .label = "random rows", PAPER("random", 0)},
    {.name = "random-120", .label = "random rows", PAPER("random", 1)},
    {.name = "random-170", .label = "random rows", PAPER("random", 2)},
};

size_t gonio_i_methods(void)
{
    return sizeof methods / sizeof *methods;
}

const gonio_i_method_entry *gonio_i_method_at(size_t index)
{
    return &methods[index];
}

gonio_i_size gonio_i_method_size(const gonio_i_study *study, const gonio_i_method_entry *method)
{
    return method->chosen == GONIO_I_OWN_SIZE ? method->size : study->chosen[method->chosen];
}
