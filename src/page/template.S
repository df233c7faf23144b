/* The page's template as bytes of the library: GONIO_TEMPLATE is the file that viewer/ was built into. */
    .section .rodata
    .global gonio_i_web_template
    .hidden gonio_i_web_template
    .global gonio_i_web_template_end
    .hidden gonio_i_web_template_end
gonio_i_web_template:
    .incbin GONIO_TEMPLATE
gonio_i_web_template_end:
    .byte 0
    .section .note.GNU-stack, "", %progbits
