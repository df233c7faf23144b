/* The messages of an HDF5 object's header, for its readers alone. */
#ifndef GONIO_HDF_MESSAGES_H
#define GONIO_HDF_MESSAGES_H

#include "hdf_bytes.h"

/* Kinds of messages that are read. */
enum {
    GONIO_I_HDF_SPACE = 0x01,
    GONIO_I_HDF_TYPE = 0x03,
    GONIO_I_HDF_FILL = 0x05,
    GONIO_I_HDF_LINK = 0x06,
    GONIO_I_HDF_EXTERNAL = 0x07,
    GONIO_I_HDF_LAYOUT = 0x08,
    GONIO_I_HDF_FILTERS = 0x0B,
    GONIO_I_HDF_ATTRIBUTE = 0x0C,
    GONIO_I_HDF_CONTINUATION = 0x10,
    GONIO_I_HDF_SYMBOLS = 0x11
};

enum { GONIO_I_HDF_BLOCKS = 256 };

/* A walk over the messages of a header. */
typedef struct gonio_i_hdf_messages {
    const gonio_i_hdf_file *file;
    int version;    /* of the header */
    bool ordered;   /* each message has a creation order */
    unsigned steps; /* messages seen */
    gonio_i_hdf_cursor block[GONIO_I_HDF_BLOCKS];
    size_t blocks, here;
} gonio_i_hdf_messages;

/* Begins a walk. On an address where no header is there are no messages. */
void gonio_i_hdf_messages_begin(gonio_i_hdf_object object, gonio_i_hdf_messages *messages);

/* The body of the next message of a kind; false if there is none. Those that are kept elsewhere
 * (shared) are passed over. */
bool gonio_i_hdf_messages_next(gonio_i_hdf_messages *messages, unsigned kind,
                               gonio_i_hdf_cursor *body);

/* The body of the first message of a kind. */
bool gonio_i_hdf_message(gonio_i_hdf_object object, unsigned kind, gonio_i_hdf_cursor *body);

#endif
