/* The built-in instruments as bytes of the library. GONIO_FILE_symbol is the path of each file. */
#define INSTRUMENT(symbol, file) \
    .global gonio_i_file_##symbol; \
    .hidden gonio_i_file_##symbol; \
    .global gonio_i_file_##symbol##_end; \
    .hidden gonio_i_file_##symbol##_end; \
gonio_i_file_##symbol: \
    .incbin file; \
gonio_i_file_##symbol##_end: \
    .byte 0

    .section .rodata
    INSTRUMENT(in_plane, GONIO_FILE_in_plane)
    INSTRUMENT(two_arms, GONIO_FILE_two_arms)
    INSTRUMENT(four_axis, GONIO_FILE_four_axis)
    .section .note.GNU-stack, "", %progbits
