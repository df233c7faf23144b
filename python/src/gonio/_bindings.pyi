"""The public headers of the C library, as cffi has them."""
from typing import Any

ffi: Any
lib: Any
