/* Condition-number plans (Ali et al., section 3.8): swap chosen rows for others until no single
 * swap lowers kappa = lambda_max/lambda_min of G = X'X.
 *
 * The positions of the choice take turns; the rows outside are tried at each in cyclic order from a
 * random one on, and the first that lowers kappa is taken. (On ten bases of 35 components, 80 rows
 * and one start, this ends at kappa 4.2 on average; the best row of each position at 5.2, the best
 * of all swaps at over 6: greed gets stuck early.)
 *
 * Taking a row out leaves a largest eigenvalue of at least d_{K-1}, the second largest of G, so a
 * swap that lowers kappa must have lambda_min > mu = d_{K-1}/kappa. The filter (filter.h) finds the
 * rows that do, all at once, and those are decided exactly (inertia.h). Nothing is approximated:
 * the same swaps win as if kappa were computed for every one. A full turn without a swap proves a
 * local optimum. */
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <omp.h>

#include "../core/random.h"
#include "../linalg/linalg.h"
#include "filter.h"
#include "inertia.h"
#include "method.h"
#include "start.h"

/* A swap has to lower kappa by more than this share: less is rounding. */
static const double least_gain = 1e-10;

/* Scratch of one thread. */
typedef struct worker {
    double *z;         /* [K]: a candidate in the eigenbasis of G */
    size_t *survivors; /* [GONIO_I_CHUNK + 1] */
} worker;

typedef struct search {
    const gonio_i_selection_problem *problem;
    size_t *chosen;
    unsigned char *taken; /* [rows] */
    double *x;            /* [count][K]: the chosen rows */
    double *y;            /* [count][K]: the chosen rows in the eigenbasis of G */
    double *gram;         /* G, [K][K] */
    double *q;            /* [K][K]: the eigenvectors of G as rows */
    double *columns;      /* [K][K]: and as columns */
    double *d;            /* [K] eigenvalues, ascending */
    double *old_d;        /* [K] before a swap */
    double *old_y;        /* [K] of the row that went out */
    double condition_number;
    gonio_i_filter filter;
    worker *workers; /* [threads] */
    size_t *winners; /* [chunks + 1]: scratch */
    int threads;
    double began;  /* s: when the descent began */
    double worked; /* s: what to add to the thread's clock for the time that it did work */
    size_t from;   /* the row that the next position begins with */
    gonio_i_random random;
    uint64_t tests;   /* that a search without the filter would have made */
    double share;     /* how far this search is, 0 to 1 */
    double *progress; /* the sum of all searches' shares */
} search;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void begin_watch(search *s)
{
    s->began = seconds(CLOCK_MONOTONIC);
    s->worked = -seconds(CLOCK_THREAD_CPUTIME_ID);
}

/* Ends a time of waiting for the other threads. The steps of a search are so short that on a busy
 * machine, where a thread may be without a processor just when it is waited for, threads only cost
 * time: where a quarter of it was lost, the search goes on with one. (The plan is the same on any
 * number.) */
static void stop_waiting(search *s, double since)
{
    static const double patience = 0.02;
    if (s->threads == 1) {
        return;
    }
    const double time = seconds(CLOCK_MONOTONIC);
    s->worked -= time - since; /* waiting looks like work to the processor */
    const double passed = time - s->began;
    const double lost = passed - (seconds(CLOCK_THREAD_CPUTIME_ID) + s->worked);
    if (lost > patience && lost > 0.25 * passed) {
        s->threads = 1;
    }
}

/* The chosen rows and G = X'X. */
static gonio_status gather(search *s)
{
    return gonio_i_chosen_gram(s->problem, s->chosen, s->x, s->gram);
}

/* The eigenvectors and eigenvalues of G, and the chosen rows in that basis. */
static gonio_status decompose(search *s)
{
    const gonio_i_selection_problem *p = s->problem;
    const size_t k = p->components;
    memcpy(s->q, s->gram, k * k * sizeof *s->q);
    gonio_status status = gonio_i_eigen(p->context, s->q, k, true, s->d);
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(p->context, s->x, p->count, k, s->q, k, s->y, k);
    }
    s->condition_number = status == GONIO_OK ? gonio_i_condition(s->d, k) : INFINITY;
    for (size_t j = 0; j < k; j++) {
        for (size_t a = 0; a < k; a++) {
            s->columns[a * k + j] = s->q[j * k + a];
        }
    }
    return status;
}

/* Sets the filter for G, from its smallest and its two largest eigenvalues. mu is kept off the
 * pole at the smallest, where single precision would decide little. Where kappa is so large that
 * rounding moves the smallest, nothing is filtered. */
static void set_filter(search *s, double smallest, double second_largest, double largest)
{
    const double mu = second_largest * smallest / largest * (1.0 - 1e-9);
    const bool sound = smallest > largest * 1e-6;
    gonio_i_filter_set(&s->filter, s->gram, sound ? fmin(mu, smallest * (1.0 - 1e-3)) : INFINITY);
}

/* All that the search needs to know of the choice. */
static gonio_status consider(search *s)
{
    const size_t k = s->problem->components;
    gonio_status status = gather(s);
    if (status == GONIO_OK) {
        status = decompose(s);
    }
    if (status == GONIO_OK && k > 1 && isfinite(s->condition_number)) {
        set_filter(s, s->d[0], s->d[k - 2], s->d[k - 1]);
    }
    return status;
}

/* z = Q'u, from the eigenvectors as columns of q[K][K]. */
GONIO_I_VECTORISED static void rotate(size_t k, const double *restrict q, const double *u,
                                      double *restrict z)
{
    memset(z, 0, k * sizeof *z);
    for (size_t a = 0; a < k; a++) {
        for (size_t j = 0; j < k; j++) {
            z[j] += u[a] * q[a * k + j];
        }
    }
}

/* G after a swap, in the eigenbasis of G. */
static gonio_i_exchange exchange_of(const search *s, size_t position, size_t row, double *z)
{
    const size_t k = s->problem->components;
    rotate(k, s->columns, gonio_i_row(s->problem, row), z);
    return (gonio_i_exchange){s->d, s->y + position * k, z, k};
}

/* Whether a swap lowers kappa, exactly. */
static bool wins(const search *s, size_t position, size_t row, double *z)
{
    if (s->taken[row]) {
        return false;
    }
    const gonio_i_exchange exchange = exchange_of(s, position, row, z);
    return gonio_i_exchange_beats(&exchange, s->condition_number * (1.0 - least_gain));
}

/* The first of a chunk's rows first .. last - 1 that lowers kappa at a position; `rows` if none. */
static size_t first_winner_among(search *s, size_t position, size_t first, size_t last, int thread)
{
    const worker *w = &s->workers[thread];
    const size_t count =
        gonio_i_filter_survivors(&s->filter, position, first, last, thread, w->survivors);
    for (size_t k = 0; k < count; k++) {
        if (wins(s, position, w->survivors[k], w->z)) {
            return w->survivors[k];
        }
    }
    return s->problem->rows;
}

/* The same for one step of the way around: chunks in cyclic order, the one with `from` in two
 * parts. */
static size_t first_winner_at(search *s, size_t position, size_t from, size_t step, int thread)
{
    const size_t chunks = gonio_i_panels_chunks(s->filter.panels);
    const size_t begin = (from / GONIO_I_CHUNK + step) % chunks * GONIO_I_CHUNK;
    const size_t full = begin + GONIO_I_CHUNK;
    const size_t end = full < s->problem->rows ? full : s->problem->rows;
    return first_winner_among(s, position, step == 0 ? from : begin, step == chunks ? from : end,
                              thread);
}

/* Some steps of the way around, by all threads. */
static void take_steps(search *s, size_t position, size_t from, size_t first, size_t count)
{
    double since = 0.0;
#pragma omp parallel num_threads(s->threads) if (count > 1)
    {
        const int thread = omp_get_thread_num();
#pragma omp for schedule(dynamic) nowait
        for (size_t step = first; step < first + count; step++) {
            s->winners[step] = first_winner_at(s, position, from, step, thread);
        }
        if (thread == 0) {
            since = seconds(CLOCK_MONOTONIC);
        }
    }
    stop_waiting(s, since);
}

/* The first row in the cyclic order from `from` on that lowers kappa at a position; `rows` if none.
 * Several threads take a step each, then twice as many, and so on, as most winners are near; the
 * last step is in the first one's chunk and waits for it. */
static size_t first_winner(search *s, size_t position, size_t from)
{
    const size_t rows = s->problem->rows;
    const size_t chunks = gonio_i_panels_chunks(s->filter.panels);
    gonio_i_filter_turn_to(&s->filter, s->x, position);
    size_t ahead = 1;
    for (size_t done = 0; done <= chunks; done += ahead) {
        const size_t threads = (size_t)s->threads;
        const size_t wanted = threads == 1 ? 1 : done > threads ? done : threads;
        const size_t rest = done < chunks ? chunks - done : 1;
        ahead = wanted < rest ? wanted : rest;
        take_steps(s, position, from, done, ahead);
        for (size_t step = done; step < done + ahead; step++) {
            if (s->winners[step] < rows) {
                s->tests += (s->winners[step] + rows - from) % rows + 1;
                return s->winners[step];
            }
        }
    }
    s->tests += rows;
    return rows;
}

static void put(search *s, size_t position, size_t row)
{
    s->taken[s->chosen[position]] = 0;
    s->taken[row] = 1;
    s->chosen[position] = row;
}

/* Computes the gains that will be needed first, as long as G is being decomposed. */
static void prepare_ahead(search *s, size_t first, size_t apart, const _Atomic bool *decomposed)
{
    const size_t chunks = gonio_i_panels_chunks(s->filter.panels);
    for (size_t step = first; step < chunks && !*decomposed; step += apart) {
        gonio_i_filter_prepare(&s->filter, (s->from / GONIO_I_CHUNK + step) % chunks,
                               omp_get_thread_num());
    }
}

/* Sets the filter and decomposes G after a swap. Where there are several threads, one decomposes;
 * the eigenvalues that the filter needs are found without. */
static gonio_status decompose_and_prepare(search *s, const gonio_i_exchange *swap)
{
    gonio_status status = GONIO_OK;
    _Atomic bool filtered = false;
    _Atomic bool decomposed = false;
    double since = 0.0;
#pragma omp parallel num_threads(s->threads) if (s->threads > 1)
    {
        const int thread = omp_get_thread_num();
        const int others = omp_get_num_threads() - 1;
        if (thread == others) {
            set_filter(s, gonio_i_exchange_eigenvalue(swap, 0),
                       gonio_i_exchange_eigenvalue(swap, swap->n - 2),
                       gonio_i_exchange_eigenvalue(swap, swap->n - 1));
            filtered = true;
        }
        if (thread == 0) {
            status = decompose(s);
            decomposed = true;
            since = seconds(CLOCK_MONOTONIC);
        } else {
            while (!filtered && !decomposed) {
                sched_yield();
            }
            prepare_ahead(s, (size_t)thread - 1, (size_t)others, &decomposed);
        }
    }
    stop_waiting(s, since);
    return status;
}

/* Makes a swap. Next to singular, rounding may promise a gain that is none: that one is undone. */
static gonio_status make_swap(search *s, size_t position, size_t row, bool *gained)
{
    const size_t k = s->problem->components;
    const double before = s->condition_number;
    const size_t old = s->chosen[position];
    gonio_i_exchange swap = exchange_of(s, position, row, s->workers[0].z);
    memcpy(s->old_d, s->d, k * sizeof *s->d);
    memcpy(s->old_y, swap.y, k * sizeof *s->y);
    swap.d = s->old_d;
    swap.y = s->old_y;
    put(s, position, row);
    gonio_status status = gather(s);
    if (status == GONIO_OK) {
        status = decompose_and_prepare(s, &swap);
    }
    *gained = s->condition_number < before;
    if (status == GONIO_OK && !*gained) {
        put(s, position, old);
        status = consider(s);
    }
    return status;
}

/* One turn through the positions. */
static gonio_status sweep(search *s, int restart, int *swaps, gonio_i_selection *selection)
{
    gonio_status status = GONIO_OK;
    for (size_t position = 0; position < s->problem->count && status == GONIO_OK; position++) {
        const size_t row = first_winner(s, position, s->from);
        s->from = (size_t)gonio_i_random_below(&s->random, s->problem->rows);
        bool gained = false;
        if (row < s->problem->rows) {
            status = make_swap(s, position, row, &gained);
        }
        if (status == GONIO_OK && gained) {
            status = gonio_i_selection_record(s->problem, selection, restart, ++*swaps,
                                              s->condition_number);
        }
    }
    return status;
}

/* Progress of all starts together. */
static gonio_status report(search *s, double share)
{
    const double gained = share - s->share;
    s->share = share;
    double sum = 0.0;
#pragma omp atomic capture
    {
        *s->progress += gained;
        sum = *s->progress;
    }
    return gonio_i_progress(s->problem->context, "planning", 0.999 * sum / s->problem->restarts);
}

static gonio_status descend(search *s, int restart, gonio_i_selection *selection)
{
    int swaps = 0;
    begin_watch(s);
    gonio_status status =
        gonio_i_selection_record(s->problem, selection, restart, swaps, s->condition_number);
    bool proved = s->problem->components < 2; /* kappa of one component is 1 */
    for (int turn = 0; status == GONIO_OK && !proved; turn++) {
        const int before = swaps;
        status = sweep(s, restart, &swaps, selection);
        proved = swaps == before;
        if (status == GONIO_OK) {
            status = report(s, proved ? 1.0 : turn / (turn + 20.0)); /* typically 20 to 40 */
        }
    }
    return status;
}

/* ---- starts ---- */

static gonio_status begin_with(search *s, const char *name, int restart)
{
    const gonio_i_selection_problem *p = s->problem;
    gonio_status status = GONIO_OK;
    if (name == NULL) {
        memcpy(s->chosen, p->given, p->count * sizeof *s->chosen);
    } else {
        status = gonio_i_find_start(name)->choose(p, restart, s->chosen);
    }
    memset(s->taken, 0, s->problem->rows);
    for (size_t j = 0; j < s->problem->count && status == GONIO_OK; j++) {
        s->taken[s->chosen[j]] = 1;
    }
    return status == GONIO_OK ? consider(s) : status;
}

/* The start asked for, or where its rows do not span K dimensions one whose rows do. */
static gonio_status start(search *s, int restart)
{
    gonio_i_random_seed(&s->random, s->problem->seed, 2 * (uint64_t)restart + 1);
    s->from = (size_t)gonio_i_random_below(&s->random, s->problem->rows);
    gonio_status status =
        begin_with(s, s->problem->given != NULL ? NULL : s->problem->start, restart);
    if (status == GONIO_OK && isinf(s->condition_number)) {
        status = begin_with(s, "qr", restart);
    }
    if (status == GONIO_OK && isinf(s->condition_number)) {
        status = gonio_i_fail(s->problem->context, GONIO_ERROR_DATA,
                              "the rows of the basis do not span %zu dimensions",
                              s->problem->components);
    }
    return status;
}

static int compare_rows(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a;
    const size_t y = *(const size_t *)b;
    return (x > y) - (x < y);
}

static bool allocate_workers(search *s)
{
    gonio_context *context = s->problem->context;
    bool ready = true;
    s->workers = gonio_i_allocate(context, (size_t)s->threads, sizeof *s->workers);
    for (int t = 0; t < s->threads && s->workers != NULL && ready; t++) {
        worker *w = &s->workers[t];
        w->z = gonio_i_allocate(context, s->problem->components, sizeof *w->z);
        w->survivors = gonio_i_allocate(context, GONIO_I_CHUNK + 1, sizeof *w->survivors);
        ready = w->z != NULL && w->survivors != NULL;
    }
    return ready && s->workers != NULL;
}

static bool allocate_search(const gonio_i_selection_problem *problem, const gonio_i_panels *panels,
                            double *progress, int threads, search *s)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t n = problem->count;
    *s = (search){
        .problem = problem,
        .progress = progress,
        .threads = threads,
        .chosen = gonio_i_allocate(context, n, sizeof *s->chosen),
        .taken = gonio_i_allocate(context, problem->rows, sizeof *s->taken),
        .x = gonio_i_allocate(context, n * k, sizeof *s->x),
        .y = gonio_i_allocate(context, n * k, sizeof *s->y),
        .gram = gonio_i_allocate(context, k * k, sizeof *s->gram),
        .q = gonio_i_allocate(context, k * k, sizeof *s->q),
        .columns = gonio_i_allocate(context, k * k, sizeof *s->columns),
        .d = gonio_i_allocate(context, k, sizeof *s->d),
        .old_d = gonio_i_allocate(context, k, sizeof *s->old_d),
        .old_y = gonio_i_allocate(context, k, sizeof *s->old_y),
        .winners = gonio_i_allocate(context, gonio_i_panels_chunks(panels) + 1, sizeof *s->winners),
    };
    return gonio_i_filter_allocate(problem, panels, threads, &s->filter) && allocate_workers(s) &&
           s->chosen != NULL && s->taken != NULL && s->x != NULL && s->y != NULL &&
           s->gram != NULL && s->q != NULL && s->columns != NULL && s->d != NULL &&
           s->old_d != NULL && s->old_y != NULL && s->winners != NULL;
}

static void free_search(search *s)
{
    for (int t = 0; s->workers != NULL && t < s->filter.threads; t++) {
        free(s->workers[t].z);
        free(s->workers[t].survivors);
    }
    free(s->workers);
    free(s->chosen);
    free(s->taken);
    free(s->x);
    free(s->y);
    free(s->gram);
    free(s->q);
    free(s->columns);
    free(s->d);
    free(s->old_d);
    free(s->old_y);
    free(s->winners);
    gonio_i_filter_free(&s->filter);
}

/* All starts, with what they share. */
typedef struct starts {
    const gonio_i_selection_problem *problem;
    const gonio_i_panels *panels;
    double progress;              /* the sum of the starts' shares */
    gonio_i_selection *histories; /* [restarts]: only the history of each */
    int threads;                  /* within a start */
    _Atomic gonio_status status;
    int best; /* the start with the lowest kappa, the first on ties; its result is in `selection` */
    gonio_i_selection *selection;
} starts;

/* Keeps the result of a start if it is the best so far. */
static void keep_best(starts *all, const search *s, int restart)
{
#pragma omp critical(gonio_condition_best)
    {
        gonio_i_selection *kept = all->selection;
        const bool better = s->condition_number < kept->condition_number ||
                            (s->condition_number == kept->condition_number && restart < all->best);
        if (all->best < 0 || better) {
            all->best = restart;
            kept->condition_number = s->condition_number;
            memcpy(kept->chosen, s->chosen, s->problem->count * sizeof *s->chosen);
        }
        kept->tests += s->tests;
    }
}

/* One start and its descent. */
static void run(starts *all, int restart)
{
    search s;
    gonio_status status =
        allocate_search(all->problem, all->panels, &all->progress, all->threads, &s)
            ? GONIO_OK
            : GONIO_ERROR_MEMORY;
    if (status == GONIO_OK) {
        status = start(&s, restart);
    }
    if (status == GONIO_OK) {
        status = descend(&s, restart, &all->histories[restart]);
    }
    if (status == GONIO_OK) {
        keep_best(all, &s, restart);
    } else {
        all->status = status;
    }
    free_search(&s);
}

static void run_unless_failed(starts *all, int restart)
{
    if (all->status == GONIO_OK) {
        run(all, restart);
    }
}

/* Several starts at a time: they share nothing but the rows, while threads within one start wait
 * for each other at every step. Threads left over go into the starts. (One at a time is no parallel
 * region of one: regions inside another make their threads anew each time.) */
static void run_all(starts *all)
{
    const int restarts = all->problem->restarts;
    const int threads = gonio_context_threads(all->problem->context);
    const int teams = restarts < threads ? restarts : threads;
    all->threads = threads / teams;
    if (teams == 1) {
        for (int restart = 0; restart < restarts; restart++) {
            run_unless_failed(all, restart);
        }
        return;
    }
#pragma omp parallel for schedule(dynamic) num_threads(teams)
    for (int restart = 0; restart < restarts; restart++) {
        run_unless_failed(all, restart);
    }
}

/* The histories of all starts, in order. */
static gonio_status join_histories(const starts *all)
{
    gonio_status status = GONIO_OK;
    for (int restart = 0; restart < all->problem->restarts; restart++) {
        const gonio_i_selection *one = &all->histories[restart];
        for (size_t k = 0; k < one->steps && status == GONIO_OK; k++) {
            const gonio_plan_step *step = &one->history[k];
            status = gonio_i_selection_record(all->problem, all->selection, step->restart,
                                              step->swap, step->condition_number);
        }
    }
    return status;
}

static gonio_status select_by_condition(const gonio_i_selection_problem *problem,
                                        gonio_i_selection *selection)
{
    gonio_context *context = problem->context;
    const size_t restarts = (size_t)problem->restarts;
    gonio_i_panels panels = {0};
    starts all = {.problem = problem,
                  .panels = &panels,
                  .histories = gonio_i_allocate(context, restarts, sizeof *all.histories),
                  .best = -1,
                  .selection = selection};
    gonio_status status = GONIO_ERROR_MEMORY;
    if (all.histories != NULL && gonio_i_panels_make(problem, &panels)) {
        run_all(&all);
        status = all.status;
    }
    if (status == GONIO_OK) {
        qsort(selection->chosen, problem->count, sizeof *selection->chosen, compare_rows);
        status = join_histories(&all);
    }
    if (status == GONIO_OK) {
        status = gonio_i_progress(context, "planning", 1.0);
    }
    for (size_t k = 0; all.histories != NULL && k < restarts; k++) {
        free(all.histories[k].history);
    }
    free(all.histories);
    gonio_i_panels_free(&panels);
    return status;
}

const gonio_i_method gonio_i_condition_method = {
    "condition", "lowest condition number by swaps (Ali et al.)", true, select_by_condition};
