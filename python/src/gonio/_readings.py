"""Readings: values at pairs of directions, from arrays or from the files of instruments."""
from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array, from_pairs, numbers, pairs
from ._exceptions import ArgumentError
from ._materials import as_material, causes
from ._plans import Plan

Path = Union[str, "os.PathLike[str]"]


def _table(value: Any, name: str, count: int, channels: Optional[int] = None) -> Array:
    """An argument (count, channels), or (count,) for one channel."""
    array = numbers(value, name)
    if array.ndim == 1:
        array = array[:, np.newaxis]
    if array.ndim != 2 or len(array) != count or array.shape[1] == 0 or channels not in (None, array.shape[1]):
        wanted = f"({count}, {'channels' if channels is None else channels})"
        raise ArgumentError(f"{name} has shape {np.shape(value)}: {count} directions need {wanted}, or ({count},) for "
                            f"a single channel")
    return np.ascontiguousarray(array)


def _broadcast(value: Any, name: str, shape: tuple[int, ...]) -> Array:
    array = numbers(value, name)
    if array.ndim == 1 and len(array) == shape[0]:
        array = array[:, np.newaxis]
    try:
        return np.ascontiguousarray(np.broadcast_to(array, shape))
    except ValueError:
        raise ArgumentError(f"{name} has shape {array.shape}: it must be {shape}, or broadcast to it") from None


@_calls.free_of_change
class Readings:
    """Values of a material at pairs of directions, in colours, at wavelengths, or from a single sensor.

    Parameters
    ----------
    wi, wo : array_like, (n, 3)
        Unit vectors towards light and viewer; n is at least 1.
    values : array_like, (n, channels) or (n,), optional
        1/sr, NaN where nothing was read. None for directions alone.
    noise : array_like, optional
        Standard deviations of the values, 1/sr; broadcast against them. NaN where not known.
    wavelengths : array_like, (channels,), optional
        nm. Without, three channels are R, G, B.
    average_repeats : bool
        Accept a direction that was read more than once in the same channel.
    negative_to_zero : bool
        Take values below zero as 0, rather than refuse them.

    Raises ArgumentError for shapes that do not fit, DataError for values that are negative or infinite and for
    directions that were read twice.

    They never change and can be pickled, without the comments of their file.

    Source: ``gonio/measurement.h``.
    """

    def __init__(self, wi: npt.ArrayLike, wo: npt.ArrayLike, values: Optional[npt.ArrayLike] = None, *,
                 noise: Optional[npt.ArrayLike] = None, wavelengths: Optional[npt.ArrayLike] = None,
                 average_repeats: bool = False, negative_to_zero: bool = False) -> None:
        at = pairs(wi, wo)
        if at.ndim != 2 or len(at) == 0:
            raise ArgumentError(f"wi and wo have together the shape {at.shape[:-1] + (3,)}: readings need (n, 3), n at "
                                f"least 1")
        nm = None if wavelengths is None else np.ascontiguousarray(numbers(wavelengths, "wavelengths").ravel())
        value = None if values is None else _table(values, "values", len(at), None if nm is None else len(nm))
        channels = 3 if value is None and nm is None else len(nm) if value is None else value.shape[1]  # type: ignore
        spread = None if noise is None else _broadcast(noise, "noise", (len(at), channels))
        self._make(at, value, spread, nm, channels, average_repeats, negative_to_zero)

    def _make(self, at: Array, value: Any, spread: Any, nm: Any, channels: int, average_repeats: bool,
              negative_to_zero: bool) -> None:
        arrays = _calls.struct(
            "gonio_readings_arrays", count=len(at), channels=channels, pair=_calls.buffer(at, "gonio_pair"),
            wavelength=_calls.buffer(nm), value=_calls.buffer(value), deviation=_calls.buffer(spread))
        how = _calls.options("readings", average_repeats=average_repeats, negative_to_zero=negative_to_zero)
        self._handle = _calls.made("readings", lib.gonio_readings_create, arrays, how)
        self._view = lib.gonio_readings_describe(self._handle)

    @classmethod
    def _of(cls, handle: Any) -> "Readings":
        made = cls.__new__(cls)
        made._handle = handle
        made._view = lib.gonio_readings_describe(handle)
        return made

    _handle: Any
    _view: Any

    @classmethod
    def load(cls, path: Path, *, convention: str = "", values_needed: bool = True, average_repeats: bool = False,
             negative_to_zero: bool = False, instrument: Any = None) -> "Readings":
        """Reads a file: CSV, Zemax BSDF, FRED, ALTA, pab-opto, ASTM E1392, TracePro, BRDF JSON and others, told by its
        content. What it was taken for is in `notes`.

        Parameters
        ----------
        path : path
        convention : str
            What its numbers stand for, where it is other than it says: ``"angles=radians,values=factor,mirror=0"``.
        values_needed : bool
            False: a plan will do.
        average_repeats, negative_to_zero : bool
            As of `Readings`.
        instrument : Goniometer, optional
            What made the readings. Numbers of a table that does not say what they stand for are its kind of values,
            otherwise the BRDF. Relative values and counts are converted by its reference factors and counts.

        Raises
        ------
        FormatError, DataError
            The message names the line.
        FileError
            The file is missing or unreadable.
        """
        how = _calls.options("readings", values_needed=values_needed, average_repeats=average_repeats,
                             negative_to_zero=negative_to_zero)
        if convention:
            _calls.run(lib.gonio_convention_parse, convention.encode(), ffi.addressof(how, "as"))
        if instrument is not None:
            how.instrument = instrument._goniometer
        return cls._of(_calls.made("readings", lib.gonio_readings_read, _calls.encoded(path), how))

    @classmethod
    def of_plan(cls, plan: Plan) -> "Readings":
        """The directions of a plan, without values."""
        return cls._of(_calls.made("readings", lib.gonio_readings_create_from_plan, plan._handle))

    def save(self, path: Path, *, command: str = "") -> None:
        """Writes the readings, as BRDF JSON if the path ends in .json or .brdf, otherwise as CSV."""
        _calls.run(lib.gonio_readings_write, self._handle, command.encode(), _calls.encoded(path))

    # -- what is in them --

    def __len__(self) -> int:
        return int(self._view.count)

    @property
    def channels(self) -> int:
        return int(self._view.channels)

    @property
    def pairs(self) -> Array:
        """theta and phi of light and viewer, radians, (n, 4), a view."""
        seen: Array = _calls.view(self, self._view.pair, (len(self), 4))
        return seen

    @property
    def wi(self) -> Array:
        """Unit vectors towards the light, (n, 3)."""
        return from_pairs(self.pairs)[0]

    @property
    def wo(self) -> Array:
        """Unit vectors towards the viewer, (n, 3)."""
        return from_pairs(self.pairs)[1]

    @property
    def values(self) -> Array:
        """1/sr, NaN where nothing was read, (n, channels), a view. Of a plan all are NaN."""
        seen: Array = _calls.view(self, self._view.value, (len(self), self.channels))
        return seen

    @property
    def noise(self) -> Optional[Array]:
        """Standard deviations, 1/sr, (n, channels), a view; None if none is known."""
        seen: Optional[Array] = _calls.view(self, self._view.deviation, (len(self), self.channels))
        return seen

    @property
    def wavelengths(self) -> Optional[Array]:
        """nm, (channels,), a view; None for colours and single sensors."""
        seen: Optional[Array] = _calls.view(self, self._view.wavelength, (self.channels,))
        return seen

    @property
    def times(self) -> Optional[Array]:
        """When each was read, seconds from any beginning, (n,), a view; None if it is not known."""
        seen: Optional[Array] = _calls.view(self, self._view.time, (len(self),))
        return seen

    @property
    def notes(self) -> list[str]:
        """What the reader of the file said: what it was taken for, what was left out."""
        return [_calls.text(self._view.note[k]) for k in range(self._view.notes)]

    def __repr__(self) -> str:
        return f"<gonio.Readings: {len(self)} directions, {self.channels} channels>"

    def survey(self) -> dict[str, Any]:
        """What they contain, before anything is done with them.

        Returns
        -------
        dict
            measured, empty : readings with a value, values that are missing.
            theta_i, theta_o, theta_h : least and most, radians.
            incidences : for each polar angle of the light a dict with theta_i, count, the share of the hemisphere that
            is covered, and the albedo of that part, (channels,) or None.
            repeats, repeats_percent : readings at the angles of an earlier one, and how far they differ (RMS).
            reciprocal_pairs, reciprocity_percent : the same with light and viewer exchanged.
            outliers : places of readings that are far from all around them, at most 16.
        """
        found = _calls.made("survey", lib.gonio_readings_survey, self._handle)
        numbers = ("measured", "empty", "in_plane", "repeats", "repeats_percent", "reciprocal_pairs",
                   "reciprocity_percent")
        made: dict[str, Any] = {name: getattr(found, name) for name in numbers}
        made.update({name: tuple(getattr(found, name)) for name in ("theta_i", "theta_o", "theta_h")})
        made["incidences"] = [self._incidence(found, found.incidence[k]) for k in range(found.incidences)]
        made["outliers"] = [int(found.outlier[k]) for k in range(min(found.outliers, lib.GONIO_MOST_OUTLIERS))]
        return made

    def _incidence(self, owner: Any, one: Any) -> dict[str, Any]:
        return {"theta_i": float(one.theta_i), "count": int(one.count), "covered": float(one.covered),
                "albedo": _copied(_calls.view(owner, one.albedo, (self.channels,)))}

    # -- other readings --

    def _copy(self) -> Any:
        return _calls.made("readings", lib.gonio_readings_copy, self._handle)

    def measured(self, material: Any, *, noise: float = 0.0, floor: float = 0.0, seed: int = 0,
                 outliers: float = 0.0) -> "Readings":
        """The same directions, read by the simulated instrument.

        Parameters
        ----------
        material : Material, or what it is made of
        noise : float
            Standard deviation relative to the value: 0.01 is 1 per cent.
        floor : float
            Standard deviation of the additive noise, 1/sr.
        seed : int
        outliers : float
            Share of directions, 0 to 1, where all values are ten times too large or too small.
        """
        how = _calls.options("instrument", noise=noise, floor=floor, seed=seed, outliers=outliers)
        sample, handle = as_material(material), self._copy()
        with causes(sample):
            _calls.run(lib.gonio_measure_material, handle, sample._handle, how)
        return Readings._of(handle)

    def looked_up(self, known: "Readings") -> "Readings":
        """The same directions, with the values that other readings of the same material have there."""
        handle = self._copy()
        _calls.run(lib.gonio_readings_look_up, handle, known._handle)
        return Readings._of(handle)

    def less_blank(self, blank: "Readings", *, noise: float = 0.01, floor: float = 1e-5) -> "Readings":
        """The same less a blank run: readings of a dark sample or a light trap, or with the lamp covered.

        A reading gets the blank of its own directions, otherwise the blank's median. The standard deviations hold that
        of the blank. Notes go to the logger; they say if the blank is brighter than the sample.

        Parameters
        ----------
        blank : Readings
            In the same channels.
        noise, floor : float
            Of readings without standard deviations of their own: relative, and 1/sr.
        """
        handle = self._copy()
        _calls.run(lib.gonio_readings_subtract_blank, handle, blank._handle,
                   _calls.number(noise, "noise", 0.0, "a finite number of 0 or more"),
                   _calls.number(floor, "floor", 0.0, "a finite number of 0 or more"))
        return Readings._of(handle)

    def times_reference(self, theta: npt.ArrayLike, factor: npt.ArrayLike) -> "Readings":
        """The same times the reflectance factor of the reference that they are relative to.

        Parameters
        ----------
        theta : array_like, (rows,)
            Polar angles of the viewer, radians.
        factor : array_like, (rows,)
            The reference's reflectance factors there: linear between rows, constant outside.
        """
        angle, value = numbers(theta, "theta").ravel(), numbers(factor, "factor").ravel()
        if len(angle) != len(value) or len(angle) == 0:
            raise ArgumentError(f"theta has {len(angle)} numbers and factor {len(value)}: give a factor for each angle")
        rows = ffi.new("gonio_reference_row[]", [{"theta": t, "factor": f} for t, f in sorted(zip(angle, value))])
        handle = self._copy()
        _calls.run(lib.gonio_readings_times_reference, handle, rows, len(rows))
        return Readings._of(handle)

    def __reduce__(self) -> Any:
        state = (self.pairs.copy(), _copied(self.values), _copied(self.noise), _copied(self.wavelengths))
        return _rebuild, (*state, self.channels)


def _copied(array: Optional[Array]) -> Optional[Array]:
    return None if array is None else array.copy()


def _rebuild(at: Any, value: Any, spread: Any, nm: Any, channels: int) -> Readings:
    made = Readings.__new__(Readings)
    made._make(at, value, spread, nm, channels, True, False)
    return made
