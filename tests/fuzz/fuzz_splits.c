/* libFuzzer on splits: whatever the bytes are, a file is refused with one message or names
 * materials that there are. */
#include "fuzz.h"

#include "experiments/splits.h"

enum { MATERIALS = 8 };

static gonio_i_digest digest[MATERIALS];
static gonio_i_digest *digests[MATERIALS];

static void check_materials(const size_t *material, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        check(material[k] < MATERIALS, "a material is there");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char name[MATERIALS][8] = {"a", "b", "c", "d", "e", "f", "g", "h\xc3\xa4"};
    const gonio_i_collection collection = {.count = MATERIALS, .digest = digests};
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_i_splits splits;
    for (int k = 0; k < MATERIALS; k++) {
        digest[k].name = name[k];
        digests[k] = &digest[k];
    }
    fuzz_path(path, "splits.json");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_i_splits_read(context, &collection, path, &splits);
    check_status(status);
    for (size_t s = 0; status == GONIO_OK && s < splits.count; s++) {
        const gonio_i_split *split = &splits.split[s];
        check(split->basis_count >= 3 && split->test_count >= 1, "a split has enough");
        check_materials(split->basis, split->basis_count);
        check_materials(split->test, split->test_count);
    }
    gonio_i_splits_free(&splits);
    unlink(path);
    return 0;
}
