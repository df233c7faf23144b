/* Larger errors to expect near odd readings: see odd_places.h. */
#include "odd_places.h"

#include <math.h>
#include <stdlib.h>

/* A reading that the others contradict more than this may be wrong. */
static const double MOST = 9.0;

typedef struct odd_readings {
    size_t count;
    gonio_i_place *place; /* [count] */
    double *oddity;       /* [count] */
    double mean;
} odd_readings;

static gonio_status list_readings(const gonio_i_choices *p, odd_readings *o)
{
    const gonio_i_known *known = p->known;
    o->place = gonio_i_allocate(p->context, known->count, sizeof *o->place);
    o->oddity = gonio_i_allocate(p->context, known->count, sizeof *o->oddity);
    if (o->place == NULL || o->oddity == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    double sum = 0.0;
    for (size_t i = 0; i < known->count; i++) {
        if (known->oddity[i] >= 0.0) {
            o->place[o->count] = gonio_i_place_of(known->read[i]);
            o->oddity[o->count] = fmin(known->oddity[i], MOST);
            sum += o->oddity[o->count++];
        }
    }
    o->mean = o->count > 0 ? sum / (double)o->count : 0.0;
    return GONIO_OK;
}

static double scale_at(const odd_readings *o, gonio_half_difference at)
{
    const gonio_i_place here = gonio_i_place_of(at);
    double odd = o->mean;
    double weight = 1.0;
    for (size_t i = 0; i < o->count; i++) {
        const double w = gonio_i_smooth(&here, &o->place[i]);
        odd += w * o->oddity[i];
        weight += w;
    }
    return sqrt(odd / (weight * o->mean));
}

gonio_status gonio_i_expect_more_of_odd_places(gonio_i_choices *p)
{
    odd_readings odd = {0};
    const gonio_status status = list_readings(p, &odd);
    for (size_t row = 0; status == GONIO_OK && odd.mean > 0.0 && row < p->rows; row++) {
        const double scale = scale_at(&odd, p->at[row]);
        for (size_t k = 0; k < p->components; k++) {
            p->f[row * p->components + k] *= (float)scale;
        }
    }
    free(odd.place);
    free(odd.oddity);
    return status;
}
