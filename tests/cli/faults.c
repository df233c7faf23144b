/* faults SHIM MOST OUTPUT[,OUTPUT] PROGRAM ARGUMENT...: runs a command in this folder again and
 * again, in each of which another allocation or call fails (faults_shim.c): all of them, or MOST of
 * each kind, evenly spread. What must hold:
 *
 *     exit code 1 and one line on standard error; or 0, and all is as without a failure
 *     outputs that are as before or as without a failure, and no other new file
 *
 * An OUTPUT of "-" stands for none. Prints what does not hold; exit code 1 then. */
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "outcome.h"

static const char *shim;
static subject tested;
static int problems;

/* A run: what it leaves, and how many entries the folder has. */
typedef struct faulty {
    outcome left;
    int code;
    int entries;
} faulty;

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
    snprintf(number, sizeof number, "%ld", nth);
    setenv("FAULT_KIND", kind, 1);
    setenv("FAULT_NTH", number, 1);
    setenv("FAULT_COUNT", "../faults.count", 1);
    setenv("LD_PRELOAD", shim, 1);
    outcome_start(&tested);
}

static faulty run(const char *kind, long nth)
{
    faulty f = {.code = -1};
    int status = 0;
    put_old(&tested);
    const pid_t child = fork();
    if (child == 0) {
        start(kind, nth);
    }
    if (child < 0 || waitpid(child, &status, 0) != child) {
        die("fork");
    }
    f.left = outcome_take(&tested, status);
    f.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    f.entries = count_entries();
    return f;
}

/* What is wrong; NULL for nothing. */
static const char *judge(const faulty *f, const faulty *good)
{
    if (f->code != 0 && f->code != 1) {
        return "neither exit code 0 nor 1";
    }
    if (f->code == 1 && !is_one_line(f->left.text[1])) {
        return "not one line on standard error";
    }
    if (f->entries != good->entries) {
        return "files are left, or missing";
    }
    for (int k = 0; k < tested.outputs; k++) {
        if (!is_same(f->left.output[k], good->left.output[k]) &&
            (f->code == 0 || !is_old(f->left.output[k]))) {
            return "an output is neither the old nor the new one";
        }
    }
    return f->code == 0 && !is_same(f->left.text[0], good->left.text[0]) ? "another standard output"
                                                                         : NULL;
}

static void tell(const char *kind, long nth, const faulty *f, const char *problem)
{
    printf("%s %ld: %s (exit code %d)\n", kind, nth, problem, f->code);
    outcome_print(&f->left, &tested);
    problems++;
}

static long count_calls(void)
{
    content c = read_content("../faults.count");
    const long count = c.data != NULL ? strtol(c.data, NULL, 10) : 0;
    free(c.data);
    return count;
}

static void run_all(const char *kind, long most)
{
    faulty good = run(kind, 0);
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
        faulty f = run(kind, nth);
        const char *problem = judge(&f, &good);
        if (problem != NULL) {
            tell(kind, nth, &f, problem);
        }
        outcome_free(&f.left, &tested);
    }
    printf("%s: %ld of %ld\n", kind, runs, count);
    outcome_free(&good.left, &tested);
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: faults SHIM MOST OUTPUT[,OUTPUT] PROGRAM ARGUMENT...\n");
        return 2;
    }
    shim = argv[1];
    tested = subject_of(argv[3], argv + 4);
    run_all("memory", strtol(argv[2], NULL, 10));
    run_all("calls", strtol(argv[2], NULL, 10));
    free(tested.list);
    return problems > 0 ? 1 : 0;
}
