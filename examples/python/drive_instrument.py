"""Drives an instrument: reads where it tells most, until the expected error is small enough.

    python drive_instrument.py [FOLDER [BASIS]]

The instrument is a callback. Here it is simulated, and reaches no direction beyond 75 degrees.
"""
# %%
import pathlib
import sys

import numpy as np

import gonio

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
basis = gonio.Basis.load(sys.argv[2]) if len(sys.argv) > 2 else gonio.builtin_basis()
TARGET = 6.0  # E6, per cent
MOST = 40  # readings

# %% What the instrument can reach: a grid of light and viewer angles.
theta_i, theta_o, phi_o = (a.ravel() for a in np.meshgrid(
    np.radians([5, 15, 30, 45, 60, 75]), np.radians([5, 10, 20, 30, 40, 50, 60, 70]),
    np.radians([0, 45, 90, 135, 180]), indexing="ij"))
reach = (gonio.directions(theta_i, 0.0), gonio.directions(theta_o, phi_o))

# %% How it is driven. In a laboratory this moves the arms and returns what the detector says, 1/sr.
sample = gonio.Material("atlas:gold-polished")
noise = np.random.default_rng(3)


def move_and_read(wi, wo):
    values = sample.eval(wi, wo)
    return np.maximum(values * (1.0 + 0.01 * noise.standard_normal(values.shape)), 0.0)


instrument = gonio.Instrument(move_and_read, directions=reach, noise=0.01)

# %% The first readings are planned for any material, the next ones for this one.
plan = basis.plan(4, instrument=instrument)
wi, wo = plan.wi, plan.wo
values = instrument.read(wi, wo)
while True:
    model = gonio.Regressor(basis, noise=instrument.noise).fit((wi, wo), values)
    print(f"{len(wi):2d} readings: expected error (E6) {model.expected_error_:.2f} %")
    more = model.reconstruction_.next(4, target_error=TARGET, instrument=instrument)
    if more is None or len(wi) >= MOST:
        break
    wi, wo = np.vstack([wi, more.wi]), np.vstack([wo, more.wo])
    values = np.vstack([values, instrument.read(more.wi, more.wo)])
print("enough" if more is None else "no more time")

# %% Keep the readings, and check against directions that were not used.
gonio.Readings(wi, wo, values).save(folder / "readings.csv")
others = gonio.Readings(*reach).measured(sample)
print(gonio.errors(others, model.reconstruction_))
