/* What the test programs share: see support.h. */
#include "support.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *support_shared(void)
{
    const char *folder = getenv("GONIO_SHARED");
    return folder != NULL && access(folder, R_OK) == 0 ? folder : NULL;
}

void support_need_shared(void)
{
    if (support_shared() == NULL) {
        print_message("skipped: the folder of shared data is not there ($GONIO_SHARED)\n");
        skip();
    }
}

bool support_small(void)
{
    const char *size = getenv("GONIO_TESTS");
    return size != NULL && strcmp(size, "small") == 0;
}

char *support_folder(void)
{
    char *folder = strdup("/tmp/gonio-test-XXXXXX");
    assert_non_null(folder);
    assert_non_null(mkdtemp(folder));
    return folder;
}

static char last_message[4096];

static void keep_message(void *user, gonio_message_level level, const char *text)
{
    (void)user;
    if (level == GONIO_MESSAGE_ERROR) {
        snprintf(last_message, sizeof last_message, "%s", text);
    }
}

gonio_context *support_context(void)
{
    gonio_context *context = NULL;
    const gonio_context_options options = {.size = sizeof options, .message = keep_message};
    last_message[0] = '\0';
    assert_int_equal(gonio_context_create(&context, &options), GONIO_OK);
    return context;
}

const char *support_message(void)
{
    return last_message;
}

static gonio_status read_loaded(void *self, gonio_context *context, int theta_h, double *rho)
{
    (void)context;
    const double *values = gonio_table_values(self) + (size_t)theta_h * GONIO_SLAB_VALUES;
    memcpy(rho, values, GONIO_SLAB_VALUES * sizeof *rho);
    return GONIO_OK;
}

static void release_loaded(void *self)
{
    gonio_table *table = self;
    gonio_table_free(&table);
}

gonio_material *support_load(gonio_context *context, const char *path)
{
    gonio_material *file = NULL;
    gonio_table *table = NULL;
    gonio_material *loaded = NULL;
    assert_int_equal(gonio_material_open(context, path, &file), GONIO_OK);
    assert_int_equal(gonio_table_load(context, file, &table), GONIO_OK);
    const gonio_material_source source = {
        .size = sizeof source, .read_slab = read_loaded, .release = release_loaded, .self = table};
    assert_int_equal(gonio_material_create(context, gonio_material_name(file),
                                           gonio_material_format(file), &source, &loaded),
                     GONIO_OK);
    gonio_material_free(&file);
    return loaded;
}

static int remove_one(const char *path, const struct stat *status, int type, struct FTW *walk)
{
    (void)status;
    (void)type;
    (void)walk;
    return remove(path);
}

void support_remove(char *folder)
{
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    free(folder);
}

/* clang-format off */
const char *const support_merl[SUPPORT_MERL] = {
    "alum-bronze", "alumina-oxide", "aluminium", "aventurnine", "beige-fabric", "black-fabric",
    "black-obsidian", "black-oxidized-steel", "black-phenolic", "black-soft-plastic",
    "blue-acrylic", "blue-fabric", "blue-metallic-paint", "blue-metallic-paint2", "blue-rubber",
    "brass", "cherry-235", "chrome-steel", "chrome", "colonial-maple-223", "color-changing-paint1",
    "color-changing-paint2", "color-changing-paint3", "dark-blue-paint", "dark-red-paint",
    "dark-specular-fabric", "delrin", "fruitwood-241", "gold-metallic-paint",
    "gold-metallic-paint2", "gold-metallic-paint3", "gold-paint", "gray-plastic",
    "grease-covered-steel", "green-acrylic", "green-fabric", "green-latex", "green-metallic-paint",
    "green-metallic-paint2", "green-plastic", "hematite", "ipswich-pine-221", "light-brown-fabric",
    "light-red-paint", "maroon-plastic", "natural-209", "neoprene-rubber", "nickel", "nylon",
    "orange-paint", "pearl-paint", "pickled-oak-260", "pink-fabric", "pink-fabric2", "pink-felt",
    "pink-jasper", "pink-plastic", "polyethylene", "polyurethane-foam", "pure-rubber",
    "purple-paint", "pvc", "red-fabric", "red-fabric2", "red-metallic-paint", "red-phenolic",
    "red-plastic", "red-specular-plastic", "silicon-nitrade", "silver-metallic-paint",
    "silver-metallic-paint2", "silver-paint", "special-walnut-224", "specular-black-phenolic",
    "specular-blue-phenolic", "specular-green-phenolic", "specular-maroon-phenolic",
    "specular-orange-phenolic", "specular-red-phenolic", "specular-violet-phenolic",
    "specular-white-phenolic", "specular-yellow-phenolic", "ss440", "steel", "teflon",
    "tungsten-carbide", "two-layer-gold", "two-layer-silver", "violet-acrylic", "violet-rubber",
    "white-acrylic", "white-diffuse-bball", "white-fabric", "white-fabric2", "white-marble",
    "white-paint", "yellow-matte-plastic", "yellow-paint", "yellow-phenolic", "yellow-plastic",
};
/* clang-format on */

double *support_vectors(const gonio_basis *basis)
{
    const gonio_basis_view *view = gonio_basis_describe(basis);
    double *vectors = malloc(view->rows * view->components * sizeof *vectors);
    assert_non_null(vectors);
    assert_int_equal(gonio_basis_rows(NULL, basis, 0, view->rows, view->components, vectors),
                     GONIO_OK);
    return vectors;
}
