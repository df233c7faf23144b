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
        if (*at == none || (f->name[k].own && !f->name[*at].own)) {
            *at = k;
        } else if (f->name[k].own == f->name[*at].own) {
            return gonio_i_csv_refuse_two(f, "the same angle", *at, k);
        }
    }
    return GONIO_OK;
}

static gonio_status refuse_missing(const gonio_i_csv_finder *f, size_t angle)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: no column '%s'; theta_i_deg, phi_i_deg, theta_o_deg and phi_o_deg "
                        "are needed, or no azimuth at all in the plane of incidence",
                        f->r->path, gonio_i_angle_names[angle]);
}

static gonio_status refuse_azimuth(const gonio_i_csv_finder *f, size_t azimuth, size_t specular)
{
    return gonio_i_fail(f->r->context, GONIO_ERROR_FORMAT,
                        "%s: column '%s' is an angle in the plane of incidence, to which no "
                        "azimuth as in '%s' belongs; delete one",
                        f->r->path, f->r->name[specular], f->r->name[azimuth]);
}

/* Whether the detector's angle is given from the mirror direction: then its own is not read. */
static gonio_status find_specular(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    const size_t from = chosen[GONIO_I_FROM_SPECULAR];
    const size_t towards = chosen[GONIO_I_ASPECULAR];
    const size_t azimuth = chosen[3] != none ? chosen[3] : chosen[GONIO_I_AZIMUTH_DIFFERENCE];
    if (chosen[2] != none) {
        chosen[GONIO_I_FROM_SPECULAR] = none;
        chosen[GONIO_I_ASPECULAR] = none;
        return GONIO_OK;
    }
    if (from != none && towards != none) {
        return gonio_i_csv_refuse_two(f, "the same angle", from, towards);
    }
    f->c->from_specular = from != none ? 1 : towards != none ? -1 : 0;
    if (f->c->from_specular != 0 && azimuth != none) {
        return refuse_azimuth(f, azimuth, from != none ? from : towards);
    }
    return GONIO_OK;
}

static gonio_status check_angles(const gonio_i_csv_finder *f,
                                 const size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const bool specular = f->c->from_specular != 0;
    for (size_t angle = 0; angle < 4; angle++) {
        const bool azimuth = angle % 2 == 1;
        const bool replaced = azimuth ? f->c->difference_gives != 0 || f->c->in_plane || specular
                                      : angle == 2 && specular;
        if (chosen[angle] == f->r->columns && !replaced) {
            return refuse_missing(f, angle);
        }
    }
    return GONIO_OK;
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

/* Which column is which angle, and what replaces those that are not there. */
static gonio_status find_columns(const gonio_i_csv_finder *f, size_t chosen[GONIO_I_ANGLE_COLUMNS])
{
    const size_t none = f->r->columns;
    gonio_status status = choose_angles(f, chosen);
    if (status == GONIO_OK) {
        status = find_specular(f, chosen);
    }
    if (chosen[GONIO_I_AZIMUTH_DIFFERENCE] != none) {
        f->c->difference_gives = chosen[3] == none ? 3 : chosen[1] == none ? 1 : 0;
    }
    if (f->c->difference_gives == 0) {
        chosen[GONIO_I_AZIMUTH_DIFFERENCE] = none;
    }
    f->c->in_plane = f->c->from_specular == 0 && f->c->difference_gives == 0 && chosen[1] == none &&
                     chosen[3] == none && !is_azimuth_unread(f);
    return status == GONIO_OK ? check_angles(f, chosen) : status;
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
        f->c->column[k] = (gonio_i_csv_column){.kind = GONIO_I_ANGLE, .index = angle};
        f->c->own_angles = f->c->own_angles && f->name[k].own;
        if (f->options->as.angles == GONIO_AS_STATED) {
            status = gonio_i_csv_agree(f, "angles", "angles", k, f->name[k].unit,
                                       &f->c->stated.angles, &by);
        }
    }
    hear_comments(f);
    return status;
}
