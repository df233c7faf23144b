"""Calls of the library: a context for each, its messages as exceptions, warnings and log lines, progress, Ctrl-C."""
from __future__ import annotations

import logging
import numbers
import os
import sys
import time
import warnings
from typing import Any, Callable, Optional

import numpy as np

from . import _exceptions as exceptions
from ._backend import ffi, lib

_log = logging.getLogger("gonio")


class Settings:
    """How the library works in this process: ``gonio.settings``.

    Attributes
    ----------
    threads : int
        Most threads of a call; 0 for one per processor. A process that was forked works on one thread unless this is
        set in it.
    progress : bool or None
        Whether work of more than a second shows a tqdm bar. None: if tqdm is installed and standard error is a
        terminal, or in a notebook.
    """

    def __init__(self) -> None:
        self.threads = 0
        self.progress: Optional[bool] = None

    def __repr__(self) -> str:
        return f"gonio.settings(threads={self.threads}, progress={self.progress})"


settings = Settings()
_forked = False


def _after_fork() -> None:
    global _forked
    _forked = True


os.register_at_fork(after_in_child=_after_fork)


def threads() -> int:
    """Threads of a call; OpenMP's threads do not survive a fork."""
    given = int(settings.threads)
    if given < 0:
        raise exceptions.ArgumentError(f"gonio.settings.threads is {given}: it must be 0 or more")
    return given or (1 if _forked else lib.gonio_context_threads(ffi.NULL))


def _in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"


class _Bar:
    """A tqdm bar that appears after a second."""

    def __init__(self) -> None:
        wanted = settings.progress
        if wanted is None:
            wanted = _in_notebook() or bool(sys.stderr is not None and sys.stderr.isatty())
        self._wanted = wanted
        self._begin = time.monotonic()
        self._bar: Any = None

    def show(self, task: str, fraction: float) -> None:
        if not self._wanted or (self._bar is None and time.monotonic() - self._begin < 1.0):
            return
        if self._bar is None:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                self._wanted = False
                return
            self._bar = tqdm(total=1.0, desc=task, leave=False,
                             bar_format="{desc}: {percentage:3.0f} %|{bar}| {remaining} left")
        self._bar.set_description_str(task, refresh=False)
        self._bar.update(fraction - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


class _Call:
    """What one call says while it runs."""

    def __init__(self) -> None:
        self.errors: list[str] = []
        self.warnings: list[str] = []
        self.raised: Optional[BaseException] = None
        self.bar = _Bar()


_interrupts: list[BaseException] = []


def _keep_interrupt(_kind: Any, value: BaseException, _traceback: Any) -> None:
    _interrupts.append(value)


@ffi.def_extern(name="gonio_python_message")  # type: ignore[misc]
def _message(user: Any, level: int, text: Any) -> None:
    call = ffi.from_handle(user)
    line = ffi.string(text).decode(errors="replace")
    if level == lib.GONIO_MESSAGE_ERROR:
        call.errors.append(line)
    elif level == lib.GONIO_MESSAGE_WARNING:
        call.warnings.append(line)
    else:
        _log.info("%s", line)


@ffi.def_extern(name="gonio_python_progress", error=1, onerror=_keep_interrupt)  # type: ignore[misc]
def _progress(user: Any, task: Any, fraction: float) -> int:
    call = ffi.from_handle(user)
    try:
        call.bar.show(ffi.string(task).decode(), fraction)
    except BaseException as error:  # Ctrl-C too: it is raised again when the library has returned
        call.raised = error
    return 0 if call.raised is None else 1


def warn(message: str, category: type[Warning] = exceptions.GonioWarning) -> None:
    """Warns, as if by the caller's line."""
    level = 1
    frame: Any = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "gonio":
        level += 1
        frame = frame.f_back
    warnings.warn(message, category, stacklevel=level)


def _context(call: _Call) -> tuple[Any, Any]:
    handle = ffi.new_handle(call)
    options = ffi.new("gonio_context_options *")
    lib.gonio_context_options_default(options)
    options.message = lib.gonio_python_message
    options.progress = lib.gonio_python_progress
    options.user = handle
    options.threads = threads()
    context = ffi.new("gonio_context **")
    status = lib.gonio_context_create(context, options)
    if status != lib.GONIO_OK:
        raise exceptions.error_of(status, "; ".join(call.errors))
    return context, handle


def run(function: Callable[..., int], *arguments: Any) -> None:
    """Calls function(context, *arguments), which returns a status; raises and warns what it says.

    The GIL is released meanwhile. Ctrl-C stops the work at its next report of progress.
    """
    call = _Call()
    context, _handle = _context(call)
    try:
        status = function(context[0], *arguments)
    finally:
        lib.gonio_context_free(context)
        call.bar.close()
    for line in call.warnings:
        warn(line)
    if call.raised is not None:
        raise call.raised
    if status == lib.GONIO_ERROR_CANCELLED and _interrupts:
        raise _interrupts.pop()
    if status != lib.GONIO_OK:
        raise exceptions.error_of(status, "; ".join(call.errors))


def made(kind: str, function: Callable[..., int], *arguments: Any) -> Any:
    """Calls a function whose last argument is a gonio_KIND **; the object is freed with what is returned. None for
    NULL."""
    out = ffi.new(f"gonio_{kind} **")
    result = None
    try:
        run(function, *arguments, out)
    finally:  # a warning may be an exception
        if out[0] != ffi.NULL:
            result = owned(kind, out[0])
    return result


def owned(kind: str, pointer: Any) -> Any:
    """A pointer whose object is freed with it."""
    free = getattr(lib, f"gonio_{kind}_free")
    new = ffi.new
    return ffi.gc(pointer, lambda p: free(new(f"gonio_{kind} **", p)))


def options(kind: str, **fields: Any) -> Any:
    """A struct of options with its defaults, and the fields that are not None."""
    struct = ffi.new(f"gonio_{kind}_options *")
    getattr(lib, f"gonio_{kind}_options_default")(struct)
    for name, value in fields.items():
        if value is not None:
            try:
                setattr(struct, name, value)
            except (OverflowError, TypeError) as error:
                raise exceptions.ArgumentError(f"{name} is {value!r}: {error}") from None
    return struct


def chosen(value: Any, name: str, table: dict[str, Any]) -> Any:
    """What an argument that is one of some words stands for."""
    if isinstance(value, str) and value in table:
        return table[value]
    raise exceptions.ArgumentError(f"{name} is {value!r}: choose one of {', '.join(map(repr, table))}")


def number(value: Any, name: str, least: float, meaning: str) -> float:
    """An argument that is a finite number of at least `least`."""
    if isinstance(value, numbers.Real) and least <= float(value) < float("inf"):
        return float(value)
    raise exceptions.ArgumentError(f"{name} is {value!r}: it must be {meaning}")


def struct(name: str, **fields: Any) -> Any:
    """A struct of input or output, zeros but for the fields, and its size if it begins with one."""
    made = ffi.new(f"{name} *", fields)
    if hasattr(made, "size"):
        made.size = ffi.sizeof(name)
    return made


def text(pointer: Any) -> str:
    """A C string; empty for NULL."""
    return "" if pointer == ffi.NULL else str(ffi.string(pointer).decode(errors="replace"))


def encoded(path: Any) -> bytes:
    """A file's name as the library takes it."""
    try:
        name = os.fsencode(os.fspath(path))
    except (TypeError, ValueError) as error:
        raise exceptions.ArgumentError(f"{path!r} is no path: {error}") from None
    if b"\0" in name:
        raise exceptions.ArgumentError(f"the path {path!r} has a null character")
    return name


def listed(function: Callable[[int], Any]) -> list[str]:
    """Names from a list of the library, which ends with NULL."""
    names: list[str] = []
    while (name := function(len(names))) != ffi.NULL:
        names.append(text(name))
    return names


class _Seen:
    """Memory of an owner, for NumPy."""

    def __init__(self, owner: Any, address: int, shape: tuple[int, ...], dtype: Any) -> None:
        self.owner = owner
        self.__array_interface__ = {"version": 3, "data": (address, True), "shape": shape,
                                    "typestr": np.dtype(dtype).str}


def view(owner: Any, pointer: Any, shape: tuple[int, ...], dtype: Any = np.float64) -> Any:
    """A read-only array over the library's memory, which keeps the owner alive; None for NULL."""
    if pointer == ffi.NULL:
        return None
    if 0 in shape:
        return np.empty(shape, dtype)
    return np.asarray(_Seen(owner, int(ffi.cast("uintptr_t", pointer)), shape, dtype))


def buffer(array: Any, kind: str = "double") -> Any:
    """A pointer to a contiguous array, which has to stay alive; NULL for None."""
    return ffi.NULL if array is None else ffi.cast(f"{kind} *", ffi.from_buffer(array))


def free_of_change(cls: type) -> type:
    """Class decorator: objects that never change are their own copies."""

    def __copy__(self: Any) -> Any:
        return self

    def __deepcopy__(self: Any, memo: Any) -> Any:
        return self

    cls.__copy__ = __copy__  # type: ignore[attr-defined]
    cls.__deepcopy__ = __deepcopy__  # type: ignore[attr-defined]
    return cls
