/* The share of processor time that control groups give, from made files as the kernel writes them.
 */
#include "../support.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/processors.h"

static char *root;
static char groups[4200];

static int set_up(void **state)
{
    (void)state;
    root = support_folder();
    snprintf(groups, sizeof groups, "%s/groups", root);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    support_remove(root);
    return 0;
}

/* A file below root, with the folders that it is in. */
static void write_text(const char *name, const char *text)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/%s", root, name);
    for (char *slash = path + strlen(root) + 1; (slash = strchr(slash, '/')) != NULL; slash++) {
        *slash = '\0';
        mkdir(path, 0777);
        *slash = '/';
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static double share(const char *lines)
{
    write_text("groups", lines);
    return gonio_i_group_limit(GONIO_I_GROUP_PROCESSORS, groups, root);
}

static void test_version_2(void **state)
{
    (void)state;
    write_text("pod/cpu.max", "250000 100000\n");
    write_text("pod/box/cpu.max", "max 100000\n");
    write_text("pod/small/cpu.max", "50000 100000\n");
    assert_true(share("0::/pod\n") == 2.5);
    assert_true(share("0::/pod/box\n") == 2.5); /* the group above has the limit */
    assert_true(share("0::/pod/small\n") == 0.5);
    assert_true(share("0::/\n") == 0.0);
    write_text("cpu.max", "150000 100000\n");
    assert_true(share("0::/\n") == 1.5);
    assert_true(share("0::/of/the/host/that/is/not/seen\n") == 1.5);
}

static void test_version_1(void **state)
{
    (void)state;
    write_text("cpu/docker/1/cpu.cfs_quota_us", "300000\n");
    write_text("cpu/docker/1/cpu.cfs_period_us", "100000\n");
    write_text("cpu/docker/2/cpu.cfs_quota_us", "-1\n");
    write_text("cpu/docker/2/cpu.cfs_period_us", "100000\n");
    write_text("cpu,cpuacct/a/cpu.cfs_quota_us", "75000\n");
    write_text("cpu,cpuacct/a/cpu.cfs_period_us", "50000\n");
    assert_true(share("4:memory:/docker/1\n1:cpu:/docker/1\n") == 3.0);
    assert_true(share("1:cpu:/docker/2\n") == 0.0);
    assert_true(share("2:cpu,cpuacct:/a\n") == 1.5);
    assert_true(share("2:cpuacct,cpu:/a\n") == 0.0); /* no such folder */
    assert_true(share("3:cpuset:/docker/1\n") == 0.0);
}

static void test_memory(void **state)
{
    (void)state;
    write_text("box/memory.max", "536870912\n");
    write_text("box/free/memory.max", "max\n");
    write_text("memory/old/memory.limit_in_bytes", "268435456\n");
    write_text("groups", "0::/box/free\n");
    assert_true(gonio_i_group_limit(GONIO_I_GROUP_MEMORY, groups, root) == 536870912.0);
    write_text("groups", "0::/box/free\n4:memory:/old\n");
    assert_true(gonio_i_group_limit(GONIO_I_GROUP_MEMORY, groups, root) == 268435456.0);
    assert_true(share("0::/box/free\n") == 1.5); /* as before */
}

static void test_files_that_are_none(void **state)
{
    (void)state;
    assert_true(gonio_i_group_limit(GONIO_I_GROUP_PROCESSORS, "/nonexistent", root) == 0.0);
    write_text("odd/cpu.max", "nan -100000\n");
    write_text("zero/cpu.max", "100000 0\n");
    write_text("cpu.max", "");
    assert_true(share("0::/odd\n") == 0.0);
    assert_true(share("0::/zero\n") == 0.0);
    assert_true(share("") == 0.0);
    assert_true(share("no colon\n7:cpu\n::\n0::relative\n") == 0.0);
}

static void test_the_processors_of_this_process(void **state)
{
    (void)state;
    assert_in_range(gonio_i_processors(), 1, omp_get_num_procs());
    assert_int_equal(gonio_i_processors(), gonio_context_threads(NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_version_2),
        cmocka_unit_test(test_version_1),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_files_that_are_none),
        cmocka_unit_test(test_the_processors_of_this_process),
    };
    return cmocka_run_group_tests_name("processors", tests, set_up, tear_down);
}
