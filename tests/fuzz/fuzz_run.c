/* libFuzzer on runs that are followed. First byte odd: a journal of any bytes, which is refused
 * with a reason or goes on, with the same records before and after one is appended. Even: lines of
 * an instrument, requests and new plans in any order; what counts of them is readings. */
#include "fuzz.h"

#include "follow/journal.h"
#include "follow/run.h"

enum { MOST_LINE = 300 };

/* ---- journals ---- */

static gonio_status gather(void *user, const char *kind, const char *text)
{
    uint64_t *sum = user;
    check(strchr(kind, ' ') == NULL && strchr(text, '\n') == NULL, "a record is a word and a text");
    for (const char *c = text; *c != '\0'; c++) {
        *sum = *sum * 31 + (unsigned char)*c;
    }
    return GONIO_OK;
}

static bool open_journal(const char *path, uint64_t *sum, journal_found *found, journal **opened)
{
    char *problem = NULL;
    *sum = 1;
    const gonio_status status = journal_open(path, gather, sum, found, opened, &problem);
    check((status == GONIO_OK) == (problem == NULL), "a refusal has a reason");
    free(problem);
    return status == GONIO_OK;
}

static void go_on(const char *path)
{
    journal *j = NULL;
    journal_found before;
    journal_found after;
    uint64_t sum[2];
    if (!open_journal(path, &sum[0], &before, &j)) {
        return;
    }
    check(journal_append(j, "ask", "7") && journal_flush(j), "a record is appended");
    journal_close(&j);
    check(open_journal(path, &sum[1], &after, &j), "what was appended to is a journal");
    journal_close(&j);
    check(after.records == before.records + 1 && after.damaged == before.damaged && after.cut == 0,
          "it has one more record");
    check(sum[1] == sum[0] * 31 + '7', "and the same ones before");
}

/* ---- lines ---- */

static gonio_readings *make_plan(gonio_context *context)
{
    static const gonio_pair pair[] = {
        {{0.5, 0.0}, {0.5, M_PI}}, {{0.5, 0.0}, {0.9, M_PI}}, {{1.0, 0.0}, {0.3, 1.5}}};
    const gonio_readings_arrays arrays = {
        .size = sizeof arrays, .count = 3, .channels = GONIO_CHANNELS, .pair = pair};
    gonio_readings *plan = NULL;
    check(gonio_readings_create(context, &arrays, NULL, &plan) == GONIO_OK, "a plan is made");
    return plan;
}

static void take_line(run *r, fuzz_bytes *bytes, size_t line)
{
    char text[MOST_LINE + 1];
    size_t length = 0;
    gonio_status status = GONIO_OK;
    while (bytes->left > 0 && *bytes->at != '\n' && length < MOST_LINE) {
        text[length++] = (char)fuzz_byte(bytes);
    }
    (void)fuzz_byte(bytes);
    text[length] = '\0';
    const run_fate fate = run_take(r, line, (double)line, text, &status);
    check(status == GONIO_OK, "a line is taken");
    check(fate != RUN_UNCLEAR || r->problem != NULL, "what is not understood has a reason");
}

static void replace_plan(run *r, fuzz_bytes *bytes)
{
    double degrees[2][4];
    for (int k = 0; k < 8; k++) {
        degrees[k / 4][k % 4] = 100.0 * fuzz_number(bytes);
    }
    check(run_replace(r, (const double(*)[4])degrees, 2) == GONIO_OK, "a plan is replaced");
}

static void check_run(const run *r)
{
    size_t *line_row = NULL;
    size_t size = 0;
    size_t *open = calloc(run_left(r) + 1, sizeof *open);
    check(open != NULL && run_list_open(r, open) == run_left(r), "what is left can be listed");
    check(run_left(r) == 0 || run_next(r) < r->wanted_count, "and begins somewhere");
    char *text = run_text(r, &size, &line_row);
    check(text != NULL && strlen(text) == size, "what counts is a text");
    for (size_t k = 0; k < r->rows; k++) {
        check(r->row[k].wanted == RUN_NOWHERE || r->row[k].wanted < r->wanted_count,
              "a row is of a direction or of none");
        for (size_t c = 0; c < r->row[k].channels && r->row[k].of_sample; c++) {
            check(isnan(r->row[k].value[c]) || r->row[k].value[c] >= 0.0,
                  "a value is none or a BRDF");
        }
    }
    free(line_row);
    free(text);
    free(open);
}

static void follow(gonio_context *context, fuzz_bytes bytes)
{
    const gonio_readings_options how = {
        .size = sizeof how, .values_needed = true, .negative_to_zero = true};
    gonio_readings *plan = make_plan(context);
    run r;
    check(run_begin(&r, plan, &how, "robot.csv") == GONIO_OK, "a run begins");
    gonio_readings_free(&plan);
    for (size_t line = 1; bytes.left > 0; line++) {
        switch (*bytes.at) {
        case '!': /* ask again */
            (void)fuzz_byte(&bytes);
            run_ask(&r, fuzz_byte(&bytes) % r.wanted_count);
            break;
        case '@': /* another plan */
            (void)fuzz_byte(&bytes);
            replace_plan(&r, &bytes);
            break;
        default:
            take_line(&r, &bytes, line);
        }
    }
    check_run(&r);
    run_end(&r);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    if (size < 1) {
        return -1;
    }
    if (data[0] % 2 != 0) {
        fuzz_path(path, "run.journal");
        fuzz_write(path, data + 1, size - 1);
        go_on(path);
        unlink(path);
    } else {
        follow(context, (fuzz_bytes){data + 1, size - 1});
    }
    errors = 0;
    return 0;
}
