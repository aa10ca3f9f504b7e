"""The body of FreeMoCap: mediapipe_body_3d_xyz.csv or .npy, in millimetres.

The tool: https://github.com/freemocap/freemocap
"""

import csv
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.capture.readers.keypoints.keypoints import MEDIAPIPE, Keypoints
from mua.errors import InputError

MILLIMETRE = 0.001
RATE = 30.0  # frames per second; the files do not say
AXES = ("_x", "_y", "_z")


def read_freemocap(path: Path) -> Keypoints:
    """Read a .csv or .npy; raises InputError that names the file and what is wrong in it."""
    names, points = _array(path) if path.suffix.lower() == ".npy" else _table(path)
    if not len(points):
        raise InputError(f"{path}: has no frames")
    return Keypoints(path, names, MILLIMETRE * points, RATE)


def _array(path: Path) -> tuple[tuple[str, ...], Array]:
    """Names [K] and points [F, K, 3] of a .npy, whose first points are MediaPipe's of the body."""
    try:
        points = np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as .npy: {error}") from error
    if points.ndim != 3 or points.shape[1] < len(MEDIAPIPE) or points.shape[2] != 3 or points.dtype.kind != "f":
        raise InputError(
            f"{path}: holds {points.dtype} {list(points.shape)}; expected coordinates [frames, "
            f"{len(MEDIAPIPE)} or more, 3]"
        )
    return MEDIAPIPE, points[:, : len(MEDIAPIPE)].astype(float)


def _table(path: Path) -> tuple[tuple[str, ...], Array]:
    """Names [K] and points [F, K, 3] of a .csv with the columns x, y and z of each point."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            head, *rows = csv.reader(file)
    except (OSError, ValueError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a table: {error}") from error
    named = [title[:-2] for title in head[::3]]
    if len(head) % 3 or head != [name + axis for name in named for axis in AXES]:
        raise InputError(f"{path}: the columns are {', '.join(head[:4])[:60]}; expected x, y and z of each point")
    values = np.array([_row(path, line, row, len(head)) for line, row in enumerate(rows, 2) if row])
    return tuple(name.removeprefix("body_") for name in named), values.reshape(-1, len(named), 3)


def _row(path: Path, line: int, row: list[str], count: int) -> list[float]:
    """The numbers of a line; not a number where a cell is empty."""
    if len(row) != count:
        raise InputError(f"{path}, line {line}: has {len(row)} cells; expected {count}")
    try:
        return [float(cell) if cell.strip() else np.nan for cell in row]
    except ValueError as error:
        raise InputError(f"{path}, line {line}: {error}") from error
