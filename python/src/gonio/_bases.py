"""Bases: what reflectance looks like, learned from materials."""
from __future__ import annotations

import os
import pathlib
import tempfile
import weakref
import zlib
from typing import Any, Iterable, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import Array
from ._exceptions import ArgumentError, MismatchError
from ._materials import as_material, atlas, causes
from ._plans import Plan, plan_options

Path = Union[str, "os.PathLike[str]"]


def _parsed(kind: str, name: str) -> int:
    out = ffi.new(f"gonio_{kind} *")
    if not getattr(lib, f"gonio_{kind}_parse")(str(name).encode(errors="replace"), out):
        raise ArgumentError(f"there is no {kind.replace('_', ' ')} {name!r}")
    return int(out[0])


def learn(materials: Iterable[Any], *, grid: str = "sectored", channels: Optional[str] = None, mapping: str = "log",
          mean: bool = True, components: int = 0, mixtures: Optional[int] = None, seed: int = 0,
          scratch: Optional[Path] = None, analytic: Optional[int] = None) -> "Basis":
    """Learns a basis from materials.

    Parameters
    ----------
    materials : iterable
        Anything that `Material` takes: paths, ``"atlas:NAME"``, arrays, materials.
    grid : {"sectored", "bivariate", "full"}
        The cells: sectored keeps phi_d in twelve sectors.
    channels : {"separate", "joint"}, optional
        Whether a column is a channel of a material or all of its channels; by default what is usual on the grid.
    mapping : {"log", "relative"}
        g = ln(1 + rho/s) with s a constant of the channel, or with s = 0.001/(cos theta_i cos theta_o).
    mean : bool
        Whether the mean column is taken out first.
    components : int
        Components to keep; 0 for 300 with mixtures, 45 without, or as many as there are.
    mixtures : int, optional
        Computed materials between and beyond the given ones; by default 1000 on the sectored grid, none otherwise.
    seed : int
        Of the mixtures. The same seed gives the same basis on any number of threads.
    scratch : path, optional
        Folder for scratch files; $TMPDIR or /tmp by default.
    analytic : int, optional
        Random analytic materials to learn from with a small weight; by default 200 beside the usual mixtures.

    Returns
    -------
    Basis

    Raises
    ------
    ArgumentError
        No materials, or more components than they span.
    DataError
        A material without data, two of the same name, materials that span too few dimensions.

    Source: ``gonio/basis.h`` (gonio_learn).
    """
    used = [as_material(m) for m in materials]
    if not used:
        raise ArgumentError("materials is empty: a basis is learned from at least two")
    representation = _parsed("representation", grid)
    usual = ffi.new("gonio_recipe *")
    lib.gonio_recipe_for_grid(usual, representation)
    folder = ffi.NULL if scratch is None else ffi.new("char[]", _calls.encoded(scratch))
    where = _calls.options("database", representation=representation, mapping=_parsed("mapping", mapping),
                           channels=usual.channels if channels is None else _parsed("channel_model", channels),
                           scratch=folder)
    handles = ffi.new("gonio_material *[]", [m._handle for m in used])
    with causes(*used):
        database = _calls.made("database", lib.gonio_database_create_from_materials, handles, len(used), where)
    how = _calls.options("basis", components=components, mixtures=mixtures, seed=seed, without_mean=not mean,
                         analytic=analytic)
    return Basis._of(_calls.made("basis", lib.gonio_basis_learn, database, how))


@_calls.free_of_change
class Basis:
    """The mean and the principal components of a database of materials, in its log space: H - m = V S W'.

    Made by `learn`, `Basis.load` or `builtin_basis`. It never changes: copies are the same object, and threads may
    share it. Pickling keeps the path of the file that it was loaded from or saved to, and checks it when it is loaded
    again; a basis without a file is pickled whole.

    Source: ``gonio/basis.h``.
    """

    def __init__(self) -> None:
        raise TypeError("make a basis by gonio.learn, gonio.Basis.load or gonio.builtin_basis")

    @classmethod
    def _of(cls, handle: Any, path: Optional[str] = None) -> "Basis":
        made = cls.__new__(cls)
        made._handle = handle
        made._view = lib.gonio_basis_describe(handle)
        made._path = path
        return made

    _handle: Any
    _view: Any
    _path: Optional[str]

    @classmethod
    def load(cls, path: Path) -> "Basis":
        """Reads a basis file, which is checked. The components stay in the file, which is mapped.

        Raises FileError and FormatError.
        """
        handle = _calls.made("basis", lib.gonio_basis_read, _calls.encoded(path))
        return cls._of(handle, os.path.abspath(os.fspath(path)))

    def save(self, path: Path, *, command: str = "") -> None:
        """Writes the basis as a safetensors file, whole or not at all; `command` is kept in it for the record."""
        _calls.run(lib.gonio_basis_write, self._handle, command.encode(), _calls.encoded(path))
        self._path = self._path or os.path.abspath(os.fspath(path))

    # -- what is in it --

    @property
    def names(self) -> list[str]:
        """The materials that it was learned from."""
        return [_calls.text(self._view.names[k]) for k in range(self._view.materials)]

    @property
    def grid(self) -> str:
        """"sectored", "bivariate" or "full"."""
        return _calls.text(lib.gonio_representation_name(self._view.representation))

    @property
    def channel_model(self) -> str:
        """"separate" or "joint"."""
        return _calls.text(lib.gonio_channel_model_name(self._view.channels))

    @property
    def mapping(self) -> str:
        """"log" or "relative"."""
        return _calls.text(lib.gonio_mapping_name(self._view.mapping))

    @property
    def components(self) -> int:
        """K, the columns of V."""
        return int(self._view.components)

    @property
    def rows(self) -> int:
        """The rows of V: cells, or three times as many with joint channels."""
        return int(self._view.rows)

    @property
    def mixtures(self) -> int:
        """Computed columns beside the measured ones."""
        return int(self._view.mixtures)

    @property
    def analytic(self) -> int:
        """Columns of random analytic materials."""
        return int(self._view.analytic)

    @property
    def cells(self) -> npt.NDArray[np.int32]:
        """The cells of the grid, (cells,), a view."""
        seen: npt.NDArray[np.int32] = _calls.view(self, self._view.cell, (self._view.cells,), np.int32)
        return seen

    @property
    def mean(self) -> Array:
        """m, log units, (rows,), a view."""
        seen: Array = _calls.view(self, self._view.mean, (self.rows,))
        return seen

    @property
    def variances(self) -> Array:
        """Variances of all components, descending, a view."""
        seen: Array = _calls.view(self, self._view.variances, (self._view.variance_count,))
        return seen

    @property
    def loadings(self) -> Optional[Array]:
        """W, (columns, components), orthonormal, a view; None in files without."""
        seen: Optional[Array] = _calls.view(self, self._view.loadings, (self._view.columns, self.components))
        return seen

    def vectors(self, first: int = 0, count: Optional[int] = None, components: Optional[int] = None) -> Array:
        """Rows `first` to `first + count` of V, the first `components` of each: (count, components), a copy."""
        rows = self.rows - first if count is None else count
        columns = self.components if components is None else components
        if first < 0 or rows < 0 or columns < 0:
            raise ArgumentError(f"first is {first}, count {rows}, components {columns}: none may be below 0")
        values = np.empty((rows, columns))
        if values.size:
            _calls.run(lib.gonio_basis_rows, self._handle, first, rows, columns, _calls.buffer(values))
        return values

    @property
    def fingerprint(self) -> str:
        """Which basis it is, as plans and readings state it."""
        return f"{self._view.fingerprint:016x}"

    def __repr__(self) -> str:
        return (f"<gonio.Basis: {self.grid}, {self.channel_model} channels, {self.components} components from "
                f"{self._view.materials} materials>")

    # -- planning --

    def plan(self, n: Optional[int] = None, *, instrument: Any = None, metric: str = "e6",
             target_error: Optional[float] = None, candidates: Any = None, method: Optional[str] = None,
             components: int = 0, seed: int = 0, restarts: int = 5, start: Optional[str] = None,
             phi_d: float = np.pi / 2, budget: Optional[float] = None, nested: bool = False) -> Plan:
        """Plans where to measure a new material.

        Parameters
        ----------
        n : int, optional
            Readings: 80 by default; with `target_error` at most so many, 300 by default.
        instrument : object, optional
            A `Goniometer`: what it reaches is chosen from, with its noise and apertures, in the order of least time
            (`Plan.run`). Or something with `directions`, a pair (wi, wo) that it can reach or None for any: they become
            `candidates`.
        metric : {"e6", "cube-root", "log-relative"}
            Whose expected value is least.
        target_error : float, optional
            The fewest readings with at most this expected error (E6), per cent.
        candidates : (wi, wo), optional
            Choose among these directions, (m, 3) each, for the least error at all of them; by default any, for the
            least error over the grid.
        method : str, optional
            One of `planning_methods`; by default what suits the basis.
        components : int
            K; 0 for all of the basis.
        seed, restarts, start
            Of the swaps of the method "condition": its random starts, how many of them, and how they begin.
        phi_d : float
            Where on the free angle a bivariate cell is measured, radians.
        budget : float, optional
            Seconds: the best run of the goniometer in this time, of at most `n` readings if that is given.
        nested : bool
            The first 5, 10, 20, 40 ... readings of the goniometer stay good plans; only these blocks are ordered.

        Returns
        -------
        Plan
            In the order of reading by the default method: the first readings are a good plan too.

        Raises
        ------
        ArgumentError
            An unknown method or metric, more readings than there are rows, a method that needs another kind of basis.

        Source: ``gonio/plan.h`` (gonio_plan_create).
        """
        how, _keep = plan_options(n, instrument, metric, target_error, candidates, method=method,
                                  components=components, seed=seed, restarts=restarts, start=start, phi_d=phi_d,
                                  budget=budget, nested=nested)
        return Plan._of(_calls.made("plan", lib.gonio_plan_create, self._handle, how))

    # -- copies --

    def __reduce__(self) -> Any:
        if self._path is not None and os.path.exists(self._path):
            return _load_checked, (self._path, int(self._view.checksum))
        return _from_bytes, (self._bytes(),)

    def _bytes(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "basis.gonio"
            _calls.run(lib.gonio_basis_write, self._handle, ffi.NULL, _calls.encoded(path))
            return path.read_bytes()


def _load_checked(path: str, checksum: int) -> Basis:
    basis = Basis.load(path)
    if int(basis._view.checksum) != checksum:
        raise MismatchError(f"{path}: it is another basis than the one that was pickled")
    return basis


def _from_bytes(content: bytes) -> Basis:
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "basis.gonio"
        path.write_bytes(content)
        basis = Basis.load(path)
        basis._path = None
        return basis


_builtin: dict[str, Basis] = {}


def builtin_basis() -> Basis:
    """The basis of the built-in materials. Learned once, which takes about half a minute, and kept in the cache folder
    ($XDG_CACHE_HOME/gonio or ~/.cache/gonio). For real work learn one from measured materials."""
    if "" not in _builtin:
        path = _cache_folder() / f"python-atlas-{_library_digest()}.gonio"
        if not path.exists():
            learn(atlas()).save(path, command="gonio.learn(gonio.atlas())")
        _builtin[""] = Basis.load(path)
    return _builtin[""]


def _cache_folder() -> pathlib.Path:
    given = os.environ.get("XDG_CACHE_HOME", "")
    folder = (pathlib.Path(given) if given.startswith("/") else pathlib.Path.home() / ".cache") / "gonio"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _library_digest() -> str:
    """Another library may learn another basis."""
    library = next((pathlib.Path(__file__).parent / "libs").glob("libgonio.so*"))
    return f"{_calls.text(lib.gonio_version())}-{zlib.crc32(library.read_bytes()):08x}"


def as_basis(value: Any) -> Basis:
    """An argument that may be a basis, the path of one, or None for the built-in one. A file in use is read once."""
    if value is None:
        return builtin_basis()
    if isinstance(value, Basis):
        return value
    path = os.path.abspath(os.fspath(value))
    found = _loaded.get(_state(path))
    if found is None:
        found = Basis.load(path)
        _loaded[_state(path)] = found
    return found


_loaded: "weakref.WeakValueDictionary[tuple[Any, ...], Basis]" = weakref.WeakValueDictionary()


def _state(path: str) -> tuple[Any, ...]:
    """A file as it is now; a missing one is found out by loading it."""
    try:
        now = os.stat(path)
        return path, now.st_mtime_ns, now.st_size, now.st_ino
    except OSError:
        return (path,)
