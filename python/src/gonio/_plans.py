"""Plans: where to measure, in order."""
from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array, from_pairs, pairs, split
from ._exceptions import ArgumentError

_ENTRY = np.dtype({"names": ["cell", "channel", "pair"], "formats": [np.int32, np.int32, (np.float64, 4)],
                   "offsets": [ffi.offsetof("gonio_plan_entry", name) for name in ("cell", "channel", "pair")],
                   "itemsize": ffi.sizeof("gonio_plan_entry")})


def metrics() -> list[str]:
    """The error metrics: names for `metric`, and the keys of `errors`."""
    names: list[str] = []
    while (metric := lib.gonio_metric_describe(len(names))) != ffi.NULL:
        names.append(_calls.text(metric.name))
    return names


def planning_methods() -> list[str]:
    """The methods of `Basis.plan`."""
    return _calls.listed(lib.gonio_plan_method_name)


def plan_options(n: Optional[int], instrument: Any, metric: str, target_error: Optional[float], candidates: Any,
                 **others: Any) -> tuple[Any, Any]:
    """gonio_plan_options, and what it points to."""
    place = lib.gonio_metric_find(str(metric).encode(errors="replace"))
    if place < 0:
        raise ArgumentError(f"metric is {metric!r}: choose one of {', '.join(metrics())}")
    if n is not None and _calls.number(n, "n", 1, "a whole number of readings, at least 1") % 1.0 != 0.0:
        raise ArgumentError(f"n is {n}: it must be a whole number of readings")
    error = None if target_error is None else _calls.number(target_error, "target_error", 0.0, "an error in per cent")
    if error == 0.0:
        raise ArgumentError("target_error is 0: it must be an error in per cent, above 0")
    if candidates is None and instrument is not None:
        candidates = getattr(instrument, "directions", None)
    at = None
    if candidates is not None:
        at = pairs(*split(candidates)).reshape(-1, 4)
        if len(at) == 0:
            raise ArgumentError("candidates is empty: give at least one pair of directions, or None for any")
    words = {name: ffi.new("char[]", str(others[name]).encode(errors="replace")) for name in ("method", "start")
             if others.get(name) is not None}
    fields = {**others, **words, "count": None if n is None else int(n), "metric": place, "target": error}
    if at is not None:
        fields.update(candidates=_calls.buffer(at, "gonio_pair"), candidate_count=len(at))
    return _calls.options("plan", **fields), (at, words)


@_calls.free_of_change
class Plan:
    """Where to measure: columns as arrays, a reading in each row.

    Made by `Basis.plan` and `Reconstruction.next`. It never changes; it can be pickled.

    Attributes
    ----------
    wi, wo : ndarray, (n, 3)
        Unit vectors towards light and viewer.
    theta_i, phi_i, theta_o, phi_o : ndarray, (n,)
        The same, radians.
    channel : ndarray of int, (n,)
        The channel to be read, -1 for all.
    cell : ndarray of int, (n,)
        The cell of the basis' grid.
    expected_error : ndarray, (n,), or None
        The expected error (E6) after each reading, per cent; None by methods that state none.
    condition_number : float
    method : str

    Source: ``gonio/plan.h``.
    """

    def __init__(self) -> None:
        raise TypeError("make a plan by Basis.plan or Reconstruction.next")

    @classmethod
    def _of(cls, handle: Any, keep: Any = None) -> "Plan":
        made = cls.__new__(cls)
        made._handle, made._keep = handle, keep
        n = int(handle.count)
        entries = _calls.view(made, handle.entries, (n * _ENTRY.itemsize,), np.uint8)
        table = entries.view(_ENTRY) if n else np.empty(0, _ENTRY)
        made.cell, made.channel = table["cell"].copy(), table["channel"].copy()
        made._pairs = table["pair"].copy()
        made.theta_i, made.phi_i, made.theta_o, made.phi_o = made._pairs.T
        made.wi, made.wo = from_pairs(made._pairs)
        made.expected_error = None
        if handle.expected != ffi.NULL:
            made.expected_error = np.array(_calls.view(made, handle.expected, (n,)))
        made.condition_number = float(handle.condition_number)
        made.method = _calls.text(handle.method)
        return made

    _handle: Any
    _keep: Any
    _pairs: Array
    cell: npt.NDArray[np.int32]
    channel: npt.NDArray[np.int32]
    theta_i: Array
    phi_i: Array
    theta_o: Array
    phi_o: Array
    wi: Array
    wo: Array
    expected_error: Optional[Array]
    condition_number: float
    method: str

    def __len__(self) -> int:
        return len(self.cell)

    def __repr__(self) -> str:
        error = "" if self.expected_error is None or not len(self) else (
            f", expected error (E6) {self.expected_error[-1]:.2f} %")
        return f"<gonio.Plan: {len(self)} readings by {self.method}{error}>"

    @property
    def directions(self) -> Array:
        """wi and wo side by side, (n, 6), as `Regressor.fit` takes them."""
        return np.hstack([self.wi, self.wo])

    def columns(self) -> dict[str, Any]:
        """The columns of the file by name; angles in degrees."""
        made: dict[str, Any] = {f"{name}_deg": np.degrees(getattr(self, name))
                                for name in ("theta_i", "phi_i", "theta_o", "phi_o")}
        made["channel"] = np.array(["R", "G", "B", "all"])[self.channel]
        if self.expected_error is not None:
            made["expected_e6_percent"] = self.expected_error
        return made

    def to_csv(self, path: Union[str, "os.PathLike[str]"], *, command: str = "") -> None:
        """Writes the plan as CSV, angles in degrees, with comments that name basis and method; whole or not at all."""
        _calls.run(lib.gonio_plan_write, self._handle, command.encode(), _calls.encoded(path))

    def to_pandas(self) -> Any:
        """The columns of the file as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self.columns())

    def _repr_html_(self) -> str:
        names = list(self.columns())
        rows = zip(*self.columns().values())
        cells = "".join("<tr>" + "".join(f"<td>{v:.3f}</td>" if isinstance(v, float) else f"<td>{v}</td>" for v in row)
                        + "</tr>" for row in rows)
        head = "".join(f"<th>{name}</th>" for name in names)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{cells}</tbody></table>"

    def __reduce__(self) -> Any:
        plan = self._handle
        fields = {"components": int(plan.components), "condition_number": self.condition_number,
                  "basis": int(plan.basis), "method": self.method.encode(), "tests": int(plan.tests)}
        return _rebuild, (self.cell, self.channel, self._pairs, self.expected_error, fields)


def _rebuild(cell: Any, channel: Any, at: Any, expected: Any, fields: dict[str, Any]) -> Plan:
    """A pickled plan again; its memory is Python's."""
    table = np.zeros(len(cell), _ENTRY)
    table["cell"], table["channel"], table["pair"] = cell, channel, at
    plan = _calls.struct("gonio_plan", count=len(cell), **fields)
    plan.entries = _calls.buffer(table, "gonio_plan_entry")
    errors = None if expected is None else np.array(expected)
    plan.expected = _calls.buffer(errors)
    return Plan._of(plan, (table, errors))
