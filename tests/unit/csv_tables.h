/* Tables as text for the tests of CSV: reading them, and their refusal. */
#ifndef CSV_TABLES_H
#define CSV_TABLES_H

#include <math.h>
#include <string.h>

#include <gonio/gonio.h>

/* A text that is refused, and what the message holds. */
typedef struct refused_text {
    const char *text;
    const char *message;
} refused_text;

/* The readings in a text; NULL where it is refused. */
static inline gonio_readings *read_table(gonio_context *context, const char *text,
                                         bool values_needed)
{
    gonio_readings_options options;
    gonio_readings *readings = NULL;
    print_message("%s", text);
    gonio_readings_options_default(&options);
    options.values_needed = values_needed;
    gonio_readings_read_text(context, "r.csv", text, strlen(text), &options, &readings);
    return readings;
}

static inline void assert_near(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9)) {
        fail_msg("%.17g where %.17g is expected", value, expected);
    }
}

/* Each text is refused as readings that are needed. */
static inline void assert_refused(const refused_text *table, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        gonio_context *context = support_context();
        assert_null(read_table(context, table[k].text, true));
        if (strstr(support_message(), table[k].message) == NULL) {
            fail_msg("%s", support_message());
        }
        gonio_context_free(&context);
    }
}

#endif
