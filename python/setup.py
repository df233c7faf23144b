"""Builds the package: the C library, the extension module over it, and the libraries that both need.

The C library is built in build/library, or taken from a build folder that GONIO_BUILD names; then all that is made goes
there, too. GONIO_WHEEL=stored makes wheels without compression, which is quick.
"""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import setup
from setuptools.command.build_ext import build_ext
from setuptools.dist import Distribution

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
BUILD = pathlib.Path(os.environ["GONIO_BUILD"]).resolve() if os.environ.get("GONIO_BUILD") else None
sys.path.insert(0, str(HERE))

import bundle  # noqa: E402


if not (ROOT / "include/gonio/status.h").exists():
    raise SystemExit("the package is built in gonio's source tree: the C library is above its folder")


def version():
    text = (ROOT / "include/gonio/status.h").read_text()
    return ".".join(re.search(rf"GONIO_VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def build_library():
    """Returns the folder of libgonio.so."""
    build = BUILD or HERE / "build" / "library"
    if BUILD is None:
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        "-DBUILD_TESTING=OFF"], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "gonio-shared"], check=True)
    return build / "src"


def folders():
    """Options of the commands: where they work."""
    made = {}
    if BUILD is not None:
        work = BUILD / "python"
        work.mkdir(exist_ok=True)
        made = {"build": {"build_base": str(work)}, "egg_info": {"egg_base": str(work)}}
    if os.environ.get("GONIO_WHEEL") == "stored":
        made["bdist_wheel"] = {"compression": "stored"}
    return made


class BuildExtension(build_ext):
    """Builds the library first, and puts it and what it needs into the package afterwards."""

    def run(self):
        library = build_library()
        self.drop_removed_modules()
        for extension in self.extensions:
            extension.library_dirs.append(str(library))
        super().run()
        bundle.fill(pathlib.Path(self.build_lib) / "gonio", library / "libgonio.so")

    def drop_removed_modules(self):
        """Of an earlier build in the same folder."""
        for built in (pathlib.Path(self.build_lib) / "gonio").glob("*.py*"):
            if built.is_file() and not (HERE / "src/gonio" / built.name).exists():
                built.unlink()


class BinaryDistribution(Distribution):
    """The package holds machine code for one version of Python."""

    def has_ext_modules(self):
        return True


setup(version=version(), cffi_modules=["bindings.py:builder"], cmdclass={"build_ext": BuildExtension},
      distclass=BinaryDistribution, options=folders())
