"""A laboratory's day as a script: plan for an instrument, rehearse, subtract a blank run, complete, ask what is next.

    python laboratory.py [FOLDER [BASIS]]

docs/laboratory.md explains the steps. Writes plan.csv, run.csv, sample.bsdf and more.csv into FOLDER.
"""
# %% The instrument and what is known of materials.
import pathlib
import sys

import numpy as np

import gonio

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
basis = gonio.Basis.load(sys.argv[2]) if len(sys.argv) > 2 else gonio.builtin_basis()
files = pathlib.Path(__file__).resolve().parents[1] / "laboratory"
rig = gonio.Goniometer(files / "gantry.json")
reach = rig.survey()
print(f"{rig.name}: {reach['share']:.0%} of all pairs; most are kept out by {next(iter(reach['kept_out']))}")

# %% The plan, in the order of least time. With budget=480.0 in place of 16: the best run of eight minutes.
plan = basis.plan(16, instrument=rig)
plan.to_csv(folder / "plan.csv")
print(f"{plan.run}, {plan.run.unordered / 60.0:.1f} min in the order of choice")
for part in plan.run.parts[1:]:
    print(f"  blind: {part['share']:.1%} by {part['obstacle']}, deviation there {part['deviation']:.0%}")

# %% The run. Here it is rehearsed; gonio measure --follow goes along with a real one. Its dark lines and its reference
# are taken care of when the file is read.
sample = gonio.Material("atlas:red-glossy-plastic")
readings = rig.rehearse(plan, sample, folder / "run.csv", seed=1)
print("\n".join(readings.notes))

# %% The blank run shows the stray light.
blank = gonio.Readings.load(files / "blank.csv")
readings = readings.less_blank(blank, noise=rig.noise, floor=rig.floor)

# %% The BRDF, its energy, and its bands at two directions.
made = gonio.reconstruct(basis, readings, noise=rig.noise, floor=rig.floor)
print(made)
energy, std = made.reflectance(np.radians([0.0, 30.0, 60.0]))
print("reflectance of green at 0, 30 and 60 degrees:",
      ", ".join(f"{e:.3f} +- {s:.3f}" for e, s in zip(energy[:, 1], std[:, 1])))
wi, wo = gonio.directions(np.radians(45.0)), gonio.directions(np.radians([45.0, 85.0]), np.pi)
low, high = made.interval(wi, wo)
for angle, can, a, b in zip((45, 85), rig.reaches(wi, wo), low[:, 1], high[:, 1]):
    print(f"theta_o = {angle}: {a:.4g} to {b:.4g} 1/sr, {'within' if can else 'out of'} reach")
made.save(folder / "sample.bsdf")

# %% What would help most, and how long it takes.
more = made.next(4, instrument=rig)
more.to_csv(folder / "more.csv")
print(f"4 more readings in {more.run.duration / 60.0:.1f} min: expected error (E6) {more.expected_error[-1]:.2f} %")

# %% The run was rehearsed, so the truth is known.
print(gonio.errors(sample, folder / "sample.bsdf"))
