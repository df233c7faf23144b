/* gonio reconstruct --anisotropic: see anisotropic_result.h. */
#include "anisotropic_result.h"

#include <math.h>
#include <stdio.h>

#include "azimuths.h"
#include "inputs.h"
#include "json_output.h"

/* From this ratio of axes on the grain has an azimuth worth printing. */
static const double LONG = 1.05;

static double degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

bool anisotropic_check_symmetry(const tool *t, int symmetry)
{
    const bool known = symmetry == 0 || symmetry == 1 || symmetry == 2 || symmetry == 4;
    return known || tool_refuse(t, "--symmetry must be 1, 2 or 4");
}

json_t *anisotropy_json(const gonio_anisotropy *a)
{
    const bool has_grain = a->axis_ratio > LONG || a->fibres;
    return json_pack("{s:o, s:o, s:i, s:o, s:o, s:b, s:b}", "probability",
                     tool_json_number(a->probability), "evidence", tool_json_number(a->evidence),
                     "symmetry", a->symmetry, "axis_ratio", tool_json_number(a->axis_ratio),
                     "rotation_deg",
                     has_grain ? tool_json_number(degrees(a->rotation)) : json_null(), "fibres",
                     a->fibres, "one_azimuth", a->cannot_tell);
}

void print_anisotropy(const gonio_anisotropy *a)
{
    if (a->fibres) {
        fprintf(tool_results(), "fibres along %.0f degrees beneath the surface",
                degrees(a->rotation));
    } else if (a->axis_ratio > LONG) {
        fprintf(tool_results(), "grain at %.0f degrees, slopes %.2g times as large across it",
                degrees(a->rotation), a->axis_ratio);
    } else {
        fprintf(tool_results(), "no long axis, %d turn%s in a full one change%s nothing",
                a->symmetry, tool_plural((size_t)a->symmetry), a->symmetry == 1 ? "s" : "");
    }
}

static void print(const gonio_anisotropic_reconstruction_view *view, const char *output,
                  double albedo)
{
    const gonio_anisotropy *a = &view->anisotropy;
    fprintf(tool_results(),
            "%s: from %zu reading%s in %zu channel%s; expected error (E6) %.2f %%; ", output,
            view->readings, tool_plural(view->readings), view->channels,
            tool_plural(view->channels), view->predicted_e6);
    if (a->probability > 0.5) {
        fprintf(tool_results(), "anisotropic (%.3g %%): ", 100.0 * a->probability);
        print_anisotropy(a);
    } else {
        fprintf(tool_results(), "isotropic (%.3g %%)", 100.0 * (1.0 - a->probability));
    }
    if (!isnan(albedo)) {
        fprintf(tool_results(), ", albedo at most %.2f", albedo);
    }
    if (view->outlying > 0) {
        fprintf(tool_results(), ", %zu value%s contradicted by the others", view->outlying,
                tool_plural(view->outlying));
    }
    fputc('\n', tool_results());
}

static json_t *as_json(const gonio_anisotropic_reconstruction_view *view, const char *output,
                       double albedo)
{
    json_t *made =
        json_pack("{s:o, s:I, s:I, s:f, s:I, s:o}", "output", tool_json_text(output), "channels",
                  (json_int_t)view->channels, "readings", (json_int_t)view->readings,
                  "expected_e6_percent", view->predicted_e6, "outlying", (json_int_t)view->outlying,
                  "anisotropy", anisotropy_json(&view->anisotropy));
    if (!isnan(albedo)) {
        json_object_set_new(made, "largest_albedo", tool_json_number(albedo));
    }
    return made;
}

/* albedo: the largest of the material; NaN if none was made. */
static void report(const gonio_anisotropic_reconstruction *made, const char *output, double albedo,
                   json_t *results)
{
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    if (albedo > 1.0 && !tool_quiet) {
        fprintf(stderr,
                "gonio reconstruct: note: %s reflects %.2f times the light at some incidence, "
                "which no material can do\n",
                output, albedo);
    }
    if (results != NULL) {
        json_array_append_new(results, as_json(view, output, albedo));
    } else if (!tool_quiet) {
        print(view, output, albedo);
    }
}

static gonio_status write_predictions(tool *t, const anisotropic_task *task,
                                      const gonio_anisotropic_reconstruction *made,
                                      const char *output)
{
    const gonio_readings_options any = {
        .size = sizeof any, .average_repeats = true, .negative_to_zero = true};
    gonio_readings *at = NULL;
    gonio_status status = tool_read_readings(t, task->predict_at, &any, &at);
    if (status == GONIO_OK) {
        status = gonio_anisotropic_reconstruction_predict_readings(t->context, made, at);
    }
    if (status == GONIO_OK) {
        status = gonio_readings_write(t->context, at, t->command_line, output);
    }
    gonio_readings_free(&at);
    return status;
}

/* Writes the material, and says if it reflects more light than arrives. */
static gonio_status write_material(tool *t, const anisotropic_task *task,
                                   const gonio_anisotropic_reconstruction *made, const char *output,
                                   double *albedo)
{
    gonio_material *material = NULL;
    tool_azimuths found;
    gonio_status status =
        gonio_anisotropic_reconstruction_material(t->context, made, "reconstruction", &material);
    if (status == GONIO_OK) {
        status = write_options_apply(t, task->write, material);
    }
    if (status == GONIO_OK) {
        status = gonio_material_write(t->context, material, output, task->format);
    }
    if (status == GONIO_OK) {
        status = write_options_state_loss(t, task->format, material, output);
    }
    if (status == GONIO_OK) {
        status = tool_find_azimuths(t->context, material, &found);
        *albedo = found.largest;
    }
    gonio_material_free(&material);
    return status;
}

gonio_status anisotropic_result_write(tool *t, const anisotropic_task *task,
                                      const gonio_readings *readings, const char *output,
                                      json_t *results)
{
    gonio_anisotropic_reconstruction *made = NULL;
    double albedo = NAN;
    gonio_status status =
        gonio_reconstruct_anisotropic(t->context, task->basis, readings, task->how, &made);
    if (status == GONIO_OK) {
        status = task->predict_at != NULL ? write_predictions(t, task, made, output)
                                          : write_material(t, task, made, output, &albedo);
    }
    if (status == GONIO_OK) {
        report(made, output, albedo, results);
    }
    gonio_anisotropic_reconstruction_free(&made);
    return status;
}
