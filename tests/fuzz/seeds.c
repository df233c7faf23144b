/* fuzz-seeds FOLDER: writes FOLDER/TARGET/NAME, small inputs that fuzz targets begin with. */
#include "fuzz.h"

#include <errno.h>
#include <sys/stat.h>

#include "seeds.h"
#include "small_basis.h"
#include "small_study.h"

/* ---- files ---- */

static const char *root;

void seed_path(char path[4096], const char *target, const char *name)
{
    snprintf(path, 4096, "%s/%s", root, target);
    check(mkdir(path, 0777) == 0 || errno == EEXIST, "a folder is made");
    snprintf(path, 4096, "%s/%s/%s", root, target, name);
}

void seed_bytes(const char *target, const char *name, const void *data, size_t size)
{
    char path[4096];
    seed_path(path, target, name);
    FILE *file = fopen(path, "wb");
    check(file != NULL && fwrite(data, 1, size, file) == size && fclose(file) == 0,
          "a file is written");
}

void seed_text(const char *target, const char *name, const char *text)
{
    seed_bytes(target, name, text, strlen(text));
}

/* ---- tables of a fixed size ---- */

static void seed_grids(void)
{
    for (unsigned kind = 0; kind < 6; kind++) {
        uint8_t bytes[18 + 3 * 12] = {(uint8_t)kind, (uint8_t)(kind < 3 ? 0 : 256 - 8)};
        char name[16];
        for (size_t k = 0; k < 3; k++) {
            const uint32_t place = (uint32_t)(k * 300000 + 17);
            const double value = k == 0 ? 0.5 : k == 1 ? -1.0 : 1e30;
            memcpy(bytes + 18 + 12 * k, &place, sizeof place);
            memcpy(bytes + 18 + 12 * k + 4, &value, sizeof value);
        }
        snprintf(name, sizeof name, "kind-%u", kind);
        seed_bytes("grid", name, bytes, sizeof bytes);
    }
}

/* ---- bases, pieces, results ---- */

static void seed_bases(void)
{
    static const struct {
        gonio_representation representation;
        gonio_channel_model channels;
        size_t mixtures;
    } kinds[] = {{GONIO_SECTORED, GONIO_SEPARATE, 12},
                 {GONIO_BIVARIATE, GONIO_JOINT, 0},
                 {GONIO_BIVARIATE, GONIO_SEPARATE, 0}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        char path[4096];
        char name[16];
        gonio_basis *basis =
            small_basis(kinds[k].representation, kinds[k].channels, 30, kinds[k].mixtures);
        snprintf(name, sizeof name, "%zu.gonio", k);
        seed_path(path, "basis", name);
        check(gonio_basis_write(NULL, basis, "a command", path) == GONIO_OK, "a basis is written");
        gonio_basis_free(&basis);
    }
}

static void seed_runs(void)
{
    seed_text("pieces", "run",
              "\1{\"gonio\": \""
              "0.1.0\", \"identity\": {\"build\": \"x\"}}\n");
    seed_text("pieces", "piece",
              "\2{\"piece\":\"p\",\"run\":\"0123456789abcdef\",\"checksum\":\"0123456789abcdef\","
              "\"result\":{\"x\":[1.5,3,null]}}\n");
    seed_text("splits", "two",
              "{\"splits\": [{\"basis\": [\"a\", \"b\", \"c\"], \"test\": [\"d\"]},\n"
              "{\"basis\": [\"d\", \"e\", \"f\", \"g\"], \"test\": [\"h\\u00e4\", \"a\"]}]}\n");
}

static void seed_results(void)
{
    gonio_i_study study;
    const char *key = NULL;
    json_t *value = NULL;
    small_study(&study);
    json_t *all = small_results(&study);
    check(all != NULL, "results are made");
    json_object_foreach(all, key, value)
    {
        json_t *one = json_pack("{s:O}", key, value);
        char *text = json_dumps(one, JSON_COMPACT);
        check(text != NULL, "memory");
        seed_text("results", key, text);
        free(text);
        json_decref(one);
    }
    json_decref(all);
    gonio_i_study_free(&study);
}

static void seed_chains(void)
{
    for (unsigned k = 0; k < 12; k++) {
        uint8_t bytes[400];
        char name[16];
        for (size_t at = 0; at < sizeof bytes; at++) {
            bytes[at] = (uint8_t)(at % 2 == 0 ? at * 7 % 96 : at * 31 + 11 * (size_t)k);
        }
        bytes[0] = (uint8_t)(k % 2);
        bytes[1] = (uint8_t)(k / 2 * 9 % 128);
        bytes[2] = (uint8_t)(k * 37 % 128 | 3U);
        bytes[3] = (uint8_t)(1 + k);
        snprintf(name, sizeof name, "%u", k);
        seed_bytes("chain", name, bytes, sizeof bytes - k);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fuzz-seeds FOLDER\n");
        return 2;
    }
    root = argv[1];
    check(mkdir(root, 0777) == 0 || errno == EEXIST, "a folder is made");
    seed_readings();
    seed_materials();
#ifndef GONIO_WITHOUT_HDF5
    seed_hdf();
#endif
#ifndef GONIO_WITHOUT_RENDER
    seed_scenes();
#endif
    seed_grids();
    seed_bases();
    seed_runs();
    seed_results();
    seed_chains();
    seed_rigs();
    return 0;
}
