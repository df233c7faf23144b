/* Files of materials, opened or refused. */
#ifndef MATERIAL_FILES_H
#define MATERIAL_FILES_H

#include <math.h>
#include <string.h>

#include <gonio/material.h>

static const double degree = M_PI / 180.0;

static inline gonio_material *open_good(const char *path)
{
    gonio_material *material = NULL;
    assert_int_equal(gonio_material_open(NULL, path, &material), GONIO_OK);
    return material;
}

/* Refused, with a message that has `part` in it. */
static inline void check_refused(const char *path, const char *part)
{
    gonio_context *context = support_context();
    gonio_material *material = NULL;
    const gonio_status status = gonio_material_open(context, path, &material);
    assert_int_equal(status, GONIO_ERROR_FORMAT);
    assert_non_null(strstr(support_message(), part));
    assert_null(material);
    gonio_context_free(&context);
}

#endif
