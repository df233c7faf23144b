/* Cairo, loaded when it is used. After gonio_i_cairo_load has succeeded, its
 * functions are called as if it were linked: see core/on_demand.h. */
#ifndef GONIO_CAIRO_LIBRARY_H
#define GONIO_CAIRO_LIBRARY_H

#include <cairo.h>

#include "../core/on_demand.h"

#define GONIO_I_CAIRO_SYMBOLS(X)                                                                   \
    X(cairo_create)                                                                                \
    X(cairo_destroy)                                                                               \
    X(cairo_image_surface_create)                                                                  \
    X(cairo_image_surface_get_data)                                                                \
    X(cairo_image_surface_get_stride)                                                              \
    X(cairo_move_to)                                                                               \
    X(cairo_paint)                                                                                 \
    X(cairo_select_font_face)                                                                      \
    X(cairo_set_font_size)                                                                         \
    X(cairo_set_source_rgb)                                                                        \
    X(cairo_show_text)                                                                             \
    X(cairo_status)                                                                                \
    X(cairo_status_to_string)                                                                      \
    X(cairo_surface_destroy)                                                                       \
    X(cairo_surface_flush) X(cairo_surface_mark_dirty) X(cairo_text_extents)

struct gonio_i_cairo {
    GONIO_I_CAIRO_SYMBOLS(GONIO_I_SYMBOL_POINTER)
};

extern struct gonio_i_cairo gonio_i_cairo;

gonio_status gonio_i_cairo_load(gonio_context *context);

#ifndef GONIO_I_CAIRO_ITSELF
#define cairo_create (*gonio_i_cairo.cairo_create)
#define cairo_destroy (*gonio_i_cairo.cairo_destroy)
#define cairo_image_surface_create (*gonio_i_cairo.cairo_image_surface_create)
#define cairo_image_surface_get_data (*gonio_i_cairo.cairo_image_surface_get_data)
#define cairo_image_surface_get_stride (*gonio_i_cairo.cairo_image_surface_get_stride)
#define cairo_move_to (*gonio_i_cairo.cairo_move_to)
#define cairo_paint (*gonio_i_cairo.cairo_paint)
#define cairo_select_font_face (*gonio_i_cairo.cairo_select_font_face)
#define cairo_set_font_size (*gonio_i_cairo.cairo_set_font_size)
#define cairo_set_source_rgb (*gonio_i_cairo.cairo_set_source_rgb)
#define cairo_show_text (*gonio_i_cairo.cairo_show_text)
#define cairo_status (*gonio_i_cairo.cairo_status)
#define cairo_status_to_string (*gonio_i_cairo.cairo_status_to_string)
#define cairo_surface_destroy (*gonio_i_cairo.cairo_surface_destroy)
#define cairo_surface_flush (*gonio_i_cairo.cairo_surface_flush)
#define cairo_surface_mark_dirty (*gonio_i_cairo.cairo_surface_mark_dirty)
#define cairo_text_extents (*gonio_i_cairo.cairo_text_extents)
#endif

#endif
