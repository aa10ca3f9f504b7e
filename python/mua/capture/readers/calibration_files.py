"""Calibrations of the family of DDC, ASH and UMA: Skeletool's .calibration and TheCaptury's cameras.calib.

Written after descriptions of both formats; untried on real downloads. Both are in millimetres, Y up; a camera's file
counts pixels from the first one's centre.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.capture.camera import UNDISTORTED, CaptureCamera
from mua.capture.readers.calibrations.calibrated import rigid
from mua.errors import InputError

SKELETOOL = "Skeletool Camera Calibration File V1.0"
CAPTURY = "tc camera calibration v0.3"
MILLIMETRES = 1e-3  # metres
VALUES = {"sensor": 2, "size": 2, "animated": 1, "intrinsic": 16, "extrinsic": 16, "radial": 1}
NEEDED = ("size", "intrinsic", "extrinsic")
# Columns of TheCaptury's: camera, frame, sensor, focal length, aspect, offset, model and its numbers, place, axes.
COLUMNS = 23
ASPECT_ROUNDING = 1e-3  # by which rounding leaves square pixels


def read_calibration(
    path: Path,
    *,
    size: tuple[int, int],  # width, height of the images, which TheCaptury's files do not say
) -> tuple[CaptureCamera, ...]:
    """The cameras of a file, by its first line; raises InputError where it is another or a camera has another model."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as text: {error}") from error
    head = lines[0].strip() if lines else ""
    if head == SKELETOOL:
        cameras = _skeletool(path, lines[1:])
    elif head.lower() == CAPTURY:
        cameras = tuple(_captury(path, number, line, size) for number, line in enumerate(lines, 1) if _is_row(line))
    else:
        raise InputError(f"{path}: the first line is {head[:60]!r}; expected {SKELETOOL!r} or {CAPTURY!r}")
    if not cameras:
        raise InputError(f"{path}: holds no camera")
    return cameras


def _skeletool(path: Path, lines: Sequence[str]) -> tuple[CaptureCamera, ...]:
    blocks: list[tuple[str, dict[str, Array]]] = []
    for number, line in enumerate(lines, 2):
        key, *values = line.split() or [""]
        if key == "name":
            blocks.append((" ".join(values), {}))
        elif key and not blocks:
            raise InputError(f"{path}, line {number}: {key!r} comes before the first camera's name")
        elif key in VALUES:
            blocks[-1][1][key] = _numbers(values, VALUES[key], f"{path}, line {number}: {key}")
        elif key:
            raise InputError(f"{path}, line {number}: {key!r} is not read; expected name, {', '.join(VALUES)}")
    return tuple(_skeletool_camera(name, fields, f"{path}: camera {name}") for name, fields in blocks)


def _skeletool_camera(name: str, fields: dict[str, Array], where: str) -> CaptureCamera:
    for key in NEEDED:
        if key not in fields:
            raise InputError(f"{where}: holds no {key}")
    if fields.get("animated", np.zeros(1)).any():
        raise InputError(f"{where}: is animated; expected cameras that stand still")
    if fields.get("radial", np.zeros(1)).any():
        raise InputError(f"{where}: radial is {fields['radial'][0]:g}; undistort the images first and set it to 0")
    intrinsic, extrinsic = fields["intrinsic"].reshape(4, 4), fields["extrinsic"].reshape(4, 4)
    width, height = fields["size"]
    return CaptureCamera(
        name=name,
        size=(int(width), int(height)),
        focal=(float(intrinsic[0, 0]), float(intrinsic[1, 1])),
        centre=(float(intrinsic[0, 2]) + 0.5, float(intrinsic[1, 2]) + 0.5),
        world_to_camera=rigid(extrinsic[:3, :3], extrinsic[:3, 3] * MILLIMETRES, where),
    )


def _is_row(line: str) -> bool:
    """Whether a line of TheCaptury's file is a camera: it begins with its number."""
    return line.split("\t")[0].strip().isdecimal()


def _captury(path: Path, number: int, line: str, size: tuple[int, int]) -> CaptureCamera:
    where, cells = f"{path}, line {number}", line.split()
    if len(cells) != COLUMNS:
        raise InputError(f"{where}: has {len(cells)} columns, expected {COLUMNS}")
    if cells[8].lower() != "opencv":
        raise InputError(f"{where}: the distortion is {cells[8]!r}, expected OpenCV")
    values = _numbers(cells[2:8] + cells[9:], COLUMNS - 3, where)
    sensor, length, aspect, offset = values[:2], values[2], values[3], values[4:6]
    coefficients, origin, up, right = values[6:11], values[11:14], values[14:17], values[17:20]
    if abs(aspect - 1) > ASPECT_ROUNDING:
        raise InputError(f"{where}: the pixels' aspect is {aspect:g}, expected 1")
    if min(sensor) <= 0 or length <= 0:
        raise InputError(f"{where}: the focal length is {length:g} and the sensor {sensor.tolist()}, expected above 0")
    turn = np.stack([right, -up, np.cross(right, -up)])
    world_to_camera = rigid(turn, -turn @ origin * MILLIMETRES, where)
    focal = float(length * size[0] / sensor[0])
    middle = np.array(size) * (0.5 + offset / sensor)
    distortion = tuple(coefficients.tolist()) if coefficients.any() else UNDISTORTED
    return CaptureCamera(
        cells[0], size, (focal, focal), (float(middle[0]), float(middle[1])), world_to_camera, distortion
    )


def _numbers(values: Sequence[str], count: int, where: str) -> Array:
    try:
        found = np.array([float(value) for value in values])
    except ValueError:
        found = np.array([np.nan])
    if len(found) != count or not np.isfinite(found).all():
        raise InputError(f"{where} is {' '.join(values)[:60]!r}, expected {count} finite numbers")
    return found
