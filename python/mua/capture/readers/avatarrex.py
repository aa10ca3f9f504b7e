"""Captures in the layout of AvatarReX and THuman4: one calibration in JSON, SMPL-X poses, images by camera.

Written after the published loaders' file names; untried on real downloads.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mua import rotation
from mua.arguments import finite_array
from mua.arrays import Array
from mua.capture.camera import UNDISTORTED, CaptureCamera
from mua.capture.capture import Capture, CaptureClip
from mua.capture.readers.numbered import complete_frames, is_there, numbered_pattern, whole_runs
from mua.capture.readers.smplx import on_template, read_smplx
from mua.characters.figure_size import FigureSize
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.poses_file import write_poses

CALIBRATIONS = ("calibration_full.json", "calibration.json")
POSES = "smpl_params.npz"
FOLDERS = (  # of images and masks
    ("{camera}", "{camera}/mask/pha"),
    ("images/{camera}", "masks/{camera}"),
    ("imgs/{camera}", "masks/{camera}"),
)
RATE = 30.0
Y_UP = np.array([0.0, 1, 0])


def is_avatarrex(source: Path) -> bool:
    """Whether a folder has this layout; raises InputError where it has all but the poses."""
    calibration = next((name for name in CALIBRATIONS if (source / name).is_file()), None)
    if calibration is not None and not (source / POSES).is_file():
        raise InputError(f"{source}: holds {calibration}, but no {POSES} with the poses of SMPL-X")
    return calibration is not None


def read_avatarrex(
    source: Path,
    folder: Path,
    *,
    template: Path,
    rate: float = RATE,
    height: float | None = None,
    leave_out: Sequence[str] = (),
) -> Capture:
    """The capture that a folder of this layout is; writes the poses on the template below `folder`.

    Frames of which a camera lacks image or mask are left out: each run of frames that all have is a clip. The world
    is turned so that Y is up. Errors: InputError with one sentence.
    """
    poses = read_smplx(source / POSES)
    turn = rotation.between(poses.up, Y_UP)
    calibration = next(source / name for name in CALIBRATIONS if (source / name).is_file())
    cameras = tuple(_camera(name, fields, calibration, turn) for name, fields in _cameras(calibration).items())
    names = [camera.name for camera in cameras]
    images, masks = _patterns(source, names)
    skeleton = read_surfaces(template, size=FigureSize(height=height), leave_out=leave_out).skeleton
    clip = on_template(poses, skeleton, turn=turn, rate=rate, where=str(template))
    motion = folder / "motion" / "poses.npz"
    there = complete_frames(source, (images, masks), names, range(len(poses) + 1))
    begin = int(there[-1] and not any(is_there(source, images, name, 0) for name in names))  # counted from 1
    runs = whole_runs(there[begin : begin + len(poses)])
    if not runs:
        raise InputError(
            f"{source}: no two frames in a row have images and masks of all {len(cameras)} cameras; "
            f"looked for {images} and {masks}"
        )
    write_poses(motion, skeleton, clip)
    return Capture(
        folder=folder,
        name=source.name,
        rate=rate,
        template=template,
        cameras=cameras,
        clips=tuple(
            CaptureClip(f"frames_{first:06d}", motion, first, frames, first_image=begin + first)
            for first, frames in runs
        ),
        images=below(source, images),
        masks=below(source, masks),
        template_height=height,
        leave_out=tuple(leave_out),
    )


def below(source: Path, pattern: str) -> str:
    """A pattern of files below another folder; braces in the folder's name are no fields."""
    return f"{source.absolute().as_posix().replace('{', '{{').replace('}', '}}')}/{pattern}"


def _cameras(path: Path) -> dict[str, Any]:
    try:
        cameras = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as JSON: {error}") from error
    if not isinstance(cameras, dict) or not cameras or not all(isinstance(one, dict) for one in cameras.values()):
        raise InputError(f"{path}: expected an object with an object for each camera")
    return cameras


def _camera(name: str, fields: dict[str, Any], path: Path, turn: Array) -> CaptureCamera:
    where = f"{path}: {name}"
    for key in ("K", "R", "T", "imgSize"):
        if key not in fields:
            raise InputError(f"{where}: holds no {key}")
    intrinsic, turned = (_square(fields[key], f"{where}: {key}") for key in ("K", "R"))
    width, height = finite_array(fields["imgSize"], f"{where}: imgSize", (2,))
    matrix = np.eye(4)
    matrix[:3, :3] = turned @ rotation.to_matrix(turn).T
    matrix[:3, 3] = finite_array(np.ravel(fields["T"]), f"{where}: T", (3,))
    coefficients = finite_array(np.ravel(fields.get("distCoeff") or UNDISTORTED), f"{where}: distCoeff", (None,))
    if len(coefficients) not in (4, 5):
        raise InputError(f"{where}: distCoeff has {len(coefficients)} numbers; expected OpenCV's k1, k2, p1, p2, k3")
    return CaptureCamera(
        name=name,
        size=(int(width), int(height)),
        focal=(float(intrinsic[0, 0]), float(intrinsic[1, 1])),
        centre=(float(intrinsic[0, 2]) + 0.5, float(intrinsic[1, 2]) + 0.5),  # OpenCV's first pixel is at 0
        world_to_camera=matrix,
        distortion=(*coefficients.tolist(), 0.0)[:5],
    )


def _square(value: Any, where: str) -> Array:
    """A matrix [3, 3], in rows or flat."""
    return finite_array(np.ravel(value), where, (9,)).reshape(3, 3)


def _patterns(source: Path, names: Sequence[str]) -> tuple[str, str]:
    """The patterns of images and masks, by the first layout of `FOLDERS` that has both."""
    for folders in FOLDERS:
        found = [numbered_pattern(source, folder, names) for folder in folders]
        if found[0] is not None and found[1] is None:
            raise InputError(f"{source / folders[1].format(camera=names[0])}: found no masks; expected 00000000.jpg")
        if found[0] is not None and found[1] is not None:
            return found[0], found[1]
    tried = ", ".join(f"{images}/00000000.jpg" for images, _ in FOLDERS)
    raise InputError(f"{source}: found no images of camera {names[0]}; looked for {tried}")
