"""Starts Warp on the CPU without its greeting and its complaint about a missing GPU."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

import warp as wp

# Module options for kernels whose numbers are never NaN: a minimum is one instruction then. Warp's own headers use NaN
# in what no kernel of ours calls, which the compiler would warn of at a first launch.
FLAGS = wp.config.cpu_compiler_flags or "-march=native"
NO_NANS = {"cpu_compiler_flags": f"{FLAGS} -menable-no-nans -Wno-nan-infinity-disabled"}
NO_GPU = b"Could not find or load the NVIDIA CUDA driver"  # the teacher runs on the CPU anyway


def start() -> None:
    """Start Warp; a second call does nothing."""
    wp.config.log_level = wp.LOG_ERROR
    with _without(NO_GPU):
        wp.init()


@contextmanager
def _without(marker: bytes) -> Iterator[None]:
    """Leave out the lines of standard error that hold `marker`, also those that are written past Python."""
    try:
        kept = os.dup(2)
    except OSError:  # there is no standard error
        yield
        return
    with tempfile.TemporaryFile() as caught:
        os.dup2(caught.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            caught.seek(0)
            for line in caught.readlines():
                if marker not in line:
                    os.write(2, line)
