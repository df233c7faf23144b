/* The time of a row: see csv_time.h. */
#include "csv_time.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../../core/csv_reader.h"

enum { MOST_CLOCK = 40 };

typedef struct time_word {
    const char *text;
    bool time;      /* means the time by itself */
    double seconds; /* of a unit; 0: no unit */
} time_word;

static const time_word known[] = {
    {"time", true, 0.0},     {"timestamp", true, 0.0}, {"elapsed", true, 0.0},
    {"clock", true, 0.0},    {"datetime", true, 0.0},  {"stamp", false, 0.0},
    {"date", false, 0.0},    {"utc", false, 0.0},      {"local", false, 0.0},
    {"of", false, 0.0},      {"day", false, 0.0},      {"reading", false, 0.0},
    {"ms", false, 1e-3},     {"s", false, 1.0},        {"sec", false, 1.0},
    {"second", false, 1.0},  {"seconds", false, 1.0},  {"min", false, 60.0},
    {"minute", false, 60.0}, {"minutes", false, 60.0}, {"h", false, 3600.0},
    {"hr", false, 3600.0},   {"hour", false, 3600.0},  {"hours", false, 3600.0},
};

static const time_word *find(const char *text)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (strcmp(known[k].text, text) == 0) {
            return &known[k];
        }
    }
    return NULL;
}

bool gonio_i_take_time_name(const gonio_i_words *words, double *seconds)
{
    bool time = false;
    *seconds = 1.0;
    for (size_t k = 0; k < words->count; k++) {
        const time_word *word = find(words->word[k].text);
        if (word == NULL) {
            return false;
        }
        time = time || word->time;
        *seconds = word->seconds > 0.0 ? word->seconds : *seconds;
    }
    return time && words->whole;
}

/* Days since 1970-01-01 of a date in the Gregorian calendar. */
static double days_of(int year, int month, int day)
{
    static const int before[12] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    const int past = month > 2 ? year : year - 1; /* years whose leap day is over */
    const int leap_days = past / 4 - past / 100 + past / 400 - 477;
    return 365.0 * (year - 1970) + leap_days + before[month - 1] + day - 1;
}

/* hh:mm or hh:mm:ss.s, with a decimal point or comma; NaN for anything else. */
static double clock_of(const char *text)
{
    int hour = 0;
    int minute = 0;
    int second = 0;
    int end = 0;
    double part = 0.0;
    if (sscanf(text, "%2d:%2d%n", &hour, &minute, &end) != 2) {
        return NAN;
    }
    text += end;
    end = 0;
    if (*text == ':' && sscanf(text, ":%2d%n", &second, &end) == 1) {
        text += end;
        if (*text == '.' || *text == ',') {
            double place = 0.1;
            for (text++; *text >= '0' && *text <= '9'; text++, place /= 10.0) {
                part += place * (*text - '0');
            }
        }
    }
    const bool ends = *text == '\0' || *text == 'Z' || *text == '+' || *text == '-';
    const bool valid =
        hour >= 0 && hour < 25 && minute >= 0 && minute < 60 && second >= 0 && second < 62;
    return ends && valid ? 3600.0 * hour + 60.0 * minute + second + part : NAN;
}

/* Date and clock. The offset from UTC is not heeded: within a run it stays. */
static double stamp_of(const char *cell)
{
    int year = 0;
    int month = 0;
    int day = 0;
    int end = 0;
    const bool read = sscanf(cell, "%4d-%2d-%2d%n", &year, &month, &day, &end) == 3 ||
                      sscanf(cell, "%2d.%2d.%4d%n", &day, &month, &year, &end) == 3;
    if (!read || year < 1970 || month < 1 || month > 12 || (cell[end] != 'T' && cell[end] != ' ')) {
        return NAN;
    }
    return 86400.0 * days_of(year, month, day) + clock_of(cell + end + 1);
}

double gonio_i_time_of(const char *cell, char delimiter, double seconds)
{
    double number = 0.0;
    if (gonio_i_csv_is_number(cell, delimiter, &number)) {
        return isfinite(number) ? number * seconds : NAN;
    }
    if (strlen(cell) > MOST_CLOCK) {
        return NAN;
    }
    const double stamp = stamp_of(cell);
    return isnan(stamp) ? clock_of(cell) : stamp;
}
