/* Planning for an instrument: time, orders, and what 45 minutes are worth.
 *
 * The built-in four-axis goniometer reads materials that were left out, with its noise. It is
 * compared with the plan that knows no instrument: those of its readings that can be reached, in
 * its own order, as many as fit into two hours. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PLANNED = 200, FREE = 320, TESTED = 6 };

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

/* Time of 200 readings among up to 10,000, and what the order is worth. */
static void bench_time(bench *b, gonio_context *context, const gonio_basis *basis,
                       const gonio_instrument *rig)
{
    const gonio_freedom freedom = GONIO_ALL_FREEDOM;
    gonio_setting *setting = NULL;
    size_t count = 0;
    check(gonio_instrument_candidates(context, rig, freedom, 10000, &setting, &count) == GONIO_OK,
          "candidates");
    free(setting);
    const double start = now();
    gonio_plan *plan = plan_with(context, basis, rig, PLANNED, 0.0);
    report(b, "instrument: reachable directions", (double)count, "");
    report(b, "instrument: plan and order 200 of them", now() - start, "s");
    report(b, "instrument: the run in the order of choice", plan->run->unordered / 60.0, "min");
    report(b, "instrument: the run in the planned order", plan->run->duration / 60.0, "min");
    gonio_plan_free(&plan);
}

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
