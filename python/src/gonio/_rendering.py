"""Rendering: a material on a sphere or a mesh, as an array; tone mapping; pictures in files."""
from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _calls
from ._backend import ffi, lib
from ._directions import numbers
from ._exceptions import ArgumentError, GonioError
from ._materials import as_material, causes

Path = Union[str, "os.PathLike[str]"]
Image = npt.NDArray[np.float32]
LAMPS = {"directional": lib.GONIO_LAMP_DIRECTIONAL, "point": lib.GONIO_LAMP_POINT}


def environments() -> list[str]:
    """The built-in environments of `render`."""
    return _calls.listed(lib.gonio_environment_name)


def render(material: Any, *, width: int = 512, height: int = 512, samples: int = 64, seed: int = 0,
           mesh: Optional[Path] = None, environment: Optional[Path] = None, environment_turn: float = 0.0,
           show_environment: bool = False, repair: bool = False, lamp: str = "directional",
           lamp_position: Optional[Sequence[float]] = None, azimuth: float = 0.0,
           elevation: float = 0.0, field_of_view: float = float(np.pi / 6), grain: float = 0.0,
           flat: bool = False) -> Image:
    """Renders a material.

    Parameters
    ----------
    material : Material, Reconstruction, or what a material is made of
    width, height : int
        Pixels.
    samples : int
        A pixel. The error falls as 1/sqrt(samples).
    seed : int
        Of the samples. The same seed gives the same image on any number of threads.
    mesh : path, optional
        An OBJ or PLY file, moved and scaled to the unit sphere; the sphere by default.
    environment : str or path, optional
        One of `environments`, or an OpenEXR or Radiance image in longitude and latitude; by default the lamp.
    environment_turn : float
        About the vertical axis, to the right as the viewer sees its centre, radians.
    show_environment : bool
        Whether it is seen behind the object.
    repair : bool
        Take negative, NaN and infinite pixels of the environment as black.
    lamp : {"directional", "point"}
    lamp_position : sequence of 3 floats, optional
        The place of a point lamp, or the direction to a directional one; up to the left in front by default.
    azimuth, elevation : float
        The viewer's, about the object, radians.
    field_of_view : float
        Vertical, radians; 0 for parallel rays.
    grain : float
        Rotates an anisotropic sample about its normal, radians. At 0 its azimuth 0 is horizontal on the surface.
    flat : bool
        A flat square sample in place of the sphere.

    Returns
    -------
    ndarray of float32, (height, width, 4)
        Linear R, G, B (primaries of BT.709), multiplied by A, and A, the share of the pixel that shows something; top
        row first. A view of the library's memory.

    Raises
    ------
    ArgumentError
        Sizes, a lamp or a view that are none; a library that was built without the renderer.
    DataError
        A material without data, a mesh without extent, an environment that is black or has pixels without a value.
    FileError, FormatError
        Of the mesh and the environment.

    Source: ``gonio/render.h`` (gonio_render).
    """
    sample = as_material(material)
    shape = _calls.made("mesh", lib.gonio_mesh_read, _calls.encoded(mesh)) if mesh is not None else None
    light = None
    if environment is not None:
        light = _calls.made("environment", lib.gonio_environment_open, _calls.encoded(environment), repair)
    place = None if lamp_position is None else numbers(lamp_position, "lamp_position")
    if place is not None and place.shape != (3,):
        raise ArgumentError(f"lamp_position has shape {place.shape}: it needs x, y, z")
    how = _calls.options("render", width=width, height=height, samples=samples, seed=seed, mesh=shape,
                         environment=light, environment_turn=environment_turn, show_environment=show_environment,
                         lamp=_calls.chosen(lamp, "lamp", LAMPS), lamp_position=None if place is None else place.tolist(), azimuth=azimuth, elevation=elevation,
                         field_of_view=field_of_view, grain=grain, flat=flat)
    with causes(sample):
        return _array(_calls.made("image", lib.gonio_render, sample._handle, how))


def _array(image: Any) -> Image:
    seen: Image = _calls.view(image, image.rgba, (image.height, image.width, lib.GONIO_IMAGE_CHANNELS), np.float32)
    return seen


def read_image(path: Path) -> Image:
    """Reads an OpenEXR or Radiance image: (height, width, 4), as `render` returns it."""
    return _array(_calls.made("image", lib.gonio_image_read, _calls.encoded(path)))


def _image(image: Any) -> tuple[Any, Any]:
    """An array (height, width, 3 or 4) as the library's image, and what it stands on."""
    given = np.asarray(image)
    if given.ndim != 3 or given.shape[2] not in (3, 4) or 0 in given.shape or given.dtype.kind not in "fiu":
        raise ArgumentError(f"image has shape {given.shape} and dtype {given.dtype}: it must be (height, width, 4), "
                            f"linear R, G, B, A, or (height, width, 3)")
    pixels = np.ones((*given.shape[:2], 4), np.float32)
    pixels[..., :given.shape[2]] = given
    made = _calls.struct("gonio_image", width=given.shape[1], height=given.shape[0])
    made.rgba = _calls.buffer(pixels, "float")
    return made, pixels


def tone_map(image: npt.ArrayLike, *, key: float = 0.18, reference: Optional[npt.ArrayLike] = None
             ) -> npt.NDArray[np.uint8]:
    """A rendering as a display shows it: Reinhard's global operator, sRGB, on black.

    Parameters
    ----------
    image : array_like, (height, width, 4) or (height, width, 3)
        Linear, as `render` returns it.
    key : float
        The luminance that the average comes to.
    reference : array_like, optional
        The image whose brightness sets the operator, to show several alike; `image` itself by default.

    Returns
    -------
    ndarray of uint8, (height, width, 3)
    """
    made, _pixels = _image(image)
    tone = _tone(image if reference is None else reference, key)
    shown = np.empty((made.height, made.width, 3), np.uint8)
    lib.gonio_python_tone_map(made, tone, _calls.threads(), _calls.buffer(shown, "uint8_t"))
    return shown


def _tone(image: Any, key: float) -> Any:
    made, _pixels = _image(image)
    return ffi.new("gonio_tone *", lib.gonio_tone_measure(made, key))


def save_image(image: npt.ArrayLike, path: Path, *, key: float = 0.18) -> None:
    """Writes a rendering: OpenEXR if the path ends in .exr, otherwise PNG, tone-mapped with `key` on black."""
    made, _pixels = _image(image)
    if pathlib.PurePath(os.fspath(path)).suffix.lower() == ".exr":
        _calls.run(lib.gonio_image_write_exr, made, _calls.encoded(path))
    else:
        _calls.run(lib.gonio_image_write_png, made, _tone(image, key), _calls.encoded(path))


def thumbnail(material: Any) -> Optional[bytes]:
    """A small rendering as PNG; None if the library was built without the renderer."""
    try:
        image = render(material, width=160, height=160, samples=16, environment=environments()[0])
    except GonioError:
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a.png"
        save_image(image, path)
        return path.read_bytes()


def image_errors(reference: npt.ArrayLike, other: npt.ArrayLike, *, key: float = 0.18) -> dict[str, float]:
    """How far a rendering is from another as they are shown: "psnr" in dB and "delta_e_itp" (BT.2124)."""
    (a, _a), (b, _b) = _image(reference), _image(other)
    found = _calls.struct("gonio_image_error")
    _calls.run(lib.gonio_image_compare, a, b, _tone(reference, key), found, ffi.NULL)
    return {"psnr": float(found.psnr), "delta_e_itp": float(found.delta_e_itp)}
