"""The files that a player plays."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mua.live.receiver import Receiver


@dataclass(frozen=True)
class Source:
    """Avatars and their motion."""

    files: tuple[Path, ...]  # avatars
    motion: Path | None = None  # motion in place of the files' own clips
    mapping: Mapping[str, str] | None = None  # avatar's joint to joint of the motion
    face: Path | None = None  # facial motion in place of that of the clips
    clip: str | None = None  # clip to begin with, the first if None
    frame: int | None = None  # frame to pause at; None: played from the start
    receiver: Receiver | None = None  # what another program sends, shown first where there is one
