"""Materials: a BRDF at any directions, from a file, by name, from an array or from a function."""
from __future__ import annotations

import contextlib
import os
import threading
from typing import Any, Callable, Iterator, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array, from_pairs, numbers, pairs
from ._exceptions import ArgumentError, DataError

SHAPE = (lib.GONIO_THETA_H_BINS, lib.GONIO_THETA_D_BINS, lib.GONIO_PHI_D_BINS, lib.GONIO_CHANNELS)
ILLUMINANTS = {"E": lib.GONIO_ILLUMINANT_E, "D65": lib.GONIO_ILLUMINANT_D65, "A": lib.GONIO_ILLUMINANT_A}


def atlas(anisotropic: bool = False) -> list[str]:
    """The built-in analytic materials: names for `Material`, ``"atlas:gold-polished"`` among them.

    Parameters
    ----------
    anisotropic
        The anisotropic ones instead, ``"atlas:steel-hairline"`` among them.
    """
    if anisotropic:
        count, name = lib.gonio_atlas_anisotropic_count(), lib.gonio_atlas_anisotropic_name
        return [f"atlas:{_calls.text(name(k))}" for k in range(count)]
    return [f"atlas:{_calls.text(lib.gonio_atlas_name(k))}" for k in range(lib.gonio_atlas_count())]


def formats() -> list[str]:
    """The formats that `Material.save` writes."""
    return _calls.listed(lib.gonio_material_writer_name)


class _Function:
    """A Python function as the library calls it, from any thread."""

    def __init__(self, function: Callable[[Array, Array], Any], channels: int) -> None:
        self.function = function
        self.channels = channels
        self.raised: Optional[BaseException] = None

    def evaluate(self, given: Array) -> Array:
        values = np.asarray(self.function(*from_pairs(given)), dtype=np.float64)
        if values.ndim == 1 and self.channels == 1:
            values = values[:, np.newaxis]
        if values.shape != (len(given), self.channels):
            raise ArgumentError(f"the function returned shape {values.shape} for {len(given)} directions: it must "
                                f"return ({len(given)}, {self.channels}), a value for each channel")
        return values


@ffi.def_extern(name="gonio_python_evaluate", error=lib.GONIO_ERROR_DATA)  # type: ignore[misc]
def _evaluate(user: Any, _context: Any, given: Any, count: int, values: Any) -> int:
    function = ffi.from_handle(user)
    try:
        at = np.frombuffer(ffi.buffer(given, count * ffi.sizeof("gonio_pair")), np.float64).reshape(count, 4)
        size = count * function.channels * ffi.sizeof("double")
        out = np.frombuffer(ffi.buffer(values, size), np.float64).reshape(count, function.channels)
        out[:] = function.evaluate(at)
    except BaseException as error:  # raised again when the library has returned
        function.raised = error
        return int(lib.GONIO_ERROR_DATA)
    return int(lib.GONIO_OK)


@contextlib.contextmanager
def causes(*materials: "Material") -> Iterator[None]:
    """While materials are evaluated: what the function of one raises comes out, rather than what the library says."""
    try:
        yield
    except Exception as error:
        for function in [m._function for m in materials if m._function is not None]:
            if function.raised is not None:
                cause, function.raised = function.raised, None
                raise cause from error
        raise


@_calls.free_of_change
class Material:
    """A BRDF at any directions, in any channels: R, G, B, one channel, or wavelengths.

    Parameters
    ----------
    source : path, str, array_like or callable
        - A file: MERL ``.binary``, RGL ``.bsdf``, KAIST ``.pbsdf``, UTIA ``.bin``, BSDF-XML or a neural BRDF ``.h5``,
          told by its content.
        - ``"atlas:NAME"``, a built-in material; `atlas` lists them.
        - An array (90, 90, 180, 3) over MERL's bins theta_h, theta_d, phi_d and R, G, B in 1/sr, NaN where there are no
          data; or (90, 90, 180), grey. `to_numpy` makes such arrays.
        - A function f(wi, wo) of unit vectors (n, 3) that returns (n, channels) in 1/sr, or (n,) with one channel. The
          library calls it from several threads, one at a time.
    name : str, optional
        What an array or a function is called.
    channels : int
        Of a function: 3 are R, G, B, 1 is grey.
    wavelengths : array_like, optional
        Of a function: the wavelength of each channel, nm.
    anisotropic : bool
        Of a function: whether values change when both directions turn about the normal.
    illuminant : {"E", "D65", "A"}
        What the colours of spectra are seen under, in `to_numpy`, `albedo`, renderings and files of colours.

    Raises FileError for a file that is missing or unreadable, FormatError for one that is damaged or no material,
    ArgumentError for an unknown name and for wrong shapes, DataError for a table without data.

    Materials never change: copies are the same object, and threads may share them. Pickling keeps the path of a file,
    not its content; an array or function is pickled with the material.

    Source: ``gonio/material.h``.
    """

    def __init__(self, source: Union[str, "os.PathLike[str]", npt.ArrayLike, Callable[[Array, Array], Any], "Material"],
                 *, name: Optional[str] = None, channels: int = 3, wavelengths: Optional[npt.ArrayLike] = None,
                 anisotropic: bool = False, illuminant: str = "E") -> None:
        self._handle: Any = None
        self._keep: Any = None
        self._function: Optional[_Function] = None
        self._origin: tuple[Any, ...] = (type(self), (source,), dict(
            name=name, channels=channels, wavelengths=wavelengths, anisotropic=anisotropic, illuminant=illuminant))
        if isinstance(source, Material):
            self._handle, self._keep, self._function = source._handle, source, source._function
            self._origin = source._origin
        elif isinstance(source, (str, os.PathLike)):
            self._open(source)
        elif callable(source):
            self._wrap_function(source, name or "function", channels, wavelengths, anisotropic)
        else:
            self._wrap_array(source, name or "array")
        light = _calls.chosen(illuminant, "illuminant", ILLUMINANTS)
        if light != lib.GONIO_ILLUMINANT_E:
            _calls.run(lib.gonio_material_set_illuminant, self._handle, light)
        self._finish()

    def _finish(self) -> None:
        self._lock = threading.Lock()
        self._table: Any = None
        self._view = lib.gonio_material_describe(self._handle)

    @classmethod
    def _of(cls, handle: Any, keep: Any, origin: tuple[Any, ...]) -> "Material":
        """Wraps a material that the library made; keep is what it stands on."""
        made = cls.__new__(cls)
        made._handle, made._keep, made._origin, made._function = handle, keep, origin, None
        made._finish()
        return made

    def _open(self, source: Any) -> None:
        path = os.fspath(source)
        self._handle = _calls.made("material", lib.gonio_material_open, _calls.encoded(path))
        if not path.startswith("atlas:"):
            self._origin = (type(self), (os.path.abspath(path),), self._origin[2])

    def _wrap_array(self, source: Any, name: str) -> None:
        array = numbers(source, "source")
        if array.shape == SHAPE[:3]:
            array = np.repeat(array[..., np.newaxis], SHAPE[3], axis=-1)
        if array.shape != SHAPE:
            raise ArgumentError(f"source has shape {array.shape}: a table of a material has {SHAPE} (theta_h, theta_d, "
                                f"phi_d, channel) or {SHAPE[:3]}; give a function for anything else")
        slabs = np.ascontiguousarray(np.moveaxis(array, 3, 1))
        if not np.any(slabs.min(axis=1) >= 0.0):
            raise DataError("source holds no data: no bin has three values of 0 or more")
        self._keep = slabs
        self._handle = _calls.made("material", lib.gonio_python_array_material, name.encode(), _calls.buffer(slabs))

    def _wrap_function(self, source: Any, name: str, channels: int, wavelengths: Any, anisotropic: bool) -> None:
        nm = None if wavelengths is None else numbers(wavelengths, "wavelengths").ravel()
        channels = int(channels) if nm is None else len(nm)
        if channels < 1:
            raise ArgumentError(f"channels is {channels}: a material has at least one")
        self._function = _Function(source, channels)
        handle = ffi.new_handle(self._function)
        self._keep = (handle, nm)
        self._handle = _calls.made("material", lib.gonio_python_function_material, name.encode(), handle, channels,
                                   _calls.buffer(nm), anisotropic, lib.gonio_python_evaluate)

    # -- what it is --

    @property
    def name(self) -> str:
        """Of a file its base name without extension; of a built-in material the part after the colon."""
        return _calls.text(self._view.name)

    @property
    def format(self) -> str:
        """Where it came from, in words."""
        return _calls.text(self._view.format)

    @property
    def channels(self) -> int:
        """Channels of `eval`."""
        return int(self._view.channels)

    @property
    def wavelengths(self) -> Optional[Array]:
        """nm, (channels,); None for R, G, B and for grey."""
        seen: Optional[Array] = _calls.view(self, self._view.wavelength, (self.channels,))
        return seen

    @property
    def anisotropic(self) -> bool:
        """Whether values change when both directions turn about the normal."""
        return bool(self._view.anisotropic)

    @property
    def theta_limit(self) -> float:
        """The polar angle up to which values were measured, radians; pi/2 for all."""
        return float(self._view.theta_limit) or float(np.pi / 2)

    def __repr__(self) -> str:
        return f"<gonio.Material {self.name!r}: {self.format}, {self.channels} channels>"

    # -- values --

    def eval(self, wi: npt.ArrayLike, wo: npt.ArrayLike, *, cosine: bool = False, below: Optional[str] = None) -> Array:
        """The BRDF at pairs of directions.

        Parameters
        ----------
        wi, wo : array_like, (..., 3)
            Unit vectors towards light and viewer, normal +z. Leading axes broadcast.
        cosine : bool
            Multiply by the cosine of wo's polar angle, as Mitsuba's ``eval`` does.
        below : {"raise", "zero", "nan"}, optional
            What a direction at or below the horizon gives: an exception, unless `cosine`; with `cosine` zero, as in
            Mitsuba.

        Returns
        -------
        ndarray, (..., channels)
            1/sr. NaN where the material has no data. From the source itself if it can evaluate, otherwise by trilinear
            interpolation of its table.

        Raises
        ------
        ArgumentError
            Shapes that do not broadcast, vectors that are not finite or have no length, directions below the horizon.
        """
        usual = "zero" if cosine else "raise"
        mode = _calls.chosen(usual if below is None else below, "below", {m: m for m in ("raise", "zero", "nan")})
        at = pairs(wi, wo, below_is_wrong=mode == "raise")
        values = np.empty((*at.shape[:-1], self.channels))
        if values.size:
            with causes(self):
                _calls.run(lib.gonio_material_evaluate, self._handle, _calls.buffer(at, "gonio_pair"), at.size // 4,
                           _calls.buffer(values))
        if mode == "zero":
            values[(at[..., 0] >= np.pi / 2) | (at[..., 2] >= np.pi / 2)] = 0.0
        if cosine:
            values *= np.clip(np.cos(at[..., 2]), 0.0, None)[..., np.newaxis]
        return values

    def _loaded(self) -> Any:
        """The table, read once."""
        with self._lock:
            if self._table is None:
                with causes(self):
                    self._table = _calls.made("table", lib.gonio_table_load, self._handle)
            return self._table

    def albedo(self, theta: npt.ArrayLike) -> Array:
        """The directional-hemispherical reflectance.

        Parameters
        ----------
        theta : array_like, (...)
            Polar angle of the light, radians, in [0, pi/2).

        Returns
        -------
        ndarray, (..., 3)
            R, G, B. Directions without data count as 0, so it is a lower bound where some are missing (`coverage`); NaN
            if there are none.
        """
        return self._albedos(theta)[0]

    def coverage(self, theta: npt.ArrayLike) -> Array:
        """The share of the hemisphere, weighted by the cosine, that has data for light from `theta`, radians."""
        return self._albedos(theta)[1]

    def _albedos(self, theta: npt.ArrayLike) -> tuple[Array, Array]:
        light = numbers(theta, "theta")
        if not np.all((light >= 0.0) & (light < np.pi / 2)):
            raise ArgumentError(f"theta has shape {light.shape} and values outside [0, pi/2): it is a polar angle in "
                                f"radians")
        albedo, share = np.empty((*light.shape, 3)), np.empty(light.shape)
        lib.gonio_python_albedos(self._loaded(), _calls.buffer(light), light.size, _calls.threads(),
                                 _calls.buffer(albedo), _calls.buffer(share))
        return albedo, share

    def to_numpy(self) -> Array:
        """The material over MERL's bins: (90, 90, 180, 3), theta_h, theta_d, phi_d and R, G, B, 1/sr; NaN: no data.

        theta_h is spaced by a square root; `grid` gives the centres of the bins.
        """
        table = self._loaded()
        stored = _calls.view(table, lib.gonio_table_values(table), (SHAPE[0], SHAPE[3], SHAPE[1], SHAPE[2]))
        values: Array = np.array(np.moveaxis(stored, 1, 3), order="C")
        values[values < 0.0] = np.nan
        return values

    def to_xarray(self) -> Any:
        """`to_numpy` as an xarray.DataArray with coordinates theta_h, theta_d, phi_d (radians) and channel."""
        import xarray

        return xarray.DataArray(self.to_numpy(), dims=("theta_h", "theta_d", "phi_d", "channel"), name=self.name,
                                coords={**grid(), "channel": ["R", "G", "B"]},
                                attrs={"units": "1/sr", "long_name": "BRDF", "source": self.format})

    def save(self, path: Union[str, "os.PathLike[str]"], format: Optional[str] = None, *, theta_i_step: float = 0.0,
             theta_o_step: float = 0.0, phi_step: float = 0.0, average_azimuths: bool = False) -> None:
        """Writes the material. The file appears whole or not at all.

        Parameters
        ----------
        path : path
        format : str, optional
            One of `formats`; by default that of the path's extension, or a MERL table.
        theta_i_step, theta_o_step, phi_step : float
            Steps of directions on a grid (csv, zemax), radians; 0 for the format's usual ones.
        average_azimuths : bool
            Write the mean over azimuths of an anisotropic material, in formats that hold isotropic ones too.

        Raises
        ------
        ArgumentError
            No such format, or something that the format cannot hold.
        FileError
            The file cannot be written.
        """
        name = ffi.NULL if format is None else ffi.new("char[]", str(format).encode(errors="replace"))
        how = _calls.options("write", format=name, theta_i_step=theta_i_step, theta_o_step=theta_o_step,
                             phi_step=phi_step, average_azimuths=average_azimuths)
        with causes(self):
            _calls.run(lib.gonio_material_write, self._handle, _calls.encoded(path), how)

    def _repr_png_(self) -> Optional[bytes]:
        """A small rendering, for notebooks."""
        from ._rendering import thumbnail

        return thumbnail(self)

    def __reduce__(self) -> Any:
        function, arguments, keywords = self._origin
        return _remake, (function, arguments, keywords)


def _remake(function: Any, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
    """Makes a pickled object again."""
    return function(*arguments, **keywords)


def grid() -> dict[str, Array]:
    """Centres of MERL's bins: theta_h (90,), theta_d (90,), phi_d (180,), radians."""
    def centre(**place: int) -> Any:
        bin = {"theta_h": 0, "theta_d": 0, "phi_d": 0, **place}
        return lib.gonio_bin_centre(bin)

    return {name: np.array([getattr(centre(**{name: k}), name) for k in range(count)])
            for name, count in zip(("theta_h", "theta_d", "phi_d"), SHAPE)}


def as_material(value: Any) -> Material:
    """An argument that may be anything a material is made of, or has one."""
    if isinstance(value, Material):
        return value
    made = getattr(value, "material", None)
    if callable(made):
        found = made()
        if isinstance(found, Material):
            return found
    return Material(value)
