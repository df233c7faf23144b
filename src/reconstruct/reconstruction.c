/* The view of a reconstruction. */
#include <gonio/reconstruct.h>

#include <stdlib.h>

void gonio_reconstruction_free(gonio_reconstruction **reconstruction)
{
    if (reconstruction == NULL || *reconstruction == NULL) {
        return;
    }
    free((*reconstruction)->coefficients);
    free((*reconstruction)->field);
    free((*reconstruction)->deviation);
    free((*reconstruction)->wavelength);
    free((*reconstruction)->dark);
    free((*reconstruction)->contradicted);
    free(*reconstruction);
    *reconstruction = NULL;
}
