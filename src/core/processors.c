/* The processors that a process is given: see processors.h. */
#include "processors.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <omp.h>

/* The files that limit a resource, and its controller's name in version 1. Two files have a number
 * each. */
typedef struct limit_files {
    const char *controller;
    const char *version_1[2];
    const char *version_2[2];
} limit_files;

static const limit_files files[] = {
    [GONIO_I_GROUP_PROCESSORS] = {"cpu",
                                  {"cpu.cfs_quota_us", "cpu.cfs_period_us"},
                                  {"cpu.max", NULL}},
    [GONIO_I_GROUP_MEMORY] = {"memory", {"memory.limit_in_bytes", NULL}, {"memory.max", NULL}},
};

/* Two numbers of a file, or of two files with one each; false if one is missing, as "max" is. */
static bool read_numbers(const char *folder, const char *const names[2], double number[2])
{
    int found = 0;
    for (int k = 0; k < 2 && names[k] != NULL; k++) {
        char path[PATH_MAX + 32];
        snprintf(path, sizeof path, "%s/%s", folder, names[k]);
        FILE *file = fopen(path, "re");
        if (file != NULL) {
            found += fscanf(file, "%lf %lf", &number[k], &number[1]) > 0;
            fclose(file);
        }
    }
    return found == (names[1] != NULL ? 2 : 1);
}

/* The lower of `least` and the limit of a folder; 0 is no limit. */
static double lower_limit(double least, const char *folder, const char *const names[2])
{
    double number[2] = {-1.0, 1.0}; /* microseconds given, of how many; or bytes */
    if (!read_numbers(folder, names, number) || !(number[0] > 0.0) || !(number[1] > 0.0)) {
        return least;
    }
    const double limit = number[0] / number[1];
    return least > 0.0 && least < limit ? least : limit;
}

/* The least limit of the folder `base` followed by `group`, and of all folders down to base. */
static double limit_of_group(const char *base, const char *group, const char *const names[2])
{
    char folder[PATH_MAX];
    double least = 0.0;
    const size_t length = strlen(base);
    if (snprintf(folder, sizeof folder, "%s%s", base, group) >= (int)sizeof folder) {
        return 0.0;
    }
    for (;;) {
        least = lower_limit(least, folder, names);
        char *last = strrchr(folder + length, '/');
        if (last == NULL) {
            return least;
        }
        *last = '\0';
    }
}

/* Whether a name is one of those between commas. */
static bool has_controller(const char *controllers, const char *name)
{
    const size_t length = strcspn(controllers, ",");
    return (length == strlen(name) && strncmp(controllers, name, length) == 0) ||
           (controllers[length] == ',' && has_controller(controllers + length + 1, name));
}

/* The limit of a line "ID:CONTROLLERS:GROUP": without controllers of version 2. */
static double limit_of_line(char *line, const char *root, const limit_files *of)
{
    char *controllers = strchr(line, ':');
    char *group = controllers != NULL ? strchr(controllers + 1, ':') : NULL;
    char base[PATH_MAX];
    if (group == NULL) {
        return 0.0;
    }
    *group++ = '\0';
    controllers++;
    group[strcspn(group, "\n")] = '\0';
    if (controllers[0] == '\0') {
        return limit_of_group(root, group, of->version_2);
    }
    const int length = snprintf(base, sizeof base, "%s/%s", root, controllers);
    return has_controller(controllers, of->controller) && length < (int)sizeof base
               ? limit_of_group(base, group, of->version_1)
               : 0.0;
}

double gonio_i_group_limit(gonio_i_group_resource which, const char *groups, const char *root)
{
    char line[PATH_MAX];
    double least = 0.0;
    FILE *file = fopen(groups, "re");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const double limit = limit_of_line(line, root, &files[which]);
        least = limit > 0.0 && (least == 0.0 || limit < least) ? limit : least;
    }
    if (file != NULL) {
        fclose(file);
    }
    return least;
}

static const double MEMORY_OF_THREAD = 64.0 * 1024.0 * 1024.0; /* bytes */

static int processors;

static void find_processors(void)
{
    static const char groups[] = "/proc/self/cgroup";
    static const char root[] = "/sys/fs/cgroup";
    const double share = gonio_i_group_limit(GONIO_I_GROUP_PROCESSORS, groups, root);
    const double memory = gonio_i_group_limit(GONIO_I_GROUP_MEMORY, groups, root);
    double most = omp_get_num_procs();
    if (share > 0.0) {
        most = fmin(most, ceil(share));
    }
    if (memory > 0.0) {
        most = fmin(most, floor(memory / MEMORY_OF_THREAD));
    }
    processors = (int)fmax(most, 1.0);
}

int gonio_i_processors(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, find_processors);
    return processors;
}
