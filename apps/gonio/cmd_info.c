/* gonio info: what a file is and what it contains. */
#include "azimuths.h"
#include "command_line.h"
#include "info_readings.h"
#include "inputs.h"
#include "json_output.h"
#include "reflectances.h"
#include "seam.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VALID_BINS = 1096216 };

/* Of --albedo-at. */
static const char *albedo_at;
static tool_reflectances reflectances;

/* ---- materials ---- */

typedef struct material_facts {
    int64_t bins;
    double peak;      /* largest value of any channel, 1/sr */
    double asymmetry; /* relative RMS of rho(phi_d) - rho(180 - phi_d), per cent */
    double albedo[TOOL_INCIDENCES][GONIO_CHANNELS];
    double share[TOOL_INCIDENCES]; /* share of the hemisphere that has data */
    double largest_albedo;
    tool_seam seam;
    uint64_t fingerprint;
    bool evaluated;     /* at any directions; the table is sampled from it */
    double reciprocity; /* E6 of rho(o, i) against rho(i, o), per cent; of a table it is exact */
    double turn;        /* E6 of an anisotropic material turned by 90 degrees, per cent */
} material_facts;

static gonio_status fingerprint_of(const gonio_table *table, uint64_t *value)
{
    gonio_fingerprint *fingerprint = NULL;
    const gonio_status status = gonio_fingerprint_create(&fingerprint);
    if (status == GONIO_OK) {
        gonio_fingerprint_add(fingerprint, gonio_table_values(table),
                              sizeof(double) * GONIO_THETA_H_BINS * GONIO_SLAB_VALUES);
        *value = gonio_fingerprint_value(fingerprint);
    }
    gonio_fingerprint_free(&fingerprint);
    return status;
}

/* Sums over one row of phi_d bins of one channel. */
static void add_row(const double *row, material_facts *facts, double *difference, double *square)
{
    for (int p = 0; p < GONIO_PHI_D_BINS; p++) {
        const double mirrored = row[GONIO_PHI_D_BINS - 1 - p];
        if (row[p] >= 0.0) {
            facts->peak = fmax(facts->peak, row[p]);
        }
        if (row[p] >= 0.0 && mirrored >= 0.0) {
            *difference += (row[p] - mirrored) * (row[p] - mirrored);
            *square += row[p] * row[p];
        }
    }
}

static gonio_status find_facts(const gonio_table *table, material_facts *facts)
{
    const double *values = gonio_table_values(table);
    double difference = 0.0;
    double square = 0.0;
    *facts = (material_facts){0};
    for (int theta_h = 0; theta_h < GONIO_THETA_H_BINS; theta_h++) {
        const double *slab = values + (size_t)theta_h * GONIO_SLAB_VALUES;
        bool data[GONIO_SLAB_BINS];
        gonio_slab_mask(theta_h, slab, data);
        for (int k = 0; k < GONIO_SLAB_BINS; k++) {
            facts->bins += data[k];
        }
        for (int k = 0; k < GONIO_CHANNELS * GONIO_THETA_D_BINS; k++) {
            add_row(slab + (size_t)k * GONIO_PHI_D_BINS, facts, &difference, &square);
        }
    }
    facts->asymmetry = square > 0.0 ? 100.0 * sqrt(difference / square) : 0.0;
    tool_albedos_and_shares(table, facts->albedo, facts->share, &facts->largest_albedo);
    facts->seam = tool_find_seam(table);
    return fingerprint_of(table, &facts->fingerprint);
}

/* Whether part of the hemisphere has no data, beyond rounding. */
static bool has_hole(const material_facts *facts, int incidence)
{
    return facts->share[incidence] < 0.9995;
}

static bool has_holes(const material_facts *facts)
{
    bool any = false;
    for (int k = 0; k < TOOL_INCIDENCES; k++) {
        any = any || has_hole(facts, k);
    }
    return any;
}

/* Adds the difference of a pair and its reverse in log space. */
static void add_reverse(const double *forth, const double *back, size_t channels, double sums[2])
{
    for (size_t c = 0; c < channels; c++) {
        if (!isnan(forth[c]) && !isnan(back[c])) {
            const int scale = channels == GONIO_CHANNELS ? (int)c : GONIO_CHANNELS;
            const double g = gonio_log_from_brdf(forth[c], scale);
            const double difference = g - gonio_log_from_brdf(back[c], scale);
            sums[0] += difference * difference;
            sums[1] += g * g;
        }
    }
}

/* Finds the reciprocity error of a material that is evaluated, at thousands of directions. */
static gonio_status find_reciprocity(gonio_context *context, const gonio_material *material,
                                     material_facts *facts)
{
    enum { STRIDE = 373, PAIRS = GONIO_BINS / STRIDE + 1 };
    const size_t channels = gonio_material_describe(material)->channels;
    gonio_pair *pair = calloc((size_t)2 * PAIRS, sizeof *pair);
    double *value = calloc(2 * PAIRS * channels, sizeof *value);
    double sums[2] = {0.0};
    gonio_status status = pair != NULL && value != NULL ? GONIO_OK : GONIO_ERROR_MEMORY;
    for (int k = 0; k < PAIRS && status == GONIO_OK; k++) {
        const gonio_bin bin = gonio_bin_from_index(k * STRIDE);
        pair[2 * k] = gonio_pair_from_half_difference(gonio_bin_centre(bin));
        pair[2 * k + 1] = (gonio_pair){pair[2 * k].outgoing, pair[2 * k].incident};
    }
    if (status == GONIO_OK) {
        status = gonio_material_evaluate(context, material, pair, (size_t)2 * PAIRS, value);
    }
    for (size_t k = 0; k < PAIRS && status == GONIO_OK; k++) {
        add_reverse(value + 2 * k * channels, value + (2 * k + 1) * channels, channels, sums);
    }
    facts->reciprocity = sums[1] > 0.0 ? 100.0 * sqrt(sums[0] / sums[1]) : 0.0;
    free(pair);
    free(value);
    return status;
}

/* The albedos of an anisotropic material, in place of those of its mean on the grid. */
static gonio_status find_azimuths(gonio_context *context, const gonio_material *material,
                                  material_facts *facts)
{
    tool_azimuths found;
    const gonio_status status = tool_find_azimuths(context, material, &found);
    if (status == GONIO_OK) {
        memcpy(facts->albedo, found.albedo, sizeof facts->albedo);
        memcpy(facts->share, found.share, sizeof facts->share);
        facts->largest_albedo = found.largest;
        facts->turn = found.turn;
    }
    return status;
}

static json_t *wavelengths_json(const gonio_material_view *view)
{
    json_t *list = view->wavelength != NULL ? json_array() : json_null();
    for (size_t k = 0; view->wavelength != NULL && k < view->channels; k++) {
        json_array_append_new(list, tool_json_number(view->wavelength[k]));
    }
    return list;
}

/* Adds what a material has beyond its table. */
static void add_view(json_t *object, const gonio_material_view *view, const material_facts *facts)
{
    json_object_set_new(object, "channels", json_integer((json_int_t)view->channels));
    json_object_set_new(object, "wavelengths_nm", wavelengths_json(view));
    json_object_set_new(object, "anisotropic", json_boolean(view->anisotropic));
    json_object_set_new(object, "turned_90_e6_percent",
                        view->anisotropic ? tool_json_number(facts->turn) : json_null());
    json_object_set_new(object, "theta_limit_deg",
                        view->theta_limit > 0.0 ? json_real(view->theta_limit * 180.0 / M_PI)
                                                : json_null());
    json_object_set_new(object, "reciprocity_e6_percent", tool_json_number(facts->reciprocity));
}

/* Whether energy is conserved; null if it is unknown, because directions without data reflect too.
 */
static json_t *conserves_energy(const material_facts *facts)
{
    if (facts->largest_albedo > 1.0) {
        return json_false();
    }
    return has_holes(facts) ? json_null() : json_true();
}

static void add_steps(json_t *object, const gonio_material_view *view, const material_facts *facts)
{
    json_object_set_new(object, "halves_difference_percent",
                        view->both_halves ? tool_json_number(100.0 * view->halves_difference)
                                          : json_null());
    json_object_set_new(object, "phi_d_step_at_0", tool_json_number(facts->seam.across));
    json_object_set_new(object, "phi_d_step_elsewhere", tool_json_number(facts->seam.elsewhere));
}

static void print_view(const gonio_material_view *view, const material_facts *facts)
{
    if (view->wavelength != NULL) {
        double least = INFINITY;
        double most = 0.0;
        for (size_t k = 0; k < view->channels; k++) {
            least = fmin(least, view->wavelength[k]);
            most = fmax(most, view->wavelength[k]);
        }
        printf("  channels     %zu wavelength%s, %g to %g nm; below, their colours\n",
               view->channels, tool_plural(view->channels), least, most);
    } else if (view->channels == 1) {
        printf("  channels     one, without a wavelength\n");
    }
    if (view->theta_limit > 0.0) {
        printf("  measured to  %.4g degrees from the normal\n", view->theta_limit * 180.0 / M_PI);
    }
    if (view->anisotropic) {
        printf("  anisotropic  turned by 90 degrees it differs by %.1f %% (E6)\n", facts->turn);
        printf("               bins below are means over azimuths, and so are albedos\n");
    }
}

static json_t *material_json(const char *path, const gonio_material *material,
                             const material_facts *facts)
{
    char fingerprint[20];
    snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, facts->fingerprint);
    json_t *albedo = json_array();
    for (int k = 0; k < TOOL_INCIDENCES; k++) {
        const double *rgb = facts->albedo[k];
        json_array_append_new(
            albedo, json_pack("{s:f, s:[o, o, o], s:f}", "theta_i_deg", tool_incidence_deg[k],
                              "albedo_rgb", tool_json_number(rgb[0]), tool_json_number(rgb[1]),
                              tool_json_number(rgb[2]), "share_with_data", facts->share[k]));
    }
    json_t *object = json_pack(
        "{s:o, s:s, s:o, s:s, s:I, s:f, s:o, s:o, s:o, s:o, s:s}", "file", tool_json_text(path),
        "kind", "material", "name", tool_json_text(gonio_material_name(material)), "format",
        gonio_material_format(material), "valid_bins", (json_int_t)facts->bins, "valid_share",
        (double)facts->bins / VALID_BINS, "peak_per_sr", tool_json_number(facts->peak),
        "mirror_asymmetry_percent", tool_json_number(facts->asymmetry), "albedo", albedo,
        "conserves_energy", conserves_energy(facts), "fingerprint", fingerprint);
    add_view(object, gonio_material_describe(material), facts);
    add_steps(object, gonio_material_describe(material), facts);
    return object;
}

static void print_albedos(const material_facts *facts)
{
    printf("  albedo       theta_i      R      G      B\n");
    for (int k = 0; k < TOOL_INCIDENCES; k++) {
        const double *rgb = facts->albedo[k];
        if (isnan(rgb[0])) {
            printf("               %4.0f deg  no data\n", tool_incidence_deg[k]);
            continue;
        }
        printf("               %4.0f deg %6.3f %6.3f %6.3f", tool_incidence_deg[k], rgb[0], rgb[1],
               rgb[2]);
        if (has_hole(facts, k)) {
            printf("  at least: %.1f %% of the hemisphere has data", 100.0 * facts->share[k]);
        }
        printf("\n");
    }
}

static const char *energy_in_words(const material_facts *facts)
{
    if (facts->largest_albedo > 1.0) {
        return "NOT conserved: reflects more than it receives";
    }
    return has_holes(facts) ? "not known: directions without data reflect too"
                            : "conserved at these incidences";
}

static void print_reciprocity(const gonio_material_view *view, const material_facts *facts)
{
    if (facts->evaluated) {
        printf("  reciprocity  rho(i, o) and rho(o, i) differ by %.2f %% (E6)\n",
               facts->reciprocity);
    } else if (view->both_halves) {
        printf("  reciprocity  phi_d and phi_d + 180 degrees differ by %.2f %% (RMS); the mean is "
               "taken\n",
               100.0 * view->halves_difference);
    } else {
        printf("  reciprocity  exact: phi_d and phi_d + 180 degrees are one bin\n");
    }
    if (tool_seam_shows(&facts->seam)) {
        printf("  seam         ln(1 + rho/s) jumps by %.3f at phi_d = 0, by %.4f elsewhere (mean): "
               "what\n               the values come from is not reciprocal\n",
               facts->seam.across, facts->seam.elsewhere);
    }
}

static void print_material(const char *path, const gonio_material *material,
                           const material_facts *facts)
{
    printf("%s: %s\n", path, gonio_material_format(material));
    printf("  name         %s\n", gonio_material_name(material));
    print_view(gonio_material_describe(material), facts);
    printf("  valid bins   %" PRId64 " of %d (%.1f %%)\n", facts->bins, (int)VALID_BINS,
           100.0 * (double)facts->bins / VALID_BINS);
    printf("  peak         %.4g 1/sr\n", facts->peak);
    print_albedos(facts);
    printf("  energy       %s\n", energy_in_words(facts));
    print_reciprocity(gonio_material_describe(material), facts);
    printf("  mirror       rho(phi_d) and rho(180 - phi_d) differ by %.2f %% (RMS)\n",
           facts->asymmetry);
    printf("  fingerprint  %016" PRIx64 "\n", facts->fingerprint);
}

static int info_material(const tool *t, const char *path, json_t *results)
{
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    material_facts facts;
    gonio_status status = tool_open_material(t, path, &material);
    if (status == GONIO_OK) {
        status = gonio_table_load(t->context, material, &table);
    }
    if (status == GONIO_OK) {
        status = find_facts(table, &facts);
    }
    facts.evaluated = status == GONIO_OK && gonio_material_describe(material)->evaluated;
    if (facts.evaluated) {
        status = find_reciprocity(t->context, material, &facts);
    }
    if (status == GONIO_OK && gonio_material_describe(material)->anisotropic) {
        status = find_azimuths(t->context, material, &facts);
    }
    json_t *made = NULL;
    if (status == GONIO_OK && results != NULL) {
        made = material_json(path, material, &facts);
        json_array_append_new(results, made);
    } else if (status == GONIO_OK) {
        print_material(path, material, &facts);
    }
    if (status == GONIO_OK) {
        status = tool_reflectances_of_material(t, &reflectances, material, made);
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    return tool_exit_code(status);
}

/* ---- the atlas ---- */

/* Prints a built-in material, or adds it to the results. */
static void info_built_in(const char *name, const char *of, bool anisotropic, json_t *results)
{
    if (results != NULL) {
        json_array_append_new(results, json_pack("{s:s, s:s, s:b}", "name", name, "class", of,
                                                 "anisotropic", anisotropic));
    } else {
        printf("atlas:%-28s %s%s\n", name, of, anisotropic ? ", anisotropic" : "");
    }
}

static int info_atlas(json_t *results)
{
    for (int k = 0; k < gonio_atlas_count(); k++) {
        info_built_in(gonio_atlas_name(k), gonio_atlas_class(k), false, results);
    }
    for (int k = 0; k < gonio_atlas_anisotropic_count(); k++) {
        info_built_in(gonio_atlas_anisotropic_name(k), gonio_atlas_anisotropic_class(k), true,
                      results);
    }
    return 0;
}

/* ---- bases ---- */

static json_t *basis_json(const char *path, const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    char fingerprint[20];
    snprintf(fingerprint, sizeof fingerprint, "%016" PRIx64, view->fingerprint);
    json_t *names = json_array();
    for (size_t k = 0; k < view->materials; k++) {
        json_array_append_new(names, tool_json_text(view->names[k]));
    }
    return json_pack(
        "{s:o, s:s, s:s, s:b, s:b, s:s, s:s, s:I, s:I, s:I, s:I, s:f, s:o, s:s, s:s, s:o}", "file",
        tool_json_text(path), "kind", "basis", "mapping", gonio_mapping_name(view->mapping), "mean",
        !view->without_mean, "loadings", view->loadings != NULL, "representation",
        gonio_representation_name(view->representation), "channels",
        gonio_channel_model_name(view->channels), "components", (json_int_t)view->components,
        "cells", (json_int_t)view->cells, "mixtures", (json_int_t)view->mixtures, "analytic",
        (json_int_t)view->analytic, "explained_variance",
        gonio_basis_cumulative_variance(basis, view->components), "materials", names, "fingerprint",
        fingerprint, "program", view->program, "command", tool_json_text(view->command));
}

static void print_basis(const char *path, const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    printf("%s: gonio basis, %s, %s channels\n", path,
           gonio_representation_name(view->representation),
           gonio_channel_model_name(view->channels));
    printf("  mapping      %s, %s mean%s\n", gonio_mapping_name(view->mapping),
           view->without_mean ? "without" : "with", view->loadings == NULL ? ", no loadings" : "");
    printf("  components   %zu on %zu cells (%zu rows)\n", view->components, view->cells,
           view->rows);
    if (view->mixtures > 0) {
        printf("  mixtures     %zu, beside the materials\n", view->mixtures);
    }
    if (view->analytic > 0) {
        printf("  analytic     %zu columns of random materials\n", view->analytic);
    }
    printf("  variance     ");
    for (size_t k = 1; k < view->components; k = k < 5 ? 5 : 2 * k) {
        printf("%.4f at %zu, ", gonio_basis_cumulative_variance(basis, k), k);
    }
    printf("%.4f at %zu\n", gonio_basis_cumulative_variance(basis, view->components),
           view->components);
    printf("  materials    %zu:", view->materials);
    int column = 80;
    for (size_t k = 0; k < view->materials; k++) {
        const int width = (int)strlen(view->names[k]) + 2;
        if (column + width > 79) {
            printf("\n    ");
            column = 4;
        }
        printf("%s%s", view->names[k], k + 1 < view->materials ? ", " : "\n");
        column += width;
    }
    printf("  fingerprint  %016" PRIx64 "\n", view->fingerprint);
    printf("  made by      %s: %s\n", view->program, view->command);
}

static int info_basis(const tool *t, const char *path, json_t *results)
{
    gonio_basis *basis = NULL;
    const gonio_status status = gonio_basis_read(t->context, path, &basis);
    if (status == GONIO_OK && results != NULL) {
        json_array_append_new(results, basis_json(path, basis));
    } else if (status == GONIO_OK) {
        print_basis(path, basis);
    }
    gonio_basis_free(&basis);
    return tool_exit_code(status);
}

/* ---- meshes and images ---- */

/* Prints the kind of a file that is not read. */
static int info_other(const tool *t, const char *path, json_t *results)
{
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    const char *format = NULL;
    const gonio_status status = gonio_file_kind(t->context, path, &kind, &format);
    if (status != GONIO_OK) {
        return tool_exit_code(status);
    }
    if (results != NULL) {
        json_array_append_new(results, json_pack("{s:o, s:s, s:s}", "file", tool_json_text(path),
                                                 "kind", gonio_kind_name(kind), "format", format));
    } else {
        printf("%s: %s, %s\n", path, gonio_kind_name(kind), format);
    }
    return 0;
}

/* ---- the kinds of files ---- */

typedef struct kind_info {
    gonio_kind kind;
    int (*info)(const tool *t, const char *path, json_t *results);
} kind_info;

static const kind_info kinds[] = {
    {GONIO_KIND_MATERIAL, info_material},
    {GONIO_KIND_BASIS, info_basis},
    {GONIO_KIND_READINGS, tool_info_readings},
    {GONIO_KIND_MESH, info_other},
    {GONIO_KIND_IMAGE, info_other},
};

enum { KINDS = sizeof kinds / sizeof *kinds };

static int info(const tool *t, const char *path, json_t *results)
{
    if (strcmp(path, "atlas:") == 0) {
        return info_atlas(results);
    }
    if (tool_names_format(t, path)) {
        return tool_info_readings(t, path, results);
    }
    unsigned any = 0;
    gonio_kind kind = GONIO_KIND_UNKNOWN;
    for (int k = 0; k < KINDS; k++) {
        any |= kinds[k].kind;
    }
    const gonio_status status = gonio_file_expect(t->context, path, any, &kind);
    if (status != GONIO_OK) {
        return tool_exit_code(status);
    }
    int k = 0;
    while (kinds[k].kind != kind) {
        k++;
    }
    return kinds[k].info(t, path, results);
}

static int run(tool *t, void *given)
{
    (void)given;
    size_t count = 0;
    const char **arguments = tool_arguments(t, &count);
    if (count == 0) {
        tool_refuse(t, "no file given");
        return EXIT_USAGE;
    }
    if (!tool_check_albedo_at(t, albedo_at, &reflectances)) {
        return EXIT_USAGE;
    }
    json_t *results = tool_json ? json_array() : NULL;
    int code = 0;
    for (size_t k = 0; k < count; k++) {
        const int one = info(t, arguments[k], results);
        code = one != 0 ? one : code;
    }
    if (results != NULL && code == 0) {
        return tool_print_json(t, results);
    }
    json_decref(results);
    return code;
}

int cmd_info(int argc, const char **argv)
{
    albedo_at = NULL;
    const struct poptOption table[] = {TOOL_ALBEDO_AT(&albedo_at), TOOL_INSTRUMENT_OPTION,
                                       TOOL_READINGS_OPTIONS, TOOL_OPTIONS};
    const tool_command_line line = {
        .table = table,
        .usage = "[OPTION...] FILE...",
        .text = "FILE is a material, a basis, a plan, readings, a mesh or an image, told apart by\n"
                "content.\n"
                "'gonio info atlas:' lists the built-in materials.",
        .work = run};
    return tool_run(argc, argv, &line);
}
