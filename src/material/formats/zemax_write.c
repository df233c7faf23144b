/* Writing Zemax .bsdf text: the BRDF of an isotropic surface at angles from the mirror direction.
 *
 * For each incidence a line of values for each azimuth about the mirror direction, 0 towards the
 * normal and 180 degrees away from it, and each radial angle. The surface is taken as symmetrical
 * about the plane of incidence (PlaneSymmetrical): the mean of either side. 0 below the horizon and
 * where there are no data. Colours are X, Y, Z, in which a flat spectrum has three times the same.
 */
#include <math.h>
#include <stdlib.h>

#include "../../core/core.h"
#include "../colour.h"
#include "../sampler.h"
#include "../text_output.h"
#include "writers.h"

enum { RADIALS = 73, MOST_ANGLES = 361, PLANES = GONIO_CHANNELS };

typedef struct writer {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    size_t incidences;
    double incidence[MOST_ANGLES]; /* radians, as all */
    size_t azimuths;
    double azimuth[MOST_ANGLES];
    double radial[RADIALS];
    double *value; /* [incidences][azimuths][RADIALS][X, Y, Z] */
} writer;

static size_t equal_steps(double first, double last, double step, double *angle)
{
    size_t count = 0;
    while (count < MOST_ANGLES && first + step * (double)count <= last + 1e-9) {
        angle[count] = first + step * (double)count;
        count++;
    }
    return count;
}

/* The outgoing direction; below the horizon theta is above pi/2. */
static gonio_angles find_outgoing(double theta_i, double azimuth, double radial)
{
    const double along = sin(radial) * cos(azimuth); /* towards the normal, in the plane */
    const double x = -cos(radial) * sin(theta_i) + along * cos(theta_i);
    const double y = sin(radial) * sin(azimuth);
    const double z = cos(radial) * cos(theta_i) + along * sin(theta_i);
    return (gonio_angles){atan2(hypot(x, y), z), atan2(y, x)};
}

/* The mean of the sides that have data; 0 without. */
static void add_sides(const double *rgb, double xyz[PLANES])
{
    double mean[PLANES] = {0.0};
    double count = 0.0;
    for (size_t side = 0; side < 2; side++) {
        const double *at = rgb + side * PLANES;
        count += isnan(at[0]) ? 0.0 : 1.0;
        for (size_t c = 0; c < PLANES && !isnan(at[0]); c++) {
            mean[c] += at[c];
        }
    }
    for (size_t c = 0; c < PLANES; c++) {
        mean[c] /= fmax(count, 1.0);
    }
    gonio_i_rgb_to_xyz(mean, xyz);
}

static gonio_status find_incidence(const writer *w, size_t in, gonio_pair *pair, double *rgb)
{
    const size_t points = w->azimuths * RADIALS;
    for (size_t k = 0; k < points; k++) {
        const gonio_angles out =
            find_outgoing(w->incidence[in], w->azimuth[k / RADIALS], w->radial[k % RADIALS]);
        const gonio_angles other = {out.theta, -out.phi};
        pair[2 * k] = (gonio_pair){{w->incidence[in], 0.0}, out};
        pair[2 * k + 1] = (gonio_pair){{w->incidence[in], 0.0}, other};
    }
    const gonio_status status =
        gonio_i_sampler_colours(w->context, w->sampler, pair, 2 * points, rgb);
    for (size_t k = 0; k < points && status == GONIO_OK; k++) {
        add_sides(rgb + 2 * k * PLANES, w->value + (in * points + k) * PLANES);
    }
    return status;
}

static gonio_status find_values(const writer *w)
{
    const size_t points = w->azimuths * RADIALS;
    gonio_pair *pair = gonio_i_allocate(w->context, 2 * points, sizeof *pair);
    double *rgb = gonio_i_allocate(w->context, 2 * points * PLANES, sizeof *rgb);
    gonio_status status = pair != NULL && rgb != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (size_t in = 0; in < w->incidences && status == GONIO_OK; in++) {
        status = find_incidence(w, in, pair, rgb);
    }
    free(pair);
    free(rgb);
    return status;
}

/* The total integrated scatter of an incidence: the trapezoidal rule over the file's own angles. */
static double integrate(const writer *w, size_t in, size_t plane)
{
    const double *value = w->value + in * w->azimuths * RADIALS * PLANES;
    double sum = 0.0;
    for (size_t a = 0; a + 1 < w->azimuths; a++) {
        for (size_t r = 0; r + 1 < RADIALS; r++) {
            const double area =
                (w->azimuth[a + 1] - w->azimuth[a]) * (cos(w->radial[r]) - cos(w->radial[r + 1]));
            for (size_t corner = 0; corner < 4; corner++) {
                const size_t i = a + corner / 2;
                const size_t j = r + corner % 2;
                const double theta =
                    find_outgoing(w->incidence[in], w->azimuth[i], w->radial[j]).theta;
                sum +=
                    0.25 * area * fmax(cos(theta), 0.0) * value[(i * RADIALS + j) * PLANES + plane];
            }
        }
    }
    return 2.0 * sum; /* both sides */
}

/* ---- text ---- */

static void print_angles(FILE *to, const char *name, const double *angle, size_t count)
{
    fprintf(to, "%s %zu\n", name, count);
    for (size_t k = 0; k < count; k++) {
        fprintf(to, "%s%.10g", k > 0 ? " " : "", angle[k] * 180.0 / M_PI);
    }
    fputc('\n', to);
}

static void print_plane(const writer *w, FILE *to, const char *name, size_t plane)
{
    fprintf(to, "%s\nDataBegin\n", name);
    for (size_t in = 0; in < w->incidences; in++) {
        fprintf(to, "TIS %.7g\n", integrate(w, in, plane));
        for (size_t a = 0; a < w->azimuths; a++) {
            for (size_t r = 0; r < RADIALS; r++) {
                const size_t at = (in * w->azimuths + a) * RADIALS + r;
                fprintf(to, "%s%.7g", r > 0 ? " " : "", w->value[at * PLANES + plane]);
            }
            fputc('\n', to);
        }
    }
    fprintf(to, "DataEnd\n");
}

static void print_name(FILE *to, const char *name)
{
    fputs("# ", to);
    for (; *name != '\0'; name++) {
        fputc((unsigned char)*name < 0x20 ? ' ' : *name, to);
    }
    fputs(", written by gonio\n", to);
}

static void print_all(const writer *w, FILE *to)
{
    static const char *const names[PLANES] = {"TristimulusX", "TristimulusY", "TristimulusZ"};
    const bool grey = w->sampler->view->channels == 1;
    const double rotation = 0.0;
    print_name(to, w->sampler->view->name);
    fprintf(to,
            "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent %s\nScatterType BRDF\n",
            grey ? "Monochrome" : "XYZ");
    print_angles(to, "SampleRotation", &rotation, 1);
    print_angles(to, "AngleOfIncidence", w->incidence, w->incidences);
    print_angles(to, "ScatterAzimuth", w->azimuth, w->azimuths);
    print_angles(to, "ScatterRadial", w->radial, RADIALS);
    if (grey) {
        print_plane(w, to, "Monochrome", 1);
        return;
    }
    for (size_t plane = 0; plane < PLANES; plane++) {
        print_plane(w, to, names[plane], plane);
    }
}

static gonio_status write_values(writer *w, const char *path)
{
    gonio_i_text_output text;
    w->value = gonio_i_allocate(w->context, w->incidences * w->azimuths * RADIALS * PLANES,
                                sizeof *w->value);
    gonio_status status = w->value != NULL ? find_values(w) : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = gonio_i_text_open(w->context, &text);
        if (status == GONIO_OK) {
            print_all(w, text.stream);
            status = gonio_i_text_close(w->context, &text, path, status);
        }
    }
    free(w->value);
    return status;
}

static gonio_status write_zemax(gonio_context *context, const gonio_material *material,
                                const char *path, const gonio_write_options *options)
{
    static const double degree = M_PI / 180.0;
    gonio_i_sampler sampler;
    gonio_status status = gonio_i_sampler_begin(context, material, true, &sampler);
    if (status != GONIO_OK) {
        return status;
    }
    writer w = {.context = context, .sampler = &sampler};
    const double steep =
        sampler.view->theta_limit > 0.0 ? sampler.view->theta_limit : 85.0 * degree;
    w.incidences =
        equal_steps(0.0, steep, options->theta_i_step > 0.0 ? options->theta_i_step : 5.0 * degree,
                    w.incidence);
    w.azimuths = equal_steps(0.0, M_PI, options->phi_step > 0.0 ? options->phi_step : 7.5 * degree,
                             w.azimuth);
    for (size_t k = 0; k < RADIALS; k++) { /* denser towards the mirror direction */
        const double t = (double)k / (RADIALS - 1);
        w.radial[k] = M_PI * t * t;
    }
    status = write_values(&w, path);
    gonio_i_sampler_end(&sampler);
    return status;
}

const gonio_i_format_writer gonio_i_zemax_writer = {
    .name = "zemax",
    .extension = ".bsdf",
    .summary = "Zemax BSDF text about the mirror direction; isotropic",
    .isotropic = true,
    .averages = true,
    .write = write_zemax,
};
