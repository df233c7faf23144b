"""What goes wrong: an exception for each status of the library, with the library's message, and warnings."""
from __future__ import annotations

from ._backend import ffi, lib


class GonioError(Exception):
    """Any failure of gonio. The message names the file or argument, the place and the remedy."""


class ArgumentError(GonioError, ValueError):
    """Something was asked for that cannot be meant: a wrong shape, an unknown name, a value out of range."""


class OutOfMemoryError(GonioError, MemoryError):
    """Out of memory."""


class FileError(GonioError, OSError):
    """A file could not be opened, read or written."""


class FormatError(GonioError, ValueError):
    """A file is not what it claims to be, or is damaged."""


class DataError(GonioError, ValueError):
    """Well-formed input whose values cannot be used."""


class MismatchError(GonioError, ValueError):
    """Two inputs that do not belong together."""


class UndeterminedError(GonioError, ValueError):
    """Too few independent readings for what is asked."""


class CancelledError(GonioError):
    """The work was stopped. Ctrl-C raises KeyboardInterrupt instead."""


class NumericalError(GonioError, ArithmeticError):
    """A numerical routine did not converge."""


class NotFittedError(GonioError, ValueError, AttributeError):
    """A regressor was asked before it was fitted."""


class GonioWarning(UserWarning):
    """The work goes on, but you should know."""


class DirectionWarning(GonioWarning):
    """Vectors were not of unit length; they were normalised."""


BY_STATUS: dict[int, type[GonioError]] = {
    lib.GONIO_ERROR_ARGUMENT: ArgumentError,
    lib.GONIO_ERROR_MEMORY: OutOfMemoryError,
    lib.GONIO_ERROR_IO: FileError,
    lib.GONIO_ERROR_FORMAT: FormatError,
    lib.GONIO_ERROR_DATA: DataError,
    lib.GONIO_ERROR_MISMATCH: MismatchError,
    lib.GONIO_ERROR_UNDETERMINED: UndeterminedError,
    lib.GONIO_ERROR_CANCELLED: CancelledError,
    lib.GONIO_ERROR_NUMERICAL: NumericalError,
}


def error_of(status: int, message: str) -> GonioError:
    """The exception for a status; without a message it has the status' own text."""
    text = message or ffi.string(lib.gonio_status_text(status)).decode()
    return BY_STATUS.get(status, GonioError)(text)
