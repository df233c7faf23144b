/* What readings seem to be, in words and as JSON: see interpretation.h. */
#include "interpretation.h"

#include <math.h>
#include <stdio.h>

#include "json_output.h"

/* ln of the largest odds that are printed. */
static const double MOST_EVIDENCE = 30.0;

static void note_alternatives(const char *command, const char *path, const gonio_interpretation *i)
{
    fprintf(stderr, "gonio %s: note: %s: the readings, whose albedo is %.2g, fit far better if ",
            command, path, i->albedo);
    for (size_t k = 0; k < i->alternatives; k++) {
        fprintf(stderr, "%s%s (albedo %.2g)", k > 0 ? ", or if " : "", i->alternative[k].mistake,
                i->alternative[k].albedo);
    }
    fputs(" (--no-checks turns this check off)\n", stderr);
}

static size_t lines_listed(const gonio_interpretation *i)
{
    return i->unmeasured < GONIO_MOST_UNMEASURED_LINES ? i->unmeasured
                                                       : GONIO_MOST_UNMEASURED_LINES;
}

static void note_unmeasured(const char *command, const char *path, const gonio_interpretation *i)
{
    fprintf(stderr,
            "gonio %s: note: %s: %zu reading%s far below what the others predict: not measured? "
            "left out: line%s",
            command, path, i->unmeasured, i->unmeasured == 1 ? " is" : "s are",
            tool_plural(i->unmeasured));
    for (size_t k = 0; k < lines_listed(i); k++) {
        fprintf(stderr, "%s %zu", k > 0 ? "," : "", i->unmeasured_line[k]);
    }
    fprintf(stderr, "%s (--no-checks keeps %s)\n", i->unmeasured > lines_listed(i) ? " ..." : "",
            i->unmeasured == 1 ? "it" : "them");
}

static void note_anisotropy(const char *command, const char *path, const gonio_interpretation *i)
{
    fprintf(stderr, "gonio %s: note: %s: the material seems anisotropic: ", command, path);
    if (i->turned > 0.0) {
        fprintf(stderr,
                "%zu readings differ by a factor of %.2g (median) from those at the same angles "
                "and another turn of the sample; ",
                i->turned_pairs, exp(i->turned));
    }
    if (i->anisotropy_evidence > 0.0) {
        fprintf(stderr, "that explains the readings %.2g times as well; ",
                exp(fmin(i->anisotropy_evidence, MOST_EVIDENCE)));
    }
    fputs("gonio assumes isotropy without --anisotropic\n", stderr);
}

void tool_note_interpretation(const char *command, const char *path, const gonio_interpretation *i)
{
    if (tool_quiet) {
        return;
    }
    if (i->alternatives > 0) {
        note_alternatives(command, path, i);
    }
    if (i->unmeasured > 0) {
        note_unmeasured(command, path, i);
    }
    if (i->anisotropic) {
        note_anisotropy(command, path, i);
    }
}

void tool_add_interpretation(json_t *json, const gonio_interpretation *i)
{
    json_t *alternatives = json_array();
    json_t *lines = json_array();
    for (size_t k = 0; k < i->alternatives; k++) {
        json_array_append_new(alternatives,
                              json_pack("{s:s, s:o}", "mistake", i->alternative[k].mistake,
                                        "albedo", tool_json_number(i->alternative[k].albedo)));
    }
    for (size_t k = 0; k < lines_listed(i); k++) {
        json_array_append_new(lines, json_integer((json_int_t)i->unmeasured_line[k]));
    }
    json_object_set_new(json, "suspicion",
                        i->alternatives > 0 ? json_string(i->alternative[0].mistake) : json_null());
    json_object_set_new(json, "alternatives", alternatives);
    json_object_set_new(json, "unmeasured", json_integer((json_int_t)i->unmeasured));
    json_object_set_new(json, "unmeasured_lines", lines);
    json_object_set_new(json, "anisotropic", json_boolean(i->anisotropic));
    json_object_set_new(json, "anisotropy_evidence", tool_json_number(i->anisotropy_evidence));
}
