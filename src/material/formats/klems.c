/* Klems bases: see klems.h. */
#include "klems.h"

#include <math.h>
#include <string.h>

static const gonio_i_klems bases[] = {
    {.name = "LBNL/Klems Full",
     .rings = 9,
     .bound = {0.0, 5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 90.0},
     .patches = {1, 8, 16, 20, 24, 24, 24, 16, 12}},
    {.name = "LBNL/Klems Half",
     .rings = 7,
     .bound = {0.0, 6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90.0},
     .patches = {1, 8, 12, 16, 20, 12, 4}},
    {.name = "LBNL/Klems Quarter",
     .rings = 5,
     .bound = {0.0, 9.0, 27.0, 46.0, 66.0, 90.0},
     .patches = {1, 8, 12, 12, 8}},
};

const gonio_i_klems *gonio_i_klems_named(const char *name)
{
    for (size_t k = 0; k < sizeof bases / sizeof *bases; k++) {
        if (strcmp(bases[k].name, name) == 0) {
            return &bases[k];
        }
    }
    return NULL;
}

size_t gonio_i_klems_patches(const gonio_i_klems *basis)
{
    size_t patches = 0;
    for (size_t k = 0; k < basis->rings; k++) {
        patches += basis->patches[k];
    }
    return patches;
}

size_t gonio_i_klems_patch(const gonio_i_klems *basis, gonio_angles direction, bool incident)
{
    const double theta = direction.theta * 180.0 / M_PI;
    const double revolutions = direction.phi / (2.0 * M_PI) + (incident ? 0.5 : 0.0);
    size_t first = 0;
    for (size_t k = 0; k < basis->rings; k++) {
        const size_t patches = basis->patches[k];
        if (theta >= basis->bound[k] && theta < basis->bound[k + 1]) {
            const double place = (revolutions - floor(revolutions)) * (double)patches + 0.5;
            return first + (size_t)place % patches;
        }
        first += patches;
    }
    return first;
}

gonio_angles gonio_i_klems_direction(const gonio_i_klems *basis, size_t patch, double across,
                                     double around, bool incident)
{
    size_t ring = 0;
    while (patch >= basis->patches[ring]) {
        patch -= basis->patches[ring];
        ring++;
    }
    const double low = sin(basis->bound[ring] * M_PI / 180.0);
    const double high = sin(basis->bound[ring + 1] * M_PI / 180.0);
    const double square = low * low + across * (high * high - low * low);
    const double revolutions = ((double)patch + around - 0.5) / (double)basis->patches[ring];
    return (gonio_angles){asin(sqrt(square)), 2.0 * M_PI * (revolutions + (incident ? 0.5 : 0.0))};
}
