""".trc files of Pose2Sim, OpenCap and OpenSim.

The file: https://opensimconfluence.atlassian.net/wiki/spaces/OpenSim/pages/53089972/Marker+.trc+Files
"""

from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.capture.readers.keypoints.keypoints import Keypoints
from mua.errors import InputError

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}  # metres
HEADER = 5  # lines before the first frame
COLUMNS = 2  # before the first point: the frame's number and its time


def read_trc(path: Path) -> Keypoints:
    """Read a .trc file; raises InputError that names line and value."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as text: {error}") from error
    if len(lines) < HEADER or not lines[0].startswith("PathFileType"):
        raise InputError(f"{path}: the first line is {(lines or [''])[0][:40]!r}; expected a .trc with PathFileType")
    header = dict(zip(lines[1].split("\t"), lines[2].split("\t"), strict=False))
    names = tuple(name.strip() for name in lines[3].split("\t")[COLUMNS:] if name.strip())
    unit, rate = header.get("Units", "").strip().lower(), _number(header.get("DataRate", ""))
    if unit not in UNITS:
        raise InputError(f"{path}, line 3: Units is {unit!r}; expected {', '.join(UNITS)}")
    if not rate > 0:
        raise InputError(f"{path}, line 3: DataRate is {header.get('DataRate')!r}; expected frames per second")
    rows = [_row(path, number, line, len(names)) for number, line in enumerate(lines, 1) if number > HEADER]
    found = [row for row in rows if row is not None]
    if not names or not found:
        raise InputError(f"{path}: has {len(names)} keypoints in {len(found)} frames; expected some")
    return Keypoints(path, names, UNITS[unit] * np.stack(found), rate)


def _row(path: Path, number: int, line: str, count: int) -> Array | None:
    """The points [K, 3] of a line; None for an empty one."""
    if not line.strip():
        return None
    cells = line.split("\t")[COLUMNS : COLUMNS + 3 * count]
    cells += [""] * (3 * count - len(cells))  # some programs cut what is empty at the end
    values = np.array([_number(cell) if cell.strip() else np.nan for cell in cells])
    wrong = next((cell for cell, value in zip(cells, values, strict=True) if np.isinf(value)), None)
    if wrong is not None:
        raise InputError(f"{path}, line {number}: {wrong[:40]!r} is not a coordinate")
    return values.reshape(count, 3)


def _number(text: str) -> float:
    """A number; infinity for what is none."""
    try:
        return float(text)
    except ValueError:
        return np.inf
