"""Returns freed memory to the system; glibc keeps it for later, separately for each thread."""

import ctypes
import sys


def release_memory() -> None:
    """Return freed memory to the system; does nothing if the C library has no such call."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # musl has none
        if trim is not None:
            trim(0)
