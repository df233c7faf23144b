/* The page of findings: see markdown.h. */
#include "markdown.h"

#include <math.h>
#include <string.h>

#include "csv_tables.h"
#include "reported_errors.h"
#include "../run/text_file.h"

typedef struct page {
    FILE *f;
    const gonio_i_study *study;
    const gonio_i_findings *findings;
    const gonio_i_claims *claims;
} page;

/* ---- what the sections share ---- */

static void put_number(FILE *f, double value, int digits)
{
    if (isfinite(value)) {
        fprintf(f, " %.*f |", digits, value);
    } else {
        fputs(" \xe2\x80\x93 |", f);
    }
}

static void put_error(FILE *f, gonio_error error)
{
    for (int k = 0; k < GONIO_I_REPORTED; k++) {
        const gonio_metric_view *metric = gonio_metric_describe((int)gonio_i_reported[k]);
        put_number(f, error.value[gonio_i_reported[k]], *metric->unit == '%' ? 2 : 4);
    }
    fputc('\n', f);
}

/* Names stand in table cells and must not end them. */
static void put_plain(FILE *f, const char *text)
{
    for (const char *c = text; *c != '\0'; c++) {
        if (strchr("|\\`*_<>[]", *c) != NULL) {
            fputc('\\', f);
        }
        fputc((unsigned char)*c < ' ' ? ' ' : *c, f);
    }
}

static void put_claims(const page *p, gonio_i_experiment experiment)
{
    size_t count = 0;
    for (size_t k = 0; k < p->claims->count; k++) {
        count += p->claims->claim[k].experiment == experiment;
    }
    if (count == 0) {
        return;
    }
    fputs("| claim | paper | here | agrees if | |\n| --- | --- | --- | --- | --- |\n", p->f);
    for (size_t k = 0; k < p->claims->count; k++) {
        const gonio_i_claim *c = &p->claims->claim[k];
        if (c->experiment == experiment) {
            fputs("| ", p->f);
            put_plain(p->f, c->what);
            fprintf(p->f, " | %s | %s | %s | %s |\n", c->paper, c->found, c->rule,
                    gonio_i_verdict_name(c->verdict));
        }
    }
    fputc('\n', p->f);
}

#define ERROR_HEADINGS "E6 % | cube root % | log-relative |\n"

/* ---- sections ---- */

static void put_introduction(const page *p)
{
    const gonio_i_study *s = p->study;
    size_t verdicts[3] = {0};
    for (size_t k = 0; k < p->claims->count; k++) {
        verdicts[p->claims->claim[k].verdict]++;
    }
    fprintf(
        p->f,
        "# Ali et al., *Optimal Sampling for Efficient BRDF Acquisition*, reproduced\n\n"
        "By gonio %s%s: %zu materials, %zu splits (%zu materials to learn from and "
        "%zu to test on), seed %llu. Of %zu claims %zu agree, %zu differ, %zu could not be tested "
        "here.\n\n",
        gonio_version(), s->quick ? ", the quick version" : "", s->collection.count,
        s->splits.count, s->splits.split[0].basis_count, s->splits.split[0].test_count,
        (unsigned long long)s->seed, p->claims->count, verdicts[GONIO_I_AGREES],
        verdicts[GONIO_I_DIFFERS], verdicts[GONIO_I_NOT_TESTED]);
    fprintf(p->f,
            "Readings are noise-free averages of cells. Plans have one random start; those of "
            "Fig. 2(b) and Fig. 4 have %d. Errors are those of the whole BRDF against the original "
            "table, all "
            "bins and channels, averaged over the test materials and the splits: E6 is the paper's "
            "eq. (6); beside it the cube-root error (Fores et al. 2012) and the log-relative one "
            "(Nielsen et al. 2015). All raw numbers are in `tables/` and `results.json`, the data "
            "and scripts of the figures beside them in `figures/`.\n\n",
            GONIO_I_STARTS);
    if (s->cut) {
        fputs("There are too few materials for the paper's numbers of components, which are cut "
              "to what the smallest basis has; what the paper says of 35, 40 and 45 cannot be "
              "tested.\n\n",
              p->f);
    }
    fputs("The bivariate average alone, mean of all materials:\n\n| " ERROR_HEADINGS
          "| --- | --- | --- |\n|",
          p->f);
    put_error(p->f, p->findings->bivariate_mean);
    fputc('\n', p->f);
}

static void put_spectrum(const page *p)
{
    const gonio_i_findings *f = p->findings;
    fputs("| components |", p->f);
    static const size_t shown[] = {1, 5, 10, 20, 35, 40, 45, 60};
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++) {
        fprintf(p->f, " %zu |", shown[k]);
    }
    fputs("\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n| variance % |", p->f);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++) {
        put_number(p->f,
                   shown[k] <= f->cumulative_count ? 100.0 * f->cumulative[shown[k] - 1] : NAN, 2);
    }
    fputs("\n\n", p->f);
}

/* Nothing beyond the claims. */
static void put_nothing(const page *p)
{
    (void)p;
}

static void put_grid(const page *p)
{
    const gonio_i_study *s = p->study;
    fputs("![E6 against samples](figures/fig3a-curves.png)\n\n"
          "| components | samples | condition number | " ERROR_HEADINGS
          "| --- | --- | --- | --- | --- | --- |\n",
          p->f);
    for (size_t k = 0; k < s->grid_components; k++) {
        for (size_t l = 0; l < s->grid_samples; l++) {
            const size_t at = k * s->grid_samples + l;
            const size_t samples = s->grid_sample[l];
            const bool shown = samples == 40 || samples == 80 || samples == 120 || samples == 170 ||
                               samples == 200;
            if (shown && samples >= s->grid_component[k]) {
                fprintf(p->f, "| %zu | %zu |", s->grid_component[k], samples);
                put_number(p->f, p->findings->grid_condition[at], 2);
                put_error(p->f, p->findings->grid[at]);
            }
        }
        fprintf(p->f, "| %zu | all rows | 1.00 |", s->grid_component[k]);
        put_error(p->f, p->findings->limit[k]);
    }
    fputs("\nAll cells: `tables/fig3a-means.csv`.\n\n", p->f);
}

static void put_methods(const page *p)
{
    fputs("Bars: the standard deviation over the splits, whose test materials differ.\n\n", p->f);
    fputs("| method | components | samples | condition number | " ERROR_HEADINGS
          "| --- | --- | --- | --- | --- | --- | --- |\n",
          p->f);
    for (size_t m = 0; m < gonio_i_methods(p->study); m++) {
        const gonio_i_method_entry *method = gonio_i_method_at(m);
        const gonio_i_size size = gonio_i_method_size(p->study, method);
        fprintf(p->f, "| %s | %zu | %zu |", method->label, size.components, size.samples);
        put_number(p->f, p->findings->method_condition[m], 2);
        put_error(p->f, p->findings->method[m]);
    }
    fputc('\n', p->f);
}

/* The materials whose errors the paper quotes, from bases of all others. */
static void put_quoted(const page *p)
{
    const gonio_i_study *s = p->study;
    if (s->quoted_count == 0) {
        return;
    }
    const gonio_i_size own = s->chosen[GONIO_I_CHOSEN - 1];
    const gonio_i_size size = gonio_i_quoted_size(s->collection.count - 1);
    const char *label = gonio_i_quoted_method()->label;
    fprintf(p->f,
            "| E6 %% of | paper, 170 | here, %zu | %s, 800, as the paper quotes | %s, %zu of "
            "%zu materials, run here |\n| --- | --- | --- | --- | --- |\n",
            own.samples, label, label, size.samples, size.components);
    for (size_t q = 0; q < s->quoted_count; q++) {
        const gonio_i_quoted *quoted = &gonio_i_quoted_materials[s->quoted[q].quote];
        const size_t at = s->quoted[q].left_out * GONIO_I_LEFT_OUT_SERIES + GONIO_I_CHOSEN - 1;
        fprintf(p->f, "| %s | %.1f |", quoted->material, quoted->paper);
        put_number(p->f, p->findings->left_out[at].value[GONIO_E6], 2);
        fprintf(p->f, " %.1f |", quoted->matusik);
        put_number(p->f, p->findings->quoted[q].value[GONIO_E6], 2);
        fputc('\n', p->f);
    }
    fputc('\n', p->f);
}

static void put_left_out(const page *p)
{
    const gonio_i_study *s = p->study;
    char text[32];
    fprintf(p->f, "Means of %zu materials, each reconstructed from a basis of all others:\n\n",
            s->left_out_count);
    fputs("| from | components | " ERROR_HEADINGS "| --- | --- | --- | --- | --- |\n", p->f);
    for (size_t series = 0; series < GONIO_I_LEFT_OUT_SERIES; series++) {
        const size_t size = series < GONIO_I_CHOSEN ? series : GONIO_I_CHOSEN - 1;
        fprintf(p->f, "| %s |", gonio_i_series_name(s, series, text));
        if (series == GONIO_I_BIVARIATE_ITSELF) {
            fputs(" \xe2\x80\x93 |", p->f);
        } else {
            fprintf(p->f, " %zu |", s->chosen[size].components);
        }
        put_error(p->f, p->findings->left_out_mean[series]);
    }
    fputs("\nEach material: `tables/fig5.csv`.\n\n", p->f);
    put_quoted(p);
}

static void put_rendered(const page *p)
{
    fputs("Below each: E6, and of what is seen PSNR and mean Delta E_ITP (BT.2124). Numbers: "
          "`tables/fig6.csv`, `tables/fig7.csv`.\n\n",
          p->f);
}

static const struct {
    const char *title;
    const char *paper;
    void (*put)(const page *p);
} sections[GONIO_I_EXPERIMENTS] = {
    [GONIO_I_SPECTRUM] = {"Fig. 2(a): the spectrum",
                          "The cumulative sum of the eigenvalues: few components carry most of the "
                          "variance of the bivariate matrix H.",
                          put_spectrum},
    [GONIO_I_CONVERGENCE] = {"Fig. 2(b): convergence of a plan",
                             "The condition number falls as rows are swapped; several runs give a "
                             "stable set of rows.",
                             put_nothing},
    [GONIO_I_GRID] =
        {"Fig. 3(a): components and samples",
         "From 35 components on, more samples help little beyond a certain number: "
         "with 35 components 0.3 points from 80 to 200 samples, with 40 components 0.2 "
         "from 120 to 200, with 45 nothing after 170.",
         put_grid},
    [GONIO_I_METHODS] = {"Fig. 3(b): other methods",
                         "The method does better than a random choice of as many samples, and "
                         "than Matusik et al. with 800.",
                         put_methods},
    [GONIO_I_DIRECTIONS] = {"Fig. 4: the chosen directions",
                            "Pairs of light (red +) and view (blue *) directions for phi_h = 0 and "
                            "phi_d = pi/2, planned from all materials.",
                            put_nothing},
    [GONIO_I_LEFT_OUT] = {"Fig. 5: every material left out once",
                          "Reconstructions from 80, 120 and 170 samples come close to those from "
                          "all samples; the bivariate average itself has a mean error of 3.36 %.",
                          put_left_out},
    [GONIO_I_RENDERED] =
        {"Fig. 6: renderings",
         "Spheres under a lamp, tone-mapped: originals, reconstructions from 170, "
         "120 and 80 samples, from 80 random ones, and by Matusik et al. with 800.",
         put_rendered},
    [GONIO_I_LIT] = {"Fig. 7: renderings under environment maps",
                     "Originals and reconstructions from 80 samples with 35 components look alike.",
                     put_rendered},
};

gonio_status gonio_i_write_page(gonio_context *context, const gonio_i_study *study,
                                const gonio_i_findings *findings, const gonio_i_claims *claims,
                                const char *folder)
{
    gonio_i_text text;
    const gonio_status status = gonio_i_text_begin(context, &text);
    if (status != GONIO_OK) {
        return status;
    }
    const page p = {text.stream, study, findings, claims};
    put_introduction(&p);
    for (int k = 0; k < GONIO_I_EXPERIMENTS; k++) {
        if (study->wanted[k]) {
            fprintf(p.f, "## %s\n\nThe paper: %s\n\n![%s](figures/%s.png)\n\n", sections[k].title,
                    sections[k].paper, sections[k].title, gonio_experiment_name(k));
            put_claims(&p, (gonio_i_experiment)k);
            sections[k].put(&p);
        }
    }
    return gonio_i_text_end(context, &text, folder, "report.md", GONIO_OK);
}

/* ---- for programs ---- */

static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *sized(gonio_error error, size_t components, size_t samples, double condition)
{
    json_t *json = gonio_i_reported_json(error);
    json_object_set_new(json, "components", json_integer((json_int_t)components));
    json_object_set_new(json, "samples",
                        samples > 0 ? json_integer((json_int_t)samples) : json_string("all"));
    json_object_set_new(json, "condition_number", number(condition));
    return json;
}

static json_t *claims_json(const gonio_i_claims *claims)
{
    json_t *list = json_array();
    for (size_t k = 0; k < claims->count; k++) {
        const gonio_i_claim *c = &claims->claim[k];
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:s, s:o, s:s, s:s}", "experiment",
                                              gonio_experiment_name((int)c->experiment), "claim",
                                              c->what, "paper", c->paper, "found", c->found,
                                              "value", number(c->value), "agrees_if", c->rule,
                                              "verdict", gonio_i_verdict_name(c->verdict)));
    }
    return list;
}

static json_t *grid_json(const gonio_i_study *study, const gonio_i_findings *findings)
{
    json_t *list = json_array();
    for (size_t k = 0; k < study->grid_components; k++) {
        const size_t components = study->grid_component[k];
        for (size_t l = 0; l < study->grid_samples; l++) {
            const size_t at = k * study->grid_samples + l;
            if (study->grid_sample[l] >= components) {
                json_array_append_new(list,
                                      sized(findings->grid[at], components, study->grid_sample[l],
                                            findings->grid_condition[at]));
            }
        }
        json_array_append_new(list, sized(findings->limit[k], components, 0, 1.0));
    }
    return list;
}

static json_t *methods_json(const gonio_i_study *study, const gonio_i_findings *findings)
{
    json_t *list = json_array();
    for (size_t m = 0; m < gonio_i_methods(study); m++) {
        const gonio_i_method_entry *method = gonio_i_method_at(m);
        const gonio_i_size size = gonio_i_method_size(study, method);
        json_t *json = sized(findings->method[m], size.components, size.samples,
                             findings->method_condition[m]);
        json_object_set_new(json, "method", json_string(method->label));
        json_array_append_new(list, json);
    }
    return list;
}

static json_t *series_json(const gonio_i_study *study, const gonio_error *errors)
{
    json_t *series = json_object();
    char text[32];
    for (size_t s = 0; s < GONIO_I_LEFT_OUT_SERIES; s++) {
        json_object_set_new(series, gonio_i_series_name(study, s, text),
                            gonio_i_reported_json(errors[s]));
    }
    return series;
}

static json_t *left_out_json(const gonio_i_study *study, const gonio_i_findings *findings)
{
    json_t *materials = json_object();
    for (size_t k = 0; k < study->left_out_count; k++) {
        json_object_set_new(materials, gonio_i_name_of(&study->collection, study->left_out[k]),
                            series_json(study, findings->left_out + k * GONIO_I_LEFT_OUT_SERIES));
    }
    json_t *quoted = json_object();
    for (size_t q = 0; q < study->quoted_count; q++) {
        json_object_set_new(quoted, gonio_i_name_of(&study->collection, study->quoted[q].material),
                            gonio_i_reported_json(findings->quoted[q]));
    }
    return json_pack("{s:o, s:o, s:o}", "mean", series_json(study, findings->left_out_mean),
                     "materials", materials, gonio_i_quoted_method()->name, quoted);
}

static json_t *cumulative_json(const gonio_i_findings *findings)
{
    json_t *list = json_array();
    for (size_t k = 0; k < findings->cumulative_count; k++) {
        json_array_append_new(list, number(findings->cumulative[k]));
    }
    return list;
}

static json_t *results_json(const gonio_i_study *study, const gonio_i_findings *findings,
                            const gonio_i_claims *claims)
{
    json_t *json =
        json_pack("{s:s, s:I, s:I, s:I, s:b, s:o, s:o}", "gonio", gonio_version(), "materials",
                  (json_int_t)study->collection.count, "splits", (json_int_t)study->splits.count,
                  "seed", (json_int_t)study->seed, "quick", study->quick, "bivariate_mean",
                  gonio_i_reported_json(findings->bivariate_mean), "claims", claims_json(claims));
    if (study->wanted[GONIO_I_SPECTRUM]) {
        json_object_set_new(json, "fig2a", cumulative_json(findings));
    }
    if (study->wanted[GONIO_I_GRID]) {
        json_object_set_new(json, "fig3a", grid_json(study, findings));
    }
    if (study->wanted[GONIO_I_METHODS]) {
        json_object_set_new(json, "fig3b", methods_json(study, findings));
    }
    if (study->wanted[GONIO_I_LEFT_OUT]) {
        json_object_set_new(json, "fig5", left_out_json(study, findings));
    }
    return json;
}

gonio_status gonio_i_write_results(gonio_context *context, const gonio_i_study *study,
                                   const gonio_i_findings *findings, const gonio_i_claims *claims,
                                   const char *folder)
{
    gonio_i_text text;
    json_t *json = results_json(study, findings, claims);
    gonio_status status = gonio_i_text_begin(context, &text);
    if (status == GONIO_OK) {
        const bool fine =
            json != NULL &&
            json_dumpf(json, text.stream, JSON_INDENT(2) | JSON_REAL_PRECISION(10)) == 0 &&
            fputc('\n', text.stream) != EOF;
        status = fine ? GONIO_OK
                      : gonio_i_fail(context, GONIO_ERROR_MEMORY, "results.json: out of memory");
        status = gonio_i_text_end(context, &text, folder, "results.json", status);
    }
    json_decref(json);
    return status;
}
