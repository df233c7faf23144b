/* The messages of an HDF5 object's header: see hdf_messages.h. */
#include "hdf_messages.h"

enum { MOST_STEPS = 65536, SHARED = 0x02, CHECKSUM = 4, PREFIX_1 = 16 };

static void add_block(gonio_i_hdf_messages *m, gonio_i_hdf_cursor block)
{
    if (!block.failed && m->blocks < GONIO_I_HDF_BLOCKS) {
        m->block[m->blocks++] = block;
    }
}

/* Headers of version 1: version, reserved, count of messages, references, size, padding. */
static void begin_1(gonio_i_hdf_messages *m, gonio_i_hdf_cursor head, uint64_t address)
{
    gonio_i_hdf_take(&head, 8);
    const uint64_t size = gonio_i_hdf_number(&head, 4);
    if (!head.failed) {
        add_block(m, gonio_i_hdf_block(m->file, address + PREFIX_1, size));
    }
}

/* Headers of version 2: OHDR, version, flags, perhaps times and limits of attributes, the size of
 * the first block in 1, 2, 4 or 8 bytes. */
static void begin_2(gonio_i_hdf_messages *m, gonio_i_hdf_cursor head)
{
    enum { ORDERED = 0x04, LIMITS = 0x10, TIMES = 0x20 };
    gonio_i_hdf_take(&head, 5);
    const uint64_t flags = gonio_i_hdf_number(&head, 1);
    gonio_i_hdf_take(&head, (flags & TIMES ? 16U : 0U) + (flags & LIMITS ? 4U : 0U));
    const uint64_t size = gonio_i_hdf_number(&head, (size_t)1 << (flags & 3U));
    const unsigned char *first = gonio_i_hdf_take(&head, size);
    m->version = 2;
    m->ordered = (flags & ORDERED) != 0;
    if (first != NULL) {
        add_block(m, (gonio_i_hdf_cursor){.at = first, .left = (size_t)size});
    }
}

void gonio_i_hdf_messages_begin(gonio_i_hdf_object object, gonio_i_hdf_messages *messages)
{
    const gonio_i_hdf_cursor head = gonio_i_hdf_from(object.file, object.address);
    gonio_i_hdf_cursor probe = head;
    messages->file = object.file;
    messages->version = 1;
    messages->ordered = false;
    messages->steps = 0;
    messages->blocks = 0;
    messages->here = 0;
    if (gonio_i_hdf_expect(&probe, "OHDR")) {
        if (gonio_i_hdf_number(&probe, 1) == 2) {
            begin_2(messages, head);
        }
    } else if (!head.failed && head.left > 0 && *head.at == 1) {
        begin_1(messages, head, object.address);
    }
}

/* The block that a continuation message names; in headers of version 2 between OCHK and a checksum.
 */
static void follow(gonio_i_hdf_messages *m, gonio_i_hdf_cursor body)
{
    const uint64_t address = gonio_i_hdf_number(&body, 8);
    const uint64_t size = gonio_i_hdf_number(&body, 8);
    gonio_i_hdf_cursor block = gonio_i_hdf_block(m->file, address, size);
    if (body.failed) {
        return;
    }
    if (m->version == 2) {
        gonio_i_hdf_expect(&block, "OCHK");
        block.failed = block.failed || block.left < CHECKSUM;
        block.left -= block.failed ? 0 : CHECKSUM;
    }
    add_block(m, block);
}

/* The next message of any kind in a block; the block has failed at its end. */
static gonio_i_hdf_cursor step(const gonio_i_hdf_messages *m, gonio_i_hdf_cursor *block,
                               unsigned *kind, unsigned *flags)
{
    *kind = (unsigned)gonio_i_hdf_number(block, m->version == 1 ? 2 : 1);
    const uint64_t size = gonio_i_hdf_number(block, 2);
    *flags = (unsigned)gonio_i_hdf_number(block, 1);
    gonio_i_hdf_take(block, m->version == 1 ? 3 : m->ordered ? 2 : 0);
    const unsigned char *body = gonio_i_hdf_take(block, size);
    return (gonio_i_hdf_cursor){.at = body, .left = body != NULL ? (size_t)size : 0};
}

bool gonio_i_hdf_messages_next(gonio_i_hdf_messages *messages, unsigned kind,
                               gonio_i_hdf_cursor *body)
{
    while (messages->here < messages->blocks && messages->steps < MOST_STEPS) {
        gonio_i_hdf_cursor *block = &messages->block[messages->here];
        unsigned found = 0;
        unsigned flags = 0;
        const gonio_i_hdf_cursor next = step(messages, block, &found, &flags);
        messages->steps++;
        if (block->failed) {
            messages->here++;
        } else if (found == GONIO_I_HDF_CONTINUATION) {
            follow(messages, next);
        } else if (found == kind && (flags & SHARED) == 0) {
            *body = next;
            return true;
        }
    }
    return false;
}

bool gonio_i_hdf_message(gonio_i_hdf_object object, unsigned kind, gonio_i_hdf_cursor *body)
{
    gonio_i_hdf_messages messages;
    gonio_i_hdf_messages_begin(object, &messages);
    return gonio_i_hdf_messages_next(&messages, kind, body);
}
