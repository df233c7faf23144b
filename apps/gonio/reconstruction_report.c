/* What gonio reconstruct says of its results: see reconstruction_report.h. */
#include "reconstruction_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "albedos.h"
#include "interpretation.h"
#include "json_output.h"
#include "readings_as.h"

/* The largest albedo of the result. */
typedef struct energy {
    bool known;
    double albedo;
    double theta_i; /* degrees */
} energy;

/* Finds the largest albedo. It is unknown only if memory runs out. The context is a new one, so
 * that it is also known of results made before an interrupt. */
static energy find_energy(const gonio_basis *basis, const gonio_reconstruction *r)
{
    gonio_material *material = NULL;
    gonio_table *table = NULL;
    gonio_context *context = NULL;
    const gonio_context_options silent = {.size = sizeof silent, .threads = tool_threads};
    energy e = {0};
    e.known = gonio_context_create(&context, &silent) == GONIO_OK &&
              gonio_reconstruction_material(context, basis, r, "made", &material) == GONIO_OK &&
              gonio_table_load(context, material, &table) == GONIO_OK;
    if (e.known) {
        double albedo[TOOL_INCIDENCES][GONIO_CHANNELS];
        e.theta_i = tool_incidence_deg[tool_albedos(table, albedo, &e.albedo)];
    }
    gonio_table_free(&table);
    gonio_material_free(&material);
    gonio_context_free(&context);
    return e;
}

static double largest(const double *value, size_t count)
{
    double most = value[0];
    for (size_t k = 1; k < count; k++) {
        most = value[k] > most ? value[k] : most;
    }
    return most;
}

/* A result that reflects too much at larger angles only is one of too few readings there, degrees.
 */
static const double NOT_GRAZING = 60.0;

static void warn(const gonio_reconstruction *r, const char *output, const energy *e)
{
    tool_note_interpretation("reconstruct", output, &r->interpretation);
    if (r->dark != NULL && !tool_quiet) {
        fprintf(stderr,
                "gonio reconstruct: note: %s: the instrument seems to subtract up to "
                "%.2g/cos(theta_i) 1/sr too much, which is corrected for (--no-checks turns this "
                "off)\n",
                output, largest(r->dark, r->columns));
    }
    if (e->known && e->albedo > 1.0 && !tool_quiet) {
        fprintf(stderr,
                "gonio reconstruct: note: %s reflects %.2f times the light from theta_i = %g "
                "degrees, which no material can do",
                output, e->albedo, e->theta_i);
        if (e->theta_i <= NOT_GRAZING) {
            fprintf(stderr, " (%.2f if the values are reflectance factors)", e->albedo / M_PI);
        }
        fputc('\n', stderr);
    }
}

/* The dark level of each channel, or null. */
static json_t *dark_levels(const gonio_reconstruction *r)
{
    json_t *levels = r->dark != NULL ? json_array() : json_null();
    for (size_t k = 0; r->dark != NULL && k < r->columns; k++) {
        json_array_append_new(levels, json_real(r->dark[k]));
    }
    return levels;
}

static json_t *as_json(const gonio_reconstruction *r, const char *output, const energy *e)
{
    json_t *made =
        r->field != NULL
            ? json_pack("{s:o, s:I, s:I, s:f, s:f, s:I, s:f, s:o}", "output",
                        tool_json_text(output), "channels", (json_int_t)r->columns, "readings",
                        (json_int_t)r->readings, "expected_e6_percent", r->predicted_e6,
                        "residual_log", r->residual, "outlying", (json_int_t)r->outlying,
                        "remainder_log", r->smoothness, "dark_level_per_sr", dark_levels(r))
            : json_pack("{s:o, s:I, s:I, s:o, s:f}", "output", tool_json_text(output), "components",
                        (json_int_t)r->components, "readings", (json_int_t)r->readings,
                        "condition_number", tool_json_number(r->condition_number), "residual_log",
                        r->residual);
    if (r->field != NULL) {
        tool_add_interpretation(made, &r->interpretation);
        json_object_set_new(made, "database_share", tool_json_number(r->database_share));
    }
    if (e->known) {
        json_object_set_new(made, "largest_albedo", tool_json_number(e->albedo));
    }
    return made;
}

static void print(const gonio_reconstruction *r, const char *output, const energy *e)
{
    if (r->field != NULL) {
        fprintf(tool_results(),
                "%s: from %zu reading%s in %zu channel%s; expected error (E6) %.2f %%, residual "
                "%.4f (log units)",
                output, r->readings, tool_plural(r->readings), r->columns, tool_plural(r->columns),
                r->predicted_e6, r->residual);
    } else {
        fprintf(tool_results(),
                "%s: %zu coefficient%s from %zu reading%s, condition number %.3f, residual %.4f "
                "(log units)",
                output, r->components, tool_plural(r->components), r->readings,
                tool_plural(r->readings), r->condition_number, r->residual);
    }
    if (e->known) {
        fprintf(tool_results(), ", albedo at most %.2f", e->albedo);
        if (r->field != NULL && tool_as == NULL) {
            fprintf(tool_results(), " (%.2g if these are reflectance factors)", e->albedo / M_PI);
        }
    }
    if (r->outlying > 0) {
        fprintf(tool_results(), ", %zu value%s contradicted by the others", r->outlying,
                tool_plural(r->outlying));
    }
    fputc('\n', tool_results());
}

/* From this share on it is said how much of a result rests on the database. */
static const double WORTH_SAYING = 0.01;

static void print_database_share(const gonio_reconstruction *r)
{
    if (r->field != NULL && r->database_share >= WORTH_SAYING) {
        fprintf(
            tool_results(),
            "  database     %.0f %% of the BRDF rests on the database alone: no reading is near\n",
            100.0 * r->database_share);
    }
}

/* The energies of several results, one on each thread, or one after the other on all threads where
 * there are fewer. */
static void find_energies(const gonio_basis *basis, gonio_reconstruction *const *made, size_t count,
                          energy *found)
{
    const gonio_context_options own = {.size = sizeof own, .threads = tool_threads};
    gonio_context *context = NULL;
    (void)gonio_context_create(&context, &own);
    const size_t threads = (size_t)gonio_context_threads(context);
    gonio_context_free(&context);
#pragma omp parallel for schedule(dynamic, 1) if (count >= threads) num_threads((int)threads)
    for (size_t k = 0; k < count; k++) {
        found[k] = made[k] != NULL ? find_energy(basis, made[k]) : (energy){0};
    }
}

/* Reports a result and its warnings, as a line or as an object appended to `results`. */
static gonio_status report_one(const tool *t, const tool_reflectances *at, const gonio_basis *basis,
                               const gonio_reconstruction *r, const char *output, const energy *e,
                               json_t *results)
{
    json_t *made = results != NULL ? as_json(r, output, e) : NULL;
    warn(r, output, e);
    if (made != NULL) {
        json_array_append_new(results, made);
    } else {
        print(r, output, e);
        print_database_share(r);
    }
    return tool_reflectances_of_reconstruction(t, at, basis, r, made);
}

gonio_status reconstruction_report(const tool *t, const tool_reflectances *at,
                                   const gonio_basis *basis, gonio_reconstruction *const *made,
                                   char *const *outputs, size_t count, json_t *results)
{
    if (tool_quiet && results == NULL) {
        return GONIO_OK;
    }
    energy *found = calloc(count, sizeof *found);
    if (found == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    gonio_status status = GONIO_OK;
    find_energies(basis, made, count, found);
    for (size_t k = 0; k < count; k++) {
        if (made[k] != NULL) {
            const gonio_status reported =
                report_one(t, at, basis, made[k], outputs[k], &found[k], results);
            status = reported != GONIO_OK ? reported : status;
        }
    }
    free(found);
    return status;
}
