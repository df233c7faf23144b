/* Outputs of a command that are looked at after each run of it: see outcome.h. */
#include "outcome.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char old[] = "old\n";
static const char *const texts[2] = {"../outcome.out", "../outcome.err"};

void die(const char *what)
{
    perror(what);
    exit(2);
}

subject subject_of(const char *outputs, char **command)
{
    subject s = {.list = strdup(outputs), .command = command};
    for (char *name = strtok(s.list, ","); name != NULL && s.outputs < MOST_OUTPUTS;
         name = strtok(NULL, ",")) {
        if (strcmp(name, "-") != 0) {
            s.output[s.outputs++] = name;
        }
    }
    return s;
}

content read_content(const char *path)
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

bool is_same(content a, content b)
{
    return a.data != NULL && b.data != NULL && a.size == b.size &&
           memcmp(a.data, b.data, a.size) == 0;
}

bool is_old(content c)
{
    return c.data != NULL && c.size == sizeof old - 1 && memcmp(c.data, old, c.size) == 0;
}

bool is_one_line(content c)
{
    const char *end = c.data != NULL ? strchr(c.data, '\n') : NULL;
    return end != NULL && end[1] == '\0' && end > c.data;
}

void put_old(const subject *s)
{
    for (int k = 0; k < s->outputs; k++) {
        FILE *file = fopen(s->output[k], "wb");
        if (file == NULL || fputs(old, file) == EOF || fclose(file) != 0) {
            die(s->output[k]);
        }
    }
}

void outcome_start(const subject *s)
{
    for (int k = 0; k < 2; k++) {
        const int file = open(texts[k], O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (file < 0 || dup2(file, k + 1) < 0) {
            _exit(126);
        }
    }
    alarm(60);
    execv(s->command[0], s->command);
    _exit(127);
}

outcome outcome_take(const subject *s, int status)
{
    outcome o = {.status = status};
    for (int k = 0; k < 2; k++) {
        o.text[k] = read_content(texts[k]);
    }
    for (int k = 0; k < s->outputs; k++) {
        o.output[k] = read_content(s->output[k]);
    }
    return o;
}

void outcome_free(outcome *o, const subject *s)
{
    for (int k = 0; k < 2; k++) {
        free(o->text[k].data);
    }
    for (int k = 0; k < s->outputs; k++) {
        free(o->output[k].data);
    }
}

void outcome_print(const outcome *o, const subject *s)
{
    printf("    ");
    for (int k = 1; s->command[k] != NULL; k++) {
        printf(" %s", s->command[k]);
    }
    printf("\n    %.300s\n", o->text[1].data != NULL ? o->text[1].data : "");
}
