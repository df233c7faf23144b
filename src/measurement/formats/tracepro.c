/* Readings that TracePro exports: the rows below Table_BSDF_Data.
 *
 * A row has a wavelength in micrometres, the incidence, and the scattered direction. The direction
 * is given by the difference of its direction cosines beta from those of the mirror direction,
 * beta_0: the length of the difference and its azimuth, which is taken as 0 away from the normal.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../../core/text_numbers.h"
#include "../import.h"
#include "../long_table.h"
#include "format.h"

enum {
    TEMPERATURE,
    WAVELENGTH,
    INCIDENCE,
    INCIDENT_AZIMUTH,
    BETA,
    BETA_AZIMUTH,
    BRDF,
    LEAST_NUMBERS,
    MOST_NUMBERS = 16
};

static const char heading[] = "Table_BSDF_Data";

static double to_degrees(double radians)
{
    return radians * 180.0 / M_PI;
}

/* theta_o and phi_o - phi_i, degrees. theta_o is 180 if no direction has these cosines. */
static void from_cosines(double theta_i, double beta, double azimuth, double *theta_o, double *phi)
{
    const double a = azimuth * M_PI / 180.0;
    const double x = sin(theta_i * M_PI / 180.0) + beta * cos(a); /* towards the mirror's side */
    const double y = beta * sin(a);
    const double sine = hypot(x, y);
    *theta_o = sine < 1.0 ? to_degrees(asin(sine)) : 180.0;
    *phi = sine > 1e-9 ? 180.0 + to_degrees(atan2(y, x)) : 0.0;
}

static gonio_status add_row(gonio_i_long_table *table, const double *number, size_t line)
{
    gonio_i_long_row row = {
        .wavelength = number[WAVELENGTH], .value = number[BRDF], .deviation = NAN, .line = line};
    double theta = 0.0;
    double phi = 0.0;
    from_cosines(number[INCIDENCE], number[BETA], number[BETA_AZIMUTH], &theta, &phi);
    row.degrees[0] = number[INCIDENCE];
    row.degrees[1] = number[INCIDENT_AZIMUTH];
    row.degrees[2] = gonio_i_import_rounded(theta);
    row.degrees[3] = gonio_i_import_rounded(number[INCIDENT_AZIMUTH] + phi);
    return gonio_i_long_table_add(table, &row);
}

/* Reads rows up to the first line that is no row of numbers. */
static gonio_status read_rows(gonio_i_numbers *n, gonio_i_long_table *table)
{
    gonio_status status = GONIO_OK;
    double number[MOST_NUMBERS];
    for (;;) {
        const bool more = gonio_i_numbers_skip(n);
        const size_t line = n->line;
        const int count = more ? gonio_i_numbers_row(n, number, MOST_NUMBERS) : -1;
        if (count < 0 || status != GONIO_OK) {
            return status;
        }
        status = count >= LEAST_NUMBERS
                     ? add_row(table, number, line)
                     : gonio_i_fail(n->context, GONIO_ERROR_FORMAT,
                                    "%s:%zu: %d numbers where a row has %d; is the file whole?",
                                    n->path, line, count, LEAST_NUMBERS);
    }
}

/* Reads the rows of every table in the file. */
static gonio_status read_tables(gonio_i_numbers *n, gonio_i_long_table *table)
{
    gonio_status status = GONIO_OK;
    while (gonio_i_numbers_skip(n) && status == GONIO_OK) {
        const bool begins = (size_t)(n->end - n->at) > strlen(heading) &&
                            memcmp(n->at, heading, strlen(heading)) == 0;
        gonio_i_numbers_next_line(n);
        if (begins) {
            gonio_i_numbers_next_line(n); /* the names of the columns */
            status = read_rows(n, table);
        }
    }
    return status;
}

static gonio_status read(gonio_i_readings_file *file, gonio_readings *readings)
{
    static const gonio_convention stated = {
        .angles = GONIO_DEGREES, .values = GONIO_VALUE_BRDF, .wavelengths = GONIO_MICROMETRES};
    gonio_i_numbers n = gonio_i_numbers_of(file->context, file->path, file->text, file->size, 0);
    gonio_i_long_table table = {.context = file->context};
    gonio_i_import in;
    gonio_i_import_begin(&in, file->context, readings, "a TracePro table", &stated);
    gonio_i_import_leniently(&in);
    gonio_status status = read_tables(&n, &table);
    if (status == GONIO_OK) {
        status = gonio_i_long_table_import(&table, &in);
    }
    gonio_i_long_table_free(&table);
    return gonio_i_import_end(&in, status);
}

static bool recognises(const char *text, size_t size)
{
    return memmem(text, size, heading, strlen(heading)) != NULL;
}

const gonio_i_readings_format gonio_i_readings_tracepro = {
    .word = "tracepro", .name = "TracePro table", .recognises = recognises, .read = read};
