/* The swaps of the condition-number search: see swap_search.h. */
#include "swap_search.h"

#include <float.h>
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <omp.h>

#include "../linalg/linalg.h"
#include "exchange_eigenvalues.h"

/* A swap has to lower kappa by more than this fraction; less is rounding. */
static const double least_gain = 1e-10;

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void gonio_i_swap_search_watch(gonio_i_swap_search *s)
{
    s->began = seconds(CLOCK_MONOTONIC);
    s->worked = -seconds(CLOCK_THREAD_CPUTIME_ID);
}

/* Ends a time of waiting for the other threads. Steps are short. On a busy machine a thread may be
 * without a processor while the others wait for it. If a quarter of the time was lost by waiting,
 * the search continues with one thread. (The plan is the same on any number of threads.) */
static void stop_waiting(gonio_i_swap_search *s, double since)
{
    static const double patience = 0.02;
    static const double short_step = 0.002;
    if (s->threads == 1) {
        return;
    }
    s->waits++;
    const double time = seconds(CLOCK_MONOTONIC);
    s->worked -= time - since; /* waiting looks like work to the processor */
    const double passed = time - s->began;
    const double lost = passed - (seconds(CLOCK_THREAD_CPUTIME_ID) + s->worked);
    if (lost > patience && lost > 0.25 * passed && passed < short_step * (double)s->waits) {
        s->threads = 1;
    }
}

/* The chosen rows and G = X'X. */
static gonio_status gather(gonio_i_swap_search *s)
{
    return gonio_i_chosen_gram(s->problem, s->chosen, s->x, s->gram);
}

/* The eigenvectors and eigenvalues of G, and the chosen rows in that basis. */
static gonio_status decompose(gonio_i_swap_search *s)
{
    const gonio_i_selection_problem *p = s->problem;
    const size_t k = p->components;
    memcpy(s->q, s->gram, k * k * sizeof *s->q);
    s->decompositions++;
    gonio_status status = gonio_i_eigen(p->context, s->q, k, true, s->d);
    if (status == GONIO_OK) {
        status = gonio_i_product_transposed(p->context, s->x, p->count, k, s->q, k, s->y, k);
    }
    s->condition_number = status == GONIO_OK ? gonio_i_condition(s->d, k) : INFINITY;
    gonio_i_rotated_rows_set(&s->rotated, s->q);
    return status;
}

/* The square of the longest chosen row's length. */
static double longest_square(const gonio_i_swap_search *s)
{
    double longest = 0.0;
    for (size_t j = 0; j < s->problem->count; j++) {
        longest = fmax(longest, (double)s->filter.packed->length[s->chosen[j]]);
    }
    return longest * longest;
}

/* Sets the filter for G, from its smallest and its two largest eigenvalues, which rounding moves by
 * some kappa eps of the smallest. mu is kept off the pole there, where single precision would
 * decide little. */
static void set_filter(gonio_i_swap_search *s, double smallest, double second_largest,
                       double largest)
{
    const double error = 1e-9 + 100.0 * DBL_EPSILON * largest / smallest;
    const double left = fmax(second_largest, largest - longest_square(s));
    const double bound = left * smallest / largest * (1.0 - error);
    const double mu = fmin(bound, smallest * (1.0 - 1e-3));
    gonio_i_swap_filter_set(&s->filter, s->gram, mu, largest / (smallest - mu));
}

/* All that the search needs to know of the choice. */
static gonio_status consider(gonio_i_swap_search *s)
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

/* G after a swap, in the eigenbasis of G. */
static gonio_i_exchange exchange_of(const gonio_i_swap_search *s, size_t position, size_t row,
                                    double *z)
{
    const size_t k = s->problem->components;
    return (gonio_i_exchange){s->d, s->y + position * k, gonio_i_rotated_row(&s->rotated, row, z),
                              k};
}

/* Whether a swap lowers kappa, decided exactly. A part of the row's values rejects most rows. */
static bool wins(const gonio_i_swap_search *s, size_t position,
                 const gonio_i_rotated_rows_candidate *c)
{
    const size_t k = s->problem->components;
    const double limit = s->condition_number * (1.0 - least_gain);
    const gonio_i_exchange in_part = {s->d, s->y + position * k, c->z, k};
    if (c->part < k && !gonio_i_exchange_may_beat(&in_part, c->part, limit)) {
        return false;
    }
    const gonio_i_exchange exchange = exchange_of(s, position, c->row, c->z);
    return gonio_i_exchange_beats(&exchange, limit);
}

/* Removes the chosen rows from a list, in place. */
static size_t leave_out_taken(const gonio_i_swap_search *s, size_t *rows, size_t count)
{
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        rows[left] = rows[i];
        left += !s->taken[rows[i]];
    }
    return left;
}

/* The first of a chunk's rows first .. last - 1 that lowers kappa at a position; `rows` if none. */
static size_t first_winner_among(gonio_i_swap_search *s, size_t position, size_t first, size_t last,
                                 int thread)
{
    const gonio_i_swap_search_worker *w = &s->workers[thread];
    const size_t passed =
        gonio_i_swap_filter_survivors(&s->filter, position, first, last, thread, w->survivors);
    const size_t count = leave_out_taken(s, w->survivors, passed);
    for (size_t i = 0; i < count; i += GONIO_I_ROTATED_TOGETHER) {
        gonio_i_rotated_rows_candidate candidate[GONIO_I_ROTATED_TOGETHER];
        const size_t rest = count - i;
        const size_t together = rest < GONIO_I_ROTATED_TOGETHER ? rest : GONIO_I_ROTATED_TOGETHER;
        gonio_i_rotated_rows_begin(&s->rotated, w->survivors + i, together, w->z, candidate);
        for (size_t j = 0; j < together; j++) {
            if (wins(s, position, &candidate[j])) {
                return candidate[j].row;
            }
        }
    }
    return s->problem->rows;
}

/* The same for one step of the cycle: chunks in cyclic order, where the chunk with `from` is two
 * steps. */
static size_t first_winner_at(gonio_i_swap_search *s, size_t position, size_t from, size_t step,
                              int thread)
{
    const size_t chunks = gonio_i_packed_rows_chunks(s->filter.packed);
    const size_t begin = (from / GONIO_I_CHUNK + step) % chunks * GONIO_I_CHUNK;
    const size_t full = begin + GONIO_I_CHUNK;
    const size_t end = full < s->problem->rows ? full : s->problem->rows;
    return first_winner_among(s, position, step == 0 ? from : begin, step == chunks ? from : end,
                              thread);
}

/* Some steps of the cycle, by all threads. (One thread uses no parallel region, because inside
 * another region it takes longer than the step.) */
static void take_steps(gonio_i_swap_search *s, size_t position, size_t from, size_t first,
                       size_t count)
{
    if (s->threads == 1) {
        for (size_t step = first; step < first + count; step++) {
            s->winners[step] = first_winner_at(s, position, from, step, 0);
        }
        return;
    }
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

size_t gonio_i_swap_search_winners(gonio_i_swap_search *s, size_t position, size_t from,
                                   size_t most, size_t *found)
{
    const size_t rows = s->problem->rows;
    const size_t chunks = gonio_i_packed_rows_chunks(s->filter.packed);
    gonio_i_swap_filter_set_position(&s->filter, s->x, position);
    size_t count = 0;
    size_t ahead = 1;
    for (size_t done = 0; done <= chunks && count < most; done += ahead) {
        const size_t threads = (size_t)s->threads;
        const size_t wanted = threads == 1 ? 1 : done > threads ? done : threads;
        const size_t rest = done < chunks ? chunks - done : 1;
        ahead = wanted < rest ? wanted : rest;
        take_steps(s, position, from, done, ahead);
        for (size_t step = done; step < done + ahead && count < most; step++) {
            found[count] = s->winners[step];
            count += found[count] < rows;
        }
    }
    return count;
}

/* The first row in the cyclic order from `from` on that lowers kappa at a position; `rows` if none.
 */
static size_t first_winner(gonio_i_swap_search *s, size_t position, size_t from)
{
    const size_t rows = s->problem->rows;
    size_t row = rows;
    if (gonio_i_swap_search_winners(s, position, from, 1, &row) == 0) {
        s->tests += rows;
        return rows;
    }
    s->tests += (row + rows - from) % rows + 1;
    return row;
}

static void put(gonio_i_swap_search *s, size_t position, size_t row)
{
    s->taken[s->chosen[position]] = 0;
    s->taken[row] = 1;
    s->chosen[position] = row;
}

/* Computes the gains that are needed first, while G is decomposed. */
static void prepare_ahead(gonio_i_swap_search *s, size_t first, size_t apart,
                          const _Atomic bool *decomposed)
{
    const size_t chunks = gonio_i_packed_rows_chunks(s->filter.packed);
    for (size_t step = first; step < chunks && !*decomposed; step += apart) {
        gonio_i_swap_filter_prepare(&s->filter, (s->from / GONIO_I_CHUNK + step) % chunks,
                                    omp_get_thread_num());
    }
}

static void set_filter_after(gonio_i_swap_search *s, const gonio_i_exchange *swap)
{
    set_filter(s, gonio_i_exchange_eigenvalue(swap, 0),
               gonio_i_exchange_eigenvalue(swap, swap->n - 2),
               gonio_i_exchange_eigenvalue(swap, swap->n - 1));
}

/* Sets the filter and decomposes G after a swap. With several threads one decomposes. The
 * eigenvalues for the filter are found without the decomposition. */
static gonio_status decompose_and_prepare(gonio_i_swap_search *s, const gonio_i_exchange *swap)
{
    if (s->threads == 1) {
        set_filter_after(s, swap);
        return decompose(s);
    }
    gonio_status status = GONIO_OK;
    _Atomic bool filtered = false;
    _Atomic bool decomposed = false;
    double since = 0.0;
#pragma omp parallel num_threads(s->threads)
    {
        const int thread = omp_get_thread_num();
        const int others = omp_get_num_threads() - 1;
        if (thread == others) {
            set_filter_after(s, swap);
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

/* Makes a swap. Near singularity, rounding may show a gain that does not exist. Then the swap is
 * undone. */
static gonio_status make_swap(gonio_i_swap_search *s, size_t position, size_t row, bool *gained)
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

gonio_status gonio_i_swap_search_begin(gonio_i_swap_search *s, const size_t *chosen)
{
    memmove(s->chosen, chosen, s->problem->count * sizeof *s->chosen);
    memset(s->taken, 0, s->problem->rows);
    for (size_t j = 0; j < s->problem->count; j++) {
        s->taken[s->chosen[j]] = 1;
    }
    return consider(s);
}

/* One sweep over the positions. */
static gonio_status sweep(gonio_i_swap_search *s, int restart, int *swaps,
                          gonio_i_selection *selection)
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

gonio_status gonio_i_swap_search_report(gonio_i_swap_search *s, double share)
{
    const double gained = share - s->share;
    s->share = share;
    double sum = 0.0;
#pragma omp atomic capture
    {
        *s->progress += gained;
        sum = *s->progress;
    }
    return s->problem->part ? GONIO_OK
                            : gonio_i_progress(s->problem->context, "planning",
                                               0.999 * sum / s->problem->restarts);
}

gonio_status gonio_i_swap_search_descend(gonio_i_swap_search *s, int restart, int swaps,
                                         gonio_i_selection *selection)
{
    gonio_status status = GONIO_OK;
    bool proved = s->problem->components < 2; /* kappa of one component is 1 */
    for (int sweeps = 0; status == GONIO_OK && !proved; sweeps++) {
        const int before = swaps;
        status = sweep(s, restart, &swaps, selection);
        proved = swaps == before;
        if (status == GONIO_OK) {
            status = gonio_i_swap_search_report(
                s, proved ? 1.0 : sweeps / (sweeps + 20.0)); /* typically 20 to 40 */
        }
    }
    return status;
}

static bool allocate_workers(gonio_i_swap_search *s)
{
    gonio_context *context = s->problem->context;
    bool ready = true;
    s->workers = gonio_i_allocate(context, (size_t)s->threads, sizeof *s->workers);
    for (int t = 0; t < s->threads && s->workers != NULL && ready; t++) {
        gonio_i_swap_search_worker *w = &s->workers[t];
        w->z = gonio_i_rotated_rows_scratch(s->problem);
        w->survivors = gonio_i_allocate(context, GONIO_I_CHUNK + 1, sizeof *w->survivors);
        ready = w->z != NULL && w->survivors != NULL;
    }
    return ready && s->workers != NULL;
}

bool gonio_i_swap_search_allocate(const gonio_i_selection_problem *problem,
                                  const gonio_i_packed_rows *packed, double *progress, int threads,
                                  gonio_i_swap_search *s)
{
    gonio_context *context = problem->context;
    const size_t k = problem->components;
    const size_t n = problem->count;
    *s = (gonio_i_swap_search){
        .problem = problem,
        .progress = progress,
        .threads = threads,
        .chosen = gonio_i_allocate(context, n, sizeof *s->chosen),
        .taken = gonio_i_allocate(context, problem->rows, sizeof *s->taken),
        .x = gonio_i_allocate(context, n * k, sizeof *s->x),
        .y = gonio_i_allocate(context, n * k, sizeof *s->y),
        .gram = gonio_i_allocate(context, k * k, sizeof *s->gram),
        .q = gonio_i_allocate(context, k * k, sizeof *s->q),
        .d = gonio_i_allocate(context, k, sizeof *s->d),
        .old_d = gonio_i_allocate(context, k, sizeof *s->old_d),
        .old_y = gonio_i_allocate(context, k, sizeof *s->old_y),
        .winners =
            gonio_i_allocate(context, gonio_i_packed_rows_chunks(packed) + 1, sizeof *s->winners),
    };
    return gonio_i_swap_filter_allocate(problem, packed, threads, &s->filter) &&
           allocate_workers(s) && gonio_i_rotated_rows_allocate(problem, &s->rotated) &&
           s->chosen != NULL && s->taken != NULL && s->x != NULL && s->y != NULL &&
           s->gram != NULL && s->q != NULL && s->d != NULL && s->old_d != NULL &&
           s->old_y != NULL && s->winners != NULL;
}

void gonio_i_swap_search_free(gonio_i_swap_search *s)
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
    free(s->d);
    free(s->old_d);
    free(s->old_y);
    free(s->winners);
    gonio_i_rotated_rows_free(&s->rotated);
    gonio_i_swap_filter_free(&s->filter);
}
