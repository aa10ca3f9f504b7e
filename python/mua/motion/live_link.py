"""Recordings of the Live Link Face app: a row of 61 numbers for each frame of a face, of which 52 are ARKit's weights.

https://dev.epicgames.com/documentation/en-us/unreal-engine/recording-face-animation-on-ios-device-in-unreal-engine
"""

import csv
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.errors import InputError

RATES = (24, 25, 30, 48, 50, 60)  # frames per second that the app records at
FIRST = "Timecode"
COUNT = "BlendShapeCount"
TURNS = ("Yaw", "Pitch", "Roll")  # ends of the columns that turn head and eyes, radians


def read_live_link(path: Path) -> tuple[float, tuple[str, ...], Array]:
    """The rate, the names of the expressions and their weights [F, S], 0 to 1; missing frames are filled linearly.

    Errors: InputError that names line and column where something else is written.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as opened:
            rows = [row for row in csv.reader(opened) if row]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a CSV file: {error}") from error
    header = [name.strip() for name in rows[0]] if rows else []
    if header[:1] != [FIRST] or len(header) < 3:
        raise InputError(f"{path}: the first line is {','.join(header)[:60]!r}, expected {FIRST},{COUNT}, then names")
    if len(rows) < 2:
        raise InputError(f"{path}: holds no frame")
    values = np.array([_numbers(path, line, row, header) for line, row in enumerate(rows[1:], 2)])
    codes = [_timecode(path, line, row[0]) for line, row in enumerate(rows[1:], 2)]
    most = max(frame for _, frame in codes)
    rate = next((rate for rate in RATES if rate > most), 0)
    if not rate:
        raise InputError(f"{path}: a timecode counts {most:g} frames in a second, expected less than {RATES[-1]}")
    at = np.array([seconds * rate + frame for seconds, frame in codes])
    late = np.flatnonzero(np.diff(at) <= 0)
    if len(late):
        line = int(late[0]) + 3
        raise InputError(f"{path}: line {line}: the timecode {rows[line - 1][0]} does not follow the one before it")
    frames = np.arange(at[0], at[-1] + 1e-6)
    kept = [column for column, name in enumerate(header[2:]) if not name.endswith(TURNS)]
    weights = np.stack([np.interp(frames, at, values[:, column]) for column in kept], axis=1)
    return float(rate), tuple(header[2 + column] for column in kept), np.clip(weights, 0, 1)


def _numbers(path: Path, line: int, row: list[str], header: list[str]) -> list[float]:
    if len(row) != len(header):
        raise InputError(f"{path}: line {line} holds {len(row)} values, expected the {len(header)} of the first line")
    found = []
    for name, text in zip(header[2:], row[2:], strict=True):
        try:
            value = float(text)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise InputError(f"{path}: line {line}: {name} is {text!r}, expected a finite number")
        found.append(value)
    return found


def _timecode(path: Path, line: int, text: str) -> tuple[int, float]:
    """Whole seconds and frames of hours:minutes:seconds:frames."""
    try:
        hours, minutes, seconds, frames = text.replace(";", ":").split(":")
        whole, part = 3600 * int(hours) + 60 * int(minutes) + int(seconds), float(frames)
    except ValueError:
        whole, part = 0, -1.0
    if not 0 <= part < 1000:
        raise InputError(f"{path}: line {line}: {FIRST} is {text!r}, expected hours:minutes:seconds:frames")
    return whole, part
