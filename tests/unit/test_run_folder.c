/* The folder of a run belongs to one run: another one, another version's, one that goes on now, and
 * a folder of something else are refused. */
#include "../support.h"

#include <sys/stat.h>

#include "squares_in_pieces.h"

static void test_other_runs_are_refused(void **state)
{
    fixture *f = *state;
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_OK);
    assert_int_equal(open_as(f, f->whole, identity(2)), GONIO_ERROR_MISMATCH);
    assert_tells(f, "identity.seed is 1 there and 2 here");
    json_t *who = identity(1);
    json_object_set_new(json_object_get(who, "materials"), "gold", json_string("c3"));
    json_object_set_new(json_object_get(who, "materials"), "tin", json_string("d4"));
    assert_int_equal(open_as(f, f->whole, who), GONIO_ERROR_MISMATCH);
    assert_tells(f, "identity.materials.gold is \"a1\" there and \"c3\" here; "
                    "identity.materials.tin is missing there and \"d4\" here");
}

static void test_other_versions_are_refused(void **state)
{
    fixture *f = *state;
    char path[512];
    snprintf(path, sizeof path, "%s/run.json", f->whole);
    json_t *run_file = json_load_file(path, 0, NULL);
    json_object_set_new(run_file, "gonio", json_string("0.0.7"));
    assert_int_equal(json_dump_file(run_file, path, 0), 0);
    json_decref(run_file);
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_ERROR_MISMATCH);
    assert_tells(f, "gonio is \"0.0.7\" there and \"");
    assert_int_equal(gonio_i_write_text(NULL, path, "{\"gonio\""), GONIO_OK);
    assert_int_equal(open_as(f, f->whole, identity(1)), GONIO_ERROR_FORMAT);
    assert_tells(f, path);
}

static void test_other_folders_are_refused(void **state)
{
    fixture *f = *state;
    char path[512];
    assert_int_equal(mkdir(f->out, 0777), 0);
    snprintf(path, sizeof path, "%s/run.json.12-0.part", f->out); /* killed at the beginning */
    assert_int_equal(gonio_i_write_text(NULL, path, "{"), GONIO_OK);
    assert_int_equal(open_as(f, f->out, identity(1)), GONIO_OK);

    snprintf(path, sizeof path, "%s/holiday.jpg", f->folder);
    assert_int_equal(gonio_i_write_text(NULL, path, "beach"), GONIO_OK);
    assert_int_equal(open_as(f, f->folder, identity(1)), GONIO_ERROR_ARGUMENT);
    assert_tells(f, "but no run of gonio");
    assert_int_equal(open_as(f, path, identity(1)), GONIO_ERROR_IO); /* a file */
    snprintf(path, sizeof path, "%s/no/where", f->folder);
    assert_int_equal(open_as(f, path, identity(1)), GONIO_ERROR_IO);
    assert_tells(f, path);
}

static void test_two_runs_at_once_are_refused(void **state)
{
    fixture *f = *state;
    gonio_i_checkpoint *checkpoint = NULL;
    json_t *who = identity(1);
    assert_int_equal(gonio_i_checkpoint_open(f->context, f->out, who, NULL, &checkpoint), GONIO_OK);
    assert_int_equal(open_as(f, f->out, json_incref(who)), GONIO_ERROR_ARGUMENT);
    assert_tells(f, "another run is using");
    gonio_i_checkpoint_free(&checkpoint);
    assert_null(checkpoint);
    assert_int_equal(open_as(f, f->out, who), GONIO_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_other_runs_are_refused),
        TEST(test_other_versions_are_refused),
        TEST(test_other_folders_are_refused),
        TEST(test_two_runs_at_once_are_refused),
    };
    return cmocka_run_group_tests_name("folders of runs", tests, NULL, NULL);
}
