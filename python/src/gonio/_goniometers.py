"""Goniometers: what an instrument can reach, how it reads, and how long that takes."""
from __future__ import annotations

import json
import os
from typing import Any, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array, from_pairs, numbers, pairs
from ._exceptions import ArgumentError, MismatchError
from ._materials import as_material, causes
from ._plans import Plan
from ._readings import Readings

Path = Union[str, "os.PathLike[str]"]
_FREEDOMS = ((False, False, False), (True, False, False), (True, True, False))  # the least first


def goniometers() -> list[str]:
    """The built-in goniometers: words for `Goniometer`."""
    return _calls.listed(lib.gonio_instrument_word)


@_calls.free_of_change
class Goniometer:
    """An instrument as its file describes it: axes, limits, noise, apertures, times.

    Plans are made for it (``basis.plan(instrument=rig, budget=2700.0)``), and runs rehearsed.

    Parameters
    ----------
    source : path, str or mapping
        A file, one of `goniometers`, or what a file holds, as a dictionary (docs/instrument.md).

    Attributes
    ----------
    name, comment, kinematics : str
    axes : list of str
        The axes that it has; positions of them are columns in this order.
    noise : float
        Standard deviation relative to the value; ``reconstruct(noise=rig.noise, floor=rig.floor)``.
    floor, dark, stray, saturation : float
        Additive noise, dark level, stray light, and the largest value that is read (inf for any), 1/sr.
    drift : float
        Relative change of the sensitivity in an hour.
    exposure : float
        Seconds of a reading.
    wavelengths : list of float
        nm; empty without.

    Raises FormatError for an unknown or missing key, DataError for contradictions and for what reaches nothing. The
    message names the key. It never changes; it can be pickled, as its description or the path of its file.

    Source: ``gonio/instrument.h``.
    """

    def __init__(self, source: Union[Path, Mapping[str, Any]]) -> None:
        self._source = dict(source) if isinstance(source, Mapping) else source
        if isinstance(self._source, dict):
            try:
                text = json.dumps(self._source)
            except (TypeError, ValueError) as error:
                raise ArgumentError(f"source is no description of an instrument: {error}") from None
            self._goniometer = _calls.made("instrument", lib.gonio_instrument_parse, text.encode(), b"goniometer")
        else:
            self._goniometer = _calls.made("instrument", lib.gonio_instrument_read, _calls.encoded(self._source))
        view = self._view = lib.gonio_instrument_describe(self._goniometer)
        self.name, self.comment = _calls.text(view.name), _calls.text(view.comment)
        self.kinematics = _calls.text(view.kinematics)
        self._present = [k for k in range(view.axes) if view.axis[k].present]
        self.axes = [_calls.text(view.axis[k].name) for k in self._present]
        self.noise, self.floor, self.dark, self.stray = view.noise, view.floor, view.dark, view.stray
        self.saturation, self.drift, self.exposure = view.saturation, view.drift, view.exposure
        known = range(view.channels if view.wavelength != ffi.NULL else 0)
        self.wavelengths = [float(view.wavelength[k]) for k in known]

    def __repr__(self) -> str:
        return f"<gonio.Goniometer: {self.name} ({self.kinematics}: {', '.join(self.axes)})>"

    def __reduce__(self) -> Any:
        return Goniometer, (self._source,)

    # -- reach --

    def survey(self) -> dict[str, Any]:
        """What it reaches of all pairs of directions, by projected solid angle, of an isotropic sample.

        Returns
        -------
        dict
            share : of the pairs, 0 to 1; 0 where only a plane or single directions can be read.
            theta_i, theta_o : the lowest and highest, radians.
            least_separation, least_from_specular : of light and detector, and from the mirror direction, radians.
            kept_out : what keeps the others out, and the share of each.
        """
        reach = ffi.new("gonio_reach *")
        _calls.run(lib.gonio_instrument_survey, self._goniometer, _freedom((True, True, True)), reach)
        return {"share": float(reach.share), "theta_i": tuple(reach.theta_i), "theta_o": tuple(reach.theta_o),
                "least_separation": float(reach.least_separation),
                "least_from_specular": float(reach.least_from_specular),
                "kept_out": {_calls.text(reach.obstacle[k]): float(reach.kept_out[k])
                             for k in range(reach.obstacles)}}

    def reaches(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Whether pairs of directions can be read, of an isotropic sample: (...) for wi and wo of (..., 3)."""
        at = pairs(wi, wo)
        flat = at.reshape(-1, 4)
        found = np.array([bool(self._settings(pair)) for pair in flat], dtype=bool)
        return found.reshape(at.shape[:-1])

    def positions(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """The positions of the axes that read directions soonest, one after another.

        Parameters
        ----------
        wi, wo : array_like, (n, 3)

        Returns
        -------
        ndarray, (n, len(axes))
            Radians. The sample is taken as isotropic: directions may be turned about the normal and mirrored.

        Raises MismatchError for directions that cannot be read; it names the first.
        """
        return self._columns(self._tour(_flat(wi, wo)))

    def directions_at(self, positions: npt.ArrayLike) -> Tuple[Array, Array]:
        """wi and wo, (n, 3) each, that positions of the axes, (n, len(axes)) in radians, read. They may be below the
        horizon."""
        given = numbers(positions, "positions")
        if given.ndim != 2 or given.shape[1] != len(self.axes):
            raise ArgumentError(f"positions has shape {given.shape}: it must be (n, {len(self.axes)}), for the axes "
                                f"{', '.join(self.axes)}")
        at = np.empty((len(given), 4))
        for k, row in enumerate(given):
            axis = np.zeros(lib.GONIO_MOST_AXES)
            axis[self._present] = row
            pair = lib.gonio_instrument_pair(self._goniometer, _calls.buffer(axis))
            at[k] = pair.incident.theta, pair.incident.phi, pair.outgoing.theta, pair.outgoing.phi
        return from_pairs(at)

    def obstacle(self, positions: npt.ArrayLike) -> list[Optional[str]]:
        """What keeps positions of the axes, (n, len(axes)) in radians, from being used: an axis, a limit, a zone,
        "horizon" or "footprint"; None where nothing does."""
        given = numbers(positions, "positions")
        at = pairs(*self.directions_at(given), below_is_wrong=False).reshape(-1, 4)
        made: list[Optional[str]] = []
        for row, pair in zip(given, at):
            one = ffi.new("gonio_setting *")
            _put(one, pair, row, self._present)
            made.append(_calls.text(lib.gonio_instrument_obstacle(self._goniometer, one)) or None)
        return made

    def _settings(self, pair: Any) -> list[Any]:
        """All settings (gonio_setting *) that read a pair (4,) with the least freedom that has any."""
        found = ffi.new("gonio_setting[]", lib.GONIO_MOST_SETTINGS)
        one = ffi.new("gonio_pair *", {"incident": {"theta": pair[0], "phi": pair[1]},
                                       "outgoing": {"theta": pair[2], "phi": pair[3]}})
        for freedom in _FREEDOMS:
            count = lib.gonio_instrument_settings(self._goniometer, one[0], _freedom(freedom), found,
                                                  lib.GONIO_MOST_SETTINGS)
            if count:
                return [ffi.new("gonio_setting *", found[k]) for k in range(count)]
        return []

    def _all_settings(self, at: Array) -> list[list[Any]]:
        made = [self._settings(pair) for pair in at]
        missing = [k for k, settings in enumerate(made) if not settings]
        if missing:
            angles = ", ".join(f"{np.degrees(angle):.4g}" for angle in at[missing[0]])
            raise MismatchError(f"{self.name}: it cannot read direction {missing[0]} (theta_i, phi_i, theta_o, phi_o "
                                f"{angles} degrees), nor {len(missing) - 1} others of {len(at)}; plan with instrument")
        return made

    def _home(self) -> Any:
        home = ffi.new("gonio_setting *")
        lib.gonio_instrument_home(self._goniometer, home)
        return home

    def _tour(self, at: Array) -> Any:
        """The settings (gonio_setting[]) that read directions in their order."""
        before = self._home()
        made = ffi.new("gonio_setting[]", max(len(at), 1))
        for k, settings in enumerate(self._all_settings(at)):
            travel = [lib.gonio_instrument_travel(self._goniometer, before, one) for one in settings]
            made[k] = settings[int(np.argmin(travel))][0]
            before = ffi.addressof(made, k)
        return made

    def _columns(self, settings: Any) -> Array:
        rows = [[settings[k].axis[j] for j in self._present] for k in range(len(settings))]
        return np.array(rows, dtype=np.float64).reshape(-1, len(self.axes))

    # -- readings and time --

    def deviation(self, values: npt.ArrayLike) -> Array:
        """Standard deviations of readings of BRDF values, 1/sr."""
        value = numbers(values, "values")
        made = np.hypot(self.noise * value, self.floor)
        return np.asarray(made, dtype=np.float64)

    def times(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> Array:
        """When the exposure of each reading ends, seconds from the start, if directions (n, 3) are read in their
        order: with moves, settling, changes of incidence and references."""
        at = _flat(wi, wo)
        settings = self._tour(at)
        time = np.empty(len(at))
        lib.gonio_instrument_schedule(self._goniometer, settings, len(at), _calls.buffer(time))
        return time

    def order(self, wi: npt.ArrayLike, wo: npt.ArrayLike) -> npt.NDArray[np.intp]:
        """The order of directions (n, 3) in which a run takes the least time, from where a run starts."""
        at = _flat(wi, wo)
        settings = self._all_settings(at)
        first = np.concatenate([[0], np.cumsum([len(one) for one in settings])]).astype(np.uintp)
        flat = ffi.new("gonio_setting[]", [one[0] for group in settings for one in group])
        found = np.empty(len(at), np.uintp)
        chosen = ffi.new("gonio_setting[]", len(at))
        _calls.run(lib.gonio_instrument_order, self._goniometer, flat, _calls.buffer(first, "size_t"), len(at), ffi.NULL,
                   _calls.buffer(found, "size_t"), chosen)
        return found.astype(np.intp)

    def rehearse(self, plan: Union[Plan, Readings], material: Any, path: Path, *, seed: int = 0) -> Readings:
        """Writes what it would write when it reads a material by a plan, and reads that.

        Values are means over the apertures, with noise, drift, dark level, stray light and saturation, in its kind of
        values; the file has times and lines of the reference and the dark level.

        Parameters
        ----------
        plan : Plan or Readings
            Whose directions are read, in this order.
        material : Material, or what it is made of
        path : path
            The CSV file.
        seed : int
            The same seed gives the same noise.

        Returns
        -------
        Readings
            The readings of the file, corrected for drift and dark level as its lines allow.

        Raises
        ------
        MismatchError
            A direction cannot be read.
        """
        asked = Readings.of_plan(plan) if isinstance(plan, Plan) else plan
        sample = as_material(material)
        with causes(sample):
            _calls.run(lib.gonio_rehearse, asked._handle, sample._handle, self._goniometer, int(seed), b"",
                       _calls.encoded(path), ffi.NULL, ffi.NULL)
        return Readings.load(path, average_repeats=True, negative_to_zero=True)


def _freedom(which: Sequence[bool]) -> Any:
    isotropic, bilateral, reciprocal = which
    return ffi.new("gonio_freedom *", {"isotropic": isotropic, "bilateral": bilateral, "reciprocal": reciprocal})[0]


def _flat(wi: Any, wo: Any) -> Array:
    at = pairs(wi, wo)
    if at.ndim != 2 or len(at) == 0:
        raise ArgumentError(f"wi and wo have together the shape {at.shape[:-1] + (3,)}: give (n, 3), n at least 1")
    return at


def _put(setting: Any, pair: Any, positions: Any, present: Sequence[int]) -> None:
    for name, first in (("incident", 0), ("outgoing", 2)):
        angles = getattr(setting.pair, name)
        angles.theta, angles.phi = float(pair[first]), float(pair[first + 1])
    for k, position in zip(present, positions):
        setting.axis[k] = float(position)
