/* The options of gonio render, and the scene that it renders. */
#ifndef GONIO_RENDER_OPTIONS_H
#define GONIO_RENDER_OPTIONS_H

#include "command_line.h"

/* The values of the options. */
typedef struct render_request {
    const char *output;
    const char *mesh;
    const char *environment;
    const char *light;
    const char *light_at;
    const char *view;
    const char *size;
    const char *labels;
    double turn;
    double grain;
    double field_of_view;
    double key;
    long samples;
    long seed;
    long columns;
    int show;
    int flat;
    int repair;
    int compare;
    int differences;
} render_request;

/* What every rendering uses. */
typedef struct render_scene {
    gonio_render_options how;
    gonio_mesh *mesh;
    gonio_environment *environment;
} render_scene;

/* Checks the options that say how to render, and turns them into *how. Returns false after
 * an error message. */
bool render_set_options(const tool *t, const render_request *o, gonio_render_options *how);

/* Renders references and others side by side into one picture. Returns an exit code. */
int render_comparison(const tool *t, const render_request *o, const render_scene *s,
                      const char *const *paths, size_t count);

#endif
