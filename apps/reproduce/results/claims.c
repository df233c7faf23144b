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

/* Of all materials' variance, in per cent; NaN if there are no more components than that. */
static double explained(const tester *t, size_t components)
{
    const gonio_i_findings *f = t->findings;
    return components < f->cumulative_count ? 100.0 * f->cumulative[components - 1] : NAN;
}

/* The paper has the curve and no numbers. */
static void test_spectrum(const tester *t)
{
    const double early = explained(t, 10);
    const double chosen = explained(t, 35);
    const double late = explained(t, 45) - chosen;
    add(t, GONIO_I_SPECTRUM, strdup("variance that 10 components explain"),
        strdup("it rises steeply (curve)"), percent(early), early, "at least 90 %", early >= 90.0);
    add(t, GONIO_I_SPECTRUM, strdup("variance that 35 components explain"),
        strdup("nearly all (curve)"), percent(chosen), chosen, "at least 99 %", chosen >= 99.0);
    add(t, GONIO_I_SPECTRUM, strdup("what 10 components more explain"),
        strdup("next to nothing (curve)"), points(late), late, "less than 0.5 points", late < 0.5);
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

/* Rows in both of two ascending lists. */
static size_t count_common(const json_t *a, const json_t *b)
{
    size_t common = 0;
    for (size_t i = 0, j = 0; i < json_array_size(a) && j < json_array_size(b);) {
        const json_int_t x = json_integer_value(json_array_get(a, i));
        const json_int_t y = json_integer_value(json_array_get(b, j));
        common += x == y;
        i += x <= y;
        j += y <= x;
    }
    return common;
}

/* "A stable set of rows": how many of its rows a start shares with another, in per cent. */
static void test_stability(const tester *t)
{
    const json_t *rows = json_object_get(t->results->convergence, "rows");
    const size_t starts = json_array_size(rows);
    double common = 0.0;
    double all = 0.0;
    for (size_t a = 0; a < starts; a++) {
        for (size_t b = a + 1; b < starts; b++) {
            const json_t *first = json_array_get(rows, a);
            common += (double)count_common(first, json_array_get(rows, b));
            all += (double)json_array_size(first);
        }
    }
    const double share = 100.0 * common / all;
    add(t, GONIO_I_CONVERGENCE, strdup("several starts end with the same rows"),
        strdup("\xe2\x80\x9c"
               "a stable set of rows\xe2\x80\x9d"),
        gonio_i_format("two of them share %.1f %% of their rows", share), share,
        "two starts share at least half of their rows", share >= 50.0);
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
        "at most a tenth, for every start", worst_fall <= 0.1);
    add(t, GONIO_I_CONVERGENCE, strdup("several starts end equally well"),
        strdup("\xe2\x80\x9cstable\xe2\x80\x9d"), gonio_i_format("from %.2f to %.2f", best, worst),
        worst / best, "the worst end is within 1.25 times the best", worst / best <= 1.25);
    test_stability(t);
}

/* ---- Fig. 3(a) ---- */

/* What the paper says of each of its sizes: the gain from there to 200 samples, in points. */
static const double paper_gains[GONIO_I_CHOSEN] = {0.3, 0.2, 0.0};

static double grid_gain(const tester *t, size_t components, size_t from, size_t to)
{
    return gonio_i_grid_e6(t->study, t->findings, components, from) -
           gonio_i_grid_e6(t->study, t->findings, components, to);
}

static double gain_to_200(const tester *t, size_t c)
{
    return grid_gain(t, gonio_i_paper_sizes[c].components, gonio_i_paper_sizes[c].samples, 200);
}

/* Where the error as a whole is smaller than the paper's, so may be the gain: the claim is that it
 * is little. Up to 0.05 points are what the paper's rounding hides. */
static void test_gain(const tester *t, size_t c)
{
    const gonio_i_size size = gonio_i_paper_sizes[c];
    const double gain = gain_to_200(t, c);
    add(t, GONIO_I_GRID,
        gonio_i_format("gain of %zu components from %zu to 200 samples", size.components,
                       size.samples),
        paper_gains[c] > 0.0 ? gonio_i_format("only %.1f points", paper_gains[c]) : strdup("none"),
        points(gain), gain, "within 0.05 points of none to the paper's",
        gain >= -0.05 && gain <= paper_gains[c] + 0.05);
}

static void test_gains_shrink(const tester *t)
{
    const double gain[GONIO_I_CHOSEN] = {gain_to_200(t, 0), gain_to_200(t, 1), gain_to_200(t, 2)};
    const double sum = gain[0] + gain[1] + gain[2];
    add(t, GONIO_I_GRID, strdup("order of these gains"), strdup("0.3 > 0.2 > 0.0"),
        isfinite(sum) ? gonio_i_format("%.2f, %.2f, %.2f points", gain[0], gain[1], gain[2])
                      : strdup("not in this run"),
        sum, "this order", gain[0] > gain[1] && gain[1] > gain[2]);
}

/* Against as many samples before as the grid has from as many as components on. */
static void test_saturation(const tester *t, size_t c)
{
    const gonio_i_size size = gonio_i_paper_sizes[c];
    const size_t from = (size.components + 9) / 10 * 10;
    const double before = grid_gain(t, size.components, from, size.samples);
    const double after = gain_to_200(t, c);
    add(t, GONIO_I_GRID,
        gonio_i_format("%zu components: samples help little beyond %zu", size.components,
                       size.samples),
        strdup("yes"),
        isfinite(before + after)
            ? gonio_i_format("%.2f points from %zu on, %.2f after", before, from, after)
            : strdup("not in this run"),
        before + after, "at most a third of the gain before", after <= before / 3.0);
}

/* The smallest error of the grid. */
static double best_of_grid(const tester *t)
{
    const gonio_i_study *s = t->study;
    double best = NAN;
    for (size_t k = 0; k < s->grid_components * s->grid_samples; k++) {
        best = fmin(best,
                    t->findings->grid[k].value[GONIO_E6]); /* those without a number do not count */
    }
    return best;
}

static void test_sufficient(const tester *t)
{
    const double best = best_of_grid(t);
    const double e6 = gonio_i_grid_e6(t->study, t->findings, 35, 80);
    add(t, GONIO_I_GRID, strdup("35 components and 80 samples are sufficient"),
        strdup("\xe2\x80\x9cquite effectively\xe2\x80\x9d"),
        isfinite(e6 - best) ? gonio_i_format("%.2f %%; the best of the grid is %.2f %%", e6, best)
                            : strdup("not in this run"),
        e6 - best, "at most a quarter above the best of the grid", e6 <= 1.25 * best);
}

static void test_grid(const tester *t)
{
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        test_gain(t, c);
    }
    test_gains_shrink(t);
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        test_saturation(t, c);
    }
    test_sufficient(t);
}

/* ---- Fig. 3(b) ---- */

/* In how many splits one method does better than another. */
static size_t count_wins(const tester *t, size_t method, size_t other)
{
    const size_t splits = t->study->splits.count;
    const gonio_error *by_split = t->findings->method_split;
    size_t wins = 0;
    for (size_t s = 0; s < splits; s++) {
        wins += by_split[method * splits + s].value[GONIO_E6] <
                by_split[other * splits + s].value[GONIO_E6];
    }
    return wins;
}

/* The paper's method, which is the first of the table with that size, against another, which is to
 * have at least `factor` times its error. */
static void test_method(const tester *t, size_t method, size_t other, char *what, double factor,
                        const char *rule)
{
    const gonio_i_findings *f = t->findings;
    const double mine = f->method[method].value[GONIO_E6];
    const double theirs = f->method[other].value[GONIO_E6];
    const size_t wins = count_wins(t, method, other);
    add(t, GONIO_I_METHODS, what,
        strdup(factor > 1.0 ? "\xe2\x80\x9c"
                              "considerable improvement\xe2\x80\x9d"
                            : "better, with fewer samples"),
        isfinite(theirs - mine)
            ? gonio_i_format("%.2f %% against %.2f %%; better in %zu of %zu splits", mine, theirs,
                             wins, t->study->splits.count)
            : strdup("too few independent readings"),
        theirs - mine, rule,
        mine < theirs && theirs >= factor * mine && 2 * wins > t->study->splits.count);
}

/* A random choice of each size, and the method that the paper quotes. Of the others, which are
 * later, it says nothing. */
static void test_methods(const tester *t)
{
    for (size_t m = GONIO_I_CHOSEN; m < gonio_i_methods(t->study); m++) {
        const gonio_i_method_entry *other = gonio_i_method_at(m);
        for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
            const size_t samples = t->study->chosen[c].samples;
            if (other->chosen == (int)c) {
                test_method(t, c, m, gonio_i_format("%s, %zu samples each", other->label, samples),
                            1.1,
                            "their mean E6 is at least 1.1 times as large, and it is larger in "
                            "most splits");
            } else if (other->quoted) {
                test_method(t, c, m,
                            gonio_i_format("%s, %zu samples against their %zu", other->label,
                                           samples, gonio_i_method_size(t->study, other).samples),
                            1.0, "a smaller mean E6, and in most splits");
            }
        }
    }
}

/* ---- Fig. 4 ---- */

enum { PARTS = 6, PART = 90 / PARTS }; /* of 90 degrees */

static size_t part_of(const json_t *entry, size_t index)
{
    const double degrees = gonio_i_json_number(json_array_get(entry, index)) * 180.0 / M_PI;
    const double part = floor(degrees / PART);
    return part < 0.0 ? 0 : part >= PARTS ? PARTS - 1 : (size_t)part;
}

static size_t count_used(const size_t *counts)
{
    size_t used = 0;
    for (size_t k = 0; k < PARTS; k++) {
        used += counts[k] > 0;
    }
    return used;
}

static size_t largest_of(const size_t *counts)
{
    size_t largest = 0;
    for (size_t k = 0; k < PARTS; k++) {
        largest = counts[k] > largest ? counts[k] : largest;
    }
    return largest;
}

/* phi_h = 0 and phi_d = 90 degrees leave the light a quarter of the hemisphere, which is cut into
 * six rings and six sectors. */
static void test_directions(const tester *t)
{
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        const json_t *entries =
            json_object_get(json_array_get(t->results->directions, c), "entries");
        const size_t count = json_array_size(entries);
        size_t rings[PARTS] = {0};
        size_t sectors[PARTS] = {0};
        for (size_t k = 0; k < count; k++) {
            rings[part_of(json_array_get(entries, k), 2)]++;
            sectors[part_of(json_array_get(entries, k), 3)]++;
        }
        const size_t most =
            largest_of(rings) > largest_of(sectors) ? largest_of(rings) : largest_of(sectors);
        add(t, GONIO_I_DIRECTIONS,
            gonio_i_format("where the light stands, %zu samples", t->study->chosen[c].samples),
            strdup("\xe2\x80\x9c"
                   "across the hemisphere\xe2\x80\x9d (picture)"),
            gonio_i_format("in %zu of %d rings and %zu of %d sectors, at most %zu of %zu in one",
                           count_used(rings), PARTS, count_used(sectors), PARTS, most, count),
            (double)most / (double)count,
            "some in each ring of 15\xc2\xb0 from the normal and each sector of 15\xc2\xb0 around "
            "it, and not more than half of all in one",
            count_used(rings) == PARTS && count_used(sectors) == PARTS && 2 * most <= count);
    }
}

/* ---- Fig. 5 ---- */

static void test_order(const tester *t)
{
    const gonio_error *mean = t->findings->left_out_mean;
    const bool order = mean[GONIO_I_BIVARIATE_ITSELF].value[GONIO_E6] <
                           mean[GONIO_I_ALL_SAMPLES].value[GONIO_E6] &&
                       mean[GONIO_I_ALL_SAMPLES].value[GONIO_E6] < mean[2].value[GONIO_E6] &&
                       mean[2].value[GONIO_E6] < mean[1].value[GONIO_E6] &&
                       mean[1].value[GONIO_E6] < mean[0].value[GONIO_E6];
    add(t, GONIO_I_LEFT_OUT, strdup("order of the mean errors"),
        gonio_i_format("bivariate < all samples < %zu < %zu < %zu", t->study->chosen[2].samples,
                       t->study->chosen[1].samples, t->study->chosen[0].samples),
        gonio_i_format("%.2f, %.2f, %.2f, %.2f, %.2f %%",
                       mean[GONIO_I_BIVARIATE_ITSELF].value[GONIO_E6],
                       mean[GONIO_I_ALL_SAMPLES].value[GONIO_E6], mean[2].value[GONIO_E6],
                       mean[1].value[GONIO_E6], mean[0].value[GONIO_E6]),
        mean[2].value[GONIO_E6], "this order", order);
}

/* The largest plan against all samples: in the mean, and in how many materials. */
static void test_closeness(const tester *t)
{
    size_t close = 0;
    const size_t count = t->study->left_out_count;
    const size_t samples = t->study->chosen[GONIO_I_CHOSEN - 1].samples;
    const gonio_error *mean = t->findings->left_out_mean;
    for (size_t k = 0; k < count; k++) {
        const gonio_error *error = t->findings->left_out + k * GONIO_I_LEFT_OUT_SERIES;
        close += error[GONIO_I_CHOSEN - 1].value[GONIO_E6] <=
                 error[GONIO_I_ALL_SAMPLES].value[GONIO_E6] + 0.5;
    }
    const double ratio =
        mean[GONIO_I_CHOSEN - 1].value[GONIO_E6] / mean[GONIO_I_ALL_SAMPLES].value[GONIO_E6];
    add(t, GONIO_I_LEFT_OUT, gonio_i_format("%zu samples come close to all, in the mean", samples),
        strdup("closely (curves)"), gonio_i_format("%.2f times the error of all samples", ratio),
        ratio, "at most 1.1 times their error", ratio <= 1.1);
    add(t, GONIO_I_LEFT_OUT,
        gonio_i_format("%zu samples come close to all, material by material", samples),
        strdup("closely (curves)"),
        gonio_i_format("within 0.5 points for %zu of %zu materials", close, count),
        (double)close / (double)count, "for at least 90 % of the materials",
        (double)close >= 0.9 * (double)count);
}

/* What the paper quotes. Its own numbers are of other data: what can agree is which is better. */
static void test_quoted(const tester *t)
{
    for (size_t q = 0; q < t->study->quoted_count && !t->study->cut; q++) {
        const gonio_i_quoted *quoted = &gonio_i_quoted_materials[t->study->quoted[q].quote];
        const size_t k = t->study->quoted[q].left_out;
        const double mine =
            t->findings->left_out[k * GONIO_I_LEFT_OUT_SERIES + GONIO_I_CHOSEN - 1].value[GONIO_E6];
        const double theirs = t->findings->quoted[q].value[GONIO_E6];
        add(t, GONIO_I_LEFT_OUT,
            gonio_i_format("%s, 170 samples against 800 of %s", quoted->material,
                           gonio_i_quoted_method()->label),
            gonio_i_format("%.1f %% against %.1f %%", quoted->paper, quoted->matusik),
            gonio_i_format("%.2f %% against %.2f %%", mine, theirs), theirs - mine, "a smaller E6",
            mine < theirs);
    }
}

static void test_left_out(const tester *t)
{
    const double bivariate = t->findings->bivariate_mean.value[GONIO_E6];
    add(t, GONIO_I_LEFT_OUT, strdup("error of the bivariate average itself, mean of all materials"),
        strdup("3.36 % (on MERL's measurements)"), percent(bivariate), bivariate,
        "within 0.2 points of the paper's", fabs(bivariate - 3.36) <= 0.2);
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
