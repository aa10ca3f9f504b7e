"""EasyMocap's calibrations: intri.yml and extri.yml, as OpenCV's FileStorage writes them.

The format: https://github.com/zju3dv/EasyMocap/blob/master/doc/quickstart.md
"""

import re
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.capture.readers.calibrations.calibrated import Calibrated
from mua.errors import InputError

INTRINSICS, EXTRINSICS = "intri.yml", "extri.yml"
MATRIX = re.compile(
    r"^(\S+?)\s*:\s*!!opencv-matrix\s+rows:\s*(\d+)\s+cols:\s*(\d+)\s+dt:\s*\S+\s+data:\s*\[([^\]]*)\]", re.M
)
NUMBER = re.compile(r"^([HW]_\S+?)\s*:\s*(\d+)", re.M)


def read_easymocap(folder: Path) -> tuple[Calibrated, ...]:
    """The cameras that both files hold; raises InputError that names camera and value."""
    (intrinsics, sizes), (extrinsics, _) = (_stored(folder / name) for name in (INTRINSICS, EXTRINSICS))
    names = [key[2:] for key in intrinsics if key.startswith("K_") and f"T_{key[2:]}" in extrinsics]
    if not names:
        raise InputError(f"{folder}: no camera has both K_ in {INTRINSICS} and T_ in {EXTRINSICS}")
    return tuple(_camera(name, folder, intrinsics, extrinsics, sizes) for name in names)


def _camera(
    name: str, folder: Path, intrinsics: dict[str, Array], extrinsics: dict[str, Array], sizes: dict[str, float]
) -> Calibrated:
    turn = extrinsics.get(f"Rot_{name}", extrinsics.get(f"R_{name}"))
    if turn is None:
        raise InputError(f"{folder / EXTRINSICS}: camera {name}: holds no R_{name}")
    sides = [sizes.get(f"{side}_{name}") for side in "WH"]
    return Calibrated.of_opencv(
        name,
        f"{folder}: camera {name}",
        matrix=intrinsics[f"K_{name}"],
        distortion=intrinsics.get(f"dist_{name}", np.zeros(5)),
        turn=turn,
        translation=extrinsics[f"T_{name}"],
        size=None if None in sides else sides,
    )


def _stored(path: Path) -> tuple[dict[str, Array], dict[str, float]]:
    """The matrices, and the heights and widths of images."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as text: {error}") from error
    matrices = {}
    for key, rows, columns, data in MATRIX.findall(text):
        try:
            values = np.array([float(value) for value in data.split(",")])
            matrices[key] = values.reshape(int(rows), int(columns))
        except ValueError as error:
            found = " ".join(data.split())[:60]
            raise InputError(f"{path}: {key} is [{found}]; expected {rows} x {columns} numbers") from error
    return matrices, {key: float(value) for key, value in NUMBER.findall(text)}
