"""Images that lie in a folder for each camera and are called by their numbers."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

PICTURES = (".jpg", ".jpeg", ".png")
LEAST_FRAMES = 2  # of a clip


def numbered_files(folder: Path) -> list[Path]:
    """The numbered images of a folder, in order."""
    found = [file for file in folder.glob("[0-9]*") if file.stem.isdecimal() and file.suffix.lower() in PICTURES]
    return sorted(found, key=lambda file: int(file.stem))


def numbered_pattern(
    source: Path,
    folder: str,  # below it, with {camera}
    cameras: Sequence[str],
) -> str | None:
    """The pattern of the images of a folder, by what the first of them is called; None where there are none."""
    for camera in cameras:
        for file in numbered_files(source / folder.format(camera=camera)):
            return f"{folder}/{{frame:0{len(file.stem)}d}}{file.suffix}"
    return None


def complete_frames(source: Path, patterns: Sequence[str], cameras: Sequence[str], frames: Sequence[int]) -> list[bool]:
    """Whether all cameras have files of all patterns, for each frame."""
    return [
        all(is_there(source, pattern, camera, frame) for camera in cameras for pattern in patterns) for frame in frames
    ]


def is_there(source: Path, pattern: str, camera: str, frame: int) -> bool:
    """Whether a camera has a file of a frame."""
    return (source / pattern.format(camera=camera, frame=frame)).is_file()


def whole_runs(there: Sequence[bool]) -> list[tuple[int, int]]:
    """First frame and number of frames of each run that is there."""
    edges = np.flatnonzero(np.diff([False, *there, False]))
    return [(int(a), int(b - a)) for a, b in edges.reshape(-1, 2) if b - a >= LEAST_FRAMES]
