"""Memory that was freed, given back to the system: glibc keeps it for later, for each thread apart."""

import ctypes
import sys


def give_back() -> None:
    """Give freed memory back; does nothing where the C library has no such call."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # musl has none
        if trim is not None:
            trim(0)
