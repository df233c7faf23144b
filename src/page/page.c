/* The interactive page: puts the data into the template. */
#include <gonio/page.h>

#include <stdlib.h>
#include <string.h>

#include "../core/number.h"
#include "../core/options.h"
#include "../core/output.h"
#include "page.h"

/* Bytes before base64: with the template under 6 MB. Reconstructions are smoother than measured
 * tables, deviations smoother still. */
enum { REFERENCE_BUDGET = 2100000, RECONSTRUCTION_BUDGET = 1100000, DEVIATION_BUDGET = 400000 };

/* Of an anisotropic material the mean over azimuths has two thirds of its budget, the plane of
 * incidence at all azimuths the rest. */
enum { MEAN_PART = 2, TURNS_PART = 1, PARTS = MEAN_PART + TURNS_PART };

enum { TABLES = 5, TURNS = 3 }; /* those of azimuths: TURNS + which material */

typedef struct page {
    gonio_context *context;
    const gonio_page_content *content;
    json_t *data;
    gonio_table *reference;
    gonio_table *reconstruction;
    gonio_i_web_table packed[TABLES];
} page;

static const char *const table_names[TABLES] = {"reference", "reconstruction", "deviation",
                                                "reference-turns", "reconstruction-turns"};

/* ---- collecting ---- */

/* Packs an anisotropic material at its azimuths. */
static gonio_status add_turns(page *p, int which, const gonio_material *material, size_t budget)
{
    gonio_i_web_table *packed = &p->packed[TURNS + which];
    const gonio_status status = gonio_i_web_pack_turns(p->context, material, budget, packed);
    if (status == GONIO_OK) {
        json_object_set_new(p->data, table_names[TURNS + which],
                            json_pack("{s:f}", "step", packed->step));
    }
    return status;
}

/* Loads a material, packs it, and adds it to the data. */
static gonio_status add_material(page *p, int which, const gonio_material *material, size_t budget,
                                 gonio_table **table)
{
    const bool turns = gonio_i_web_turns(material);
    gonio_status status = gonio_table_load(p->context, material, table);
    if (status == GONIO_OK) {
        status = gonio_i_web_pack(p->context, gonio_table_values(*table), GONIO_I_WEB_LOG,
                                  turns ? budget * MEAN_PART / PARTS : budget, &p->packed[which]);
    }
    if (status == GONIO_OK) {
        json_object_set_new(p->data, table_names[which],
                            gonio_i_web_material(material, *table, p->packed[which].step));
    }
    return status == GONIO_OK && turns ? add_turns(p, which, material, budget * TURNS_PART / PARTS)
                                       : status;
}

/* Reads a MERL table whose numbers are standard deviations of g. The reader converts numbers to
 * 1/sr; this is undone. */
static gonio_status add_deviation(page *p)
{
    gonio_table *table = NULL;
    gonio_status status = gonio_table_load(p->context, p->content->deviation, &table);
    const size_t count = (size_t)GONIO_THETA_H_BINS * GONIO_SLAB_VALUES;
    double *values =
        status == GONIO_OK ? gonio_i_allocate(p->context, count, sizeof *values) : NULL;
    for (size_t k = 0; values != NULL && k < count; k++) {
        const double value = gonio_table_values(table)[k];
        const int channel = (int)(k / GONIO_SLAB_BINS % GONIO_CHANNELS);
        values[k] = value < 0.0 ? value : value / gonio_log_scale(channel);
    }
    gonio_table_free(&table);
    if (status == GONIO_OK) {
        status = values == NULL ? GONIO_ERROR_MEMORY
                                : gonio_i_web_pack(p->context, values, GONIO_I_WEB_DEVIATION,
                                                   DEVIATION_BUDGET, &p->packed[2]);
    }
    if (status == GONIO_OK) {
        json_object_set_new(p->data, "deviation", json_pack("{s:f}", "step", p->packed[2].step));
    }
    free(values);
    return status;
}

static gonio_status add_comparison(page *p)
{
    gonio_comparison comparison;
    const gonio_status status =
        gonio_compare(p->context, p->content->reference, p->content->reconstruction, &comparison);
    if (status == GONIO_OK) {
        json_object_set_new(p->data, "comparison", gonio_i_web_comparison(&comparison));
    }
    return status;
}

static gonio_status collect(page *p)
{
    const gonio_page_content *c = p->content;
    gonio_status status = GONIO_OK;
    if (c->reference != NULL) {
        status = add_material(p, 0, c->reference, REFERENCE_BUDGET, &p->reference);
    }
    if (status == GONIO_OK && c->reconstruction != NULL) {
        status = add_material(p, 1, c->reconstruction, RECONSTRUCTION_BUDGET, &p->reconstruction);
    }
    if (status == GONIO_OK && c->reconstruction != NULL) {
        status = add_comparison(p);
    }
    if (status == GONIO_OK && c->deviation != NULL) {
        status = add_deviation(p);
    }
    if (status == GONIO_OK && c->readings != NULL) {
        const gonio_i_web_known reference = {c->reference, p->reference};
        const gonio_i_web_known reconstruction = {c->reconstruction, p->reconstruction};
        json_object_set_new(p->data, "readings",
                            gonio_i_web_readings(c->readings, reference, reconstruction));
    }
    json_t *figures = NULL;
    if (status == GONIO_OK && c->folder != NULL) {
        status = gonio_i_web_figures(p->context, c->folder, &figures);
    }
    if (figures != NULL) {
        json_object_set_new(p->data, "figures", figures);
    }
    return status;
}

/* ---- writing ---- */

static char *dump(const json_t *data)
{
    gonio_i_plain_numbers plain;
    if (!gonio_i_plain_numbers_begin(&plain)) {
        return NULL;
    }
    char *text = json_dumps(data, JSON_COMPACT | JSON_REAL_PRECISION(9));
    gonio_i_plain_numbers_end(&plain);
    return text;
}

/* JSON that is safe in HTML: "</script>" in a name must not end the element. */
static char *safe_json(const json_t *data)
{
    char *plain = dump(data);
    size_t angles = 0;
    for (const char *c = plain; c != NULL && *c != '\0'; c++) {
        angles += *c == '<';
    }
    char *safe = plain != NULL ? malloc(strlen(plain) + 5 * angles + 1) : NULL;
    char *next = safe;
    for (const char *c = plain; safe != NULL && *c != '\0'; c++) {
        if (*c == '<') {
            memcpy(next, "\\u003c", 6);
            next += 6;
        } else {
            *next++ = *c;
        }
    }
    if (safe != NULL) {
        *next = '\0';
    }
    free(plain);
    return safe;
}

static gonio_status put(page *p, gonio_i_output *output, const char *text)
{
    return gonio_i_output_write(p->context, output, text, strlen(text));
}

/* An element whose text is data and is not run by browsers. */
static gonio_status put_element(page *p, gonio_i_output *output, const char *type, const char *id,
                                const char *text)
{
    char *start = gonio_i_format("<script type=\"%s\" id=\"gonio-%s\">", type, id);
    gonio_status status = start == NULL
                              ? gonio_i_fail(p->context, GONIO_ERROR_MEMORY, "out of memory")
                              : put(p, output, start);
    free(start);
    if (status == GONIO_OK) {
        status = put(p, output, text);
    }
    return status == GONIO_OK ? put(p, output, "</script>\n") : status;
}

static gonio_status put_data(page *p, gonio_i_output *output)
{
    char *json = safe_json(p->data);
    gonio_status status =
        json == NULL ? gonio_i_fail(p->context, GONIO_ERROR_MEMORY, "out of memory for the page")
                     : put_element(p, output, "application/json", "data", json);
    free(json);
    for (int k = 0; k < TABLES && status == GONIO_OK; k++) {
        if (p->packed[k].text != NULL) {
            status = put_element(p, output, "text/plain", table_names[k], p->packed[k].text);
        }
    }
    return status;
}

static const char *place_in_template(void)
{
    return strstr(gonio_i_web_template, GONIO_I_WEB_PLACE);
}

static gonio_status write_page(page *p, const char *path)
{
    const char *place = place_in_template();
    gonio_i_output output;
    gonio_status status = gonio_i_output_open(p->context, path, &output);
    if (status != GONIO_OK) {
        return status;
    }
    status = gonio_i_output_write(p->context, &output, gonio_i_web_template,
                                  (size_t)(place - gonio_i_web_template));
    if (status == GONIO_OK) {
        status = put_data(p, &output);
    }
    if (status == GONIO_OK) {
        status = put(p, &output, place + strlen(GONIO_I_WEB_PLACE));
    }
    return gonio_i_output_close(p->context, &output, status);
}

bool gonio_page_is_built(void)
{
    return place_in_template() != NULL;
}

static gonio_status check(gonio_context *context, const gonio_page_content *content)
{
    if (!gonio_page_is_built()) {
        return gonio_i_fail(context, GONIO_ERROR_IO,
                            "this gonio was built without Node.js and cannot write pages: install "
                            "nodejs (18.19 or newer) and npm, and run make again");
    }
    if (content->reference == NULL && content->folder == NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a page needs a material or a folder");
    }
    if (content->reference == NULL && content->reconstruction != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT, "a reconstruction needs a reference");
    }
    if (content->reconstruction == NULL && content->deviation != NULL) {
        return gonio_i_fail(context, GONIO_ERROR_ARGUMENT,
                            "standard deviations need the reconstruction that they belong to");
    }
    return GONIO_OK;
}

gonio_status gonio_page_write(gonio_context *context, const gonio_page_content *content,
                              const char *path)
{
    gonio_page_content taken;
    gonio_status status = GONIO_I_TAKE_PLAIN(context, gonio_page_content, content, &taken);
    if (status == GONIO_OK) {
        status = check(context, &taken);
    }
    if (status != GONIO_OK) {
        return status;
    }
    page p = {.context = context, .content = &taken};
    p.data = json_pack("{s:s}", "version", gonio_version());
    status =
        p.data == NULL ? gonio_i_fail(context, GONIO_ERROR_MEMORY, "out of memory") : collect(&p);
    if (status == GONIO_OK) {
        status = write_page(&p, path);
    }
    gonio_table_free(&p.reference);
    gonio_table_free(&p.reconstruction);
    for (int k = 0; k < TABLES; k++) {
        free(p.packed[k].text);
    }
    json_decref(p.data);
    return status;
}
