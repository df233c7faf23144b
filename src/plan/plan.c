/* A plan in memory: its entries, and the rows of a basis that they read. */
#include "plan.h"

#include <stdio.h>
#include <stdlib.h>

gonio_plan_entry gonio_i_plan_entry(const gonio_basis_view *basis, size_t row, double phi_d)
{
    const int32_t cell = gonio_i_row_cell(basis, row);
    const bool joint = basis->channels == GONIO_JOINT;
    return (gonio_plan_entry){cell,
                              joint ? gonio_i_channel_of(basis->channels, row) : GONIO_ALL_CHANNELS,
                              gonio_pair_from_half_difference(
                                  gonio_i_cell_direction(basis->representation, cell, phi_d))};
}

/* Whether a basis has what an entry reads. */
static bool is_of(const gonio_basis_view *basis, const gonio_plan_entry *entry)
{
    const bool one = entry->channel >= 0 && entry->channel < GONIO_CHANNELS;
    return entry->cell >= 0 && entry->cell < gonio_grid_cells(basis->representation) &&
           (basis->channels == GONIO_JOINT ? one : entry->channel == GONIO_ALL_CHANNELS);
}

gonio_status gonio_plan_rows(gonio_context *context, const gonio_plan *plan,
                             const gonio_basis *basis, size_t *rows)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    for (size_t j = 0; j < plan->count; j++) {
        if (!is_of(view, &plan->entries[j])) {
            return gonio_i_fail(context, GONIO_ERROR_MISMATCH,
                                "entry %zu of the plan is of another kind of basis: cell %d, "
                                "channel %d",
                                j + 1, (int)plan->entries[j].cell, plan->entries[j].channel);
        }
    }
    for (size_t j = 0; j < plan->count; j++) {
        const size_t position = gonio_basis_position(basis, plan->entries[j].cell);
        rows[j] = gonio_i_row_of(view->channels, position, plan->entries[j].channel);
    }
    return GONIO_OK;
}

gonio_plan *gonio_i_allocate_plan(gonio_context *context, const gonio_basis_view *basis,
                                  const char *method, size_t components, size_t count)
{
    gonio_plan *made = gonio_i_allocate(context, 1, sizeof *made);
    if (made != NULL) {
        made->count = count;
        made->components = components;
        made->basis = basis->fingerprint;
        snprintf(made->method, sizeof made->method, "%s", method);
        made->entries = gonio_i_allocate(context, count, sizeof *made->entries);
    }
    if (made != NULL && made->entries == NULL) {
        gonio_plan_free(&made);
    }
    return made;
}

void gonio_plan_free(gonio_plan **plan)
{
    if (plan == NULL || *plan == NULL) {
        return;
    }
    free((*plan)->entries);
    free((*plan)->history);
    free((*plan)->expected);
    if ((*plan)->run != NULL) {
        free((*plan)->run->setting);
        free((*plan)->run->time);
    }
    free((*plan)->run);
    free(*plan);
    *plan = NULL;
}
