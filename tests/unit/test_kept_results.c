/* Kept results: what a computation leaves is accepted, and what anything else says is not. */
#include "../support.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "experiments/kept_results.h"

/* Two splits, with one and two materials to test on; two numbers of components. */
static size_t tests[2] = {3, 4};
static gonio_i_split split[2] = {{.basis_count = 3, .test = tests, .test_count = 1},
                                 {.basis_count = 3, .test = tests, .test_count = 2}};
static const gonio_i_study study = {.splits = {.count = 2, .split = split},
                                    .chosen = {{2, 2}, {2, 3}, {2, 4}},
                                    .grid_components = 2,
                                    .grid_samples = 2,
                                    .grid_component = {2, 3},
                                    .grid_sample = {2, 4}};

/* `text` with E for the errors of a material. */
static json_t *json_of(const char *text)
{
    char error[256] = "[";
    char whole[4096] = "";
    for (int m = 0; gonio_metric_describe(m) != NULL; m++) {
        strcat(error, m == 0 ? "null" : ",1.5");
    }
    strcat(error, "]");
    for (; *text != '\0'; text++) {
        const char one[2] = {*text, '\0'};
        strcat(whole, *text == 'E' ? error : one);
    }
    json_t *json = json_loads(whole, 0, NULL);
    assert_non_null(json);
    return json;
}

/* Whether a text is accepted as a piece; of a refused one the complaint is kept. */
static char complaint[GONIO_I_COMPLAINT];

static bool accepts(gonio_i_accept *accept, size_t of_split, size_t index, const char *text)
{
    const gonio_i_piece piece = {.split = of_split, .index = index};
    json_t *json = json_of(text);
    complaint[0] = '\0';
    const bool accepted = accept(&study, &piece, json, complaint);
    assert_true(accepted == (complaint[0] == '\0'));
    json_decref(json);
    return accepted;
}

static void refuse_all(gonio_i_accept *accept, size_t of_split, size_t index, const char *field,
                       const char *const *texts)
{
    for (; *texts != NULL; texts++) {
        if (accepts(accept, of_split, index, *texts)) {
            fail_msg("accepted: %s", *texts);
        }
        assert_non_null(strstr(complaint, field));
    }
}

static void test_spectrum(void **state)
{
    (void)state;
    static const char *const wrong[] = {"{}",
                                        "[]",
                                        "{\"all\": [], \"splits\": [[1.0], [2]]}",
                                        "{\"all\": [1.0, null], \"splits\": [[1.0], [2]]}",
                                        "{\"all\": {\"0\": 1.0}, \"splits\": [[1.0], [2]]}",
                                        NULL};
    static const char *const wrong_splits[] = {
        "{\"all\": [1.0]}", "{\"all\": [1.0], \"splits\": [[1.0]]}",
        "{\"all\": [1.0], \"splits\": [[1.0], \"x\"]}", NULL};
    assert_true(accepts(gonio_i_accept_spectrum, 0, 0,
                        "{\"all\": [2.0, 1, 0.5], \"splits\": [[1.0], [2.0, 1.0]]}"));
    refuse_all(gonio_i_accept_spectrum, 0, 0, "'all'", wrong);
    refuse_all(gonio_i_accept_spectrum, 0, 0, "'splits'", wrong_splits);
}

static void test_convergence(void **state)
{
    (void)state;
    static const char *const wrong[] = {"{\"starts\": [[null, 2.0], [1], [1], [1], [1]], \"rows\": "
                                        "[[0, 1], [0, 1], [0, 1], [0, 1]]}",
                                        "{\"starts\": [[null, 2.0], [1], [1], [1], [1]],"
                                        " \"rows\": [[0, 1], [0, 1], [0, 1], [0, 1], [0, 24300]]}",
                                        "{\"starts\": [[null, 2.0], [1], [1], [1], [1]],"
                                        " \"rows\": [[0, 1], [0, 1], [0, 1], [0, 1], [0, -1]]}",
                                        "{\"starts\": [[null, 2.0], [1], [1], [1], [1]],"
                                        " \"rows\": [[0, 1], [0, 1], [0, 1], [0, 1], [0]]}",
                                        NULL};
    static const char *const wrong_starts[] = {
        "{\"starts\": [], \"rows\": [[0, 1], [0, 1], [0, 1], [0, 1], [0, 1]]}",
        "{\"starts\": [[], [1], [1], [1], [1]], \"rows\": []}", NULL};
    assert_true(accepts(gonio_i_accept_convergence, 0, 0,
                        "{\"starts\": [[null, 2.0], [1], [1], [1], [1]],"
                        " \"rows\": [[0, 1], [0, 1], [0, 1], [0, 1], [0, 24299]]}"));
    refuse_all(gonio_i_accept_convergence, 0, 0, "'rows'", wrong);
    refuse_all(gonio_i_accept_convergence, 0, 0, "'starts'", wrong_starts);
}

static void test_directions(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "{\"condition\": 1.5}",
        "{\"condition\": 1.5, \"entries\": [[30, 1, 0.5, 1.5, 0.5, 4.7]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 1, 0.5, 1.5, 0.5, 4.7], null]}",
        "{\"condition\": 1.5, \"entries\": [[30, 3, 0.5, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, -1, 0.5, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 100000000, 0.5, 1.5, 0.5, 4.7],"
        " [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[8100, 1, 0.5, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 1.0, 0.5, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 1, null, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 1, 1.6, 1.5, 0.5, 4.7], [1, 2, 0, 0, 0, 0]]}",
        "{\"condition\": 1.5, \"entries\": [[30, 1, 0.5, 1.5, 0.5, 6.3], [1, 2, 0, 0, 0, 0]]}",
        NULL};
    assert_true(accepts(gonio_i_accept_directions, 0, 0,
                        "{\"condition\": 1.5, \"entries\": [[30, 1, 0.5, 1.5, 0.5, 4.7],"
                        " [8099, 2, 0, 0, 0, 0]]}"));
    refuse_all(gonio_i_accept_directions, 0, 0, "'entries'", wrong);
    assert_false(
        accepts(gonio_i_accept_directions, 0, 1, "{\"condition\": \"1.5\", \"entries\": []}"));
    assert_non_null(strstr(complaint, "'condition'"));
}

static void test_grid(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "{\"condition\": [1.5, null], \"errors\": [[E]], \"all\": [E]}",
        "{\"condition\": [1.5, null], \"errors\": [[E], null], \"all\": [E]}",
        "{\"condition\": [1.5, null], \"errors\": [[E], [E, E]], \"all\": [E]}",
        "{\"condition\": [1.5, null], \"errors\": [[E], [[1.0]]], \"all\": [E]}", NULL};
    assert_true(accepts(gonio_i_accept_grid, 0, 0,
                        "{\"condition\": [1.5, null], \"errors\": [[E], [E]], \"all\": [E]}"));
    assert_true(accepts(gonio_i_accept_grid, 1, 1,
                        "{\"condition\": [null, 2], \"errors\": [null, [E, E]], \"all\": [E, E]}"));
    refuse_all(gonio_i_accept_grid, 0, 0, "'errors'", wrong);
    assert_false(accepts(gonio_i_accept_grid, 1, 1,
                         "{\"condition\": [1, 2], \"errors\": [[E, E], [E, E]], \"all\": [E, E]}"));
    assert_false(accepts(gonio_i_accept_grid, 0, 0,
                         "{\"condition\": [1, 2], \"errors\": [[E], [E]], \"all\": [E, E]}"));
    assert_non_null(strstr(complaint, "'all'"));
}

static void test_errors(void **state)
{
    (void)state;
    static const char *const wrong_method[] = {"{\"condition\": 2.0}",
                                               "{\"condition\": 2.0, \"errors\": [E]}",
                                               "{\"condition\": 2.0, \"errors\": [E, [null]]}",
                                               "{\"condition\": 2.0, \"errors\": [E, null]}", NULL};
    static const char *const wrong_left_out[] = {
        "{\"condition\": [1, 2, 3], \"errors\": [E, E, E, E]}",
        "{\"condition\": [1, 2, 3], \"errors\": {}}", NULL};
    static const char *const wrong_quoted[] = {"{\"condition\": 1}",
                                               "{\"condition\": 1, \"error\": [E]}", NULL};
    assert_true(accepts(gonio_i_accept_method, 1, 0, "{\"condition\": null, \"errors\": [E, E]}"));
    refuse_all(gonio_i_accept_method, 1, 0, "'errors'", wrong_method);
    assert_true(accepts(gonio_i_accept_left_out, 0, 0,
                        "{\"condition\": [1, 2, 3], \"errors\": [E, E, E, E, E]}"));
    refuse_all(gonio_i_accept_left_out, 0, 0, "'errors'", wrong_left_out);
    assert_true(accepts(gonio_i_accept_quoted, 0, 0, "{\"condition\": 1, \"error\": E}"));
    refuse_all(gonio_i_accept_quoted, 0, 0, "'error'", wrong_quoted);
}

/* One pixel: 1, 1, 1, 1 as bits. */
static void test_images(void **state)
{
    (void)state;
    static const char *const one = "3f8000003f8000003f8000003f800000";
    static const char *const images[] = {
        "3f8000003f8000003f8000003f800000", "3f8000003f8000003f8000007f800000",
        "3f8000003f8000003f800000ffc00001", "3f8000003f8000003f8000003f80000g",
        "3f8000003f8000003f8000003f80000",  NULL};
    for (int k = 0; images[k] != NULL; k++) {
        json_t *json =
            json_pack("{s:n, s:f, s:n, s:f, s:s, s:s}", "condition", "e6_percent", 1.5, "psnr_db",
                      "delta_e_itp", 0.25, "original", one, "image", images[k]);
        complaint[0] = '\0';
        assert_true(gonio_i_accept_images(json, 1, complaint) == (k == 0));
        assert_true(k == 0 || strcmp(complaint, "'image' is not an image") == 0);
        assert_false(gonio_i_accept_images(json, 2, complaint));
        json_decref(json);
    }
}

int main(void)
{
    const struct CMUnitTest all[] = {
        cmocka_unit_test(test_spectrum),   cmocka_unit_test(test_convergence),
        cmocka_unit_test(test_directions), cmocka_unit_test(test_grid),
        cmocka_unit_test(test_errors),     cmocka_unit_test(test_images),
    };
    return cmocka_run_group_tests_name("kept results", all, NULL, NULL);
}
