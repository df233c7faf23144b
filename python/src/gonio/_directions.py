"""Directions: unit vectors in the surface's frame (normal +z, tangent +x), angles, and how arguments are checked.

wi points towards the light, wo towards the viewer, both away from the surface. theta is measured from the normal, phi
from +x towards +y, in radians.
"""
from __future__ import annotations

from typing import Any, Tuple

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._exceptions import ArgumentError, DirectionWarning

Array = npt.NDArray[np.float64]
OFF = 1e-3  # of unit length, beyond which a warning is due
_VECTORS = "its last axis must hold x, y, z of unit vectors; gonio.directions(theta, phi) makes them from angles"


def numbers(value: Any, name: str) -> Array:
    """An argument as a float64 array, contiguous; copied only if it is not."""
    if isinstance(value, np.ma.MaskedArray):
        if np.any(np.ma.getmaskarray(value)):  # type: ignore[no-untyped-call]
            raise ArgumentError(f"{name} has shape {value.shape} and masked entries: fill them (numpy.ma.filled, NaN "
                                f"for values that were not read) or leave them out")
        value = np.asarray(value)
    try:
        array = np.asarray(value)
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{name} is no array of numbers: {error}") from None
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{name} has shape {array.shape} and dtype {array.dtype}: give real numbers, float64")
    return np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)


def vectors(value: Any, name: str) -> Array:
    """An argument of shape (..., 3)."""
    array = numbers(value, name)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ArgumentError(f"{name} has shape {array.shape}: {_VECTORS}")
    return array


def _place(index: int, shape: tuple[int, ...]) -> str:
    place = tuple(int(k) for k in np.unravel_index(index, shape)) if shape else ()
    return f"[{', '.join(map(str, place))}]" if place else ""


def _judge(found: Any, w: Array, name: str, below_is_wrong: bool) -> None:
    shape = w.shape[:-1]
    count = w.size // 3
    flat = w.reshape(-1, 3)
    if found.not_finite < count:
        raise ArgumentError(f"{name}{_place(found.not_finite, shape)} is {flat[found.not_finite]}, {name} of shape "
                            f"{w.shape}: leave out directions that are not finite")
    if found.zero < count:
        raise ArgumentError(f"{name}{_place(found.zero, shape)} is {flat[found.zero]}, {name} of shape {w.shape}: it "
                            f"has no direction; {_VECTORS}")
    if below_is_wrong and found.below < count:
        raise ArgumentError(f"{name}{_place(found.below, shape)} is {flat[found.below]}, {name} of shape {w.shape}: it "
                            f"is at or below the horizon (z must be above 0, both directions point away from the "
                            f"surface); leave such directions out")
    if found.off > OFF:
        _calls.warn(f"{name}{_place(found.far, shape)} has the length {np.linalg.norm(flat[found.far]):.6g}, {name} of "
                    f"shape {w.shape}: the vectors were normalised", DirectionWarning)


def _write_angles(w: Array, name: str, out: Array, first: int, below_is_wrong: bool) -> None:
    """Angles of w[count][3] into out[count][stride], columns first and first + 1."""
    found = ffi.new("gonio_python_vectors *")
    if w.size:
        at = ffi.cast("double *", ffi.from_buffer(out)) + first
        lib.gonio_python_angles(_calls.buffer(w), w.size // 3, _calls.threads(), at, out.shape[-1], found)
        _judge(found, w, name, below_is_wrong)


def pairs(wi: Any, wo: Any, below_is_wrong: bool = True) -> Array:
    """Pairs of directions as the library takes them: (..., 4), theta and phi of wi, then of wo; broadcast."""
    light, viewer = vectors(wi, "wi"), vectors(wo, "wo")
    try:
        shape = np.broadcast_shapes(light.shape[:-1], viewer.shape[:-1])
    except ValueError:
        raise ArgumentError(f"wi has shape {light.shape} and wo {viewer.shape}: their leading axes must be the same, "
                            f"or broadcast") from None
    made = np.empty((*shape, 4))
    for w, name, first in ((light, "wi", 0), (viewer, "wo", 2)):
        if w.shape[:-1] == shape:
            _write_angles(w, name, made, first, below_is_wrong)
        else:
            few = np.empty((*w.shape[:-1], 2))
            _write_angles(w, name, few, 0, below_is_wrong)
            made[..., first:first + 2] = few
    return made


def directions(theta: npt.ArrayLike, phi: npt.ArrayLike = 0.0) -> Array:
    """Unit vectors from angles.

    Parameters
    ----------
    theta : array_like
        Polar angle from the normal, radians.
    phi : array_like
        Azimuth from +x towards +y, radians. Broadcast against theta.

    Returns
    -------
    ndarray, (..., 3)
    """
    polar, azimuth = numbers(theta, "theta"), numbers(phi, "phi")
    try:
        shape = np.broadcast_shapes(polar.shape, azimuth.shape)
    except ValueError:
        raise ArgumentError(f"theta has shape {polar.shape} and phi {azimuth.shape}: they do not broadcast") from None
    at = np.empty((*shape, 2))
    at[..., 0], at[..., 1] = polar, azimuth
    w = np.empty((*shape, 3))
    lib.gonio_python_unit_vectors(_calls.buffer(at), 2, w.size // 3, _calls.threads(), _calls.buffer(w))
    return w


def angles(w: npt.ArrayLike) -> Tuple[Array, Array]:
    """Polar angle and azimuth of vectors.

    Parameters
    ----------
    w : array_like, (..., 3)

    Returns
    -------
    theta, phi : ndarray, (...)
        Radians; theta in [0, pi], phi in [-pi, pi].
    """
    array = vectors(w, "w")
    at = np.empty((*array.shape[:-1], 2))
    _write_angles(array, "w", at, 0, False)
    return at[..., 0], at[..., 1]


def from_pairs(at: Array) -> Tuple[Array, Array]:
    """Unit vectors wi, wo of pairs (n, 4)."""
    return directions(at[..., 0], at[..., 1]), directions(at[..., 2], at[..., 3])


def split(given: Any, wo: Any = None) -> Tuple[Any, Any]:
    """wi and wo from (wi, wo), from an array (..., 6) that has both side by side, or from (..., 2, 3)."""
    if wo is not None:
        return given, wo
    if isinstance(given, tuple) and len(given) == 2:
        return given[0], given[1]
    array = numbers(given, "directions")
    if array.ndim > 0 and array.shape[-1] == 6:
        return array[..., :3], array[..., 3:]
    if array.ndim > 1 and array.shape[-2:] == (2, 3):
        return array[..., 0, :], array[..., 1, :]
    raise ArgumentError(f"directions has shape {array.shape}: give (wi, wo), or an array (n, 6) of wi and wo side by "
                        f"side, or (n, 2, 3)")
