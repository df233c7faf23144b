"""Instruments: what reads a sample at directions. One of your own has the same attributes."""
from __future__ import annotations

from typing import Any, Callable, Optional, Tuple

import numpy as np
import numpy.typing as npt

from ._directions import Array
from ._exceptions import ArgumentError
from ._readings import Readings


class Instrument:
    """An instrument behind a callback.

    Parameters
    ----------
    callback : callable
        callback(wi, wo) moves to unit vectors (n, 3) and returns the values there, (n, channels), 1/sr.
    directions : (wi, wo), optional
        All that it can reach, (m, 3) each; None for any.
    noise, floor, saturation : float
        As of `Regressor`.
    """

    def __init__(self, callback: Callable[[Array, Array], Any], directions: Optional[Tuple[Any, Any]] = None, *,
                 noise: float = 0.01, floor: float = 1e-5, saturation: float = 0.0) -> None:
        self._callback = callback
        self.directions = directions
        self.noise, self.floor, self.saturation = noise, floor, saturation

    def read(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """Values at directions, (n, channels), 1/sr."""
        light, viewer = np.atleast_2d(np.asarray(wi, float)), np.atleast_2d(np.asarray(wo, float))
        values = np.asarray(self._callback(light, viewer), dtype=np.float64)
        if values.ndim not in (1, 2) or len(values) != len(light):
            raise ArgumentError(f"the instrument returned shape {values.shape} for {len(light)} directions: it must "
                                f"return ({len(light)}, channels)")
        return values


class SimulatedInstrument(Instrument):
    """Reads a known material with noise (gonio_measure_material).

    Parameters
    ----------
    material : Material, or what it is made of
    directions : (wi, wo), optional
        All that it can reach; None for any.
    noise : float
        Standard deviation relative to the value.
    floor : float
        Standard deviation of the additive noise, 1/sr.
    outliers : float
        Share of directions where all values are ten times too large or too small.
    seed : int
        Of the first call of `read`; each call counts it up.
    """

    def __init__(self, material: Any, directions: Optional[Tuple[Any, Any]] = None, *, noise: float = 0.01,
                 floor: float = 1e-5, outliers: float = 0.0, seed: int = 0) -> None:
        super().__init__(self._simulate, directions, noise=noise, floor=floor)
        self.material, self.outliers, self.seed = material, outliers, seed

    def _simulate(self, wi: Array, wo: Array) -> Array:
        seed, self.seed = self.seed, self.seed + 1
        asked = Readings(wi, wo, average_repeats=True)
        return asked.measured(self.material, noise=self.noise, floor=self.floor, seed=seed,
                              outliers=self.outliers).values
