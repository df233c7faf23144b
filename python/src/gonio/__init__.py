"""gonio: plan BRDF measurements and complete them.

A basis is learned from measured (or built-in) materials. It says which few pairs of light and view directions to
measure, and completes the readings to the whole BRDF, with its uncertainty. All work is done by the C library gonio.

    import gonio

    basis = gonio.Basis.load("merl.gonio")                    # or gonio.learn(paths), or gonio.builtin_basis()
    plan = basis.plan(20)                                     # plan.wi, plan.wo: (20, 3)
    values = my_instrument(plan.wi, plan.wo)                  # (20, channels), 1/sr
    model = gonio.Regressor(basis).fit(plan.directions, values)
    value, std = model.predict(wi, wo, return_std=True)       # (..., channels), 1/sr
    model.reconstruction_.save("material.bsdf")               # for Mitsuba 3 and pbrt-v4

Conventions
-----------
Directions are unit vectors (..., 3) in the surface's frame: normal +z, tangent +x. wi points towards the light, wo
towards the viewer, both away from the surface; leading axes broadcast. Angles are radians, values 1/sr, arrays float64.
`directions(theta, phi)` makes vectors from angles, `angles` goes back. E6, the error that is expected and reported, is
the relative RMS error of ln(1 + rho/s), in per cent.

What there is
-------------
Material        a BRDF from a file, "atlas:NAME", an array or a function: eval, albedo, to_numpy, to_xarray, save
learn, Basis    a basis: plan, load, save, arrays; builtin_basis() is that of the built-in materials
Plan            where to measure: columns as arrays, to_csv, to_pandas
Readings        values at directions, from arrays or an instrument's file
Regressor       fit, predict, score, as scikit-learn has them
reconstruct, Reconstruction   the same without its manners: expected_error, suspicion, predict, interval, next
Goniometer      an instrument's file: reach, noise, times; plans and rehearsals of its runs
Instrument, SimulatedInstrument   what reads a sample, behind a callback
errors          how far one BRDF is from another
render, tone_map, save_image, report, plot   to look at
settings        threads, progress

Failures are exceptions under `GonioError` with the library's message, warnings are Python warnings (`GonioWarning`),
notes go to the logger "gonio". Work is stopped by Ctrl-C and shows a tqdm bar if tqdm is installed. The GIL is released
while the library works. Objects never change once made, so threads may share them.
"""
from __future__ import annotations

from . import _calls
from ._backend import lib as _lib
from ._calls import settings
from ._bases import Basis, builtin_basis, learn
from ._directions import angles, directions
from ._evaluation import Errors, errors, file_kind
from ._exceptions import (ArgumentError, CancelledError, DataError, DirectionWarning, FileError, FormatError,
                         GonioError, GonioWarning, MismatchError, NotFittedError, NumericalError, OutOfMemoryError,
                         UndeterminedError)
from ._goniometers import Goniometer, goniometers
from ._instruments import Instrument, SimulatedInstrument
from ._materials import Material, atlas, formats, grid
from ._plans import Plan, Run, metrics, planning_methods
from ._readings import Readings
from ._reconstruction import Reconstruction, reconstruct, reconstruction_methods
from ._regressor import Regressor
from ._rendering import environments, image_errors, read_image, render, save_image, tone_map
from ._reports import Report, report
from . import plot

__version__ = _calls.text(_lib.gonio_version())

__all__ = [
    "ArgumentError", "Basis", "CancelledError", "DataError", "DirectionWarning", "Errors", "FileError", "FormatError",
    "GonioError", "GonioWarning", "Goniometer", "Instrument", "Material", "MismatchError", "NotFittedError",
    "NumericalError",
    "OutOfMemoryError", "Plan", "Readings", "Reconstruction", "Regressor", "Report", "Run", "SimulatedInstrument",
    "UndeterminedError", "angles", "atlas", "builtin_basis", "directions", "environments", "errors", "file_kind",
    "formats", "goniometers", "grid", "image_errors", "learn", "metrics", "plot", "planning_methods", "read_image",
    "reconstruct",
    "reconstruction_methods", "render", "report", "save_image", "settings", "tone_map",
]

for _name in __all__:  # as users know them, in messages and pickles
    if getattr(globals()[_name], "__module__", "").startswith("gonio._"):
        globals()[_name].__module__ = "gonio"
