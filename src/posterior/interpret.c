/* The interpretation of readings: see interpret.h. */
#include "interpret.h"

#include <stdlib.h>

#include "dark_level.h"
#include "mistakes.h"

gonio_status gonio_i_interpret(gonio_context *context, const gonio_i_prior *prior,
                               const gonio_readings *readings, const gonio_i_noise *noise,
                               gonio_i_columns *columns, double **dark, const char **mistake)
{
    *mistake = NULL;
    gonio_status status = gonio_i_dark_level_find(context, prior, readings, noise, columns, dark);
    if (status == GONIO_OK) {
        status = gonio_i_mistake_find(context, prior, readings, noise, columns, *dark, mistake);
    }
    if (*mistake != NULL) {
        free(*dark); /* the level was of readings with a mistake */
        *dark = NULL;
    }
    const gonio_i_transform transform = {.factor = 1.0, .dark = *dark};
    for (size_t k = 0; k < columns->count && status == GONIO_OK && *dark != NULL; k++) {
        gonio_i_column_transform(readings, noise, &transform, &columns->column[k]);
    }
    return status;
}
