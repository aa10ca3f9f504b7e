"""A folder with a .json for each frame: keypoints3d/ of EasyMocap, or what OpenPose writes with --3d.

The files: https://github.com/zju3dv/EasyMocap/blob/master/doc/02_output.md and
https://github.com/CMU-Perceptual-Computing-Lab/openpose/blob/master/doc/02_output.md
"""

import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.capture.readers.keypoints.keypoints import BODY_25, COCO, Keypoints
from mua.errors import InputError

RATE = 30.0  # frames per second; the files do not say


def read_openpose(folder: Path) -> Keypoints:
    """Read the person who is in most frames; frames without them, and numbers without a file, hold no points.

    Errors: InputError that names file and value.
    """
    frames = {number: _people(file) for number, file in _files(folder).items()}
    seen = Counter(person for people in frames.values() for person in people)
    if not seen:
        raise InputError(f"{folder}: has {len(frames)} numbered .json files with no person; expected keypoints in 3D")
    person = seen.most_common(1)[0][0]
    found = {number: people[person] for number, people in frames.items() if person in people}
    counts = {len(points) for points in found.values()}
    names = _names(folder, min(counts))
    points = np.full((max(frames) - min(frames) + 1, len(names), 3), np.nan)
    for number, rows in found.items():
        points[number - min(frames)] = rows[: len(names)]
    return Keypoints(folder, names, points, RATE)


def _files(folder: Path) -> dict[int, Path]:
    """The files by the last number in their names: 000012.json, or video_000000000012_keypoints.json."""
    numbers = {file: re.findall(r"\d+", file.stem) for file in sorted(folder.glob("*.json"))}
    return {int(found[-1]): file for file, found in numbers.items() if found}


def _people(file: Path) -> dict[str, Array]:
    """The points [K, 3] of each person of a frame, by their number."""
    try:
        read = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: cannot be read as JSON: {error}") from error
    people = read.get("people") if isinstance(read, dict) else read
    if not isinstance(people, list) or not all(isinstance(person, dict) for person in people):
        raise InputError(f"{file}: is no list of people; expected EasyMocap's or OpenPose's keypoints")
    points = {str(person.get("id", person.get("person_id"))): _points(file, person) for person in reversed(people)}
    return {name: rows for name, rows in points.items() if len(rows)}


def _points(file: Path, person: dict[str, Any]) -> Array:
    """Points [K, 3] of a person; not a number where their confidence is 0."""
    values = person.get("keypoints3d", person.get("pose_keypoints_3d"))
    if values is None:
        raise InputError(f"{file}: a person has {', '.join(person)}; expected keypoints3d or pose_keypoints_3d")
    try:
        rows = np.array(values, float)
        rows = rows.reshape(-1, 4) if rows.ndim == 1 else rows
    except (TypeError, ValueError) as error:
        raise InputError(f"{file}: the keypoints are no rows of x, y, z and confidence: {error}") from error
    if rows.ndim != 2 or rows.shape[1] not in (3, 4):
        raise InputError(
            f"{file}: keypoints have the shape {list(rows.shape)}; expected rows of x, y, z and confidence"
        )
    unseen = rows[:, 3] <= 0 if rows.shape[1] == 4 else np.zeros(len(rows), bool)
    return np.where(unseen[:, None], np.nan, rows[:, :3])


def _names(folder: Path, count: int) -> tuple[str, ...]:
    """The names of the first points, by how many points there are."""
    if count >= len(BODY_25):  # hands and face come after the body
        return BODY_25
    if count == len(COCO):
        return COCO
    raise InputError(
        f"{folder}: people have {count} keypoints; expected {len(COCO)} (COCO) or {len(BODY_25)} (BODY_25)"
    )
