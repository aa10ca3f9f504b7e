"""Returns freed memory to the system; glibc keeps it for later, separately for each thread."""

import ctypes
import sys

ARENAS, TRIM_THRESHOLD, MMAP_THRESHOLD = -8, -1, -3  # mallopt's numbers of glibc's malloc.h
LARGE = 1 << 24  # bytes of a block that goes back at once; below are those of a step of Adam, which come back each step
KEPT = 1 << 26  # bytes above the last block in use that stay


def return_large_blocks() -> None:
    """Let large blocks go back to the system when they are freed; does nothing if the C library has no such call.

    Left to itself glibc keeps blocks of up to 32 MB, separately for each of up to eight threads per core, and puts
    small ones that stay in use into them, so that the next large one needs new room.
    """
    if sys.platform == "linux":
        tune = getattr(ctypes.CDLL(None), "mallopt", None)
        if tune is not None:
            for option, value in ((ARENAS, 2), (TRIM_THRESHOLD, KEPT), (MMAP_THRESHOLD, LARGE)):
                tune(option, value)


def release_memory() -> None:
    """Return freed memory to the system; does nothing if the C library has no such call."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # musl has none
        if trim is not None:
            trim(0)
