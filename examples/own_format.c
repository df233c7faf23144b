/* Makes a material format of one's own known to the library, and converts it.
 *
 *     own_format INPUT OUTPUT
 *
 * INPUT is one line of text, "DIFFUSE SPECULAR EXPONENT": the parameters of a modified Phong model.
 * OUTPUT is a MERL table. */
#include <gonio/gonio.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What the format's reader keeps. */
typedef struct phong {
    double diffuse, specular, exponent;
} phong;

/* rho = kd/pi + ks (n + 2)/(2 pi) cos^n alpha, alpha the angle to the mirror direction. The library
 * calls it from several threads. One channel: a grey material. */
static gonio_status evaluate(void *self, gonio_context *context, const gonio_pair *pairs,
                             size_t count, double *values)
{
    const phong *p = self;
    (void)context;
    for (size_t k = 0; k < count; k++) {
        const gonio_angles i = pairs[k].incident;
        const gonio_angles o = pairs[k].outgoing;
        const double cosine =
            cos(i.theta) * cos(o.theta) - sin(i.theta) * sin(o.theta) * cos(i.phi - o.phi);
        values[k] = p->diffuse / M_PI + p->specular * (p->exponent + 2.0) / (2.0 * M_PI) *
                                            pow(fmax(cosine, 0.0), p->exponent);
    }
    return GONIO_OK;
}

static gonio_status open_phong(gonio_context *context, const char *path, gonio_material **material)
{
    FILE *file = fopen(path, "r");
    phong *p = malloc(sizeof *p);
    const bool read = file != NULL && p != NULL &&
                      fscanf(file, "%lf %lf %lf", &p->diffuse, &p->specular, &p->exponent) == 3;
    if (file != NULL) {
        fclose(file);
    }
    const gonio_material_source source = {
        .size = sizeof source, .evaluate = evaluate, .release = free, .self = p, .channels = 1};
    const gonio_status status =
        read ? gonio_material_create(context, "phong", "Phong's model", &source, material)
             : GONIO_ERROR_FORMAT;
    if (status != GONIO_OK) {
        free(p); /* the material owns it only on success */
    }
    return status;
}

int main(int argc, char **argv)
{
    gonio_context *context = NULL;
    gonio_material *material = NULL;
    if (argc != 3) {
        fprintf(stderr, "usage: own_format INPUT OUTPUT\n");
        return 2;
    }
    const bool done = gonio_context_create(&context, NULL) == GONIO_OK &&
                      open_phong(context, argv[1], &material) == GONIO_OK &&
                      gonio_material_write_merl(context, material, argv[2]) == GONIO_OK;
    printf("%s: %s\n", argv[2], done ? "written" : "cannot be made");
    gonio_material_free(&material);
    gonio_context_free(&context);
    return done ? 0 : 1;
}
