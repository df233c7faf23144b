"""Puts the shared libraries that the package needs into it, so that it runs where there are only Python and NumPy.

What every Linux system with Python has stays outside. A library is named after its content, so that it never stands in
for another one of its name in the same process; NumPy keeps its own BLAS. cffi's run-time module is put in too.
"""
import hashlib
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess

# Of the system, with its C library and compiler.
OUTSIDE = re.compile(r"(ld-linux.*|lib(c|m|mvec|dl|rt|pthread|resolv|util|gcc_s|stdc\+\+))\.so.*")


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def resolved(path):
    """Where the dynamic linker finds each library that is to be inside: {name: path}."""
    found = re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", path), flags=re.M)
    return {name: pathlib.Path(place).resolve() for name, place in found if not OUTSIDE.fullmatch(name)}


def content_names(libraries):
    """New names: libpng16.so.16 becomes libpng16-1a2b3c4d.so.16."""
    made = {}
    for name, path in libraries.items():
        stem, suffix = name.split(".so", 1)
        made[name] = f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{suffix}"
    return made


def copy_terms(library, folder):
    """Debian keeps the licence of a library with its package."""
    found = subprocess.run(["dpkg", "-S", library], capture_output=True, text=True)
    package = found.stdout.split(":")[0]
    terms = pathlib.Path("/usr/share/doc") / package / "copyright"
    if found.returncode == 0 and terms.exists():
        shutil.copy(terms, folder / package)


def adapt(path, names, rpath):
    """Makes a file ask for the libraries by their new names, in rpath. patchelf 0.14 cannot do both at once."""
    command = ["patchelf"]
    for name in run("patchelf", "--print-needed", path).split():
        new = names.get(re.sub(r"-[0-9a-f]{8}(?=\.so)", "", name), name)
        if new != name:
            command += ["--replace-needed", name, new]
    if len(command) > 1:
        run(*command, path)
    run("patchelf", "--set-rpath", rpath, path)


def put_dependencies(libs, libraries, names):
    """Copies of the libraries under their new names."""
    shutil.rmtree(libs, ignore_errors=True)
    (libs / "licences").mkdir(parents=True)
    for name, path in libraries.items():
        copied = libs / names[name]
        shutil.copy(path, copied)
        copied.chmod(0o755)
        run("patchelf", "--set-soname", names[name], copied)
        adapt(copied, names, "$ORIGIN")
        copy_terms(path, libs / "licences")


def put(source, target, names, rpath):
    shutil.copy(source, target)
    target.chmod(0o755)
    adapt(target, names, rpath)


def fill(package, library):
    """Puts into a built package the library, cffi's module and all libraries that these need."""
    backend = pathlib.Path(importlib.util.find_spec("_cffi_backend").origin)
    libraries = {**resolved(library), **resolved(backend)}
    names = content_names(libraries)
    libs = package / "libs"
    record = package.parent / "bundled.json"
    if not libs.exists() or not record.exists() or json.loads(record.read_text()) != names:
        record.unlink(missing_ok=True)
        put_dependencies(libs, libraries, names)
        record.write_text(json.dumps(names))
    own = run("patchelf", "--print-soname", library).strip()
    put(library.resolve(), libs / own, names, "$ORIGIN")
    put(backend, package / backend.name, names, "$ORIGIN/libs")
    for module in package.glob("_bindings*.so"):
        adapt(module, names, "$ORIGIN/libs")
    print(f"{own} and {len(names)} libraries that it needs are in the package")
