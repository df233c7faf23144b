"""Run where there are only Python, NumPy and the wheel: the whole chain, and no library from anywhere else.

    python clean.py FOLDER      FOLDER is that of the environment
"""
import importlib.util
import pathlib
import re
import sys
import tempfile

import numpy

import gonio

folder = pathlib.Path(sys.argv[1]).resolve()
for module in ("cffi", "pytest", "matplotlib", "sklearn", "tqdm"):
    assert importlib.util.find_spec(module) is None, f"{module} is in the clean environment"
assert folder in pathlib.Path(gonio.__file__).resolve().parents

basis = gonio.learn(gonio.atlas()[:4], mixtures=8, components=10)
plan = basis.plan(5)
model = gonio.Regressor(basis).fit(plan.directions, gonio.Material("atlas:gold-polished").eval(plan.wi, plan.wo))
value, std = model.predict(plan.wi, plan.wo, return_std=True)
assert value.shape == std.shape == (5, 3) and numpy.isfinite(std).all()
image = gonio.render(model.reconstruction_, width=16, height=16, samples=1)
with tempfile.TemporaryDirectory() as scratch:
    gonio.save_image(image, pathlib.Path(scratch) / "a.png")
    gonio.save_image(image, pathlib.Path(scratch) / "a.exr")
    basis.save(pathlib.Path(scratch) / "a.gonio")
    assert gonio.Basis.load(pathlib.Path(scratch) / "a.gonio").fingerprint == basis.fingerprint

system = re.compile(r"(ld-linux|lib(c|m|mvec|dl|rt|pthread|resolv|util|gcc_s|stdc\+\+|python3))[.-]")
# What the interpreter and NumPy stand on themselves.
theirs = re.compile(r"lib(blas|lapack|openblas[\w.-]*|gfortran|quadmath|bz2|lzma|z|expat|ffi|ssl|crypto|uuid)\.so")
python = re.compile(r"/(numpy|lib-dynload)/")
mapped = {line.split(maxsplit=5)[5].strip() for line in open("/proc/self/maps") if ".so" in line}
for path in sorted(mapped):
    name = pathlib.PurePath(path).name
    inside = folder in pathlib.Path(path).resolve().parents
    assert inside or python.search(path) or system.match(name) or theirs.match(name), f"{path} is not of the wheel"
print(f"gonio {gonio.__version__} runs with Python and NumPy alone: {sum('/gonio/' in p for p in mapped)} libraries")
