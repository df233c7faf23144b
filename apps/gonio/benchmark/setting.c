/* The setting of a benchmark: see setting.h. */
#include "setting.h"

#include <math.h>

const size_t benchmark_rendered_sizes[BENCHMARK_RENDERED_SIZES] = {8, 16, 32};

void benchmark_setting_default(benchmark_setting *setting)
{
    static const size_t sizes[] = {5, 10, 20, 40, 80, 160};
    *setting = (benchmark_setting){.folds = 10,
                                   .sizes = sizeof sizes / sizeof *sizes,
                                   .draws = 3,
                                   .candidates = 20000,
                                   .reach = 80.0 * M_PI / 180.0,
                                   .channels = 8,
                                   .batch = 5};
    for (size_t k = 0; k < setting->sizes; k++) {
        setting->size[k] = sizes[k];
    }
}

gonio_reconstruct_options benchmark_how(const benchmark_setting *setting)
{
    gonio_reconstruct_options how;
    gonio_reconstruct_options_default(&how);
    how.all_channels = true;
    how.deviation = !setting->no_bands;
    how.noise = fmax(setting->noise, how.noise);
    how.floor = fmax(setting->floor, how.floor);
    return how;
}
