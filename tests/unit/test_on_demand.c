/* Libraries that are loaded when they are used: what is linked is used, what is missing is said. */
#include "../support.h"

#include <stdlib.h>
#include <string.h>

#include "core/on_demand.h"

struct pointers {
    __typeof__(strlen) *strlen;
    __typeof__(abs) *abs;
};

static gonio_status load(gonio_context *context, const char *name, const gonio_i_symbol *symbols,
                         struct pointers *pointers)
{
    gonio_i_on_demand library = {.library = name,
                                 .symbol = symbols,
                                 .symbols = 2,
                                 .pointers = pointers,
                                 .lock = PTHREAD_MUTEX_INITIALIZER};
    gonio_status status = gonio_i_load(context, &library);
    assert_int_equal(status == GONIO_OK, library.ready);
    return status;
}

static void test_what_is_linked_is_used(void **state)
{
    (void)state;
    const gonio_i_symbol symbols[] = {GONIO_I_SYMBOL_ROW(strlen) GONIO_I_SYMBOL_ROW(abs)};
    struct pointers pointers = {0};
    assert_int_equal(load(NULL, NULL, symbols, &pointers), GONIO_OK);
    assert_true(pointers.strlen == strlen && pointers.abs == abs);
}

static void test_what_is_not_linked_is_loaded(void **state)
{
    (void)state;
    const gonio_i_symbol symbols[] = {{"strlen", NULL}, {"abs", NULL}};
    struct pointers pointers = {0};
    assert_int_equal(load(NULL, "libc.so.6", symbols, &pointers), GONIO_OK);
    assert_int_equal(pointers.strlen("four"), 4);
    assert_int_equal(pointers.abs(-3), 3);
}

static void test_what_is_missing_is_said(void **state)
{
    (void)state;
    const gonio_i_symbol symbols[] = {{"strlen", NULL}, {"no_such_symbol", NULL}};
    struct pointers pointers = {0};
    gonio_context *context = support_context();
    assert_int_equal(load(context, "libc.so.6", symbols, &pointers), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "no_such_symbol"));
    assert_int_equal(load(context, "libno-such.so.1", symbols, &pointers), GONIO_ERROR_IO);
    assert_non_null(strstr(support_message(), "a library cannot be loaded: libno-such.so.1"));
    gonio_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_linked_is_used),
        cmocka_unit_test(test_what_is_not_linked_is_loaded),
        cmocka_unit_test(test_what_is_missing_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
