"""Loads the extension module; cffi's run-time module comes from the package where none is installed."""
from __future__ import annotations

import importlib.util
import pathlib
import sys


def _load_own_backend() -> None:
    path = next(pathlib.Path(__file__).parent.glob("_cffi_backend*.so"))
    spec = importlib.util.spec_from_file_location("_cffi_backend", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.modules["_cffi_backend"] = module


if importlib.util.find_spec("_cffi_backend") is None:
    _load_own_backend()

from ._bindings import ffi, lib  # noqa: E402

__all__ = ["ffi", "lib"]
