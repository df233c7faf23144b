/* The paper's claims, tested: see claims.h. */
#include "claims.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct tester {
    const gonio_i_study *study;
    const gonio_i_results *results;
    const gonio_i_findings *findings;
    gonio_i_claims *claims;
} tester;

const char *gonio_i_verdict_name(gonio_i_verdict verdict)
{
    static const char *const names[] = {"agrees", "differs", "not tested"};
    return names[verdict];
}

/* Takes the texts. A value that is NaN was not tested. */
static void add(const tester *t, gonio_i_experiment experiment, char *what, char *paper,
                char *found, double value, const char *rule, bool agrees)
{
    gonio_i_claims *c = t->claims;
    const gonio_i_verdict verdict = isnan(value) ? GONIO_I_NOT_TESTED
                                    : agrees     ? GONIO_I_AGREES
                                                 : GONIO_I_DIFFERS;
    if (c->count == GONIO_I_MOST_CLAIMS || what == NULL || paper == NULL || found == NULL) {
        free(what);
        free(paper);
        free(found);
        c->failed = true;
        return;
    }
    c->claim[c->count++] = (gonio_i_claim){experiment, what, paper, found, value, rule, verdict};
}

/* A number in per cent, or that there is none. */
static char *percent(double value)
{
    return isfinite(value) ? gonio_i_format("%.2f %%", value) : strdup("not in this run");
}

static char *points(double value)
{
    return isfinite(value) ? gonio_i_format("%.2f points", value) : strdup("not in this run");
}

/* ---- Fig. 2 ---- */

static void test_spectrum(const tester *t)
{
    const gonio_i_findings *f = t->findings;
    for (size_t c = 0; c < GONIO_I_CHOSEN; c += GONIO_I_CHOSEN - 1) {
        const size_t components = gonio_i_paper_sizes[c].components;
        const double share =
            components <= f->cumulative_count ? 100.0 * f->cumulative[components - 1] : NAN;
        add(t, GONIO_I_SPECTRUM, gonio_i_format("variance that %zu components explain", components),
            strdup("nearly all (curve)"), percent(share), share, "at least 95 %", share >= 95.0);
    }
}

/* The last over the first condition number; and whether it ever rises. */
static double fall(const json_t *steps, bool *rises)
{
    const size_t count = json_array_size(steps);
    double first = NAN;
    double last = NAN;
    for (size_t k = 0; k < count; k++) {
        const double value = gonio_i_json_number(json_array_get(steps, k));
        *rises = *rises || value > last;
        first = isnan(first) ? value : first;
        last = value;
    }
    return last / first;
}

static void test_convergence(const tester *t)
{
    const json_t *starts = json_object_get(t->results->convergence, "starts");
    double worst_fall = 0.0;
    double best = HUGE_VAL;
    double worst = 0.0;
    bool rises = false;
    for (size_t s = 0; s < json_array_size(starts); s++) {
        const json_t *steps = json_array_get(starts, s);
        const double end = gonio_i_json_number(json_array_get(steps, json_array_size(steps) - 1));
        worst_fall = fmax(worst_fall, fall(steps, &rises));
        best = fmin(best, end);
        worst = fmax(worst, end);
    }
    add(t, GONIO_I_CONVERGENCE, strdup("the condition number falls with every swap"),
        strdup("yes (curve)"), strdup(rises ? "it rises somewhere" : "it never rises"),
        rises ? 1.0 : 0.0, "it never rises, whatever the start", !rises);
    add(t, GONIO_I_CONVERGENCE, strdup("what is left of it in the end"),
        strdup("a small part (curve)"),
        gonio_i_format("at most %.1f %% of the start's", 100.0 * worst_fall), 100.0 * worst_fall,
        "less than half, for every start", worst_fall < 0.5);
    add(t, GONIO_I_CONVERGENCE, strdup("several starts end alike"),
        strdup("\xe2\x80\x9cstable\xe2\x80\x9d"), gonio_i_format("from %.2f to %.2f", best, worst),
        worst / best, "the worst end is within 1.5 times the best", worst / best < 1.5);
}

/* ---- Fig. 3(a) ---- */

static void test_gain(const tester *t, size_t components, size_t samples, double paper)
{
    const double gain = gonio_i_grid_e6(t->study, t->findings, components, samples) -
                        gonio_i_grid_e6(t->study, t->findings, components, 200);
    add(t, GONIO_I_GRID,
        gonio_i_format("gain of %zu components from %zu to 200 samples", components, samples),
        gonio_i_format("%.1f points", paper), points(gain), gain,
        "within 0.2 points of the paper's", fabs(gain - paper) <= 0.2);
}

static void test_components(const tester *t)
{
    const gonio_i_study *s = t->study;
    const size_t first = s->grid_component[0];
    const size_t last = s->grid_component[s->grid_components - 1];
    const double to_35 =
        gonio_i_grid_e6(s, t->findings, first, 200) - gonio_i_grid_e6(s, t->findings, 35, 200);
    const double beyond =
        gonio_i_grid_e6(s, t->findings, 35, 200) - gonio_i_grid_e6(s, t->findings, last, 200);
    add(t, GONIO_I_GRID, strdup("gain of components beyond 35, with 200 samples"), strdup("little"),
        isfinite(beyond)
            ? gonio_i_format("%.2f points for %zu; %.2f from %zu to 35", beyond, last, to_35, first)
            : strdup("not in this run"),
        beyond, "less than the gain up to 35", beyond < to_35);
}

static void test_grid(const tester *t)
{
    test_gain(t, 35, 80, 0.3);
    test_gain(t, 40, 120, 0.2);
    test_gain(t, 45, 170, 0.0);
    test_components(t);
}

/* ---- Fig. 3(b) ---- */

/* In how many splits one method does better than another. */
static size_t count_wins(const tester *t, size_t method, size_t other)
{
    const size_t splits = t->study->splits.count;
    const gonio_error *by_split = t->findings->method_split;
    size_t wins = 0;
    for (size_t s = 0; s < splits; s++) {
        wins += by_split[method * splits + s].e6 < by_split[other * splits + s].e6;
    }
    return wins;
}

/* The paper's method, which is the first of the table with that size, against another. */
static void test_method(const tester *t, size_t method, size_t other, const char *size)
{
    const gonio_i_findings *f = t->findings;
    const double difference = f->method[other].e6 - f->method[method].e6;
    add(t, GONIO_I_METHODS,
        gonio_i_format("condition plan against %s, %s", gonio_i_method_at(other)->label, size),
        strdup("better"),
        isfinite(difference)
            ? gonio_i_format("%.2f %% against %.2f %%; better in %zu of %zu splits",
                             f->method[method].e6, f->method[other].e6,
                             count_wins(t, method, other), t->study->splits.count)
            : strdup("too few independent readings"),
        difference, "a smaller mean E6", difference > 0.0);
}

/* Others of the same size, and those of their own size. */
static void test_methods(const tester *t)
{
    for (size_t m = GONIO_I_CHOSEN; m < gonio_i_methods(t->study); m++) {
        const gonio_i_method_entry *other = gonio_i_method_at(m);
        const gonio_i_size own = gonio_i_method_size(t->study, other);
        for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
            const gonio_i_size size = t->study->chosen[c];
            char text[96];
            if (other->chosen == (int)c) {
                snprintf(text, sizeof text, "%zu samples", size.samples);
                test_method(t, c, m, text);
            } else if (other->chosen == GONIO_I_OWN_SIZE) {
                snprintf(text, sizeof text, "%zu samples against %zu", size.samples, own.samples);
                test_method(t, c, m, text);
            }
        }
    }
}

/* ---- Fig. 4 ---- */

static void test_directions(const tester *t)
{
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        const json_t *entries =
            json_object_get(json_array_get(t->results->directions, c), "entries");
        const size_t count = json_array_size(entries);
        size_t low = 0;
        double highest = 0.0;
        for (size_t k = 0; k < count; k++) {
            const double theta =
                gonio_i_json_number(json_array_get(json_array_get(entries, k), 2)) * 180.0 / M_PI;
            low += theta < 30.0;
            highest = fmax(highest, theta);
        }
        add(t, GONIO_I_DIRECTIONS,
            gonio_i_format("where the light stands, %zu samples", t->study->chosen[c].samples),
            strdup("all over the hemisphere (picture)"),
            gonio_i_format("%zu of %zu below 30\xc2\xb0, the highest at %.0f\xc2\xb0", low, count,
                           highest),
            highest, "some below 30\xc2\xb0, some above 75\xc2\xb0", low > 0 && highest > 75.0);
    }
}

/* ---- Fig. 5 ---- */

static void test_order(const tester *t)
{
    const gonio_error *mean = t->findings->left_out_mean;
    const bool order = mean[GONIO_I_BIVARIATE_ITSELF].e6 < mean[GONIO_I_ALL_SAMPLES].e6 &&
                       mean[GONIO_I_ALL_SAMPLES].e6 < mean[2].e6 && mean[2].e6 < mean[1].e6 &&
                       mean[1].e6 < mean[0].e6;
    add(t, GONIO_I_LEFT_OUT, strdup("order of the mean errors"),
        gonio_i_format("bivariate < all samples < %zu < %zu < %zu", t->study->chosen[2].samples,
                       t->study->chosen[1].samples, t->study->chosen[0].samples),
        gonio_i_format("%.2f, %.2f, %.2f, %.2f, %.2f %%", mean[GONIO_I_BIVARIATE_ITSELF].e6,
                       mean[GONIO_I_ALL_SAMPLES].e6, mean[2].e6, mean[1].e6, mean[0].e6),
        mean[2].e6, "this order", order);
}

/* In how many materials the largest plan comes close to all samples. */
static void test_closeness(const tester *t)
{
    size_t close = 0;
    const size_t count = t->study->left_out_count;
    for (size_t k = 0; k < count; k++) {
        const gonio_error *error = t->findings->left_out + k * GONIO_I_LEFT_OUT_SERIES;
        close += error[GONIO_I_CHOSEN - 1].e6 <= error[GONIO_I_ALL_SAMPLES].e6 + 0.5;
    }
    add(t, GONIO_I_LEFT_OUT,
        gonio_i_format("%zu samples come close to all samples",
                       t->study->chosen[GONIO_I_CHOSEN - 1].samples),
        strdup("closely (curves)"),
        gonio_i_format("within 0.5 points for %zu of %zu materials", close, count),
        (double)close / (double)count, "for at least 80 % of the materials",
        (double)close >= 0.8 * (double)count);
}

static void test_quoted(const tester *t)
{
    for (size_t q = 0; q < GONIO_I_QUOTED; q++) {
        const gonio_i_quoted *quoted = &gonio_i_quoted_materials[q];
        double e6 = NAN;
        for (size_t k = 0; k < t->study->left_out_count && !t->study->cut; k++) {
            const size_t material = t->study->left_out[k];
            if (strcmp(gonio_i_name_of(&t->study->collection, material), quoted->material) == 0) {
                e6 = t->findings->left_out[k * GONIO_I_LEFT_OUT_SERIES + GONIO_I_CHOSEN - 1].e6;
            }
        }
        add(t, GONIO_I_LEFT_OUT,
            gonio_i_format("%s, 170 samples and 45 components", quoted->material),
            gonio_i_format("%.1f %% (Matusik et al., 800 samples: %.1f %%)", quoted->paper,
                           quoted->matusik),
            percent(e6), e6, "no more than Matusik et al. as quoted", e6 <= quoted->matusik);
    }
}

static void test_left_out(const tester *t)
{
    const double bivariate = t->findings->bivariate_mean.e6;
    add(t, GONIO_I_LEFT_OUT, strdup("error of the bivariate average itself, mean of all materials"),
        strdup("3.36 % (on MERL's measurements)"), percent(bivariate), bivariate,
        "no more than the paper's, within 0.2 points", bivariate <= 3.56);
    test_order(t);
    test_closeness(t);
    test_quoted(t);
}

/* ---- all ---- */

gonio_status gonio_i_make_claims(gonio_context *context, const gonio_i_study *study,
                                 const gonio_i_results *results, const gonio_i_findings *findings,
                                 gonio_i_claims *claims)
{
    static void (*const test[GONIO_I_EXPERIMENTS])(const tester *) = {
        test_spectrum, test_convergence, test_grid, test_methods, test_directions, test_left_out};
    const tester t = {study, results, findings, claims};
    *claims = (gonio_i_claims){0};
    for (int k = 0; k < GONIO_I_EXPERIMENTS; k++) {
        if (study->wanted[k] && test[k] != NULL) { /* pictures are for the eye */
            test[k](&t);
        }
    }
    return claims->failed ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory") : GONIO_OK;
}

void gonio_i_claims_free(gonio_i_claims *claims)
{
    for (size_t k = 0; k < claims->count; k++) {
        free(claims->claim[k].what);
        free(claims->claim[k].paper);
        free(claims->claim[k].found);
    }
    *claims = (gonio_i_claims){0};
}
