"""Reports: the interactive page of a material and its reconstruction, in a notebook or a file."""
from __future__ import annotations

import html
import pathlib
import tempfile
from typing import Any, Optional

from . import _calls
from ._backend import lib
from ._materials import Material, as_material, causes
from ._readings import Path, Readings
from ._reconstruction import Reconstruction


class Report:
    """A page for a browser, one file that needs no network. It shows itself in a notebook.

    Attributes
    ----------
    html : str
        The page.
    """

    def __init__(self, page: str) -> None:
        self.html = page

    def save(self, path: Path) -> None:
        """Writes the page."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<gonio.Report of {len(self.html) / 1e6:.1f} MB: show it in a notebook, or save(path)>"

    def _repr_html_(self) -> str:
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:900px;border:0" title="gonio report"></iframe>'


def report(material: Any, reconstruction: Any = None, *, readings: Optional[Readings] = None,
           deviation: Optional[Material] = None) -> Report:
    """An interactive page of a material.

    Parameters
    ----------
    material : Material, Reconstruction, or what a material is made of
        What is shown; with `reconstruction` the reference.
    reconstruction : alike, optional
        Shown beside it, with the difference. A `Reconstruction` brings its readings and standard deviations with it.
    readings : Readings, optional
        The directions that were measured.
    deviation : Material, optional
        `Reconstruction.deviation_material`.

    Returns
    -------
    Report

    Raises
    ------
    FileError
        The library was built without the page, for which Node.js is needed.

    Source: ``gonio/page.h`` (gonio_page_write).
    """
    shown = reconstruction if reconstruction is not None else material
    if isinstance(shown, Reconstruction):
        readings = shown.readings if readings is None else readings
        if deviation is None and reconstruction is not None and shown.field is not None:
            deviation = shown.deviation_material()
    keep = [as_material(material), None if reconstruction is None else as_material(reconstruction)]
    parts = dict(reference=keep[0], reconstruction=keep[1], deviation=deviation, readings=readings)
    content = _calls.struct("gonio_page_content", **{n: p._handle for n, p in parts.items() if p is not None})
    with tempfile.TemporaryDirectory() as folder, causes(*[m for m in keep if m is not None]):
        path = pathlib.Path(folder) / "page.html"
        _calls.run(lib.gonio_page_write, content, _calls.encoded(path))
        return Report(path.read_text(encoding="utf-8"))
