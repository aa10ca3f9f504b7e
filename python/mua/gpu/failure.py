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
    except (wgpu.GPUError, RuntimeError) as error:
        raise InputError(f"{subject}: {_reason(error)}") from error


def _reason(error: Exception) -> str:
    """wgpu gives lost devices and exhausted memory as validation errors too: its messages distinguish them."""
    text = " ".join(str(error).split())
    if isinstance(error, wgpu.GPUOutOfMemoryError) or "not enough memory" in text.lower():
        return "the device is out of memory"
    return "the device was lost" if "lost" in text.lower() else f"the device refused: {text}"
