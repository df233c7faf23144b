"""A regressor with scikit-learn's manners: from readings at directions to values at any others."""
from __future__ import annotations

import inspect
from typing import Any, Literal, Optional, Tuple, Union, overload

import numpy as np
import numpy.typing as npt

from ._bases import Basis, as_basis
from ._directions import Array, numbers, pairs, split
from ._exceptions import ArgumentError, DataError, NotFittedError
from ._readings import Path, Readings
from ._reconstruction import Reconstruction, reconstruct


class Regressor:
    """Completes a BRDF from readings, as a Gaussian process with a learned prior.

    It has scikit-learn's interface (`fit`, `predict`, `score`, `get_params`, `set_params`; it can be cloned, used in a
    Pipeline and searched over) without needing scikit-learn.

    Parameters
    ----------
    basis : Basis, path or None
        The prior. None: `builtin_basis`.
    noise : float
        Standard deviation of a reading relative to its value: 0.01 is 1 per cent.
    floor : float
        Standard deviation of the additive noise, 1/sr.
    saturation : float
        1/sr; readings of this value or more are lower bounds; 0 for none.
    wavelengths : array_like, optional
        nm, a channel each. Without, three channels are R, G, B.
    method : str, optional
        One of `reconstruction_methods`; by default what suits the basis.
    average_repeats : bool
        Accept directions that were read more than once.
    negative_to_zero : bool
        Take values below zero as 0, rather than refuse them.
    checks : bool
        Whether to look for usual mistakes in the readings; one that is found is a warning, and `suspicion_`.

    Attributes
    ----------
    reconstruction_ : Reconstruction
        What `fit` found: `expected_error`, `suspicion`, `next`.
    expected_error_ : float
        The expected error (E6), per cent.
    suspicion_ : str or None
    n_features_in_ : int
        6.

    Examples
    --------
    >>> model = gonio.Regressor("merl.gonio").fit((wi, wo), values)       # doctest: +SKIP
    >>> value, std = model.predict(wi_other, wo_other, return_std=True)   # doctest: +SKIP

    Source: ``gonio/reconstruct.h``.
    """

    _estimator_type = "regressor"

    def __init__(self, basis: Union[Basis, Path, None] = None, *, noise: float = 0.01, floor: float = 1e-5,
                 saturation: float = 0.0, wavelengths: Optional[npt.ArrayLike] = None, method: Optional[str] = None,
                 average_repeats: bool = False, negative_to_zero: bool = False, checks: bool = True) -> None:
        self.basis = basis
        self.noise = noise
        self.floor = floor
        self.saturation = saturation
        self.wavelengths = wavelengths
        self.method = method
        self.average_repeats = average_repeats
        self.negative_to_zero = negative_to_zero
        self.checks = checks

    # -- scikit-learn's manners --

    @classmethod
    def _names(cls) -> list[str]:
        return [name for name in inspect.signature(cls.__init__).parameters if name != "self"]

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters by name."""
        return {name: getattr(self, name) for name in self._names()}

    def set_params(self, **parameters: Any) -> "Regressor":
        """Sets parameters by name; returns itself."""
        for name, value in parameters.items():
            if name not in self._names():
                raise ArgumentError(f"Regressor has no parameter {name!r}: they are {', '.join(self._names())}")
            setattr(self, name, value)
        return self

    def __sklearn_tags__(self) -> Any:
        from sklearn.utils import RegressorTags, Tags, TargetTags

        return Tags(estimator_type="regressor", target_tags=TargetTags(required=True, multi_output=True),
                    regressor_tags=RegressorTags())

    def __sklearn_is_fitted__(self) -> bool:
        return hasattr(self, "reconstruction_")

    def __repr__(self) -> str:
        usual = {name: p.default for name, p in inspect.signature(type(self).__init__).parameters.items()}
        given = [f"{n}={v!r}" for n, v in self.get_params().items() if v is not usual[n] and v != usual[n]]
        return f"Regressor({', '.join(given)})"

    # -- the work --

    def fit(self, directions: Any, values: npt.ArrayLike, noise: Optional[npt.ArrayLike] = None) -> "Regressor":
        """Completes a BRDF from readings.

        Parameters
        ----------
        directions : (wi, wo), or array_like (n, 6) or (n, 2, 3)
            Unit vectors towards light and viewer, (n, 3) each, normal +z; in an array side by side.
        values : array_like, (n, channels) or (n,)
            1/sr, NaN where nothing was read.
        noise : array_like, optional
            Standard deviations of the values, 1/sr, broadcast against them, in place of the parameters.

        Returns
        -------
        The regressor itself.

        Raises
        ------
        ArgumentError
            Shapes or types that do not fit, directions that are none or below the horizon.
        DataError
            Values that are negative or infinite, directions that were read twice, no value at all.
        """
        wi, wo = split(directions)
        readings = Readings(wi, wo, values, noise=noise, wavelengths=self.wavelengths,
                            average_repeats=self.average_repeats, negative_to_zero=self.negative_to_zero)
        self._single = np.ndim(values) == 1
        return self.fit_readings(readings)

    def fit_readings(self, readings: Readings) -> "Regressor":
        """The same from `Readings`, which may come from a file."""
        made = reconstruct(self.basis, readings, noise=self.noise, floor=self.floor, saturation=self.saturation,
                           method=self.method, checks=self.checks)
        if made.suspicion is not None:
            from ._calls import warn

            warn(f"a usual mistake would explain these readings far better: {made.suspicion}")
        self.reconstruction_: Reconstruction = made
        self.expected_error_ = made.expected_error
        self.suspicion_ = made.suspicion
        self.n_features_in_ = 6
        return self

    def _fitted(self) -> Reconstruction:
        if not hasattr(self, "reconstruction_"):
            raise NotFittedError("this Regressor was not fitted: call fit(directions, values) first")
        return self.reconstruction_

    @overload
    def predict(self, wi: Any, wo: Any = None, return_std: Literal[False] = False) -> Array: ...

    @overload
    def predict(self, wi: Any, wo: Any = None, *, return_std: Literal[True]) -> Tuple[Array, Array]: ...

    @overload
    def predict(self, wi: Any, wo: Any, return_std: Literal[True]) -> Tuple[Array, Array]: ...

    def predict(self, wi: Any, wo: Any = None, return_std: bool = False) -> Union[Array, Tuple[Array, Array]]:
        """The BRDF at any directions.

        Parameters
        ----------
        wi, wo : array_like, (..., 3)
            Unit vectors towards light and viewer; they broadcast. Or one argument as of `fit`.
        return_std : bool
            Also return standard deviations, 1/sr, as `Reconstruction.predict`.

        Returns
        -------
        values : ndarray, (..., channels)
            1/sr; (...) if it was fitted to values (n,).
        std : ndarray
            Alike.
        """
        made = self._fitted()
        light, viewer = split(wi, wo)
        single = getattr(self, "_single", False)
        if return_std:
            value, std = made.predict(light, viewer, return_std=True)
            return (value[..., 0], std[..., 0]) if single else (value, std)
        value = made.predict(light, viewer)
        return value[..., 0] if single else value

    def interval(self, wi: Any, wo: Any = None, level: float = 0.95) -> Tuple[Array, Array]:
        """The interval that holds a value with probability `level`, as `Reconstruction.interval`: low, high, 1/sr."""
        made = self._fitted()
        low, high = made.interval(*split(wi, wo), level)
        return (low[..., 0], high[..., 0]) if getattr(self, "_single", False) else (low, high)

    def score(self, directions: Any, values: npt.ArrayLike, sample_weight: Optional[npt.ArrayLike] = None) -> float:
        """The coefficient of determination, R^2, of ln(1 + value/s), in which errors are measured (E6). At most 1.

        Parameters
        ----------
        directions, values
            As of `fit`; NaN values do not count.
        sample_weight : array_like, (n,), optional
        """
        made = self._fitted()
        at = pairs(*split(directions))
        truth = numbers(values, "values")
        truth = truth[..., np.newaxis] if truth.ndim == at.ndim - 1 else truth
        predicted, _ = made._predict(at, False)
        if truth.shape != predicted.shape:
            raise ArgumentError(f"values has shape {np.shape(values)}: it must be {predicted.shape}")
        scale = made._scales(at)
        g, h = np.log1p(truth / scale), np.log1p(predicted / scale)
        weight = np.ones(len(truth)) if sample_weight is None else np.asarray(sample_weight, dtype=float)
        weights = np.where(np.isnan(g) | np.isnan(h), 0.0, weight.reshape(-1, *[1] * (g.ndim - 1)))
        total = weights.sum()
        if total == 0.0:
            raise DataError("values holds nothing to compare with: all are NaN")
        known = weights > 0.0
        mean = np.sum(weights * np.where(known, g, 0.0), axis=0) / np.maximum(weights.sum(axis=0), 1e-300)
        error = np.sum(weights * np.where(known, g - h, 0.0) ** 2)
        spread = np.sum(weights * np.where(known, g - mean, 0.0) ** 2)
        return 1.0 - float(error / spread) if spread > 0.0 else float(error == 0.0)
