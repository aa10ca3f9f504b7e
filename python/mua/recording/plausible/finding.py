"""A likely mistake in units or conventions."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """A sentence with the likely cause; `certain` where nothing else explains the numbers."""

    sentence: str
    certain: bool


class LikelyMistake(UserWarning):
    """Warns of a frame that was recorded although it looks like a mistake."""
