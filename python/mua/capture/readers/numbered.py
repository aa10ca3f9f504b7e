"""Images that lie in a folder for each camera and are called by their numbers."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

PICTURES = (".jpg", ".jpeg", ".png")
LEAST_FRAMES = 2  # of a clip
NUMBER = re.compile("[0-9]+$")


def number_of(file: Path) -> int:
    """The number that a file's name ends in."""
    return int(_split(file)[1])


def numbered_files(folder: Path) -> list[Path]:
    """The numbered images of a folder, in order; of several series, the longest."""
    series: dict[str, list[Path]] = {}
    for file in sorted(folder.iterdir()):
        if file.suffix.lower() in PICTURES and NUMBER.search(file.stem):
            series.setdefault(_split(file)[0], []).append(file)
    longest = max(series.values(), key=lambda files: len(files), default=[])
    return sorted(longest, key=number_of)


def numbered_pattern(
    source: Path,
    folder: str,  # below it, with {camera}
    cameras: Sequence[str],
) -> str | None:
    """The pattern of the images of a folder, by what the first of them is called; None where there are none."""
    for camera in cameras:
        place = source / folder.format(camera=camera)
        for file in numbered_files(place) if place.is_dir() else ():
            before, digits = _split(file)
            before = before.replace("{", "{{").replace("}", "}}").replace(camera, "{camera}")
            return f"{folder}/{before}{{frame:0{len(digits)}d}}{file.suffix}"
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


def _split(file: Path) -> tuple[str, str]:
    """What comes before the number that a name ends in, and its digits."""
    digits = NUMBER.findall(file.stem)[0]
    return file.stem.removesuffix(digits), digits
