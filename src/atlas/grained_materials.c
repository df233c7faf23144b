/* The parameters of the built-in anisotropic materials, one entry a material. Reflectances are
 * linear R G B. Brushed metals have ratios of axes of 1.5 to 8. */
#include "grained.h"

/* clang-format off */

/* Name, symmetry and azimuth of the grain. */
#define METAL(NAME, SYMMETRY, GRAIN, EDGE)                                                         \
    .name = NAME, .material_class = "brushed metal", .symmetry = SYMMETRY, .grain = GRAIN, .edge = EDGE
#define WEAVE(NAME, SYMMETRY, GRAIN)                                                               \
    .name = NAME, .material_class = "weave", .symmetry = SYMMETRY, .grain = GRAIN
#define WOOD(NAME, SYMMETRY, GRAIN)                                                                \
    .name = NAME, .material_class = "grained wood", .symmetry = SYMMETRY, .grain = GRAIN
#define LAMINATE(NAME, SYMMETRY, GRAIN)                                                            \
    .name = NAME, .material_class = "laminate", .symmetry = SYMMETRY, .grain = GRAIN

/* Clear coat: share, F0, alpha. */
#define COAT(SHARE, F0, ALPHA) .coat = SHARE, .coat_f0 = F0, .coat_alpha = ALPHA

/* Lobe: weight, F0 (R G B), alpha along and across, light share, turn in degrees. */
#define LOBE(WEIGHT, R, G, B, ALONG, ACROSS, LIGHT, TURN) {WEIGHT, {R, G, B}, ALONG, ACROSS, LIGHT, TURN}

/* Fibres: strength (R G B), width and tilt in degrees. */
#define FIBRE(R, G, B, WIDTH, TILT) .fibre = {R, G, B}, .fibre_width = WIDTH, .fibre_tilt = TILT

const gonio_i_grained_material gonio_i_grained_materials[] = {
    {METAL("aluminium-fine-brushed", 2, 0.0, 0.12),
     .lobe = {LOBE(0.90, 0.91, 0.92, 0.92, 0.120, 0.180, 0.3, 0.0), LOBE(0.10, 0.91, 0.92, 0.92, 0.350, 0.350, 0.0, 0.0)}},
    {METAL("aluminium-coarse-brushed", 2, 90.0, 0.15),
     .lobe = {LOBE(0.85, 0.86, 0.87, 0.88, 0.100, 0.400, 0.1, 0.0), LOBE(0.15, 0.86, 0.87, 0.88, 0.450, 0.600, 0.5, 0.0)}},
    {METAL("steel-belt-ground", 2, 30.0, 0.20),
     .lobe = {LOBE(1.00, 0.56, 0.57, 0.58, 0.090, 0.270, 0.0, 0.0)}},
    {METAL("steel-hairline", 2, 0.0, 0.20),
     .lobe = {LOBE(0.86, 0.55, 0.56, 0.57, 0.050, 0.400, 0.6, 0.0), LOBE(0.14, 0.55, 0.56, 0.57, 0.240, 0.300, 0.2, 0.0)}},
    {METAL("brass-wheel-brushed", 2, 75.0, 0.10),
     .lobe = {LOBE(0.95, 0.90, 0.77, 0.41, 0.140, 0.280, 0.8, 0.0), LOBE(0.05, 0.85, 0.70, 0.36, 0.500, 0.500, 0.0, 0.0)}},
    {METAL("copper-scratch-brushed", 2, 120.0, 0.08),
     .lobe = {LOBE(1.00, 0.95, 0.64, 0.52, 0.080, 0.480, 0.2, 0.0)}},
    {METAL("nickel-linished", 2, 0.0, 0.18),
     .lobe = {LOBE(0.92, 0.66, 0.61, 0.54, 0.130, 0.325, 0.4, 0.0), LOBE(0.08, 0.66, 0.61, 0.54, 0.060, 0.060, 0.0, 0.0)}},
    {METAL("titanium-surface-ground", 2, 90.0, 0.15),
     .lobe = {LOBE(1.00, 0.54, 0.50, 0.45, 0.070, 0.350, 0.5, 0.0)}},
    {METAL("gold-engine-turned", 4, 20.0, 0.05),
     .lobe = {LOBE(0.50, 0.98, 0.77, 0.34, 0.060, 0.240, 0.5, 0.0), LOBE(0.50, 0.98, 0.77, 0.34, 0.060, 0.240, 0.5, 90.0)}},
    {METAL("bronze-cross-hatched", 2, 0.0, 0.12),
     .lobe = {LOBE(0.55, 0.72, 0.54, 0.33, 0.080, 0.400, 0.3, 30.0), LOBE(0.45, 0.72, 0.54, 0.33, 0.080, 0.400, 0.3, -30.0)}},
    {METAL("blue-anodised-brushed", 2, 0.0, 0.10), COAT(1.0, 0.070, 0.060),
     .lobe = {LOBE(1.00, 0.10, 0.22, 0.60, 0.100, 0.350, 0.3, 0.0)}},
    {METAL("brass-brushed-lacquered", 2, 45.0, 0.10), COAT(1.0, 0.040, 0.018),
     .lobe = {LOBE(1.00, 0.84, 0.68, 0.30, 0.110, 0.330, 0.2, 0.0)}},

    {WEAVE("ivory-silk-satin", 2, 0.0),
     .lobe = {LOBE(0.70, 0.300, 0.270, 0.210, 0.140, 0.560, 0.3, 0.0), LOBE(0.15, 0.240, 0.210, 0.160, 0.180, 0.500, 0.3, 90.0)},
     .diffuse = {0.42, 0.37, 0.28}},
    {WEAVE("crimson-satin", 2, 60.0),
     .lobe = {LOBE(0.80, 0.280, 0.060, 0.060, 0.120, 0.600, 0.6, 0.0), LOBE(0.08, 0.180, 0.030, 0.030, 0.200, 0.600, 0.6, 90.0)},
     .diffuse = {0.24, 0.016, 0.022}},
    {WEAVE("acetate-ribbon", 2, 90.0),
     .lobe = {LOBE(0.90, 0.180, 0.240, 0.160, 0.080, 0.480, 0.8, 0.0)}, .diffuse = {0.08, 0.20, 0.09}},
    {WEAVE("navy-cotton-twill", 2, 27.0),
     .lobe = {LOBE(0.50, 0.045, 0.048, 0.070, 0.300, 0.600, 0.5, 45.0), LOBE(0.25, 0.045, 0.048, 0.070, 0.350, 0.650, 0.5, -45.0)},
     .diffuse = {0.020, 0.032, 0.110}},
    {WEAVE("grey-worsted-twill", 2, 0.0),
     .lobe = {LOBE(0.45, 0.050, 0.050, 0.052, 0.250, 0.450, 0.7, 63.0), LOBE(0.30, 0.050, 0.050, 0.052, 0.280, 0.560, 0.7, -27.0)},
     .diffuse = {0.17, 0.17, 0.18}},
    {WEAVE("shot-taffeta", 2, 10.0),
     .lobe = {LOBE(0.45, 0.360, 0.040, 0.060, 0.120, 0.480, 0.4, 0.0), LOBE(0.45, 0.030, 0.070, 0.380, 0.120, 0.480, 0.4, 90.0)},
     .diffuse = {0.10, 0.03, 0.12}},
    {WEAVE("white-nylon-plain-weave", 4, 0.0),
     .lobe = {LOBE(0.40, 0.060, 0.060, 0.060, 0.180, 0.540, 0.2, 0.0), LOBE(0.40, 0.060, 0.060, 0.060, 0.180, 0.540, 0.2, 90.0)},
     .diffuse = {0.74, 0.73, 0.70}},

    {WOOD("maple-quartersawn-lacquered", 2, 0.0), COAT(1.0, 0.040, 0.035),
     .diffuse = {0.43, 0.32, 0.19}, FIBRE(0.120, 0.092, 0.056, 12.0, 0.0)},
    {WOOD("maple-curly-varnished", 1, 0.0), COAT(1.0, 0.042, 0.025),
     .diffuse = {0.38, 0.25, 0.12}, FIBRE(0.130, 0.095, 0.050, 11.0, 14.0)},
    {WOOD("mahogany-ribbon-polished", 1, 50.0), COAT(1.0, 0.043, 0.020),
     .diffuse = {0.150, 0.052, 0.026}, FIBRE(0.120, 0.052, 0.030, 9.0, -10.0)},
    {WOOD("walnut-straight-oiled", 2, 90.0), COAT(0.7, 0.040, 0.240),
     .diffuse = {0.110, 0.060, 0.032}, FIBRE(0.060, 0.036, 0.020, 17.0, 0.0)},
    {WOOD("ash-straight-planed", 2, 15.0), COAT(0.3, 0.038, 0.400),
     .diffuse = {0.52, 0.42, 0.28}, FIBRE(0.090, 0.075, 0.050, 21.0, 0.0)},

    {LAMINATE("silver-brushed-film", 2, 0.0), COAT(1.0, 0.045, 0.020),
     .lobe = {LOBE(0.80, 0.720, 0.730, 0.740, 0.150, 0.300, 0.4, 0.0)}, .diffuse = {0.05, 0.05, 0.05}},
    {LAMINATE("carbon-unidirectional", 2, 90.0), COAT(1.0, 0.048, 0.022),
     .lobe = {LOBE(1.00, 0.070, 0.070, 0.074, 0.060, 0.480, 0.3, 0.0)}, .diffuse = {0.008, 0.008, 0.009}},
    {LAMINATE("carbon-twill", 4, 45.0), COAT(1.0, 0.048, 0.015),
     .lobe = {LOBE(0.50, 0.070, 0.070, 0.074, 0.080, 0.420, 0.3, 0.0), LOBE(0.50, 0.070, 0.070, 0.074, 0.080, 0.420, 0.3, 90.0)},
     .diffuse = {0.007, 0.007, 0.008}},
};

/* clang-format on */

const int gonio_i_grained_material_count =
    (int)(sizeof gonio_i_grained_materials / sizeof gonio_i_grained_materials[0]);
