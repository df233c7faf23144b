/* faults SHIM MOST OUTPUT[,OUTPUT] PROGRAM ARGUMENT...: runs a command in this folder again and
 * again, in each of which another allocation or call fails (faults_shim.c): all of them, or MOST of
 * each kind, evenly spread. What must hold:
 *
 *     exit code 1 and one line on standard error; or 0, and all is as without a failure
 *     outputs that are as before or as without a failure, and no other new file
 *
 * An OUTPUT of "-" stands for none. Prints what does not hold; exit code 1 then. */
#include <dirent.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_OUTPUTS = 4 };

static const char old[] = "old\n";

typedef struct content {
    char *data;
    size_t size;
} content;

/* What a run leaves. */
typedef struct outcome {
    int code;
    content text[2]; /* of standard output and error */
    content output[MOST_OUTPUTS];
    int entries; /* of the folder */
} outcome;

static const char *shim;
static char **command;
static const char *outputs[MOST_OUTPUTS];
static int output_count;
static int problems;

static void die(const char *what)
{
    perror(what);
    exit(2);
}

static content read_file(const char *path)
{
    content c = {NULL, 0};
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return c;
    }
    fseek(file, 0, SEEK_END);
    c.size = (size_t)ftell(file);
    rewind(file);
    c.data = malloc(c.size + 1);
    if (c.data == NULL || fread(c.data, 1, c.size, file) != c.size) {
        die(path);
    }
    c.data[c.size] = '\0';
    fclose(file);
    return c;
}

static bool is_same(content a, content b)
{
    return a.data != NULL && b.data != NULL && a.size == b.size &&
           memcmp(a.data, b.data, a.size) == 0;
}

static bool is_old(content c)
{
    return c.data != NULL && c.size == sizeof old - 1 && memcmp(c.data, old, c.size) == 0;
}

static void put_old(void)
{
    for (int k = 0; k < output_count; k++) {
        FILE *file = fopen(outputs[k], "wb");
        if (file == NULL || fputs(old, file) == EOF || fclose(file) != 0) {
            die(outputs[k]);
        }
    }
}

static int count_entries(void)
{
    int count = 0;
    DIR *folder = opendir(".");
    while (folder != NULL && readdir(folder) != NULL) {
        count++;
    }
    closedir(folder);
    return count;
}

static void start(const char *kind, long nth)
{
    char number[32];
    const char *const files[2] = {"../faults.out", "../faults.err"};
    snprintf(number, sizeof number, "%ld", nth);
    setenv("FAULT_KIND", kind, 1);
    setenv("FAULT_NTH", number, 1);
    setenv("FAULT_COUNT", "../faults.count", 1);
    setenv("LD_PRELOAD", shim, 1);
    for (int k = 0; k < 2; k++) {
        const int file = open(files[k], O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (file < 0 || dup2(file, k + 1) < 0) {
            _exit(126);
        }
    }
    alarm(60);
    execv(command[0], command);
    _exit(127);
}

static outcome run(const char *kind, long nth)
{
    outcome o = {.code = -1};
    int status = 0;
    put_old();
    const pid_t child = fork();
    if (child == 0) {
        start(kind, nth);
    }
    if (child < 0 || waitpid(child, &status, 0) != child) {
        die("fork");
    }
    o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    o.text[0] = read_file("../faults.out");
    o.text[1] = read_file("../faults.err");
    o.entries = count_entries();
    for (int k = 0; k < output_count; k++) {
        o.output[k] = read_file(outputs[k]);
    }
    return o;
}

static void release(outcome *o)
{
    free(o->text[0].data);
    free(o->text[1].data);
    for (int k = 0; k < output_count; k++) {
        free(o->output[k].data);
    }
}

static bool is_one_line(content c)
{
    const char *end = c.data != NULL ? strchr(c.data, '\n') : NULL;
    return end != NULL && end[1] == '\0' && end > c.data;
}

/* What is wrong; NULL for nothing. */
static const char *judge(const outcome *o, const outcome *good)
{
    if (o->code != 0 && o->code != 1) {
        return "neither exit code 0 nor 1";
    }
    if (o->code == 1 && !is_one_line(o->text[1])) {
        return "not one line on standard error";
    }
    if (o->entries != good->entries) {
        return "files are left, or missing";
    }
    for (int k = 0; k < output_count; k++) {
        if (!is_same(o->output[k], good->output[k]) && (o->code == 0 || !is_old(o->output[k]))) {
            return "an output is neither the old nor the new one";
        }
    }
    return o->code == 0 && !is_same(o->text[0], good->text[0]) ? "another standard output" : NULL;
}

static void tell(const char *kind, long nth, const outcome *o, const char *problem)
{
    printf("%s %ld: %s (exit code %d)\n    ", kind, nth, problem, o->code);
    for (int k = 1; command[k] != NULL; k++) {
        printf(" %s", command[k]);
    }
    printf("\n    %.300s\n", o->text[1].data != NULL ? o->text[1].data : "");
    problems++;
}

static long count_calls(void)
{
    content c = read_file("../faults.count");
    const long count = c.data != NULL ? strtol(c.data, NULL, 10) : 0;
    free(c.data);
    return count;
}

static void run_all(const char *kind, long most)
{
    outcome good = run(kind, 0);
    const long count = count_calls();
    if (good.code != 0) {
        tell(kind, 0, &good, "fails without a fault");
        exit(1);
    }
    if (count == 0 && strcmp(kind, "memory") == 0) {
        tell(kind, 0, &good, "no allocation is seen: is the shim loaded?");
    }
    const long runs = count < most ? count : most;
    for (long k = 0; k < runs; k++) {
        const long nth = 1 + k * count / runs;
        outcome o = run(kind, nth);
        const char *problem = judge(&o, &good);
        if (problem != NULL) {
            tell(kind, nth, &o, problem);
        }
        release(&o);
    }
    printf("%s: %ld of %ld\n", kind, runs, count);
    release(&good);
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: faults SHIM MOST OUTPUT[,OUTPUT] PROGRAM ARGUMENT...\n");
        return 2;
    }
    shim = argv[1];
    command = argv + 4;
    char *list = strdup(argv[3]);
    for (char *name = strtok(list, ","); name != NULL && output_count < MOST_OUTPUTS;
         name = strtok(NULL, ",")) {
        if (strcmp(name, "-") != 0) {
            outputs[output_count++] = name;
        }
    }
    run_all("memory", strtol(argv[2], NULL, 10));
    run_all("calls", strtol(argv[2], NULL, 10));
    free(list);
    return problems > 0 ? 1 : 0;
}
