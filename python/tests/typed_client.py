"""Not run but checked by mypy: what a program with types sees."""
from typing import List, Optional

import numpy as np
import numpy.typing as npt

import gonio

Array = npt.NDArray[np.float64]


def chain(paths: List[str]) -> Array:
    basis: gonio.Basis = gonio.learn(paths, mixtures=10)
    plan: gonio.Plan = basis.plan(5, target_error=3.0)
    sample = gonio.Material("atlas:gold-polished")
    values: Array = sample.eval(plan.wi, plan.wo, cosine=False)
    model: gonio.Regressor = gonio.Regressor(basis, noise=0.02).fit((plan.wi, plan.wo), values)
    alone: Array = model.predict(plan.wi, plan.wo)
    value, std = model.predict(plan.wi, plan.wo, return_std=True)
    more = model.reconstruction_.next(3)
    if more is not None:
        more.to_csv("more.csv")
    rig: gonio.Goniometer = gonio.Goniometer("two-arms")
    run: Optional[gonio.Run] = basis.plan(5, instrument=rig, budget=600.0).run
    seconds: float = 0.0 if run is None else run.duration + float(run.positions.max())
    rehearsed: gonio.Readings = rig.rehearse(plan, sample, "run.csv").less_blank(gonio.Readings.load("blank.csv"))
    energy, band = gonio.reconstruct(basis, rehearsed).reflectance([0.0, 0.5])
    error: float = gonio.errors(sample, model.reconstruction_)["e6"]
    picture: npt.NDArray[np.float32] = gonio.render(sample, width=64, height=64)
    return alone + value + std + energy + band + error + seconds + float(picture.max())
