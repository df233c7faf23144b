/* libFuzzer on what kept pieces say: of any JSON, what is accepted becomes findings, claims, tables
 * and the page. */
#include "fuzz.h"

#include <sys/stat.h>

#include "results/claims.h"
#include "results/csv_tables.h"
#include "results/markdown.h"
#include "small_study.h"

enum { KINDS = 6 };

static const struct {
    const char *name;
    gonio_i_accept *accept;
    bool single;   /* one result */
    bool by_split; /* [split][index]; otherwise [index] */
} kinds[KINDS] = {{"spectrum", gonio_i_accept_spectrum, true, false},
                  {"convergence", gonio_i_accept_convergence, true, false},
                  {"grid", gonio_i_accept_grid, false, true},
                  {"methods", gonio_i_accept_method, false, true},
                  {"directions", gonio_i_accept_directions, false, false},
                  {"left_out", gonio_i_accept_left_out, false, false}};

static gonio_i_study study;

static size_t count_of(int kind)
{
    const size_t count[KINDS] = {
        1, 1, study.grid_components, gonio_i_methods(&study), GONIO_I_CHOSEN, study.left_out_count};
    return count[kind];
}

/* Whether all pieces of a kind are there and accepted. */
static bool is_accepted(int kind, const json_t *json)
{
    const size_t splits = kinds[kind].by_split ? study.splits.count : 1;
    bool good = json != NULL;
    for (size_t s = 0; s < splits && good; s++) {
        const json_t *list = kinds[kind].by_split ? json_array_get(json, s) : json;
        for (size_t k = 0; k < count_of(kind) && good; k++) {
            const gonio_i_piece piece = {.split = s, .index = k};
            char complaint[GONIO_I_COMPLAINT] = "";
            good = kinds[kind].accept(
                &study, &piece, kinds[kind].single ? list : json_array_get(list, k), complaint);
            check(good == (complaint[0] == '\0'), "what is refused is complained of");
        }
    }
    return good;
}

static void show(gonio_context *context, const gonio_i_results *results)
{
    char folder[128];
    gonio_i_findings findings;
    gonio_i_claims claims;
    fuzz_path(folder, "results");
    mkdir(folder, 0700);
    check(gonio_i_find(context, &study, results, &findings) == GONIO_OK, "findings");
    check(gonio_i_write_tables(context, &study, results, &findings, folder) == GONIO_OK, "tables");
    check(gonio_i_make_claims(context, &study, results, &findings, &claims) == GONIO_OK, "claims");
    check(gonio_i_write_page(context, &study, &findings, &claims, folder) == GONIO_OK, "the page");
    check(gonio_i_write_results(context, &study, &findings, &claims, folder) == GONIO_OK,
          "the numbers");
    check_status(GONIO_OK);
    gonio_i_claims_free(&claims);
    gonio_i_findings_free(&findings);
}

static void fuzz_begin(void)
{
    if (study.collection.count == 0) {
        small_study(&study);
    }
}

FUZZ_INITIALIZE

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    json_t *all = json_loadb((const char *)data, size, 0, NULL);
    gonio_i_results results = {0};
    json_t **const place[KINDS] = {&results.spectrum, &results.convergence, &results.grid,
                                   &results.methods,  &results.directions,  &results.left_out};
    if (!json_is_object(all)) {
        json_decref(all);
        return -1;
    }
    fuzz_begin();
    bool any = false;
    for (int k = 0; k < KINDS; k++) {
        json_t *json = json_object_get(all, kinds[k].name);
        study.wanted[k] = is_accepted(k, json);
        *place[k] = study.wanted[k] ? json_incref(json) : NULL;
        any = any || study.wanted[k];
    }
    if (any) {
        show(context, &results);
    }
    gonio_i_results_free(&results);
    json_decref(all);
    return 0;
}

/* ---- changes that keep it JSON ---- */

enum { MOST_PLACES = 4000 };

/* A member or an element. */
typedef struct place {
    json_t *parent;
    const char *key; /* NULL of an element */
    size_t index;
} place;

static size_t list_places(json_t *at, place *list, size_t count) /* NOLINT(misc-no-recursion) */
{
    const char *key = NULL;
    json_t *value = NULL;
    size_t k = 0;
    json_object_foreach(at, key, value)
    {
        list[count] = (place){at, key, 0};
        count = list_places(value, list, count + 1 < MOST_PLACES ? count + 1 : count);
    }
    json_array_foreach(at, k, value)
    {
        list[count] = (place){at, NULL, k};
        count = list_places(value, list, count + 1 < MOST_PLACES ? count + 1 : count);
    }
    return count;
}

static json_t *get(place p)
{
    return p.key != NULL ? json_object_get(p.parent, p.key) : json_array_get(p.parent, p.index);
}

static json_t *hard_value(unsigned which)
{
    static const double number[] = {0.0, -1.0, 1.0, 2.0, 1e300, -1e300, 0.5, 5e-324, 1.570796327};
    static const json_int_t integer[] = {0, 1, 2, 3, -1, 255, 8099, INT64_MAX, INT64_MIN};
    switch (which % 6) {
    case 0:
        return json_null();
    case 1:
        return json_array();
    case 2:
        return json_string("x");
    case 3:
        return json_integer(integer[which / 6 % 9]);
    default:
        return json_real(number[which / 6 % 9]);
    }
}

/* Replaces, copies, repeats or removes a value. */
static void change(const place *list, size_t count, unsigned seed)
{
    const place p = list[seed / 8 % count];
    json_t *value = NULL;
    if (seed % 8 == 0 && p.key == NULL) {
        json_array_remove(p.parent, p.index);
        return;
    }
    if (seed % 8 == 1 && p.key == NULL) {
        json_array_append_new(p.parent, json_deep_copy(get(p)));
        return;
    }
    value = seed % 8 == 2 ? json_deep_copy(get(list[seed / 64 % count])) : hard_value(seed / 8);
    if (p.key != NULL) {
        json_object_set_new(p.parent, p.key, value);
    } else {
        json_array_set_new(p.parent, p.index, value);
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    static place list[MOST_PLACES];
    json_t *all = seed % 20 != 0 ? json_loadb((const char *)data, size, 0, NULL) : NULL;
    const size_t count = list_places(all, list, 0);
    if (count == 0) {
        json_decref(all);
        return LLVMFuzzerMutate(data, size, most);
    }
    change(list, count, seed / 20);
    char *text = json_dumps(all, JSON_COMPACT | JSON_REAL_PRECISION(17));
    const size_t length = text != NULL ? strlen(text) : 0;
    const bool fits = length > 0 && length <= most;
    if (fits) {
        memcpy(data, text, length);
    }
    free(text);
    json_decref(all);
    return fits ? length : size;
}
