"""Makes the extension module gonio._bindings from the public headers, which say everything there is to declare."""
import pathlib
import re

from cffi import FFI

HERE = pathlib.Path(__file__).resolve().parent
INCLUDE = HERE.parent / "include"

CALLBACKS = """
extern "Python" void gonio_python_message(void *, gonio_message_level, const char *);
extern "Python" int gonio_python_progress(void *, const char *, double);
extern "Python" gonio_status gonio_python_evaluate(void *, gonio_context *, const gonio_pair *, size_t, double *);
"""


def headers():
    """The public headers in the order in which gonio.h includes them."""
    main = (INCLUDE / "gonio/gonio.h").read_text()
    return [INCLUDE / name for name in re.findall(r"#include <(gonio/\w+\.h)>", main)]


def constant(match):
    """A macro with a value as cffi declares it: a floating point number, or an integer that the compiler knows."""
    name, value = match[1], match[2].strip()
    if re.fullmatch(r"[-+]?\d+\.\d*(e[-+]?\d+)?", value):
        return f"static const double {name};"
    if re.fullmatch(r"\w+", value):
        return f"#define {name} ..."
    return ""


def declarations(text):
    """What a header declares, without comments, conditions, attributes and bodies of functions."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = text.replace("\\\n", " ")
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    text = re.sub(r"^#define (\w+) +(.+)$", constant, text, flags=re.M)
    text = re.sub(r"^#(?!define \w+ \.\.\.).*$", "", text, flags=re.M)
    text = re.sub(r"static inline ([^{;]*)\{.*?^\}", r"\1;", text, flags=re.S | re.M)
    return text.replace("GONIO_API ", "")


def public_declarations():
    return "\n".join(declarations(header.read_text()) for header in headers())


def builder():
    made = FFI()
    made.cdef(public_declarations())
    made.cdef(declarations((HERE / "kernels/kernels.h").read_text()))
    made.cdef(CALLBACKS)
    made.set_source(
        "gonio._bindings",
        '#include <gonio/gonio.h>\n#include "kernels.h"\n',
        sources=["kernels/kernels.c"],
        include_dirs=[str(INCLUDE), "kernels"],
        libraries=["gonio", "m"],
        extra_compile_args=["-std=gnu17", "-O2", "-fopenmp", "-ffp-contract=off", "-fno-math-errno"],
        extra_link_args=["-fopenmp", "-Wl,-rpath,$ORIGIN/libs"],
    )
    return made
