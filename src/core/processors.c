/* The processors that a process is given: see processors.h. */
#include "processors.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <omp.h>

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

/* The lower of `least` and the share that a folder gives; 0 is no limit. */
static double lower_share(double least, const char *folder, const char *const names[2])
{
    double number[2] = {-1.0, -1.0}; /* microseconds given, of how many */
    if (!read_numbers(folder, names, number) || !(number[0] > 0.0) || !(number[1] > 0.0)) {
        return least;
    }
    const double share = number[0] / number[1];
    return least > 0.0 && least < share ? least : share;
}

/* The least share of the folder `base` followed by `group`, and of all folders down to base. */
static double share_of_group(const char *base, const char *group, const char *const names[2])
{
    char folder[PATH_MAX];
    double least = 0.0;
    const size_t length = strlen(base);
    if (snprintf(folder, sizeof folder, "%s%s", base, group) >= (int)sizeof folder) {
        return 0.0;
    }
    for (;;) {
        least = lower_share(least, folder, names);
        char *last = strrchr(folder + length, '/');
        if (last == NULL) {
            return least;
        }
        *last = '\0';
    }
}

/* Whether "cpu" is one of the names between commas. */
static bool has_cpu(const char *controllers)
{
    const size_t length = strcspn(controllers, ",");
    return (length == 3 && strncmp(controllers, "cpu", 3) == 0) ||
           (controllers[length] == ',' && has_cpu(controllers + length + 1));
}

/* The share of a line "ID:CONTROLLERS:GROUP": without controllers of version 2. */
static double share_of_line(char *line, const char *root)
{
    static const char *const version_1[2] = {"cpu.cfs_quota_us", "cpu.cfs_period_us"};
    static const char *const version_2[2] = {"cpu.max", NULL};
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
        return share_of_group(root, group, version_2);
    }
    return has_cpu(controllers) &&
                   snprintf(base, sizeof base, "%s/%s", root, controllers) < (int)sizeof base
               ? share_of_group(base, group, version_1)
               : 0.0;
}

double gonio_i_processor_share(const char *groups, const char *root)
{
    char line[PATH_MAX];
    double least = 0.0;
    FILE *file = fopen(groups, "re");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        const double share = share_of_line(line, root);
        least = share > 0.0 && (least == 0.0 || share < least) ? share : least;
    }
    if (file != NULL) {
        fclose(file);
    }
    return least;
}

static int processors;

static void find_processors(void)
{
    const double share = gonio_i_processor_share("/proc/self/cgroup", "/sys/fs/cgroup");
    processors = omp_get_num_procs();
    if (share > 0.0 && ceil(share) < processors) {
        processors = (int)ceil(share);
    }
}

int gonio_i_processors(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, find_processors);
    return processors;
}
