/* BSDF-XML parsed into blocks of numbers and bases of angles. */
#ifndef GONIO_BSDF_XML_PARSE_H
#define GONIO_BSDF_XML_PARSE_H

#include <gonio/context.h>

#include "klems.h"
#include "tensor_tree.h"

enum {
    GONIO_I_XML_BASES = 16,
    GONIO_I_XML_BLOCKS = 1024, /* at most, of reflection */
    GONIO_I_XML_PATCHES = 4096 /* of a basis, at most */
};

/* ScatteringData of reflection of a wavelength and a direction, as read. */
typedef struct gonio_i_xml_block {
    char wavelength[GONIO_I_KLEMS_NAME];
    char unit[GONIO_I_KLEMS_NAME];
    char direction[GONIO_I_KLEMS_NAME];
    char column[GONIO_I_KLEMS_NAME]; /* names of bases */
    char row[GONIO_I_KLEMS_NAME];
    double *value; /* [count], of a matrix */
    size_t count;
    gonio_i_tensor_tree *tree; /* of a tensor tree; otherwise NULL */
} gonio_i_xml_block;

typedef struct gonio_i_xml {
    char structure[GONIO_I_KLEMS_NAME]; /* of the data: Columns, Rows, TensorTree3, TensorTree4 */
    gonio_i_klems basis[GONIO_I_XML_BASES];
    size_t bases;
    gonio_i_xml_block *block; /* [blocks] */
    size_t blocks;
} gonio_i_xml;

/* The dimensions of the trees that a structure names; 0 of matrices. */
int gonio_i_xml_dimensions(const gonio_i_xml *xml);

/* Reads a file. Numbers have decimal points: the caller sees to the locale. To be freed in any
 * case. Errors: _IO; _FORMAT, with the line (not well-formed, an entity is declared, too deep, not
 * finite); _MEMORY. */
gonio_status gonio_i_xml_read(gonio_context *context, const char *path, gonio_i_xml *xml);
void gonio_i_xml_free(gonio_i_xml *xml);

#endif
