"""Errors: how far one BRDF is from another, by every metric."""
from __future__ import annotations

import os
from typing import Any, Iterator, Mapping, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array
from ._exceptions import ArgumentError
from ._materials import as_material, causes
from ._plans import metrics
from ._readings import Readings


def _values(error: Any) -> dict[str, float]:
    return {name: float(error.value[k]) for k, name in enumerate(metrics())}


class Errors(Mapping[str, float]):
    """Errors by the names of `metrics`: ``errors["e6"]``, in per cent, "log-relative" in natural log units.

    Attributes
    ----------
    channels : dict of ndarray, (3,), or None
        The errors of each channel alone; None of readings.
    compared : int
        Bins or readings that count.
    missing : int
        Bins with data in the reference only.
    """

    def __init__(self, values: dict[str, float], channels: Optional[dict[str, Array]], compared: int,
                 missing: int) -> None:
        self._values, self.channels, self.compared, self.missing = values, channels, compared, missing

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return "Errors(" + ", ".join(f"{name}={value:.4g}" for name, value in self.items()) + ")"


def errors(reference: Any, other: Any, *, left_out: Optional[npt.ArrayLike] = None) -> Errors:
    """How far `other` is from `reference`.

    Parameters
    ----------
    reference, other : Material, Readings, Reconstruction, or what a material is made of
        Two materials are compared over all bins where both have data. If one of them is readings, the other is looked
        up or evaluated at their directions.
    left_out : array_like of bool, (n,), optional
        Of readings: those that do not count, for they were used.

    Returns
    -------
    Errors

    Source: ``gonio/evaluate.h`` (gonio_compare, gonio_compare_readings).
    """
    if isinstance(reference, Readings) or isinstance(other, Readings):
        return _of_readings(reference, other, left_out)
    if left_out is not None:
        raise ArgumentError("left_out is of readings; two materials are compared over all bins")
    first, second = as_material(reference), as_material(other)
    found = _calls.struct("gonio_comparison")
    with causes(first, second):
        _calls.run(lib.gonio_compare, first._handle, second._handle, found)
    by_channel = [_values(found.channel[c]) for c in range(lib.GONIO_CHANNELS)]
    channels = {name: np.array([e[name] for e in by_channel]) for name in metrics()}
    return Errors(_values(found.all), channels, int(found.bins), int(found.missing))


def _of_readings(reference: Any, other: Any, left_out: Any) -> Errors:
    places = reference if isinstance(reference, Readings) else other
    a, b = (_at(places, given) for given in (reference, other))
    _calls.run(lib.gonio_readings_share_channels, a, b)
    skipped = None
    if left_out is not None:
        skipped = np.ascontiguousarray(left_out, dtype=np.bool_)
        if skipped.shape != (len(places),):
            raise ArgumentError(f"left_out has shape {skipped.shape}: it needs {(len(places),)}")
    error, compared = _calls.struct("gonio_error"), ffi.new("size_t *")
    _calls.run(lib.gonio_compare_readings, a, b, _calls.buffer(skipped, "bool"), error, compared)
    return Errors(_values(error), None, int(compared[0]), 0)


def _at(places: Readings, given: Any) -> Any:
    """A handle of readings of something at the places."""
    if given is places:
        return places._copy()
    found = places.looked_up(given) if isinstance(given, Readings) else places.measured(given)
    return found._copy()


def file_kind(path: "str | os.PathLike[str]") -> Tuple[str, str]:
    """What a file is, by its content: its kind ("material", "basis", "readings", "mesh", "image", or "" if unknown) and
    its format in words."""
    kind, name = ffi.new("gonio_kind *"), ffi.new("char **")
    _calls.run(lib.gonio_file_kind, _calls.encoded(path), kind, name)
    return _calls.text(lib.gonio_kind_name(kind[0])), _calls.text(name[0])
