"""A one-line fault of a shader."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """What is wrong once `original`, which stands once in the file, reads `replacement`."""

    breaks: str
    original: str
    replacement: str
    file: str = ""  # the kernel's own if empty
