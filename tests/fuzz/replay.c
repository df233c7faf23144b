/* fuzz-replay [-n CHANGES] TARGET PATH...: runs a fuzz target on files, and folders of files,
 * without libFuzzer; with -n also on so many changed copies of them, the same ones every time. */
#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/random.h"

typedef int run_function(const uint8_t *data, size_t size);
typedef size_t mutate_function(uint8_t *data, size_t size, size_t most, unsigned seed);

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);

static mutate_function plain_mutate;

#define PLAIN(name) run_function fuzz_##name;
#define MUTATED(name)                                                                              \
    run_function fuzz_##name;                                                                      \
    mutate_function mutate_##name;
#include "targets.h"
#undef PLAIN
#undef MUTATED

static const struct {
    const char *name;
    run_function *run;
    mutate_function *mutate;
} targets[] = {
#define PLAIN(name) {#name, fuzz_##name, plain_mutate},
#define MUTATED(name) {#name, fuzz_##name, mutate_##name},
#include "targets.h"
};

enum { TARGETS = sizeof targets / sizeof *targets, MOST_INPUTS = 4096, SPARE = 64 };

typedef struct input {
    char *path;
    uint8_t *data;
    size_t size;
} input;

static input inputs[MOST_INPUTS];
static size_t input_count;
static gonio_i_random random_state;

/* ---- changes ---- */

static size_t below(size_t limit)
{
    return (size_t)gonio_i_random_below(&random_state, limit > 0 ? limit : 1);
}

/* Numbers in a text or in bytes that are hard to read or to compute with. */
static size_t put_hard(uint8_t *data, size_t size, size_t at)
{
    static const char *const texts[] = {"nan", "-1", "1e308", "0", "99999999999", "inf", "\n", ","};
    static const double numbers[] = {0.0, -1.0, 1e300, 5e-324};
    const size_t which = below(12);
    const void *from = which < 8 ? (const void *)texts[which] : (const void *)&numbers[which - 8];
    const size_t length = which < 8 ? strlen(texts[which]) : sizeof *numbers;
    memcpy(data + at, from, length < size - at ? length : size - at);
    return size;
}

/* Moves what begins at `from` to `to`, repeating or removing what is between. */
static size_t shift(uint8_t *data, size_t size, size_t most, size_t from, size_t to)
{
    size_t tail = size - from;
    tail = to + tail > most ? most - to : tail;
    memmove(data + to, data + from, tail);
    return to + tail;
}

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most)
{
    if (size == 0) {
        return 0;
    }
    const size_t at = below(size);
    const size_t near = at + below(16) < size ? at + below(16) : at;
    switch (below(6)) {
    case 0:
        data[at] ^= (uint8_t)(1U << below(8));
        return size;
    case 1:
        data[at] = (uint8_t)below(256);
        return size;
    case 2:
        return put_hard(data, size, at);
    case 3:
        return shift(data, size, most, near < size ? near : at, at);
    case 4:
        return shift(data, size, most, at, near < size ? near : at);
    default:
        return below(8) == 0 ? at : size;
    }
}

static size_t plain_mutate(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    (void)seed;
    return LLVMFuzzerMutate(data, size, most);
}

/* ---- inputs ---- */

static void add_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    struct stat about;
    if (file == NULL || fstat(fileno(file), &about) != 0 || input_count == MOST_INPUTS) {
        fprintf(stderr, "fuzz-replay: %s cannot be read\n", path);
        exit(1);
    }
    input *in = &inputs[input_count++];
    in->path = strdup(path);
    in->data = malloc((size_t)about.st_size + SPARE);
    in->size = in->data != NULL ? fread(in->data, 1, (size_t)about.st_size, file) : 0;
    fclose(file);
}

static int by_name(const void *a, const void *b)
{
    return strcmp(((const input *)a)->path, ((const input *)b)->path);
}

static void add(const char *path)
{
    DIR *folder = opendir(path);
    if (folder == NULL) {
        add_file(path);
        return;
    }
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        char name[4096];
        if (entry->d_name[0] != '.') {
            snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
            add_file(name);
        }
    }
    closedir(folder);
}

/* ---- running ---- */

/* In a block of its own, so that a read beyond its end is seen. */
static void run_on(int target, const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size > 0 ? size : 1);
    if (copy != NULL) {
        memcpy(copy, data, size);
        (void)targets[target].run(copy, size);
    }
    free(copy);
}

static void run_changed(int target, const input *in)
{
    uint8_t *copy = malloc(in->size + SPARE);
    size_t size = in->size;
    if (copy == NULL) {
        return;
    }
    memcpy(copy, in->data, size);
    for (size_t n = 1 + below(4); n > 0; n--) {
        size = targets[target].mutate(copy, size, in->size + SPARE, (unsigned)below(1U << 31));
    }
    run_on(target, copy, size);
    free(copy);
}

static int find_target(const char *name)
{
    int k = 0;
    while (k < TARGETS && strcmp(targets[k].name, name) != 0) {
        k++;
    }
    return k;
}

int main(int argc, char **argv)
{
    const bool counted = argc > 2 && strcmp(argv[1], "-n") == 0;
    const long changes = counted ? strtol(argv[2], NULL, 10) : 0;
    const int first = counted ? 3 : 1;
    const int target = first < argc ? find_target(argv[first]) : TARGETS;
    if (target == TARGETS) {
        fprintf(stderr, "usage: fuzz-replay [-n CHANGES] TARGET PATH...; TARGET is one of\n");
        for (int k = 0; k < TARGETS; k++) {
            fprintf(stderr, "    %s\n", targets[k].name);
        }
        return 2;
    }
    for (int k = first + 1; k < argc; k++) {
        add(argv[k]);
    }
    qsort(inputs, input_count, sizeof *inputs, by_name);
    gonio_i_random_seed(&random_state, 1, 0);
    for (size_t k = 0; k < input_count; k++) {
        run_on(target, inputs[k].data, inputs[k].size);
    }
    for (long k = 0; k < changes && input_count > 0; k++) {
        run_changed(target, &inputs[(size_t)k % input_count]);
    }
    printf("%s: %zu files, %ld changed\n", targets[target].name, input_count, changes);
    for (size_t k = 0; k < input_count; k++) {
        free(inputs[k].path);
        free(inputs[k].data);
    }
    return 0;
}
