/* Writing a material as readings in CSV, at directions on a grid. Every program can read these. */
#include <math.h>
#include <stdlib.h>

#include "../../core/core.h"
#include "../sampler.h"
#include "../text_output.h"
#include "writers.h"

enum { MOST_STEPS = 3600, MOST_DIRECTIONS = 100000000 };

typedef struct writer {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    double theta_i_step; /* radians */
    double theta_o_step;
    double phi_step;
    double limit; /* of polar angles */
    size_t left_out;
} writer;

static size_t count_steps(double range, double step)
{
    return (size_t)fmin(floor(range / step + 1e-9), MOST_STEPS) + 1;
}

/* A full circle ends a step before 360 degrees. At the pole there is one azimuth. */
static size_t count_azimuths(double theta, double step)
{
    return theta > 0.0 ? count_steps(2.0 * M_PI - step, step) : 1;
}

static void print_names(const writer *w, FILE *to)
{
    static const char *const colours[GONIO_CHANNELS] = {"R", "G", "B"};
    const gonio_material_view *view = w->sampler->view;
    fputs("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg", to);
    for (size_t c = 0; c < view->channels; c++) {
        if (view->wavelength != NULL) {
            fprintf(to, ",%.10gnm_per_sr", view->wavelength[c]);
        } else {
            fprintf(to, ",%s_per_sr", view->channels == 1 ? "value" : colours[c % GONIO_CHANNELS]);
        }
    }
    fputc('\n', to);
}

static double in_degrees(double angle)
{
    return angle * 180.0 / M_PI;
}

static void print_row(writer *w, FILE *to, gonio_pair pair, const double *values)
{
    bool any = false;
    for (size_t c = 0; c < w->sampler->view->channels; c++) {
        any = any || !isnan(values[c]);
    }
    if (!any) {
        w->left_out++;
        return;
    }
    fprintf(to, "%.10g,%.10g,%.10g,%.10g", in_degrees(pair.incident.theta),
            in_degrees(pair.incident.phi), in_degrees(pair.outgoing.theta),
            in_degrees(pair.outgoing.phi));
    for (size_t c = 0; c < w->sampler->view->channels; c++) {
        if (isnan(values[c])) {
            fputc(',', to);
        } else {
            fprintf(to, ",%.9g", values[c]);
        }
    }
    fputc('\n', to);
}

/* All outgoing directions of an incident one. */
static gonio_status print_incident(writer *w, FILE *to, gonio_angles incident)
{
    const size_t thetas = count_steps(w->limit, w->theta_o_step);
    const size_t most = thetas * count_azimuths(1.0, w->phi_step);
    gonio_pair *pair = gonio_i_allocate(w->context, most, sizeof *pair);
    double *values =
        gonio_i_allocate(w->context, most * w->sampler->view->channels, sizeof *values);
    size_t count = 0;
    for (size_t t = 0; t < thetas && pair != NULL; t++) {
        const double theta = w->theta_o_step * (double)t;
        for (size_t p = 0; p < count_azimuths(theta, w->phi_step); p++) {
            pair[count++] = (gonio_pair){incident, {theta, w->phi_step * (double)p}};
        }
    }
    const gonio_status status =
        pair != NULL && values != NULL
            ? gonio_i_sampler_values(w->context, w->sampler, pair, count, values)
            : GONIO_ERROR_MEMORY;
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        print_row(w, to, pair[k], values + k * w->sampler->view->channels);
    }
    free(pair);
    free(values);
    return status;
}

static gonio_status print_all(writer *w, FILE *to)
{
    const size_t thetas = count_steps(w->limit, w->theta_i_step);
    gonio_status status = GONIO_OK;
    fputs("# gonio readings\n", to);
    fputs("# theta from the normal, phi about it, incident (i) towards the light, outgoing (o) "
          "towards the detector\n",
          to);
    print_names(w, to);
    for (size_t t = 0; t < thetas && status == GONIO_OK; t++) {
        const double theta = w->theta_i_step * (double)t;
        const size_t azimuths =
            w->sampler->view->anisotropic ? count_azimuths(theta, w->phi_step) : 1;
        for (size_t p = 0; p < azimuths && status == GONIO_OK; p++) {
            status = print_incident(w, to, (gonio_angles){theta, w->phi_step * (double)p});
        }
        if (status == GONIO_OK) {
            status =
                gonio_i_progress(w->context, "writing", 0.99 * (double)(t + 1) / (double)thetas);
        }
    }
    return status;
}

static gonio_status check_size(const writer *w)
{
    const double azimuths = (double)count_azimuths(1.0, w->phi_step);
    const double directions = (double)count_steps(w->limit, w->theta_i_step) *
                              (double)count_steps(w->limit, w->theta_o_step) * azimuths *
                              (w->sampler->view->anisotropic ? azimuths : 1.0);
    return directions <= MOST_DIRECTIONS
               ? GONIO_OK
               : gonio_i_fail(w->context, GONIO_ERROR_ARGUMENT,
                              "a grid of %.0f directions; at most 1e8 are written", directions);
}

static gonio_status write_grid(gonio_context *context, const gonio_material *material,
                               const char *path, const gonio_write_options *options)
{
    static const double degree = M_PI / 180.0;
    gonio_i_sampler sampler;
    gonio_i_text_output text;
    gonio_status status = gonio_i_sampler_begin(context, material, false, &sampler);
    if (status != GONIO_OK) {
        return status;
    }
    writer w = {
        .context = context,
        .sampler = &sampler,
        .theta_i_step = options->theta_i_step > 0.0 ? options->theta_i_step : 10.0 * degree,
        .theta_o_step = options->theta_o_step > 0.0 ? options->theta_o_step : 5.0 * degree,
        .phi_step = options->phi_step > 0.0 ? options->phi_step
                                            : (sampler.view->anisotropic ? 30.0 : 10.0) * degree,
        .limit = sampler.view->theta_limit > 0.0 ? sampler.view->theta_limit : 89.0 * degree};
    status = check_size(&w);
    if (status == GONIO_OK) {
        status = gonio_i_text_open(context, &text);
        if (status == GONIO_OK) {
            status = print_all(&w, text.stream);
            status = gonio_i_text_close(context, &text, path, status);
        }
    }
    if (status == GONIO_OK && w.left_out > 0) {
        gonio_i_note(context, "%s: %zu directions without data are left out", path, w.left_out);
    }
    gonio_i_sampler_end(&sampler);
    return status == GONIO_OK ? gonio_i_progress(context, "writing", 1.0) : status;
}

const gonio_i_format_writer gonio_i_grid_writer = {
    .name = "csv",
    .extension = ".csv",
    .summary = "readings in CSV at directions on a grid (--steps)",
    .write = write_grid,
};
