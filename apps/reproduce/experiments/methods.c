/* The methods that Fig. 3(b) compares: see methods.h. */
#include "methods.h"

/* The paper's representation. */
#define PAPER(plan_method, index)                                                                  \
    .representation = GONIO_BIVARIATE, .channels = GONIO_JOINT, .mapping = GONIO_LOG,              \
    .plan = (plan_method), .chosen = (index)

/* The representation of Nielsen et al.; every channel of a direction is read. */
#define RELATIVE(plan_method, count)                                                               \
    .representation = GONIO_FULL, .channels = GONIO_SEPARATE, .mapping = GONIO_LOG_RELATIVE,       \
    .plan = (plan_method), .chosen = GONIO_I_OWN_SIZE, .size = {count, count}

/* The methods. Those of the full grid are last. */
static const gonio_i_method_entry methods[] = {
    {.name = "condition-80", .label = "condition number", PAPER("condition", 0)},
    {.name = "condition-120", .label = "condition number", PAPER("condition", 1)},
    {.name = "condition-170", .label = "condition number", PAPER("condition", 2)},
    {.name = "random-80", .label = "random rows", PAPER("random", 0)},
    {.name = "random-120", .label = "random rows", PAPER("random", 1)},
    {.name = "random-170", .label = "random rows", PAPER("random", 2)},
    {.name = "matusik-800",
     .label = "Matusik et al.",
     .representation = GONIO_FULL,
     .channels = GONIO_JOINT,
     .mapping = GONIO_LOG,
     .without_mean = true,
     .plan = "matusik",
     .chosen = GONIO_I_OWN_SIZE,
     .size = {0, 800},
     .quoted = true},
    {.name = "nielsen-40", .label = "Nielsen et al.", RELATIVE("nielsen", 40)},
    {.name = "frost-40", .label = "FROST", RELATIVE("frost", 40)},
};

size_t gonio_i_methods(const gonio_i_study *study)
{
    size_t count = 0;
    while (count < sizeof methods / sizeof *methods &&
           !(study->quick && methods[count].representation == GONIO_FULL)) {
        count++;
    }
    return count;
}

const gonio_i_method_entry *gonio_i_method_at(size_t index)
{
    return &methods[index];
}

/* The number of components that a basis of this many materials has at least. Separate channels are
 * columns of their own, but those of grey materials are copies of each other. */
static size_t most_components(const gonio_i_method_entry *method, size_t materials)
{
    return method->without_mean ? materials : materials - 1;
}

/* The method's own size for a basis of this many materials. */
static gonio_i_size own_size(const gonio_i_method_entry *method, size_t materials)
{
    gonio_i_size size = method->size;
    const bool square = size.components == size.samples;
    const size_t most = most_components(method, materials);
    size.components = size.components == 0 || size.components > most ? most : size.components;
    size.samples = square ? size.components : size.samples;
    return size;
}

gonio_i_size gonio_i_method_size(const gonio_i_study *study, const gonio_i_method_entry *method)
{
    if (method->chosen != GONIO_I_OWN_SIZE) {
        return study->chosen[method->chosen];
    }
    size_t least = study->splits.split[0].basis_count;
    for (size_t s = 1; s < study->splits.count; s++) {
        const size_t count = study->splits.split[s].basis_count;
        least = count < least ? count : least;
    }
    return own_size(method, least);
}

const gonio_i_method_entry *gonio_i_quoted_method(void)
{
    size_t m = 0;
    while (!methods[m].quoted) {
        m++;
    }
    return &methods[m];
}

gonio_i_size gonio_i_quoted_size(size_t materials)
{
    return own_size(gonio_i_quoted_method(), materials);
}
