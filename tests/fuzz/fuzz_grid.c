/* libFuzzer on tables of a fixed size, MERL's and UTIA's: such a file is made of zeros, and the
 * bytes say its size, its head, and a few numbers in it.
 *
 *     1 byte   MERL with 180 or 360 bins of phi_d, or UTIA; whether the size is right
 *     1 byte   how far it is from the right one
 *     16       the head, XORed over the right one
 *     12 each  a place among the numbers, and the number */
#include "fuzz.h"

enum { KINDS = 3, HEAD = 16, PATCH = 12 };

static const struct {
    off_t size;
    int32_t head[3];
    size_t numbers; /* where they begin */
} kinds[KINDS] = {{12 + 24 * 90 * 90 * 180, {90, 90, 180}, 12},
                  {12 + 24 * 90 * 90 * 360, {90, 90, 360}, 12},
                  {8 * 3 * 288 * 288, {0, 0, 0}, 0}};

static double rho[GONIO_SLAB_VALUES];

static void check_slab(void)
{
    for (int k = 0; k < GONIO_SLAB_BINS; k++) {
        const double a = rho[k];
        const double b = rho[k + GONIO_SLAB_BINS];
        const double c = rho[k + 2 * GONIO_SLAB_BINS];
        check((a == -1.0 && b == -1.0 && c == -1.0) ||
                  (a >= 0.0 && b >= 0.0 && c >= 0.0 && isfinite(a + b + c)),
              "a bin has values or none");
    }
}

/* A sparse file of the kind; false where the bytes do not say one. */
static bool make_file(const char *path, const uint8_t *data, size_t size)
{
    if (size < 2 + HEAD) {
        return false;
    }
    const int kind = data[0] % KINDS;
    const off_t length = kinds[kind].size + (data[0] / KINDS % 2 != 0 ? (int8_t)data[1] : 0);
    uint8_t head[HEAD] = {0};
    memcpy(head, kinds[kind].head, sizeof kinds[kind].head);
    for (size_t k = 0; k < HEAD; k++) {
        head[k] ^= data[2 + k];
    }
    const int file = open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    check(file >= 0 && pwrite(file, head, HEAD, 0) == HEAD && ftruncate(file, length) == 0,
          "a file is written");
    for (size_t at = 2 + HEAD; at + PATCH <= size; at += PATCH) {
        uint32_t place = 0;
        memcpy(&place, data + at, sizeof place);
        const size_t numbers = ((size_t)length - kinds[kind].numbers) / sizeof(double);
        check(pwrite(file, data + at + 4, sizeof(double),
                     (off_t)(kinds[kind].numbers + place % numbers * sizeof(double))) ==
                  sizeof(double),
              "a number is written");
    }
    close(file);
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_material *material = NULL;
    fuzz_path(path, "grid");
    if (!make_file(path, data, size)) {
        return -1;
    }
    gonio_status status = gonio_material_open(context, path, &material);
    check_status(status);
    if (status == GONIO_OK) {
        const gonio_pair pair = {{0.3, 0.1}, {0.7, 2.0}};
        double value[GONIO_CHANNELS];
        check_status(gonio_material_evaluate(context, material, &pair, 1, value));
        check_status(gonio_material_read_slab(context, material, data[1] % 90, rho));
        check_slab();
        status = gonio_material_read_slab(context, material, 90, rho);
        check(status == GONIO_ERROR_ARGUMENT, "there are 90 slabs");
    }
    gonio_material_free(&material);
    unlink(path);
    return 0;
}
