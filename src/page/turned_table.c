/* Anisotropic materials for the page: the plane of incidence at every azimuth of the sample. */
#include "page.h"

#include <math.h>
#include <stdlib.h>

#include "../material/sampler.h"
#include "../material/source.h"

/* phi_h takes the place of phi_d, which is 0 in the plane of incidence: bins of 2 degrees. Both
 * sides of the reciprocal pair are evaluated for the bins of a row. */
enum { AZIMUTHS = GONIO_PHI_D_BINS, SIDES = 2, ROW = SIDES * AZIMUTHS };

typedef struct rows {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    double *values; /* [theta_h][channel][theta_d][phi_h] */
} rows;

bool gonio_i_web_turns(const gonio_material *material)
{
    return gonio_material_describe(material)->anisotropic && gonio_i_material_is_direct(material);
}

/* phi_d = 0 of a cell's centre, at all azimuths of the half vector, and with i and o exchanged. */
static void list_pairs(gonio_half_difference centre, gonio_pair pairs[ROW])
{
    const gonio_half_difference in_plane = {centre.theta_h, centre.theta_d, 0.0};
    const gonio_pair first = gonio_pair_from_half_difference(in_plane);
    for (int k = 0; k < AZIMUTHS; k++) {
        const double turn = 2.0 * M_PI * (k + 0.5) / AZIMUTHS;
        gonio_pair pair = first;
        pair.incident.phi += turn;
        pair.outgoing.phi += turn;
        pairs[k] = pair;
        pairs[AZIMUTHS + k] = (gonio_pair){pair.outgoing, pair.incident};
    }
}

/* The mean of both sides, that of one where the other has no data, or -1. */
static double mean_of(double there, double back)
{
    const double mean = isnan(there) ? back : isnan(back) ? there : 0.5 * (there + back);
    return isnan(mean) ? -1.0 : mean;
}

static gonio_status fill_row(const rows *r, int theta_h, int theta_d)
{
    const gonio_half_difference centre = gonio_bin_centre((gonio_bin){theta_h, theta_d, 0});
    const bool above = centre.theta_h + centre.theta_d < M_PI_2;
    double rgb[ROW * GONIO_CHANNELS];
    gonio_status status = GONIO_OK;
    if (above) {
        gonio_pair pairs[ROW];
        list_pairs(centre, pairs);
        status = gonio_i_sampler_colours(r->context, r->sampler, pairs, ROW, rgb);
    }
    double *row = r->values + (size_t)theta_h * GONIO_SLAB_VALUES + (size_t)theta_d * AZIMUTHS;
    for (int k = 0; k < AZIMUTHS && status == GONIO_OK; k++) {
        for (int c = 0; c < GONIO_CHANNELS; c++) {
            row[(size_t)c * GONIO_SLAB_BINS + k] =
                above
                    ? mean_of(rgb[k * GONIO_CHANNELS + c], rgb[(AZIMUTHS + k) * GONIO_CHANNELS + c])
                    : -1.0;
        }
    }
    return status;
}

static gonio_status fill_rows(const rows *r)
{
    gonio_status status = GONIO_OK;
    for (int cell = 0; cell < GONIO_CELLS && status == GONIO_OK; cell++) {
        status = fill_row(r, cell / GONIO_THETA_D_BINS, cell % GONIO_THETA_D_BINS);
        if (status == GONIO_OK && cell % GONIO_THETA_D_BINS == 0) {
            status = gonio_i_progress(r->context, "azimuths", (double)cell / GONIO_CELLS);
        }
    }
    return status;
}

gonio_status gonio_i_web_pack_turns(gonio_context *context, const gonio_material *material,
                                    size_t budget, gonio_i_web_table *packed)
{
    gonio_i_sampler sampler;
    gonio_status status = gonio_i_sampler_begin(context, material, false, &sampler);
    if (status != GONIO_OK) {
        return status;
    }
    const size_t count = (size_t)GONIO_THETA_H_BINS * GONIO_SLAB_VALUES;
    const rows r = {context, &sampler, gonio_i_allocate(context, count, sizeof *r.values)};
    status = r.values == NULL ? GONIO_ERROR_MEMORY : fill_rows(&r);
    if (status == GONIO_OK) {
        status = gonio_i_web_pack(context, r.values, GONIO_I_WEB_LOG, budget, packed);
    }
    free(r.values);
    gonio_i_sampler_end(&sampler);
    return status;
}
