"""The calibration.csv of ActorsHQ: a row for each camera, as its toolbox reads it.

The format: https://github.com/synthesiaresearch/humanrf/blob/main/actorshq/dataset/camera_data.py
"""

import csv
from pathlib import Path

import numpy as np

from mua.arguments import finite_array
from mua.arrays import Array
from mua.capture.readers.calibrations.calibrated import Calibrated, rigid
from mua.errors import InputError

COLUMNS = ("name", "w", "h", "rx", "ry", "rz", "tx", "ty", "tz", "fx", "fy", "px", "py")


def is_actorshq(path: Path) -> bool:
    """Whether a file begins with the columns of such a calibration."""
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        return file.readline().strip().split(",")[: len(COLUMNS)] == list(COLUMNS)


def read_actorshq(path: Path) -> tuple[Calibrated, ...]:
    """The cameras of a file; raises InputError that names camera and value."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise InputError(f"{path}: holds no camera")
    return tuple(_camera(row, f"{path}: camera {row['name']}") for row in rows)


def _camera(row: dict[str, str | None], where: str) -> Calibrated:
    """Focal lengths and centre are shares of the image's sides; rotation and place are the camera's in the world."""
    sides, turn, place, focal, centre = (
        _numbers(row, keys, where) for keys in (("w", "h"), COLUMNS[3:6], COLUMNS[6:9], COLUMNS[9:11], COLUMNS[11:13])
    )
    return Calibrated.of_pinhole(
        str(row["name"]),
        where,
        size=sides,
        focal=focal * sides,
        centre=centre * sides,
        world_to_camera=np.linalg.inv(rigid(turn, place, where)),
    )


def _numbers(row: dict[str, str | None], keys: tuple[str, ...], where: str) -> Array:
    try:
        values = [float(row[key] or "") for key in keys]
    except ValueError as error:
        found = ", ".join(str(row[key]) for key in keys)
        raise InputError(f"{where}: {', '.join(keys)}: expected {len(keys)} numbers, found {found}") from error
    return finite_array(values, f"{where}: {', '.join(keys)}", (len(keys),))
