/* libFuzzer on images, OpenEXR and Radiance: whatever the bytes are, a file is refused with one
 * message or is an environment that can be looked up and sampled. */
#include "fuzz.h"

#include "render/environment.h"

static void sample(const gonio_environment *environment)
{
    for (int k = 0; k < 8; k++) {
        const double u[2] = {k / 8.0 + 1e-9, 1.0 - k / 8.0 - 1e-9};
        double direction[3];
        double radiance[3];
        double density = 0.0;
        gonio_i_environment_sample(environment, u, direction);
        check(isfinite(direction[0] + direction[1] + direction[2]), "a direction is one");
        gonio_i_environment_look(environment, direction, radiance, &density);
        check(radiance[0] >= 0.0 && isfinite(density) && density >= 0.0, "radiance is not below 0");
        gonio_i_environment_shown(environment, direction, radiance);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gonio_context *context = fuzz_context();
    char path[128];
    gonio_environment *environment = NULL;
    fuzz_path(path, "image");
    fuzz_write(path, data, size);
    const gonio_status status = gonio_environment_open(context, path, size % 2 != 0, &environment);
    check_status(status);
    if (status == GONIO_OK) {
        sample(environment);
    }
    gonio_environment_free(&environment);
    unlink(path);
    return 0;
}
