/* All tests in C, linked once: gonio-tests KIND/NAME runs tests/KIND/test_NAME.c. */
#include <stdio.h>
#include <string.h>

/* The table is made by tests/CMakeLists.txt: TEST(kind, name) for each gonio_test. */
#define TEST(kind, name) int kind##_##name(void);
#include "tests.inc"
#undef TEST

static const struct {
    const char *name;
    int (*run)(void);
} tests[] = {
#define TEST(kind, name) {#kind "/" #name, kind##_##name},
#include "tests.inc"
#undef TEST
};

enum { TESTS = sizeof tests / sizeof tests[0] };

int main(int argc, char **argv)
{
    for (size_t k = 0; argc > 1 && k < TESTS; k++) {
        if (strcmp(argv[1], tests[k].name) == 0) {
            return tests[k].run();
        }
    }
    fprintf(stderr, "usage: gonio-tests KIND/NAME\n");
    for (size_t k = 0; k < TESTS; k++) {
        fprintf(stderr, "    %s\n", tests[k].name);
    }
    return 2;
}
