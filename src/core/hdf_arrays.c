/* Arrays of numbers in HDF5 files: see hdf_read.h. */
#include <stdlib.h>
#include <string.h>

#include "hdf_chunks.h"

/* Reads what a dataset is whose numbers become the wanted ones; NULL, or what is wrong. */
static const char *read_numeric(gonio_i_hdf_object object, gonio_i_hdf_number_type wanted,
                                gonio_i_hdf_set *set)
{
    const char *problem = gonio_i_hdf_read_set(object, set);
    return problem != NULL                             ? problem
           : !gonio_i_hdf_converts(&set->type, wanted) ? "is not numeric"
                                                       : NULL;
}

const char *gonio_i_hdf_describe(gonio_i_hdf_object set, gonio_i_hdf_array *array)
{
    gonio_i_hdf_set found;
    const char *problem = read_numeric(set, GONIO_I_HDF_DOUBLE, &found);
    problem = problem != NULL ? problem : gonio_i_hdf_lacks(&found, found.type.size);
    if (problem != NULL) {
        return problem;
    }
    *array = (gonio_i_hdf_array){.rank = found.space.rank};
    memcpy(array->extent, found.space.extent, sizeof array->extent);
    if (found.unwritten != NULL) {
        gonio_i_hdf_convert(&found.type, found.unwritten, 1, GONIO_I_HDF_DOUBLE, &array->unwritten);
    }
    return NULL;
}

/* ---- runs ---- */

/* Numbers on their way from the file to a caller. */
typedef struct passing {
    const gonio_i_hdf_type *type;
    gonio_i_hdf_number_type wanted;
    gonio_i_hdf_run *run;
    void *user;
} passing;

static void pass(void *user, size_t first, size_t count, const unsigned char *stored)
{
    enum { ROOM = 512 };
    const passing *p = user;
    uint64_t values[ROOM]; /* of any type */
    while (count > 0) {
        const size_t now = count < ROOM ? count : ROOM;
        gonio_i_hdf_convert(p->type, stored, now, p->wanted, values);
        p->run(p->user, first, now, values);
        first += now;
        count -= now;
        stored += now * p->type->size;
    }
}

const char *gonio_i_hdf_visit(gonio_i_hdf_object set, gonio_i_hdf_number_type type,
                              gonio_i_hdf_run *run, void *user)
{
    gonio_i_hdf_set found;
    const char *problem = read_numeric(set, type, &found);
    problem = problem != NULL ? problem : gonio_i_hdf_lacks(&found, gonio_i_hdf_width(type));
    passing p = {.type = &found.type, .wanted = type, .run = run, .user = user};
    return problem != NULL ? problem : gonio_i_hdf_visit_stored(&found, pass, &p);
}

/* ---- whole arrays ---- */

/* An array that is being filled. */
typedef struct filling {
    const gonio_i_hdf_type *type;
    gonio_i_hdf_number_type wanted;
    unsigned char *values;
} filling;

static void keep(void *user, size_t first, size_t count, const unsigned char *stored)
{
    const filling *f = user;
    gonio_i_hdf_convert(f->type, stored, count, f->wanted,
                        f->values + first * gonio_i_hdf_width(f->wanted));
}

static void fill_unwritten(const gonio_i_hdf_set *set, const filling *f)
{
    const size_t width = gonio_i_hdf_width(f->wanted);
    for (size_t k = 0; k < set->space.count && set->unwritten != NULL; k++) {
        gonio_i_hdf_convert(f->type, set->unwritten, 1, f->wanted, f->values + k * width);
    }
}

static const char *read_values(const gonio_i_hdf_set *set, gonio_i_hdf_number_type type,
                               void **data)
{
    filling f = {.type = &set->type, .wanted = type};
    f.values = calloc(set->space.count + 1, gonio_i_hdf_width(type));
    if (f.values == NULL) {
        return "is too large for the memory";
    }
    fill_unwritten(set, &f);
    const char *problem = gonio_i_hdf_visit_stored(set, keep, &f);
    if (problem != NULL) {
        free(f.values);
        return problem;
    }
    *data = f.values;
    return NULL;
}

const char *gonio_i_hdf_read_array(gonio_i_hdf_object group, const char *path, int rank,
                                   size_t limit, gonio_i_hdf_number_type type, void **data,
                                   size_t *dimensions)
{
    gonio_i_hdf_object object;
    gonio_i_hdf_set set;
    if (!gonio_i_hdf_find(group, path, &object)) {
        return "is missing";
    }
    const char *problem = read_numeric(object, type, &set);
    problem = problem != NULL ? problem : gonio_i_hdf_lacks(&set, gonio_i_hdf_width(type));
    if (problem != NULL) {
        return problem;
    }
    bool fits = set.space.rank == rank && set.space.count <= limit;
    for (int k = 0; k < rank && fits; k++) {
        fits = set.space.extent[k] <= limit;
        dimensions[k] = set.space.extent[k];
    }
    return fits ? read_values(&set, type, data) : "has a wrong shape";
}
