/* The columns of angles of readings as CSV: see csv_finder.h. */
#include <string.h>

#include "../rules.h"
#include "csv_finder.h"

/* Chooses the column of each angle. gonio's own names come before others. */
static gonio_status choose_angles(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    for (size_t k = 0; k < none; k++) {
        if (f->name[k].kind != GONIO_I_ANGLE) {
            continue;
        }
        size_t *at = &chosen[f->name[k].index];
        if (*at != none && f->name[k].complement != f->name[*at].complement) {
            *at = f->name[k].complement ? *at : k; /* theta comes before an elevation */
        } else if (*at == none || (f->name[k].own && !f->name[*at].own)) {
            *at = k;
        } else if (f->name[k].own == f->name[*at].own && f->name[k].index < GONIO_I_PHASE) {
            return gonio_i_csv_refuse_two(f, "the same angle", *at, k);
        }
    }
    return GONIO_OK;
}

static bool has_transmission(const gonio_i_csv_finder *f)
{
    bool any = false;
    for (size_t k = 0; k < f->r->columns; k++) {
        const char *name = f->r->name[k];
        any = any || strcasestr(name, "btdf") != NULL || strcasestr(name, "theta_t") != NULL ||
              strcasestr(name, "transm") != NULL;
    }
    return any;
}

static gonio_status refuse_missing(const gonio_i_csv_finder *f, size_t angle)
{
    if (angle == 2 && has_transmission(f)) {
        return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                            "%s: no column 'theta_o_deg', but one of transmission; gonio reads "
                            "reflection",
                            f->r->path);
    }
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: no column '%s'; theta_i_deg, phi_i_deg, theta_o_deg and phi_o_deg "
                        "are needed, or no azimuth at all in the plane of incidence%s",
                        f->r->path, gonio_i_angle_names[angle],
                        angle == 1 ? "; an azimuth counted from that of the light is called "
                                     "phi_diff"
                                   : "");
}

static gonio_status refuse_azimuth(const gonio_i_csv_finder *f, size_t azimuth, size_t specular)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: column '%s' is an angle in the plane of incidence, to which no "
                        "azimuth as in '%s' belongs; delete one",
                        f->r->path, f->r->name[specular], f->r->name[azimuth]);
}

/* Whether a column that is not read names an azimuth, of which it is not known whose it is. */
static bool is_azimuth_unread(const gonio_i_csv_finder *f)
{
    bool any = false;
    for (size_t k = 0; k < f->r->columns; k++) {
        any = any || (f->name[k].kind == GONIO_I_OTHER && gonio_i_names_azimuth(f->r->name[k]));
    }
    return any;
}

static bool has_all(const gonio_i_csv_finder *f, const size_t chosen[], size_t first, size_t count)
{
    bool all = true;
    for (size_t k = first; k < first + count; k++) {
        all = all && chosen[k] != f->r->columns;
    }
    return all;
}

static bool has_any(const gonio_i_csv_finder *f, const size_t chosen[], size_t first, size_t count)
{
    bool any = false;
    for (size_t k = first; k < first + count; k++) {
        any = any || chosen[k] != f->r->columns;
    }
    return any;
}

/* The geometry of columns without theta_o: from the mirror direction. */
static gonio_status find_specular(const gonio_i_csv_finder *f,
                                  const size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    const size_t from = chosen[GONIO_I_FROM_SPECULAR];
    const size_t towards = chosen[GONIO_I_ASPECULAR];
    const size_t azimuth = chosen[3] != none ? chosen[3] : chosen[GONIO_I_AZIMUTH_DIFFERENCE];
    if (from != none && towards != none) {
        return gonio_i_csv_refuse_two(f, "the same angle", from, towards);
    }
    f->c->geometry = from != none ? GONIO_I_FROM_THE_NORMAL : GONIO_I_TOWARDS_LIGHT;
    return azimuth != none ? refuse_azimuth(f, azimuth, from != none ? from : towards) : GONIO_OK;
}

/* The geometry of columns of polar angles, by the azimuths that there are. */
static gonio_i_geometry with_azimuths(const gonio_i_csv_finder *f,
                                      const size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const bool phi_i = has_any(f, chosen, 1, 1);
    const bool phi_o = has_any(f, chosen, 3, 1);
    if (has_any(f, chosen, GONIO_I_AZIMUTH_DIFFERENCE, 1)) {
        return !phi_o   ? GONIO_I_DIFFERENCE_GIVES_PHI_O
               : !phi_i ? GONIO_I_DIFFERENCE_GIVES_PHI_I
                        : GONIO_I_FOUR_ANGLES;
    }
    if (phi_i || phi_o) {
        return GONIO_I_FOUR_ANGLES;
    }
    return has_any(f, chosen, GONIO_I_PHASE, 1) ? GONIO_I_PHASE_ANGLE
           : is_azimuth_unread(f)               ? GONIO_I_FOUR_ANGLES
                                                : GONIO_I_IN_PLANE;
}

/* "phi_diff" is an azimuth of the difference vector beside theta_h and theta_d. */
static bool is_half_difference(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    if (has_any(f, chosen, 0, 4) || chosen[GONIO_I_THETA_H] == none ||
        chosen[GONIO_I_THETA_D] == none) {
        return false;
    }
    if (chosen[GONIO_I_PHI_D] == none) {
        chosen[GONIO_I_PHI_D] = chosen[GONIO_I_AZIMUTH_DIFFERENCE];
    }
    return chosen[GONIO_I_PHI_D] != none;
}

static gonio_status find_geometry(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const bool specular = !has_any(f, chosen, 2, 1) && has_any(f, chosen, GONIO_I_FROM_SPECULAR, 2);
    if (!has_all(f, chosen, 0, 4) && has_all(f, chosen, GONIO_I_VECTORS, 6)) {
        f->c->geometry = GONIO_I_UNIT_VECTORS;
    } else if (is_half_difference(f, chosen)) {
        f->c->geometry = GONIO_I_HALF_DIFFERENCE;
    } else if (!has_any(f, chosen, 2, 1) && has_any(f, chosen, GONIO_I_BETA, 2)) {
        f->c->geometry =
            has_any(f, chosen, GONIO_I_BETA, 1) ? GONIO_I_SINES : GONIO_I_SIZE_OF_SINES;
    } else if (!has_any(f, chosen, 0, 4) && has_any(f, chosen, GONIO_I_NAMED_GEOMETRY, 1)) {
        f->c->geometry = GONIO_I_NAMED_DIRECTIONS;
    } else if (specular) {
        return find_specular(f, chosen);
    } else {
        f->c->geometry = with_azimuths(f, chosen);
    }
    return GONIO_OK;
}

/* Bits of the columns without which a geometry cannot do, and of those that it reads too. */
#define BIT(index) (1U << (index))
#define HALF_BITS (BIT(GONIO_I_THETA_H) | BIT(GONIO_I_THETA_D) | BIT(GONIO_I_PHI_D))
#define VECTOR_BITS (0x3fU << GONIO_I_VECTORS)
static const struct {
    unsigned needed, also;
} columns_of[] = {
    [GONIO_I_FOUR_ANGLES] = {0xfU, 0},
    [GONIO_I_DIFFERENCE_GIVES_PHI_O] = {0x5U | BIT(GONIO_I_AZIMUTH_DIFFERENCE), 0x2U},
    [GONIO_I_DIFFERENCE_GIVES_PHI_I] = {0xdU | BIT(GONIO_I_AZIMUTH_DIFFERENCE), 0},
    [GONIO_I_IN_PLANE] = {0x5U, 0},
    [GONIO_I_FROM_THE_NORMAL] = {0x1U | BIT(GONIO_I_FROM_SPECULAR), 0x2U},
    [GONIO_I_TOWARDS_LIGHT] = {0x1U | BIT(GONIO_I_ASPECULAR), 0x2U},
    [GONIO_I_PHASE_ANGLE] = {0x5U | BIT(GONIO_I_PHASE), 0},
    [GONIO_I_HALF_DIFFERENCE] = {HALF_BITS, BIT(GONIO_I_PHI_H)},
    [GONIO_I_SINES] = {0x1U | BIT(GONIO_I_BETA), 0x2U},
    [GONIO_I_SIZE_OF_SINES] = {0x1U | BIT(GONIO_I_BETA_SIZE), 0x2U},
    [GONIO_I_UNIT_VECTORS] = {VECTOR_BITS, 0},
    [GONIO_I_NAMED_DIRECTIONS] = {BIT(GONIO_I_NAMED_GEOMETRY), 0},
};

/* Leaves out the columns that the geometry does not read. Errors: _FORMAT for one that is missing.
 */
static gonio_status check_columns(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const unsigned needed = columns_of[f->c->geometry].needed;
    const unsigned read = needed | columns_of[f->c->geometry].also | BIT(GONIO_I_SAMPLE_ROTATION);
    for (size_t k = 0; k < GONIO_I_ANGLE_COLUMNS; k++) {
        if ((needed & BIT(k)) != 0 && chosen[k] == f->r->columns) {
            return refuse_missing(f, k);
        }
        chosen[k] = (read & BIT(k)) != 0 ? chosen[k] : f->r->columns;
    }
    return GONIO_OK;
}

/* Which column is which angle, and how they give the directions. */
static gonio_status find_columns(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    gonio_status status = choose_angles(f, chosen);
    if (status == GONIO_OK) {
        status = find_geometry(f, chosen);
    }
    return status == GONIO_OK ? check_columns(f, chosen) : status;
}

/* What comments say: the unit, and on which side of the plane the mirror direction is. */
static void hear_comments(const gonio_i_csv_finder *f)
{
    static const char *const units[] = {"angles", "angle unit", "angle units",
                                        "unit",   "units",      NULL};
    static const char *const mirror[] = {"mirror", NULL};
    const char *unit = gonio_i_csv_comment_of(f, units);
    const char *side = gonio_i_csv_comment_of(f, mirror);
    if (f->c->stated.angles == 0 && unit != NULL) {
        f->c->stated.angles = gonio_i_angle_unit_in(unit);
    }
    if (side != NULL && (strcmp(side, "0") == 0 || strcmp(side, "180") == 0)) {
        f->c->stated.mirror = side[0] == '0' ? GONIO_MIRROR_0 : GONIO_MIRROR_180;
        f->c->own_angles = false;
    }
}

/* Unless the user says which. */
static gonio_status refuse_grad(const gonio_i_csv_finder *f)
{
    return f->options->as.angles != GONIO_AS_STATED
               ? GONIO_OK
               : gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                              "%s: angles in 'grad' are degrees or gradians: use --as "
                              "angles=degrees or --as angles=gon",
                              f->r->path);
}

gonio_status gonio_i_csv_find_angles(const gonio_i_csv_finder *f)
{
    const size_t none = f->r->columns;
    size_t chosen[GONIO_I_ANGLE_COLUMNS];
    size_t by = 0;
    for (size_t angle = 0; angle < GONIO_I_ANGLE_COLUMNS; angle++) {
        chosen[angle] = none;
    }
    gonio_status status = find_columns(f, chosen);
    f->c->own_angles =
        chosen[1] != none && chosen[3] != none && chosen[GONIO_I_SAMPLE_ROTATION] == none;
    for (size_t angle = 0; angle < GONIO_I_ANGLE_COLUMNS && status == GONIO_OK; angle++) {
        const size_t k = chosen[angle];
        if (k == none) {
            continue;
        }
        f->c->column[k] = (gonio_i_csv_column){
            .kind = GONIO_I_ANGLE, .index = angle, .complement = f->name[k].complement};
        f->c->own_angles = f->c->own_angles && f->name[k].own;
        if (f->options->as.angles == GONIO_AS_STATED) {
            status = gonio_i_csv_agree(f, "angles", "angles", k, f->name[k].unit,
                                       &f->c->stated.angles, &by);
        }
    }
    hear_comments(f);
    return status == GONIO_OK && f->c->stated.angles == GONIO_I_DEGREES_OR_GRADIANS ? refuse_grad(f)
                                                                                    : status;
}
