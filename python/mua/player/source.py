"""What a player was asked to play."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Source:
    """Avatars and what moves them."""

    files: tuple[Path, ...]  # avatars
    motion: Path | None = None  # in place of the files' own clips
    mapping: Mapping[str, str] | None = None  # avatar's joint to joint of the motion
    clip: str | None = None  # to begin with, the first if None
    frame: int | None = None  # to rest at, played from the start if None
