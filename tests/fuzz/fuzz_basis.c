/* libFuzzer on basis files: whatever the bytes are, a basis is refused with one message or is one
 * that plans and reconstructs. Hashes may be wrong in this build, as a liar could have right ones.
 */
#include "fuzz.h"

static void plan(gonio_context *context, const gonio_basis *basis, const char *method)
{
    gonio_plan_options options;
    gonio_plan_options_default(&options);
    options.method = method;
    options.count = 2;
    options.components = strcmp(method, "expected-error") == 0 ? 0 : 1;
    options.restarts = 1;
    gonio_plan *made = NULL;
    const gonio_status status = gonio_plan_create(context, basis, &options, &made);
    check_status(status);
    check(status != GONIO_OK || made->count == 2, "a plan has what was asked for");
    gonio_plan_free(&made);
}

/* A material from one row, with finite values. */
static void reconstruct(gonio_context *context, const gonio_basis *basis)
{
    static double rho[GONIO_SLAB_VALUES];
    const size_t row = 0;
    const double b[GONIO_CHANNELS] = {1.0, 2.0, 3.0};
    gonio_reconstruction *made = NULL;
    gonio_material *material = NULL;
    gonio_status status = gonio_reconstruct_rows(context, basis, 1, &row, 1, b, &made);
    check_status(status);
    if (status != GONIO_OK) {
        return;
    }
    status = gonio_reconstruction_material(context, basis, made, "made", &material);
    check_status(status);
    if (status == GONIO_OK) {
        check_status(gonio_material_read_slab(context, material, 7, rho));
        for (size_t k = 0; k < GONIO_SLAB_VALUES; k++) {
            check(isfinite(rho[k]) && (rho[k] >= 0.0 || rho[k] == -1.0), "a BRDF is not negative");
        }
    }
    gonio_material_free(&material);
    gonio_reconstruction_free(&made);
}

static void use(gonio_context *context, const gonio_basis *basis, unsigned which)
{
    static const char *const methods[] = {"condition", "random", "matusik",
                                          "nielsen",   "frost",  "expected-error"};
    plan(context, basis, methods[which % (sizeof methods / sizeof *methods)]);
    reconstruct(context, basis);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_basis *basis = NULL;
    fuzz_path(path, "basis");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_basis_read(context, path, &basis);
    check_status(status);
    if (status == GONIO_OK) {
        use(context, basis, size > 0 ? data[size - 1] + (unsigned)size : 0);
    }
    gonio_basis_free(&basis);
    unlink(path);
    return 0;
}

/* Half of the changes are in the header, which is a small part of the file; some are of numbers in
 * place, with values that are hard to compute with. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    static const double hard[] = {0.0,  -1.0, 1e300, -1e300, 5e-324,
                                  1e16, 1e4,  710.0, NAN,    INFINITY};
    uint64_t length = 0;
    memcpy(&length, data, size >= 8 ? 8 : 0);
    if (size < 64 || length > size - 8 || seed % 8 == 0) {
        return LLVMFuzzerMutate(data, size, most);
    }
    if (seed % 8 < 5) { /* the length of the header stays, and so does what follows it */
        uint8_t *copy = malloc((size_t)length);
        check(copy != NULL, "memory");
        memcpy(copy, data + 8, (size_t)length);
        size_t changed = LLVMFuzzerMutate(copy, (size_t)length, (size_t)length);
        memset(data + 8, ' ', (size_t)length);
        memcpy(data + 8, copy, changed);
        free(copy);
        return size;
    }
    const size_t start = 8 + (size_t)length;
    const size_t at = start + seed / 8 % 65536 * 8 % (size - start + 1) / 4 * 4;
    const double value = hard[seed / 524288 % (sizeof hard / sizeof *hard)];
    const float single = (float)value;
    if (seed % 8 == 5 && at + sizeof single <= size) {
        memcpy(data + at, &single, sizeof single);
    } else if (at + sizeof value <= size) {
        memcpy(data + at, &value, sizeof value);
    }
    return size;
}
