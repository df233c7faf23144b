/* gonio check-isotropy: how certain it is that a sample is isotropic. */
#include "anisotropic_result.h"
#include "builtin_basis.h"
#include "command_line.h"
#include "inputs.h"
#include "json_output.h"
#include "posterior_options.h"

#include <math.h>
#include <stdio.h>

typedef struct options {
    posterior_options posterior;
    int symmetry;
} options;

static int report_json(const tool *t, const char *path, const gonio_isotropy_check *c)
{
    return tool_print_json(
        t, json_pack("{s:o, s:o, s:o, s:o, s:o}", "readings", tool_json_text(path), "isotropic",
                     tool_json_number(1.0 - c->anisotropy.probability), "anisotropy",
                     anisotropy_json(&c->anisotropy), "ratio_limit",
                     tool_json_number(c->ratio_limit), "more_readings",
                     c->anisotropy.cannot_tell ? json_null() : json_integer((json_int_t)c->more)));
}

static void print_certain(const gonio_isotropy_check *c)
{
    const double p = c->anisotropy.probability;
    if (p > 0.5) {
        fprintf(tool_results(), "anisotropic with a probability of %.4g %%: ", 100.0 * p);
        print_anisotropy(&c->anisotropy);
        fputc('\n', tool_results());
        return;
    }
    fprintf(tool_results(), "isotropic with a probability of %.4g %%", 100.0 * (1.0 - p));
    if (isfinite(c->ratio_limit)) {
        fprintf(tool_results(), "; a ratio of axes above %.2g is excluded (95 %%)", c->ratio_limit);
    }
    fputc('\n', tool_results());
}

static int report(const tool *t, const char *path, const gonio_isotropy_check *c)
{
    if (tool_json) {
        return report_json(t, path, c);
    }
    fprintf(tool_results(), "%s: ", path);
    if (c->anisotropy.cannot_tell) {
        fputs("cannot tell: all readings are at one azimuth of the half vector; add readings with "
              "the sample turned by 45, 90 and 135 degrees\n",
              tool_results());
        return 0;
    }
    print_certain(c);
    if (c->more > 0) {
        fprintf(tool_results(),
                "%zu more reading%s at other turns of the sample (gonio next --anisotropic) would "
                "show a ratio of axes of 1.3\n",
                c->more, tool_plural(c->more));
    }
    return 0;
}

static int check_isotropy(tool *t, const options *o, const char *basis_path, const char *path)
{
    const gonio_readings_options any = {.size = sizeof any,
                                        .values_needed = true,
                                        .average_repeats = true,
                                        .instrument = t->instrument};
    gonio_reconstruct_options how;
    gonio_readings *readings = NULL;
    gonio_basis *basis = NULL;
    gonio_isotropy_check found;
    gonio_reconstruct_options_default(&how);
    posterior_options_apply(&o->posterior, &how);
    how.other_basis = true;
    how.symmetry = o->symmetry;
    gonio_status status = tool_read_readings(t, path, &any, &readings);
    if (status == GONIO_OK) {
        status = tool_basis(t, basis_path, NULL, &basis);
    }
    if (status == GONIO_OK) {
        status = tool_keep_read_channels(t, basis, readings);
    }
    if (status == GONIO_OK) {
        status = gonio_check_isotropy(t->context, basis, readings, &how, &found);
    }
    const int code = status == GONIO_OK ? report(t, path, &found) : tool_exit_code(status);
    gonio_basis_free(&basis);
    gonio_readings_free(&readings);
    return code;
}

static int run(tool *t, void *given)
{
    const options *o = given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count == 0 || count > 2) {
        tool_refuse(t, "READINGS are needed; give a BASIS before them if you have one");
        return EXIT_USAGE;
    }
    if (!posterior_options_check(t, &o->posterior) || !anisotropic_check_symmetry(t, o->symmetry)) {
        return EXIT_USAGE;
    }
    return check_isotropy(t, o, count > 1 ? arguments[0] : NULL, arguments[count - 1]);
}

int cmd_check_isotropy(int argc, const char **argv)
{
    options o = {.posterior = posterior_options_default()};
    const struct poptOption table[] = {POSTERIOR_OPTIONS(&o.posterior),
                                       SYMMETRY_OPTION(&o.symmetry), TOOL_INSTRUMENT_OPTION,
                                       TOOL_READINGS_OPTIONS, TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] [BASIS] READINGS",
        .text = "Without BASIS, the basis of the built-in materials is used. The readings are at "
                "several turns of the sample, or at directions of any azimuths.\n"
                "Example: gonio check-isotropy readings.csv",
        .work = run,
        .options = &o};
    return tool_run(argc, argv, &line);
}
