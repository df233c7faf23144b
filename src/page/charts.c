/* The tables of a `gonio reproduce` folder for the page's charts: see page.h. */
#include "page.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../core/csv.h"

enum { MOST_ROWS = 50000 };

enum { MOST_COLUMNS = 8 + GONIO_MOST_METRICS };

/* The columns of each table that the charts need. Other columns are left out of the page. */
typedef struct chart_table {
    const char *name;
    const char *columns[8]; /* ends with NULL */
    bool errors;            /* and the columns of errors, for the metrics that the table has */
} chart_table;

static const chart_table tables[] = {
    {"fig2a", {"basis_of", "component", "cumulative"}, false},
    {"fig2b", {"start", "swap", "condition_number"}, false},
    {"fig3a-means", {"components", "samples", "condition_number"}, true},
    {"fig3b", {"method", "components", "samples"}, true},
    {"fig4",
     {"components", "samples", "channel", "theta_i_deg", "phi_i_deg", "theta_o_deg", "phi_o_deg"},
     false},
    {"fig5", {"material", "reconstructed_from"}, true},
};

enum { TABLES = sizeof tables / sizeof *tables };

/* The columns to take, up to a NULL, and the metrics among them. A table that should have errors
 * and has none is asked for the first metric's, so that it is told what it lacks. */
static void list_columns(const chart_table *table, const gonio_i_csv *csv,
                         const char *columns[MOST_COLUMNS], json_t *metrics)
{
    size_t count = 0;
    while (table->columns[count] != NULL) {
        columns[count] = table->columns[count];
        count++;
    }
    const gonio_metric_view *metric = NULL;
    for (int m = 0; table->errors && (metric = gonio_metric_describe(m)) != NULL; m++) {
        if (gonio_i_csv_column(csv, metric->key) >= 0) {
            columns[count++] = metric->key;
            json_array_append_new(metrics, gonio_i_web_metric(metric));
        }
    }
    if (table->errors && json_array_size(metrics) == 0) {
        columns[count++] = gonio_metric_describe(0)->key;
    }
    columns[count] = NULL;
}

static json_t *cell(const gonio_i_csv *csv, size_t row, size_t column)
{
    double value = 0.0;
    if (gonio_i_csv_number(csv, row, column, &value)) {
        json_t *number = json_real(value);
        return number != NULL ? number : json_null(); /* NaN: a missing value */
    }
    return json_string(gonio_i_csv_cell(csv, row, column));
}

static gonio_status convert(gonio_context *context, const gonio_i_csv *csv, const char *path,
                            const chart_table *chart, json_t **table)
{
    const char *columns[MOST_COLUMNS];
    json_t *metrics = json_array();
    list_columns(chart, csv, columns, metrics);
    json_t *names = json_array();
    json_t *rows = json_array();
    gonio_status status = GONIO_OK;
    for (size_t k = 0; k < csv->rows; k++) {
        json_array_append_new(rows, json_array());
    }
    for (int c = 0; columns[c] != NULL && status == GONIO_OK; c++) {
        const int at = gonio_i_csv_column(csv, columns[c]);
        if (at < 0) {
            status =
                gonio_i_fail(context, GONIO_ERROR_DATA, "%s: has no column %s", path, columns[c]);
        }
        json_array_append_new(names, json_string(columns[c]));
        for (size_t k = 0; k < csv->rows && status == GONIO_OK; k++) {
            if (json_array_append_new(json_array_get(rows, k), cell(csv, k, (size_t)at)) != 0) {
                status = gonio_i_fail(context, GONIO_ERROR_DATA, "%s: line %zu: not UTF-8", path,
                                      csv->line[k]);
            }
        }
    }
    *table = json_pack("{s:o, s:o, s:o}", "columns", names, "rows", rows, "metrics", metrics);
    return status;
}

static gonio_status read_table(gonio_context *context, const char *path, const chart_table *chart,
                               json_t **table)
{
    gonio_i_csv *csv = NULL;
    gonio_status status = gonio_i_csv_read(context, path, &csv);
    if (status == GONIO_OK && csv->rows > MOST_ROWS) {
        status = gonio_i_fail(context, GONIO_ERROR_DATA,
                              "%s: %zu rows are more than a page can show, at most %d", path,
                              csv->rows, MOST_ROWS);
    }
    if (status == GONIO_OK) {
        status = convert(context, csv, path, chart, table);
    }
    gonio_i_csv_free(&csv);
    return status;
}

gonio_status gonio_i_web_figures(gonio_context *context, const char *folder, json_t **figures)
{
    json_t *found = json_object();
    gonio_status status = GONIO_OK;
    for (int k = 0; k < TABLES && status == GONIO_OK; k++) {
        char *path = gonio_i_format("%s/tables/%s.csv", folder, tables[k].name);
        json_t *table = NULL;
        if (path != NULL && access(path, F_OK) == 0) {
            status = read_table(context, path, &tables[k], &table);
            json_object_set_new(found, tables[k].name, table);
        }
        free(path);
    }
    if (status == GONIO_OK && json_object_size(found) == 0) {
        status = gonio_i_fail(context, GONIO_ERROR_DATA,
                              "%s: has no tables of figures: give the folder that 'gonio reproduce "
                              "-o' has written, after it has finished",
                              folder);
    }
    if (status != GONIO_OK) {
        json_decref(found);
        return status;
    }
    *figures = found;
    return GONIO_OK;
}
