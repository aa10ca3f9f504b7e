"""Calibrations as .toml: a table for each camera with OpenCV's matrices.

Written by aniposelib (https://anipose.readthedocs.io), Pose2Sim and FreeMoCap as [cam_01], by Caliscope as [cameras.0].
"""

import tomllib
from pathlib import Path
from typing import Any

from mua.capture.readers.calibrations.calibrated import Calibrated
from mua.errors import InputError

NEEDED = ("matrix", "distortions", "rotation", "translation")


def read_anipose(path: Path) -> tuple[Calibrated, ...]:
    """The cameras of a file; raises InputError that names camera and value."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as TOML: {error}") from error
    within = content["cameras"] if isinstance(content.get("cameras"), dict) else content
    tables = {key: table for key, table in within.items() if isinstance(table, dict) and "matrix" in table}
    if not tables:
        raise InputError(f"{path}: holds no camera: no table has a matrix")
    return tuple(_camera(key, table, path) for key, table in tables.items() if not table.get("ignore"))


def _camera(key: str, table: dict[str, Any], path: Path) -> Calibrated:
    where = f"{path}: camera {key}"
    for needed in NEEDED:
        if needed not in table:
            raise InputError(f"{where}: holds no {needed}")
    if table.get("fisheye"):
        raise InputError(f"{where}: has a fisheye lens; undistort its images first")
    return Calibrated.of_opencv(
        str(table.get("name", key)),
        where,
        matrix=table["matrix"],
        distortion=table["distortions"],
        turn=table["rotation"],
        translation=table["translation"],
        size=table.get("size"),
    )
