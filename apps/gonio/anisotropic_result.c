/* gonio reconstruct --anisotropic: see anisotropic_result.h. */
#include "anisotropic_result.h"

#include <math.h>
#include <stdio.h>

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
    const bool long_axes = a->axis_ratio > LONG;
    return json_pack("{s:o, s:o, s:i, s:o, s:o, s:b}", "probability",
                     tool_json_number(a->probability), "evidence", tool_json_number(a->evidence),
                     "symmetry", a->symmetry, "axis_ratio", tool_json_number(a->axis_ratio),
                     "rotation_deg",
                     long_axes ? tool_json_number(degrees(a->rotation)) : json_null(),
                     "one_azimuth", a->cannot_tell);
}

void print_anisotropy(const gonio_anisotropy *a)
{
    if (a->axis_ratio > LONG) {
        fprintf(tool_results(), "grain at %.0f degrees, slopes %.2g times as large across it",
                degrees(a->rotation), a->axis_ratio);
    } else {
        fprintf(tool_results(), "no long axis, %d turn%s in a full one change%s nothing",
                a->symmetry, tool_plural((size_t)a->symmetry), a->symmetry == 1 ? "s" : "");
    }
}

static void print(const gonio_anisotropic_reconstruction_view *view, const char *output)
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
    if (view->outlying > 0) {
        fprintf(tool_results(), ", %zu value%s contradicted by the others", view->outlying,
                tool_plural(view->outlying));
    }
    fputc('\n', tool_results());
}

static void report(const gonio_anisotropic_reconstruction *made, const char *output,
                   json_t *results)
{
    const gonio_anisotropic_reconstruction_view *view =
        gonio_anisotropic_reconstruction_describe(made);
    if (results != NULL) {
        json_array_append_new(
            results, json_pack("{s:o, s:I, s:I, s:f, s:I, s:o}", "output", tool_json_text(output),
                               "channels", (json_int_t)view->channels, "readings",
                               (json_int_t)view->readings, "expected_e6_percent",
                               view->predicted_e6, "outlying", (json_int_t)view->outlying,
                               "anisotropy", anisotropy_json(&view->anisotropy)));
    } else if (!tool_quiet) {
        print(view, output);
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

gonio_status anisotropic_result_write(tool *t, const anisotropic_task *task,
                                      const gonio_readings *readings, const char *output,
                                      json_t *results)
{
    gonio_anisotropic_reconstruction *made = NULL;
    gonio_status status =
        gonio_reconstruct_anisotropic(t->context, task->basis, readings, task->how, &made);
    if (status == GONIO_OK) {
        status = write_predictions(t, task, made, output);
    }
    if (status == GONIO_OK) {
        report(made, output, results);
    }
    gonio_anisotropic_reconstruction_free(&made);
    return status;
}
