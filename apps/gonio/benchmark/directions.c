/* Ways to choose the directions that are read: see directions.h. */
#include "directions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "core/core.h"
#include "incidences.h"

enum { RANDOM_STREAM = 3000, PLANE_STREAM = 4000, REPEATS = 9 };
static const char usual_plan[] = "expected-error";

static gonio_status make_room(gonio_context *context, benchmark_pairs *chosen, size_t n)
{
    gonio_pair *more = reallocarray(chosen->pair, n > 0 ? n : 1, sizeof *chosen->pair);
    if (more == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory");
    }
    chosen->pair = more;
    return GONIO_OK;
}

static gonio_status take(gonio_context *context, const gonio_pair *pair, size_t count,
                         benchmark_pairs *chosen)
{
    const gonio_status status = make_room(context, chosen, count);
    if (status == GONIO_OK) {
        memcpy(chosen->pair, pair, count * sizeof *pair);
        chosen->count = count;
    }
    return status;
}

/* ---- plans ---- */

static json_t *pairs_json(const gonio_plan *plan)
{
    json_t *list = json_array();
    for (size_t k = 0; k < plan->count; k++) {
        const gonio_pair *p = &plan->entries[k].pair;
        json_array_append_new(list, json_pack("[f, f, f, f]", p->incident.theta, p->incident.phi,
                                              p->outgoing.theta, p->outgoing.phi));
    }
    return list;
}

static gonio_status take_json(gonio_context *context, const json_t *list, size_t n,
                              benchmark_pairs *chosen)
{
    const size_t count = n < json_array_size(list) ? n : json_array_size(list);
    const gonio_status status = make_room(context, chosen, count);
    for (size_t k = 0; k < count && status == GONIO_OK; k++) {
        double angle[4];
        for (size_t a = 0; a < 4; a++) {
            angle[a] = json_number_value(json_array_get(json_array_get(list, k), a));
        }
        chosen->pair[k] = (gonio_pair){{angle[0], angle[1]}, {angle[2], angle[3]}};
    }
    chosen->count = status == GONIO_OK ? count : 0;
    return status;
}

static gonio_status make_plan(gonio_context *context, const benchmark_setting *setting,
                              const gonio_basis *basis, const char *method,
                              const gonio_pair *candidate, size_t candidates, size_t n,
                              gonio_plan **plan)
{
    const size_t components = gonio_basis_describe(basis)->components;
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = method;
    options.count = n;
    options.seed = setting->seed;
    options.keep_history = false;
    if (gonio_plan_method_basis(method)->mixtures) {
        options.candidates = candidates > 0 ? candidate : NULL;
        options.candidate_count = candidates;
    } else {
        options.components = components < n ? components : n;
    }
    return gonio_plan_create(context, basis, &options, plan);
}

/* Without a plan for an n that the method cannot plan for with this basis, which is silent. */
static gonio_status plan_published(gonio_context *context, const benchmark_setting *setting,
                                   const gonio_basis *basis, const char *method, json_t *plans)
{
    gonio_context *silent = NULL;
    const gonio_context_options quiet = {.size = sizeof quiet, .threads = 1};
    gonio_status status = gonio_context_create(&silent, &quiet);
    for (size_t i = 0; i < setting->sizes && status == GONIO_OK; i++) {
        char key[32];
        gonio_plan *plan = NULL;
        snprintf(key, sizeof key, "%zu", setting->size[i]);
        status = make_plan(silent, setting, basis, method, NULL, 0, setting->size[i], &plan);
        if (status == GONIO_OK) {
            json_object_set_new(plans, key, pairs_json(plan));
        } else if (status == GONIO_ERROR_ARGUMENT || status == GONIO_ERROR_DATA) {
            status = GONIO_OK;
        }
        gonio_plan_free(&plan);
        status = status == GONIO_OK ? gonio_i_progress(context, "a plan", 0.5) : status;
    }
    gonio_context_free(&silent);
    return status;
}

gonio_status benchmark_plan(gonio_context *context, const benchmark_setting *setting,
                            benchmark_bases *bases, const benchmark_directions *ways,
                            const benchmark_pairs *candidates, json_t **plan)
{
    const gonio_basis *basis = NULL;
    gonio_plan *made = NULL;
    gonio_status status = benchmark_basis(context, bases, ways->plan_method, &basis);
    if (status != GONIO_OK) {
        return status;
    }
    if (ways->own_methods) {
        json_t *plans = json_object();
        status = plan_published(context, setting, basis, ways->plan_method, plans);
        *plan = status == GONIO_OK ? plans : NULL;
        if (status != GONIO_OK) {
            json_decref(plans);
        }
        return status;
    }
    const size_t n = setting->size[setting->sizes - 1];
    status = make_plan(context, setting, basis, ways->plan_method, candidates->pair,
                       candidates->count, n, &made);
    if (status == GONIO_OK) {
        *plan = pairs_json(made);
    }
    gonio_plan_free(&made);
    return status;
}

static bool is_pair(const json_t *pair)
{
    bool fine = json_array_size(pair) == 4;
    for (size_t k = 0; k < 4 && fine; k++) {
        const json_t *angle = json_array_get(pair, k);
        const double most = k % 2 == 0 ? M_PI_2 : 2.0 * M_PI;
        fine = json_is_number(angle) && json_number_value(angle) >= 0.0 &&
               json_number_value(angle) <= most;
    }
    return fine;
}

static bool is_list_of_pairs(const json_t *list)
{
    bool fine = json_is_array(list);
    for (size_t k = 0; k < json_array_size(list) && fine; k++) {
        fine = is_pair(json_array_get(list, k));
    }
    return fine;
}

bool benchmark_plan_accept(const benchmark_directions *ways, const json_t *plan, char *complaint,
                           size_t size)
{
    bool fine = ways->own_methods ? json_is_object(plan) : is_list_of_pairs(plan);
    const char *key = NULL;
    json_t *list = NULL;
    if (ways->own_methods) {
        json_object_foreach((json_t *)plan, key, list)
        {
            fine = fine && is_list_of_pairs(list);
        }
    }
    if (!fine) {
        snprintf(complaint, size, "it is no list of pairs of directions");
    }
    return fine;
}

static gonio_status choose_published(gonio_context *context, const benchmark_choosing *with,
                                     size_t n, benchmark_pairs *chosen)
{
    char key[32];
    snprintf(key, sizeof key, "%zu", n);
    return take_json(context, json_object_get(with->plan, key), n, chosen);
}

static size_t largest(const benchmark_choosing *with)
{
    const size_t most = benchmark_sample_most(with->sample);
    const size_t n = with->setting->size[with->setting->sizes - 1];
    return n < most ? n : most;
}

/* The first n of a plan, of tables of that for all. */
static gonio_status plan_first(gonio_context *context, const benchmark_choosing *with, size_t n,
                               benchmark_pairs *chosen)
{
    if (with->plan != NULL) {
        return take_json(context, with->plan, n, chosen);
    }
    const gonio_basis *basis = NULL;
    gonio_plan *plan = NULL;
    gonio_status status = benchmark_basis(context, with->bases, usual_plan, &basis);
    if (status == GONIO_OK) {
        status = make_plan(context, with->setting, basis, usual_plan, with->sample->candidate,
                           with->sample->candidates, n, &plan);
    }
    if (status == GONIO_OK) {
        status = make_room(context, chosen, plan->count);
    }
    for (size_t k = 0; status == GONIO_OK && k < plan->count; k++) {
        chosen->pair[k] = plan->entries[k].pair;
        chosen->count = k + 1;
    }
    gonio_plan_free(&plan);
    return status;
}

/* The first of a plan for the largest n that the sample allows are a good plan themselves. */
static gonio_status choose_planned(gonio_context *context, const benchmark_choosing *with, size_t n,
                                   benchmark_pairs *chosen)
{
    return chosen->count >= n ? GONIO_OK : plan_first(context, with, largest(with), chosen);
}

/* ---- on the way ---- */

static gonio_status append(gonio_context *context, const gonio_plan *plan, size_t most,
                           benchmark_pairs *chosen)
{
    const gonio_status status = make_room(context, chosen, chosen->count + plan->count);
    for (size_t k = 0; status == GONIO_OK && k < plan->count && chosen->count < most; k++) {
        chosen->pair[chosen->count++] = plan->entries[k].pair;
    }
    return status;
}

/* One batch, after what was read. */
static gonio_status go_on(gonio_context *context, const benchmark_choosing *with, size_t n,
                          benchmark_pairs *chosen)
{
    const size_t batch = with->setting->batch;
    const gonio_reconstruct_options how = benchmark_how(with->setting);
    const gonio_basis *basis = NULL;
    gonio_readings *readings = NULL;
    gonio_plan *plan = NULL;
    gonio_plan_options what;
    gonio_plan_options_default(&what);
    what.count = n - chosen->count < batch ? n - chosen->count : batch;
    what.candidates = with->sample->candidates > 0 ? with->sample->candidate : NULL;
    what.candidate_count = with->sample->candidates;
    gonio_status status = benchmark_basis(context, with->bases, usual_plan, &basis);
    if (status == GONIO_OK) {
        status = benchmark_sample_read(context, with->setting, with->sample, chosen, &readings);
    }
    if (status == GONIO_OK) {
        status = gonio_plan_next(context, basis, readings, &how, &what, NULL, NULL, &plan);
    }
    if (status == GONIO_OK) {
        status = append(context, plan, n, chosen);
    }
    gonio_plan_free(&plan);
    gonio_readings_free(&readings);
    return status;
}

static gonio_status choose_next(gonio_context *context, const benchmark_choosing *with, size_t n,
                                benchmark_pairs *chosen)
{
    gonio_status status = GONIO_OK;
    if (chosen->count < BENCHMARK_FIRST) {
        const size_t first = n < BENCHMARK_FIRST ? n : BENCHMARK_FIRST;
        chosen->count = 0;
        status = plan_first(context, with, first, chosen);
    }
    while (status == GONIO_OK && chosen->count < n) {
        const size_t before = chosen->count;
        status = go_on(context, with, n, chosen);
        if (chosen->count == before) {
            break;
        }
    }
    return status;
}

/* ---- drawn at random ---- */

/* The first `count` of a random order of the candidates. */
static gonio_status draw(gonio_context *context, const benchmark_choosing *with,
                         const gonio_pair *from, size_t candidates, uint64_t stream, size_t count,
                         benchmark_pairs *chosen)
{
    gonio_i_random random;
    count = count < candidates ? count : candidates;
    gonio_pair *all = gonio_i_allocate(context, candidates + 1, sizeof *all);
    if (all == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    memcpy(all, from, candidates * sizeof *all);
    gonio_i_random_seed(&random, with->setting->seed, stream + with->draw);
    for (size_t k = 0; k < count; k++) {
        const size_t other = k + gonio_i_random_below(&random, candidates - k);
        const gonio_pair kept = all[k];
        all[k] = all[other];
        all[other] = kept;
    }
    const gonio_status status = take(context, all, count, chosen);
    free(all);
    return status;
}

static gonio_status choose_random(gonio_context *context, const benchmark_choosing *with, size_t n,
                                  benchmark_pairs *chosen)
{
    const benchmark_sample *s = with->sample;
    return draw(context, with, s->candidate, s->candidates, RANDOM_STREAM, n, chosen);
}

/* The same directions, the first of them read ten times. */
static gonio_status choose_repeated(gonio_context *context, const benchmark_choosing *with,
                                    size_t n, benchmark_pairs *chosen)
{
    gonio_status status = choose_random(context, with, n, chosen);
    if (status == GONIO_OK && chosen->count == n) {
        status = make_room(context, chosen, n + REPEATS);
    }
    for (size_t k = 0; status == GONIO_OK && chosen->count >= n && k < REPEATS; k++) {
        chosen->pair[n + k] = chosen->pair[0];
        chosen->count = n + k + 1;
    }
    return status;
}

/* Of scattered readings those in the plane of incidence; of tables the polar angles of the
 * candidates, the viewer on the mirror's side or on the light's. */
static size_t list_plane(const benchmark_sample *sample, gonio_pair *pair)
{
    size_t count = 0;
    for (size_t k = 0; k < sample->candidates; k++) {
        gonio_pair p = sample->candidate[k];
        if (sample->known == NULL) {
            p.outgoing.phi = cos(p.outgoing.phi) < 0.0 ? M_PI : 0.0;
        }
        if (benchmark_is_in_plane(&p)) {
            pair[count++] = p;
        }
    }
    return count;
}

static gonio_status choose_in_plane(gonio_context *context, const benchmark_choosing *with,
                                    size_t n, benchmark_pairs *chosen)
{
    gonio_pair *pair = gonio_i_allocate(context, with->sample->candidates + 1, sizeof *pair);
    if (pair == NULL) {
        return GONIO_ERROR_MEMORY;
    }
    const size_t count = list_plane(with->sample, pair);
    const gonio_status status = draw(context, with, pair, count, PLANE_STREAM, n, chosen);
    free(pair);
    return status;
}

/* ---- the list ---- */

#define PUBLISHED(method, text)                                                                    \
    {                                                                                              \
        .name = (method), .summary = (text), .plan_method = (method), .own_methods = true,         \
        .choose = choose_published                                                                 \
    }

static const benchmark_directions list[] = {
    {.name = "planned",
     .summary = "planned before anything is read, for the least expected error",
     .plan_method = usual_plan,
     .choose = choose_planned},
    {.name = "next",
     .summary = "ten planned, the others chosen on the way by what was read",
     .plan_method = usual_plan,
     .on_the_way = true,
     .choose = choose_next},
    {.name = "random", .summary = "at random", .drawn = true, .choose = choose_random},
    {.name = "in-plane",
     .summary = "at random in the plane of incidence",
     .drawn = true,
     .choose = choose_in_plane},
    {.name = "two-incidences",
     .summary = "in the plane of incidence, evenly spread over two incidences",
     .drawn = true,
     .choose = benchmark_choose_two_incidences},
    {.name = "repeated",
     .summary = "at random, the first of them read ten times",
     .drawn = true,
     .repeats = REPEATS,
     .choose = choose_repeated},
    PUBLISHED("condition", "Ali et al. 2018: the least condition number"),
    PUBLISHED("matusik", "Matusik et al. 2003"),
    PUBLISHED("nielsen", "Nielsen et al. 2015"),
    PUBLISHED("frost", "Miandji et al. 2024"),
};

enum { WAYS = sizeof list / sizeof *list };

const benchmark_directions *benchmark_directions_at(int index)
{
    return index >= 0 && index < WAYS ? &list[index] : NULL;
}

int benchmark_directions_find(const char *name)
{
    for (int k = 0; k < WAYS; k++) {
        if (strcmp(list[k].name, name) == 0) {
            return k;
        }
    }
    return -1;
}
