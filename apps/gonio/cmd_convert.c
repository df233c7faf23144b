/* gonio convert: any material to a MERL table. */
#include "command_line.h"

int cmd_convert(int argc, const char **argv)
{
    const struct poptOption table[] = {TOOL_OPTIONS};
    tool t;
    int code = tool_begin(&t, argc, argv, table, "[OPTION...] IN OUT",
                          "IN is a MERL .binary table, a neural BRDF .h5 or atlas:NAME (a built-in "
                          "material; 'gonio info atlas:' lists them).\n"
                          "OUT becomes a MERL .binary table.");
    if (code < 0) {
        size_t count = 0;
        const char **arguments = tool_arguments(&t, &count);
        gonio_material *material = NULL;
        code = count != 2 ? tool_usage_error(&t, "IN and OUT are needed")
                          : tool_check_output(&t, arguments[1], arguments, 1);
        if (code == 0) {
            gonio_status status = gonio_material_open(t.context, arguments[0], &material);
            if (status == GONIO_OK) {
                status = gonio_material_write_merl(t.context, material, arguments[1]);
            }
            code = tool_exit_code(status);
        }
        gonio_material_free(&material);
    }
    tool_end(&t);
    return code;
}
