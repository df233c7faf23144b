/* A quick study of five built-in materials, and results of it made of nothing. */
#ifndef FUZZ_SMALL_STUDY_H
#define FUZZ_SMALL_STUDY_H

#include <jansson.h>

#include "fuzz.h"

#include "experiments/kept_results.h"
#include "experiments/methods.h"

static inline void small_study(gonio_i_study *study)
{
    static const char *const paths[] = {"atlas:gold-polished", "atlas:oak-sawn", "atlas:red-cotton",
                                        "atlas:jade-carved", "atlas:grey-primer"};
    gonio_reproduce_options options;
    gonio_reproduce_options_default(&options);
    options.quick = true;
    options.only = "fig2a,fig2b,fig3a,fig3b,fig4,fig5";
    check(gonio_i_study_create(NULL, paths, 5, &options, study) == GONIO_OK, "a study is made");
}

static inline json_t *small_list(size_t count, json_t *each)
{
    json_t *list = json_array();
    for (size_t k = 0; k < count; k++) {
        json_array_append(list, each);
    }
    json_decref(each);
    return list;
}

static inline json_t *small_error(void)
{
    return json_pack("[f, f, f, f]", 1.5, 2.5, 0.5, 0.25);
}

static inline json_t *small_grid(const gonio_i_study *s)
{
    json_t *splits = json_array();
    for (size_t split = 0; split < s->splits.count; split++) {
        const size_t tests = s->splits.split[split].test_count;
        json_t *lines = json_array();
        for (size_t k = 0; k < s->grid_components; k++) {
            json_t *by_samples = json_array();
            for (size_t l = 0; l < s->grid_samples; l++) {
                json_array_append_new(by_samples, s->grid_sample[l] < s->grid_component[k]
                                                      ? json_null()
                                                      : small_list(tests, small_error()));
            }
            json_array_append_new(lines,
                                  json_pack("{s:o, s:o, s:o}", "condition",
                                            small_list(s->grid_samples, json_real(1.25)), "errors",
                                            by_samples, "all", small_list(tests, small_error())));
        }
        json_array_append_new(splits, lines);
    }
    return splits;
}

static inline json_t *small_methods(const gonio_i_study *s)
{
    json_t *splits = json_array();
    for (size_t split = 0; split < s->splits.count; split++) {
        json_array_append_new(
            splits,
            small_list(gonio_i_methods(s),
                       json_pack("{s:f, s:o}", "condition", 2.0, "errors",
                                 small_list(s->splits.split[split].test_count, small_error()))));
    }
    return splits;
}

static inline json_t *small_directions(const gonio_i_study *s)
{
    json_t *sizes = json_array();
    for (size_t c = 0; c < GONIO_I_CHOSEN; c++) {
        json_array_append_new(
            sizes, json_pack("{s:f, s:o}", "condition", 1.5, "entries",
                             small_list(s->chosen[c].samples, json_pack("[i, i, f, f, f, f]", 30, 1,
                                                                        0.5, 1.5, 0.5, 4.7))));
    }
    return sizes;
}

/* {"spectrum": ..., "convergence": ...}, as gonio_i_results has them. */
static inline json_t *small_results(const gonio_i_study *s)
{
    json_t *variances = json_pack("[f, f, f]", 3.0, 1.0, 0.5);
    json_t *spectrum =
        json_pack("{s:O, s:o}", "all", variances, "splits", small_list(s->splits.count, variances));
    json_t *convergence = json_pack(
        "{s:o, s:o}", "starts", small_list(GONIO_I_STARTS, json_pack("[n, f, f]", 3.0, 2.0)),
        "rows", small_list(GONIO_I_STARTS, small_list(s->chosen[0].samples, json_integer(7))));
    json_t *left_out =
        small_list(s->left_out_count,
                   json_pack("{s:o, s:o}", "condition", small_list(GONIO_I_CHOSEN, json_real(2.0)),
                             "errors", small_list(GONIO_I_LEFT_OUT_SERIES, small_error())));
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "spectrum", spectrum, "convergence",
                     convergence, "grid", small_grid(s), "methods", small_methods(s), "directions",
                     small_directions(s), "left_out", left_out);
}

#endif
