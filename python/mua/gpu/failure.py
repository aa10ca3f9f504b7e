"""Turns what wgpu raises into the one sentence that a user sees."""

from collections.abc import Iterator
from contextlib import contextmanager

import wgpu

from mua.errors import InputError


@contextmanager
def naming(subject: str) -> Iterator[None]:
    """Raise InputError that names `subject` where the device refuses, runs out of memory or is lost."""
    try:
        yield
    except wgpu.GPUOutOfMemoryError as error:
        raise InputError(f"{subject}: the device is out of memory") from error
    except (wgpu.GPUError, RuntimeError) as error:
        said = " ".join(str(error).split())
        reason = "the device was lost" if "lost" in said.lower() else f"the device refused: {said}"
        raise InputError(f"{subject}: {reason}") from error
