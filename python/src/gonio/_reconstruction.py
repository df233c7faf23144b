"""Reconstruction: from a few readings to the whole BRDF, with its uncertainty."""
from __future__ import annotations

import statistics
import threading
from typing import Any, Literal, Optional, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._bases import Basis, as_basis
from ._directions import Array, numbers, pairs
from ._exceptions import ArgumentError
from ._materials import Material
from ._plans import Plan, plan_options
from ._readings import Path, Readings


def reconstruction_methods() -> list[str]:
    """The methods of `reconstruct`."""
    return _calls.listed(lib.gonio_reconstruct_method_name)


def reconstruct(basis: Any, readings: Readings, *, noise: float = 0.01, floor: float = 1e-5, saturation: float = 0.0,
                method: Optional[str] = None, components: int = 0, eta: float = 40.0, all_channels: bool = False,
                other_basis: bool = False, checks: bool = True, source_aperture: float = 0.0,
                detector_aperture: float = 0.0) -> "Reconstruction":
    """Reconstructs a BRDF from readings.

    Parameters
    ----------
    basis : Basis, path or None
        None: `builtin_basis`.
    readings : Readings
    noise : float
        Standard deviation of a reading relative to its value: 0.01 is 1 per cent.
    floor : float
        Standard deviation of the additive noise, 1/sr. Readings with standard deviations of their own need neither.
    saturation : float
        1/sr; readings of this value or more are lower bounds; 0 for none.
    method : str, optional
        One of `reconstruction_methods`; by default what suits the basis, the posterior for one with mixtures.
    components : int
        K; 0 for the plan's, or all of the basis.
    eta : float
        Of ridge, above 0.
    all_channels : bool
        Use all that was read, not only the planned channel of each direction.
    other_basis : bool
        Accept readings that were planned with another basis.
    checks : bool
        Whether to look for usual mistakes (`Reconstruction.suspicion`) and for a dark level.
    source_aperture, detector_aperture : float
        Half angles in radians, below pi/4: each reading is the mean over these apertures, which is undone. Then mistakes
        and dark levels are not looked for.

    Returns
    -------
    Reconstruction

    Raises
    ------
    UndeterminedError
        Fewer independent readings than components, by other methods than the posterior.
    MismatchError
        The readings were planned with another basis.
    DataError
        A planned channel was not read, or there are no values.

    Source: ``gonio/reconstruct.h`` (gonio_reconstruct).
    """
    if not isinstance(readings, Readings):
        raise ArgumentError(f"readings is {type(readings).__name__}: make gonio.Readings(wi, wo, values), or load them")
    settings = dict(noise=noise, floor=floor, saturation=saturation, method=method, components=components, eta=eta,
                    all_channels=all_channels, other_basis=other_basis, checks=checks, source_aperture=source_aperture,
                    detector_aperture=detector_aperture)
    return Reconstruction._solve(as_basis(basis), readings, settings)


@_calls.free_of_change
class Reconstruction:
    """A BRDF that was reconstructed from readings. Made by `reconstruct` and `Regressor.fit`.

    It never changes. Pickling keeps basis, readings and settings; it is solved again when it is loaded.

    Attributes
    ----------
    basis : Basis
    readings : Readings

    Source: ``gonio/reconstruct.h``.
    """

    def __init__(self) -> None:
        raise TypeError("make a reconstruction by gonio.reconstruct or gonio.Regressor.fit")

    basis: Basis
    readings: Readings

    @classmethod
    def _solve(cls, basis: Basis, readings: Readings, settings: dict[str, Any]) -> "Reconstruction":
        made = cls.__new__(cls)
        made.basis, made.readings, made._settings = basis, readings, settings
        made._handle = made._solved(False)
        made._deviating = made._made = None
        made._lock = threading.Lock()
        return made

    _settings: dict[str, Any]
    _handle: Any
    _deviating: Any
    _made: Optional[Material]
    _lock: Any

    def _solved(self, deviation: bool) -> Any:
        how, _word = self._options()
        how.deviation = deviation
        return _calls.made("reconstruction", lib.gonio_reconstruct, self.basis._handle, self.readings._handle, how)

    def _with_deviation(self) -> Any:
        """The same with standard deviations, which take several times as long: solved when they are first needed."""
        if not self._has_field:
            raise ArgumentError("standard deviations need the posterior method, which a basis with mixtures has")
        with self._lock:
            if self._deviating is None:
                self._deviating = self._solved(True)
            return self._deviating

    def _options(self) -> tuple[Any, Any]:
        given = dict(self._settings)
        method = given.pop("method")
        word = ffi.NULL if method is None else ffi.new("char[]", str(method).encode(errors="replace"))
        checks = given.pop("checks")
        for name in ("noise", "floor", "saturation", "eta"):
            given[name] = _calls.number(given[name], name, 0.0, "a finite number of 0 or more")
        return _calls.options("reconstruct", method=word, no_checks=not checks, **given), word

    # -- what was found --

    @property
    def expected_error(self) -> float:
        """The expected error (E6), per cent; NaN by other methods than the posterior."""
        return float(self._handle.predicted_e6) if self._has_field else float("nan")

    @property
    def suspicion(self) -> Optional[str]:
        """A usual mistake that explains the readings far better, such as wrong units; None if there is none."""
        return _calls.text(self._handle.suspicion) or None

    @property
    def _has_field(self) -> bool:
        return bool(self._handle.field != ffi.NULL)

    @property
    def channels(self) -> int:
        """Channels of `predict`."""
        return 3 if self.basis.channel_model == "joint" else int(self._handle.columns)

    @property
    def wavelengths(self) -> Optional[Array]:
        """nm, (channels,), a view; None without."""
        seen: Optional[Array] = _calls.view(self, self._handle.wavelength, (int(self._handle.wavelengths),))
        return seen

    @property
    def coefficients(self) -> Array:
        """c, (columns, components), a view."""
        seen: Array = _calls.view(self, self._handle.coefficients, (self._handle.columns, self._handle.components))
        return seen

    @property
    def field(self) -> Optional[Array]:
        """g in every row of the basis, log units, (columns, rows), a view; None by other methods than the posterior."""
        seen: Optional[Array] = _calls.view(self, self._handle.field, (self._handle.columns, self.basis.rows))
        return seen

    @property
    def field_std(self) -> Optional[Array]:
        """The standard deviation of `field`, log units, a view; None by other methods. Computed when first needed."""
        if not self._has_field:
            return None
        seen: Array = _calls.view(self, self._with_deviation().deviation, (self._handle.columns, self.basis.rows))
        return seen

    @property
    def dark(self) -> Optional[Array]:
        """The dark level that the instrument subtracts in excess, 1/sr, (columns,), a view; None if there is none."""
        seen: Optional[Array] = _calls.view(self, self._handle.dark, (self._handle.columns,))
        return seen

    @property
    def residual(self) -> float:
        """Root mean square of readings less prediction, log units."""
        return float(self._handle.residual)

    @property
    def condition_number(self) -> float:
        """kappa of the equations; 0 by the posterior."""
        return float(self._handle.condition_number)

    @property
    def smoothness(self) -> float:
        """Standard deviation of what the basis does not explain, log units."""
        return float(self._handle.smoothness)

    @property
    def surprise(self) -> float:
        """Root mean square error of leave-one-out predictions, in standard deviations; 1 if all is as expected."""
        return float(self._handle.surprise)

    @property
    def outlying(self) -> int:
        """Readings that the others contradict; they have almost no weight."""
        return int(self._handle.outlying)

    def __repr__(self) -> str:
        error = f", expected error (E6) {self.expected_error:.2f} %" if self._has_field else ""
        return f"<gonio.Reconstruction: {len(self.readings)} directions, {self.channels} channels{error}>"

    # -- values --

    @overload
    def predict(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, return_std: Literal[False] = False) -> Array: ...

    @overload
    def predict(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, return_std: Literal[True]) -> Tuple[Array, Array]: ...

    def predict(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, return_std: bool = False
                ) -> Union[Array, Tuple[Array, Array]]:
        """The BRDF at any directions.

        Parameters
        ----------
        wi, wo : array_like, (..., 3)
            Unit vectors towards light and viewer; they broadcast.
        return_std : bool
            Also return standard deviations.

        Returns
        -------
        values : ndarray, (..., channels)
            1/sr: the median of the posterior.
        std : ndarray, (..., channels)
            The standard deviation of a value, 1/sr, to first order: (value + s) times that of ln(1 + value/s). Use
            `interval` for bands.
        """
        at = pairs(wi, wo)
        value, spread = self._predict(at, return_std)
        if not return_std:
            return value
        return value, (value + self._scales(at)) * spread

    def interval(self, wi: npt.ArrayLike, wo: npt.ArrayLike, level: float = 0.95) -> Tuple[Array, Array]:
        """The central interval that holds a value with probability `level`.

        Parameters
        ----------
        wi, wo : array_like, (..., 3)
        level : float
            Between 0 and 1.

        Returns
        -------
        low, high : ndarray, (..., channels)
            1/sr; 0 or more. From the normal distribution of ln(1 + value/s).
        """
        if not 0.0 < _calls.number(level, "level", 0.0, "a probability between 0 and 1") < 1.0:
            raise ArgumentError(f"level is {level}: it must be a probability between 0 and 1")
        at = pairs(wi, wo)
        value, spread = self._predict(at, True)
        scale = self._scales(at)
        g, reach = np.log1p(value / scale), statistics.NormalDist().inv_cdf((1.0 + level) / 2.0) * spread
        return scale * np.expm1(np.maximum(g - reach, 0.0)), scale * np.expm1(g + reach)

    def _predict(self, at: Array, with_deviation: bool) -> tuple[Array, Array]:
        """Values, and standard deviations of ln(1 + value/s)."""
        made = self._with_deviation() if with_deviation else self._handle
        count, channels = at.size // 4, self.channels
        value = np.empty((*at.shape[:-1], channels))
        spread = np.empty(value.shape if with_deviation else 0)
        given = _calls.buffer(at, "gonio_pair")
        if self._has_field and count:
            lib.gonio_python_predict(self.basis._handle, made, given, count, channels, _calls.threads(),
                                     _calls.buffer(value), _calls.buffer(spread if with_deviation else None))
        elif count:
            _calls.run(lib.gonio_material_evaluate, self.material()._handle, given, count, _calls.buffer(value))
        return value, spread

    def _scales(self, at: Array) -> Array:
        """s of the log space at each pair, or for all pairs, (channels,)."""
        colours = self.wavelengths is None and self.channels == 3
        mapping = self.basis._view.mapping
        if mapping == lib.GONIO_LOG:
            return np.array([lib.gonio_log_scale(c if colours else -1) for c in range(self.channels)])
        scale = np.empty((*at.shape[:-1], self.channels))
        if scale.size:
            lib.gonio_python_scales(mapping, colours, _calls.buffer(at, "gonio_pair"), at.size // 4, self.channels,
                                    _calls.threads(), _calls.buffer(scale))
        return scale

    def predicted_readings(self, readings: Readings) -> Readings:
        """What the instrument would read at the directions of `readings`: the dark level is subtracted again. They have
        no deviations; see `predict`."""
        handle = readings._copy()
        _calls.run(lib.gonio_reconstruction_predict_readings, self.basis._handle, self._handle, handle)
        return Readings._of(handle)

    def reflectance(self, theta_i: npt.ArrayLike) -> Tuple[Array, Array]:
        """What share of the light from polar angles is reflected (directional-hemispherical reflectance, albedo).

        Parameters
        ----------
        theta_i : array_like, (...)
            Radians, from 0 to below pi/2.

        Returns
        -------
        reflectance, std : ndarray, (..., channels)
            The errors of all directions are taken as fully correlated, so that std is rather too large.

        Source: ``gonio/evaluate.h`` (gonio_reconstruction_reflectance).
        """
        theta = numbers(theta_i, "theta_i")
        made = self._with_deviation()
        value = np.empty((theta.size, self.channels))
        spread = np.empty_like(value)
        for k, angle in enumerate(theta.ravel()):
            one, deviation = np.empty(self.channels), np.empty(self.channels)
            _calls.run(lib.gonio_reconstruction_reflectance, self.basis._handle, made, float(angle),
                       _calls.buffer(one), _calls.buffer(deviation))
            value[k], spread[k] = one, deviation
        shape = (*theta.shape, self.channels)
        return value.reshape(shape), spread.reshape(shape)

    def material(self, name: str = "reconstruction") -> Material:
        """The reconstructed BRDF as a material: at its wavelengths if it has any, a table of R, G, B otherwise."""
        if name == "reconstruction" and self._made is not None:
            return self._made
        handle = _calls.made("material", lib.gonio_reconstruction_spectral_material, self.basis._handle, self._handle,
                             name.encode())
        made = Material._of(handle, self, (_material, (self, name), {}))
        self._made = made if name == "reconstruction" else self._made
        return made

    def deviation_material(self) -> Material:
        """The standard deviations of ln(1 + value/s) as a material: the numbers in its MERL file are the deviations."""
        handle = _calls.made("material", lib.gonio_reconstruction_deviation_material, self.basis._handle,
                             self._with_deviation())
        return Material._of(handle, self, (_deviation_material, (self,), {}))

    def save(self, path: Path, format: Optional[str] = None) -> None:
        """Writes the reconstructed BRDF, in one of `formats`; by default that of the path's extension."""
        self.material().save(path, format)

    # -- what to read next --

    def next(self, n: Optional[int] = None, *, target_error: Optional[float] = None, candidates: Any = None,
             instrument: Any = None, metric: str = "e6", budget: Optional[float] = None, nested: bool = False
             ) -> Optional[Plan]:
        """Plans the next readings of this material: those that leave the least expected error.

        Parameters
        ----------
        n : int, optional
            How many; 5 by default.
        target_error : float, optional
            The fewest with at most this expected error (E6), per cent.
        candidates, instrument, metric, budget, nested
            As of `Basis.plan`.

        Returns
        -------
        Plan or None
            None if the expected error is at most `target_error` already.

        Source: ``gonio/reconstruct.h`` (gonio_plan_next).
        """
        what, _keep = plan_options(n, instrument, metric, target_error, candidates, budget, nested)
        how, _word = self._options()
        made = _calls.made("plan", lib.gonio_plan_next, self.basis._handle, self.readings._handle, how, what, ffi.NULL,
                           ffi.NULL)
        return None if made is None else Plan._of(made)

    def __reduce__(self) -> Any:
        return Reconstruction._solve, (self.basis, self.readings, self._settings)


def _material(reconstruction: Reconstruction, name: str) -> Material:
    return reconstruction.material(name)


def _deviation_material(reconstruction: Reconstruction) -> Material:
    return reconstruction.deviation_material()
