/* Planning for an instrument: time, orders, and what 45 minutes are worth.
 *
 * The built-in four-axis goniometer reads materials that were left out, with its noise. It is
 * compared with the plan that knows no instrument: those of its readings that can be reached, in
 * its own order, as many as fit into two hours. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { DIRECTIONS = 10000, PLANNED = 200, FREE = 320, TESTED = 6 };

static gonio_plan *plan_with(gonio_context *context, const gonio_basis *basis,
                             const gonio_instrument *rig, size_t count, double budget)
{
    gonio_plan_options options;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&options);
    options.instrument = rig;
    options.budget = budget;
    options.count = count;
    check(gonio_plan_create(context, basis, &options, &plan) == GONIO_OK, "planning");
    return plan;
}

/* ---- time ---- */

static double degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

static void write_axes(FILE *file, const gonio_instrument_view *view)
{
    for (size_t k = 0; k < view->axes; k++) {
        const gonio_axis *axis = &view->axis[k];
        fprintf(file,
                "%s\"%s\": {\"from_deg\": -360, \"to_deg\": 360, \"speed_deg_per_s\": %.9g, "
                "\"settling_s\": %.9g}",
                k > 0 ? ", " : "", axis->name, degrees(axis->speed), axis->settling);
    }
}

static void write_rows(FILE *file, const gonio_instrument_view *view, const gonio_setting *setting)
{
    for (size_t k = 0; k < DIRECTIONS; k++) {
        const gonio_pair *p = &setting[k].pair;
        fprintf(file, "%s[%.9f, %.9f, %.9f, %.9f", k > 0 ? ",\n" : "", degrees(p->incident.theta),
                degrees(p->incident.phi), degrees(p->outgoing.theta), degrees(p->outgoing.phi));
        for (size_t a = 0; a < view->axes; a++) {
            fprintf(file, ", %.9f", degrees(setting[k].axis[a]));
        }
        fprintf(file, "]");
    }
}

/* An instrument that reaches 10,000 directions of another one, as a table. */
static gonio_instrument *make_table(gonio_context *context, const gonio_instrument *rig)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    const gonio_instrument_view *view = gonio_instrument_describe(rig);
    char path[] = "/tmp/gonio-bench-XXXXXX";
    gonio_setting *setting = NULL;
    gonio_instrument *table = NULL;
    size_t count = 0;
    check(gonio_instrument_candidates(context, rig, freedom, 2 * DIRECTIONS, &setting, &count) ==
                  GONIO_OK &&
              count >= DIRECTIONS,
          "candidates");
    const int descriptor = mkstemp(path);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    check(file != NULL, "a file of the instrument");
    fprintf(file, "{\"gonio_instrument\": 1, \"kinematics\": \"table\", \"axes\": {");
    write_axes(file, view);
    fprintf(file, "},\n\"times\": {\"exposure_s\": %.9g, \"incidence_change_s\": %.9g},\n",
            view->exposure, view->incidence_change);
    fprintf(file, "\"directions\": [\n");
    write_rows(file, view, setting);
    fprintf(file, "]}\n");
    check(fclose(file) == 0 && gonio_instrument_read(context, path, &table) == GONIO_OK,
          "the instrument of a table");
    unlink(path);
    free(setting);
    return table;
}

static void report_plan(bench *b, gonio_context *context, const gonio_basis *basis,
                        const gonio_instrument *rig, const char *name)
{
    char label[128];
    const double start = now();
    gonio_plan *plan = plan_with(context, basis, rig, PLANNED, 0.0);
    snprintf(label, sizeof label, "instrument: plan and order 200 of %s", name);
    report(b, label, now() - start, "s");
    report(b, "instrument: their expected error (E6)", plan->expected[plan->count - 1], "%");
    report(b, "instrument: the run in the order of choice", plan->run->unordered / 60.0, "min");
    report(b, "instrument: the run in the planned order", plan->run->duration / 60.0, "min");
    gonio_plan_free(&plan);
}

/* 200 readings among 10,000, and of the instrument itself; what the order is worth. */
static void bench_time(bench *b, gonio_context *context, const gonio_basis *basis,
                       const gonio_instrument *rig)
{
    gonio_instrument *table = make_table(context, rig);
    report_plan(b, context, basis, table, "10,000 directions");
    report_plan(b, context, basis, rig, "what the four-axis goniometer offers");
    gonio_instrument_free(&table);
}

/* ---- a time that is given ---- */

/* The readings of a free plan that can be reached, as many as fit: pair[]. */
static size_t filter(const gonio_instrument *rig, const gonio_plan *plan, double budget,
                     gonio_pair *pair)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_setting *run = calloc(plan->count, sizeof *run);
    size_t count = 0;
    check(run != NULL, "memory");
    for (size_t k = 0; k < plan->count; k++) {
        if (gonio_instrument_settings(rig, plan->entries[k].pair, freedom, &run[count], 1) == 1) {
            pair[count] = run[count].pair;
            count++;
        }
    }
    while (count > 0 && gonio_instrument_schedule(rig, run, count, NULL) > budget) {
        count--;
    }
    free(run);
    return count;
}

/* E6 of a material completed from noisy readings, per cent. */
static double error_of(gonio_context *context, const gonio_basis *basis, const gonio_pair *pair,
                       size_t count, const gonio_material *material)
{
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = count, .channels = GONIO_CHANNELS, .pair = pair};
    const gonio_instrument_options noise = {
        .size = sizeof noise, .noise = 0.01, .floor = 1e-5, .seed = 1};
    gonio_readings *readings = NULL;
    gonio_reconstruction *made = NULL;
    gonio_material *completed = NULL;
    gonio_comparison comparison = {0};
    check(gonio_readings_create(context, &arrays, NULL, &readings) == GONIO_OK &&
              gonio_measure_material(context, readings, material, &noise) == GONIO_OK &&
              gonio_reconstruct(context, basis, readings, NULL, &made) == GONIO_OK &&
              gonio_reconstruction_material(context, basis, made, "bench", &completed) ==
                  GONIO_OK &&
              gonio_compare(context, material, completed, &comparison) == GONIO_OK,
          "completing a material");
    gonio_material_free(&completed);
    gonio_reconstruction_free(&made);
    gonio_readings_free(&readings);
    return comparison.all.value[GONIO_E6];
}

/* The mean over materials that were left out. */
static double mean_error(const bench *b, gonio_context *context, const gonio_basis *basis,
                         const gonio_pair *pair, size_t count)
{
    double sum = 0.0;
    size_t tested = 0;
    for (size_t k = BASIS_MATERIALS; k < b->count && tested < TESTED; k++, tested++) {
        gonio_material *material = NULL;
        check(gonio_material_open(context, b->paths[k], &material) == GONIO_OK, "opening");
        sum += error_of(context, basis, pair, count, material);
        gonio_material_free(&material);
    }
    return sum / (double)tested;
}

static void bench_budget(bench *b, gonio_context *context, const gonio_basis *basis,
                         const gonio_instrument *rig)
{
    gonio_plan_options options;
    gonio_plan *unlimited = NULL;
    gonio_plan_options_default(&options);
    options.count = FREE;
    check(gonio_plan_create(context, basis, &options, &unlimited) == GONIO_OK, "planning");
    gonio_pair *pair = calloc(unlimited->count, sizeof *pair);
    check(pair != NULL, "memory");
    const size_t count = filter(rig, unlimited, 7200.0, pair);
    report(b, "instrument: readings of the free plan in 2 h", (double)count, "");
    report(b, "instrument: their error (E6)", mean_error(b, context, basis, pair, count), "%");
    free(pair);
    gonio_plan_free(&unlimited);

    const double start = now();
    gonio_plan *plan = plan_with(context, basis, rig, GONIO_USUAL_COUNT, 2700.0);
    report(b, "instrument: planning 45 min", now() - start, "s");
    pair = calloc(plan->count, sizeof *pair);
    check(pair != NULL, "memory");
    for (size_t k = 0; k < plan->count; k++) {
        pair[k] = plan->entries[k].pair;
    }
    report(b, "instrument: readings of the plan of 45 min", (double)plan->count, "");
    report(b, "instrument: their error (E6)", mean_error(b, context, basis, pair, plan->count),
           "%");
    free(pair);
    gonio_plan_free(&plan);
}

void bench_instrument(bench *b)
{
    gonio_context *context = make_context(0);
    gonio_basis *basis = learn(context, b->paths, BASIS_MATERIALS, NULL);
    gonio_instrument *rig = NULL;
    check(gonio_instrument_read(context, "four-axis", &rig) == GONIO_OK, "the instrument");
    bench_time(b, context, basis, rig);
    bench_budget(b, context, basis, rig);
    gonio_instrument_free(&rig);
    gonio_basis_free(&basis);
    gonio_context_free(&context);
}
