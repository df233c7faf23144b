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


def _run_options(instrument: Any, candidates: Any, budget: Optional[float], nested: bool) -> dict[str, Any]:
    """The options of plans for a goniometer."""
    handle = getattr(instrument, "_goniometer", None)
    if handle is None:
        if budget is not None or nested:
            raise ArgumentError("budget and nested need a gonio.Goniometer as instrument")
        return {}
    if candidates is not None:
        raise ArgumentError("give a goniometer as instrument, or candidates, not both")
    seconds = None if budget is None else _calls.number(budget, "budget", 1e-3, "a time in seconds, above 0")
    return {"instrument": handle, "budget": seconds, "nested": bool(nested)}


def plan_options(n: Optional[int], instrument: Any, metric: str, target_error: Optional[float], candidates: Any,
                 budget: Optional[float] = None, nested: bool = False, **others: Any) -> tuple[Any, Any]:
    """gonio_plan_options, and what it points to."""
    others.update(_run_options(instrument, candidates, budget, nested))
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
    return _calls.options("plan", **fields), (at, words, instrument)


class Run:
    """How a goniometer makes the readings of a plan, which are in this order.

    Attributes
    ----------
    instrument : str
        Its name.
    axes : list of str
    positions : ndarray, (n, len(axes))
        Radians.
    times : ndarray, (n,)
        Seconds from the start to the end of each reading.
    duration, unordered : float
        Seconds of the run, and of the same readings in the order in which they were chosen.
    free_expected_error : float
        The expected error (E6) of as many readings anywhere, per cent; NaN if it was not looked for.
    parts : list of dict
        Of all pairs of directions, the part that is reached and those that are not: obstacle ("" for none), share,
        deviation (relative to the BRDF) after the plan.
    """

    instrument: str
    axes: list[str]
    positions: Array
    times: Array
    duration: float
    unordered: float
    free_expected_error: float
    parts: list[dict[str, Any]]

    def __init__(self, **fields: Any) -> None:
        self.__dict__.update(fields)

    def __repr__(self) -> str:
        return f"<gonio.Run: {len(self.times)} readings of the {self.instrument} in {self.duration / 60.0:.1f} min>"

    @classmethod
    def _of(cls, run: Any, count: int) -> "Run":
        shown = [k for k in range(run.axes) if run.shown[k]]
        positions = [[run.setting[k].axis[j] for j in shown] for k in range(count)]
        parts = [{"obstacle": _calls.text(part.obstacle), "share": float(part.share),
                  "deviation": float(part.deviation)} for part in (run.part[k] for k in range(run.parts))]
        return cls(instrument=_calls.text(run.instrument), axes=[_calls.text(run.axis[k]) for k in shown],
                   positions=np.array(positions, dtype=np.float64).reshape(count, len(shown)),
                   times=np.array([run.time[k] for k in range(count)]), duration=float(run.duration),
                   unordered=float(run.unordered), free_expected_error=float(run.free_expected), parts=parts)

    def _struct(self, at: Array) -> tuple[Any, Any]:
        """gonio_plan_run again, and what it points to."""
        run = _calls.struct("gonio_plan_run", instrument=self.instrument.encode(), axes=len(self.axes),
                            duration=self.duration, unordered=self.unordered, free_expected=self.free_expected_error,
                            parts=len(self.parts))
        settings = ffi.new("gonio_setting[]", len(at))
        times = np.array(self.times)
        for k, name in enumerate(self.axes):
            run.axis[k], run.shown[k] = name.encode(), True
        for k, part in enumerate(self.parts):
            run.part[k] = {**part, "obstacle": part["obstacle"].encode()}
        for k, pair in enumerate(at):
            settings[k].pair.incident.theta, settings[k].pair.incident.phi = pair[0], pair[1]
            settings[k].pair.outgoing.theta, settings[k].pair.outgoing.phi = pair[2], pair[3]
            for j in range(len(self.axes)):
                settings[k].axis[j] = self.positions[k, j]
        run.setting, run.time = settings, _calls.buffer(times)
        return run, (settings, times)


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
    run : Run or None
        How a goniometer makes it; None without one.

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
        made.run = None if handle.run == ffi.NULL else Run._of(handle.run, n)
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
    run: Optional[Run]

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
        if self.run is not None:
            made.update({f"axis_{name}_deg": column for name, column in zip(self.run.axes, np.degrees(
                self.run.positions).T)})
            made["time_s"] = self.run.times
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
        return _rebuild, (self.cell, self.channel, self._pairs, self.expected_error, fields, self.run)


def _rebuild(cell: Any, channel: Any, at: Any, expected: Any, fields: dict[str, Any], run: Optional[Run]) -> Plan:
    """A pickled plan again; its memory is Python's."""
    table = np.zeros(len(cell), _ENTRY)
    table["cell"], table["channel"], table["pair"] = cell, channel, at
    plan = _calls.struct("gonio_plan", count=len(cell), **fields)
    plan.entries = _calls.buffer(table, "gonio_plan_entry")
    errors = None if expected is None else np.array(expected)
    plan.expected = _calls.buffer(errors)
    of_run, kept = (ffi.NULL, None) if run is None else run._struct(at)
    plan.run = of_run
    return Plan._of(plan, (table, errors, of_run, kept))
