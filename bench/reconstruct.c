/* Reconstructing, against plain writes of the same bytes. */
#include "bench.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* write(2) of a MERL table's bytes, with fsync and rename as gonio does. In pieces as cp and dd use
 * them: Linux is slower with all at once, for which it looks for larger pages. */
static double plain_write_seconds(const char *path, const char *data, size_t size)
{
    enum { PIECE = 128 << 10 };
    char *part = NULL;
    check(asprintf(&part, "%s.part", path) > 0, "memory");
    const double start = now();
    const int descriptor = open(part, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    size_t done = 0;
    while (descriptor >= 0 && done < size) {
        const size_t piece = size - done < PIECE ? size - done : PIECE;
        const ssize_t written = write(descriptor, data + done, piece);
        check(written > 0, "write");
        done += (size_t)written;
    }
    check(fsync(descriptor) == 0 && close(descriptor) == 0 && rename(part, path) == 0, "write");
    free(part);
    return now() - start;
}

static double reconstruct_seconds(gonio_context *context, const gonio_basis *basis,
                                  const size_t *rows, size_t n, const double *readings,
                                  const char *path)
{
    gonio_reconstruction *reconstruction = NULL;
    gonio_material *material = NULL;
    const double start = now();
    check(gonio_reconstruct_rows(context, basis, 35, rows, n, readings, &reconstruction) ==
                  GONIO_OK &&
              gonio_reconstruction_material(context, basis, reconstruction, "bench", &material) ==
                  GONIO_OK &&
              gonio_material_write_merl(context, material, path) == GONIO_OK,
          "reconstructing");
    const double seconds = now() - start;
    gonio_material_free(&material);
    gonio_reconstruction_free(&reconstruction);
    return seconds;
}

enum { MERL_SIZE = 12 + sizeof(double) * GONIO_CHANNELS * GONIO_BINS };

/* The bytes of a real table, for the plain writes. */
static char *table_bytes(const bench *b, gonio_context *context, const char *path)
{
    gonio_material *material = NULL;
    char *data = malloc(MERL_SIZE);
    check(data != NULL && gonio_material_open(context, b->paths[0], &material) == GONIO_OK &&
              gonio_material_write_merl(context, material, path) == GONIO_OK,
          "writing a table");
    FILE *file = fopen(path, "rb");
    check(file != NULL && fread(data, 1, MERL_SIZE, file) == MERL_SIZE, "reading a table");
    fclose(file);
    gonio_material_free(&material);
    return data;
}

static void bench_reconstruct_one(bench *b, gonio_context *context, const gonio_basis *basis,
                                  const char *path, const char *data)
{
    enum { N = 80, TIMES = 15 };
    const gonio_basis_view *view = gonio_basis_describe(basis);
    size_t rows[N];
    double readings[N];
    for (size_t k = 0; k < N; k++) {
        rows[k] = k * (view->rows / N);
        readings[k] = view->mean[rows[k]] + 0.01 * (double)(k % 7);
    }
    double ratio[TIMES];
    double seconds[TIMES];
    for (int run = 0; run < TIMES; run++) {
        const double plain = plain_write_seconds(path, data, MERL_SIZE);
        seconds[run] = reconstruct_seconds(context, basis, rows, N, readings, path);
        ratio[run] = seconds[run] / plain;
    }
    report(b, "reconstruct one material to a MERL table", median(seconds, TIMES), "s");
    report(b, "reconstruct one material: over plain write(2)", median(ratio, TIMES), "x");
}

/* Readings of TABLES materials by the simulated instrument, in FOLDER/readings-NUMBER.csv. */
static void write_readings(const bench *b, gonio_context *context, const gonio_basis *basis,
                           const char *folder)
{
    gonio_plan_options how;
    gonio_plan *plan = NULL;
    gonio_plan_options_default(&how);
    how.method = "random";
    check(gonio_plan_create(context, basis, &how, &plan) == GONIO_OK, "planning");
    for (size_t k = 0; k < TABLES; k++) {
        gonio_readings *readings = NULL;
        gonio_material *material = NULL;
        gonio_table *table = NULL;
        char *to = NULL;
        check(asprintf(&to, "%s/readings-%03zu.csv", folder, k) > 0 &&
                  gonio_readings_create_from_plan(context, plan, &readings) == GONIO_OK &&
                  gonio_material_open(context, b->paths[k % b->count], &material) == GONIO_OK &&
                  gonio_table_load(context, material, &table) == GONIO_OK &&
                  gonio_measure(context, readings, table, NULL) == GONIO_OK &&
                  gonio_readings_write(context, readings, NULL, to) == GONIO_OK,
              "measuring");
        gonio_table_free(&table);
        gonio_material_free(&material);
        gonio_readings_free(&readings);
        free(to);
    }
    gonio_plan_free(&plan);
}

/* Empties FOLDER/out and waits for the disk. */
static void make_room(const char *folder)
{
    command_seconds(folder, "rm -rf out && mkdir out && sync");
}

static double plain_writes_seconds(const char *folder, const char *data)
{
    double seconds = 0.0;
    for (int k = 0; k < TABLES; k++) {
        char *path = NULL;
        check(asprintf(&path, "%s/out/%03d.binary", folder, k) > 0, "memory");
        seconds += plain_write_seconds(path, data, MERL_SIZE);
        free(path);
    }
    return seconds;
}

/* The whole command, reading of the basis and of the readings included. */
static void bench_reconstruct_many(bench *b, gonio_context *context, const gonio_basis *basis,
                                   const char *folder, const char *data)
{
    char *path = NULL;
    check(asprintf(&path, "%s/basis.gonio", folder) > 0 &&
              gonio_basis_write(context, basis, NULL, path) == GONIO_OK,
          "writing a basis");
    write_readings(b, context, basis, folder);
    double ratio[RUNS];
    double seconds[RUNS];
    for (int run = 0; run < RUNS; run++) {
        make_room(folder);
        const double plain = plain_writes_seconds(folder, data);
        make_room(folder);
        seconds[run] = command_seconds(folder, GONIO_PROGRAM
                                       " reconstruct -q basis.gonio readings-*.csv -o out");
        ratio[run] = seconds[run] / plain;
    }
    report(b, "reconstruct 100 materials in one command", median(seconds, RUNS), "s");
    report(b, "reconstruct 100 materials: over plain write(2)", median(ratio, RUNS), "x");
    command_seconds(folder, "rm -rf out basis.gonio readings-*.csv");
    free(path);
}

void bench_reconstruct(bench *b)
{
    gonio_context *all = make_context(0);
    gonio_basis *basis = learn_paper(all, b->paths, BASIS_MATERIALS, 35);
    char *folder = scratch_folder();
    char *path = NULL;
    check(asprintf(&path, "%s/table.binary", folder) > 0, "memory");
    char *data = table_bytes(b, all, path);
    bench_reconstruct_one(b, all, basis, path, data);
    bench_reconstruct_many(b, all, basis, folder, data);
    unlink(path);
    rmdir(folder);
    free(data);
    free(path);
    free(folder);
    gonio_basis_free(&basis);
    gonio_context_free(&all);
}
