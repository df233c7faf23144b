/* Readings as Zemax BSDF files: values on a grid of incidences, azimuths and radial angles.
 * Azimuths and radial angles are about the mirror direction. */
#include "../../material/colour.h"
#include "../../material/formats/zemax_grid.h"
#include "../import.h"
#include "format.h"

static void take_values(const gonio_i_zemax_grid *g, size_t k, double value[GONIO_I_ZEMAX_PLANES])
{
    double xyz[GONIO_I_ZEMAX_PLANES] = {0.0};
    for (size_t p = 0; p < g->planes; p++) {
        xyz[p] = g->value[p][k];
    }
    if (g->planes == GONIO_I_ZEMAX_PLANES) {
        gonio_i_xyz_to_rgb(xyz, value);
    } else {
        value[0] = xyz[0];
    }
}

/* The angles of value k, radial fastest. */
static void find_angles(const gonio_i_zemax_grid *g, size_t k, double angle[GONIO_I_ZEMAX_AXES])
{
    for (int a = GONIO_I_ZEMAX_AXES - 1; a >= 0; a--) {
        angle[a] = g->axis[a].degrees[k % g->axis[a].count];
        k /= g->axis[a].count;
    }
}

static gonio_status import_grid(const gonio_i_zemax_grid *g, gonio_i_import *in)
{
    gonio_status status = gonio_i_import_channels(in, g->planes, NULL);
    const size_t count = g->line != NULL ? gonio_i_zemax_total(g) : 0;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        double angle[GONIO_I_ZEMAX_AXES];
        double value[GONIO_I_ZEMAX_PLANES];
        double difference = 0.0;
        gonio_i_row row = {.planned = GONIO_ALL_CHANNELS, .line = g->line[k], .value = value};
        find_angles(g, k, angle);
        take_values(g, k, value);
        row.degrees[0] = angle[GONIO_I_ZEMAX_INCIDENCE];
        row.degrees[1] = angle[GONIO_I_ZEMAX_ROTATION];
        gonio_i_from_mirror(angle[GONIO_I_ZEMAX_INCIDENCE], angle[GONIO_I_ZEMAX_RADIAL],
                            angle[GONIO_I_ZEMAX_AZIMUTH], &row.degrees[2], &difference);
        row.degrees[3] = angle[GONIO_I_ZEMAX_ROTATION] + difference;
        status = gonio_i_import_add(in, &row);
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {
        .angles = GONIO_DEGREES, .values = GONIO_VALUE_BRDF, .zeros = GONIO_ZEROS_MISSING};
    gonio_i_import in;
    gonio_i_zemax_grid g;
    gonio_i_import_begin(&in, file->context, readings,
                         "a Zemax BSDF (angles about the mirror direction)", &stated);
    gonio_i_import_leniently(&in);
    gonio_status status = gonio_i_zemax_read(file->context, file->path, file->text, file->size, &g);
    if (status == GONIO_OK) {
        status = import_grid(&g, &in);
        gonio_i_zemax_free(&g);
    }
    return gonio_i_import_end(&in, status);
}

const gonio_i_readings_format gonio_i_readings_zemax = {
    .word = "zemax", .name = "Zemax BSDF", .recognises = gonio_i_zemax_recognises, .read = read};
