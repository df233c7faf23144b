"""From 20 readings to a whole BRDF with bands.

    python readings_to_bands.py [FOLDER [BASIS]]

Writes material.bsdf and bands.png (with Matplotlib) into FOLDER. The cells can be run one by one in a notebook.
"""
# %% A basis: learned from measured materials once, or the one of the built-in materials.
import pathlib
import sys

import numpy as np

import gonio

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
basis = gonio.Basis.load(sys.argv[2]) if len(sys.argv) > 2 else gonio.builtin_basis()
print(basis)

# %% Where to measure: 20 directions, in order of use.
plan = basis.plan(20)
plan.to_csv(folder / "plan.csv")
print(plan)

# %% Measure there. A simulated instrument with 1 % noise stands for yours.
sample = gonio.Material("atlas:red-glossy-plastic")
values = gonio.SimulatedInstrument(sample, noise=0.01, seed=1).read(plan.wi, plan.wo)

# %% Complete the readings.
model = gonio.Regressor(basis, noise=0.01).fit(plan.directions, values)
print(f"expected error (E6) {model.expected_error_:.2f} %")

# %% The BRDF in the plane of incidence, with the band that holds 95 % of the true values.
theta_o = np.radians(np.arange(-80.0, 81.0, 10.0))
wi = gonio.directions(np.radians(45.0), 0.0)
wo = gonio.directions(np.abs(theta_o), np.where(theta_o < 0.0, 0.0, np.pi))
value = model.predict(wi, wo)
low, high = model.interval(wi, wo)
truth = sample.eval(wi, wo)
print("theta_o  green, 1/sr   from .. to            true")
for angle, v, a, b, t in zip(np.degrees(theta_o), value[:, 1], low[:, 1], high[:, 1], truth[:, 1]):
    print(f"{angle:7.0f}  {v:11.4f}   {a:.4f} .. {b:<9.4f} {t:9.4f}")
inside = np.mean((truth >= low) & (truth <= high))
print(f"{inside:.0%} of the true values lie in the bands")

# %% For a renderer, and how far it is from the truth.
model.reconstruction_.save(folder / "material.bsdf")
print(gonio.errors(sample, model.reconstruction_))

# %% A picture.
try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    print("no Matplotlib: no picture")
else:
    gonio.plot.lobes(model.reconstruction_, np.radians([0.0, 45.0]))
    plt.savefig(folder / "bands.png", dpi=100)
