/* Lists of names with one-line descriptions: every entry has both, no name occurs twice, and the
 * list ends with NULL. */
#include "../support.h"

#include <string.h>

#include <gonio/gonio.h>

typedef struct list {
    const char *of;
    const char *(*name)(int index);
    const char *(*summary)(int index);
    const char *one_of_them;
} list;

static const char *kind_format(int index)
{
    return gonio_kind_format(GONIO_KIND_MATERIAL, index);
}

static const list lists[] = {
    {"plan methods", gonio_plan_method_name, gonio_plan_method_summary, "expected-error"},
    {"starts", gonio_plan_start_name, gonio_plan_start_summary, "random"},
    {"reconstruction methods", gonio_reconstruct_method_name, gonio_reconstruct_method_summary,
     "posterior"},
    {"writers of materials", gonio_material_writer_name, gonio_material_writer_summary, "rgl"},
    {"environments", gonio_environment_name, gonio_environment_summary, "studio"},
    {"built-in materials", gonio_atlas_name, gonio_atlas_class, "gold-polished"},
    {"built-in anisotropic materials", gonio_atlas_anisotropic_name, gonio_atlas_anisotropic_class,
     "steel-hairline"},
    {"formats of materials", kind_format, kind_format, "MERL .binary table"},
};

static int count_of(const list *l, const char *name)
{
    int count = 0;
    for (int k = 0; l->name(k) != NULL; k++) {
        count += strcmp(l->name(k), name) == 0;
    }
    return count;
}

static void test_lists(void **state)
{
    (void)state;
    for (size_t l = 0; l < sizeof lists / sizeof *lists; l++) {
        int end = 0;
        while (lists[l].name(end) != NULL) {
            assert_true(*lists[l].name(end) != '\0');
            assert_true(lists[l].summary(end) != NULL && *lists[l].summary(end) != '\0');
            assert_int_equal(count_of(&lists[l], lists[l].name(end)), 1);
            end++;
        }
        print_message("%s: %d\n", lists[l].of, end);
        assert_int_equal(count_of(&lists[l], lists[l].one_of_them), 1);
        assert_null(lists[l].summary(end));
        assert_true(lists[l].name(-1) == NULL && lists[l].summary(-1) == NULL);
        assert_true(lists[l].name(1000000) == NULL && lists[l].summary(1000000) == NULL);
    }
}

/* A library without the page says so before it looks at what the page is to show. */
static void test_whether_the_page_is_built(void **state)
{
    (void)state;
    const gonio_page_content nothing = {.size = sizeof nothing};
    gonio_context *context = support_context();
    const gonio_status expected = gonio_page_is_built() ? GONIO_ERROR_ARGUMENT : GONIO_ERROR_IO;
    assert_int_equal(gonio_page_write(context, &nothing, "/nonexistent/page.html"), expected);
    gonio_context_free(&context);
}

static void test_writers_of_means(void **state)
{
    (void)state;
    static const char *const means[] = {"merl", "rgl", "table", "zemax"};
    size_t found = 0;
    for (int k = 0; gonio_material_writer_name(k) != NULL; k++) {
        bool listed = false;
        for (size_t m = 0; m < sizeof means / sizeof *means; m++) {
            listed = listed || strcmp(gonio_material_writer_name(k), means[m]) == 0;
        }
        assert_int_equal(gonio_material_writer_averages(k), listed);
        found += listed;
    }
    assert_int_equal(found, sizeof means / sizeof *means);
    assert_false(gonio_material_writer_averages(-1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_writers_of_means),
        cmocka_unit_test(test_lists),
        cmocka_unit_test(test_whether_the_page_is_built),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
