"""Captures in the layout of AvatarReX and THuman4: one calibration in JSON, SMPL-X poses, pictures by camera.

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
from mua.capture.smplx import on_template, read_smplx
from mua.characters.figure_size import FigureSize
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.poses_file import write_poses

CALIBRATIONS = ("calibration_full.json", "calibration.json")
POSES = "smpl_params.npz"
PATTERNS = (  # of pictures and masks
    ("{camera}/{frame:08d}.jpg", "{camera}/mask/pha/{frame:08d}.jpg"),
    ("images/{camera}/{frame:08d}.jpg", "masks/{camera}/{frame:08d}.jpg"),
    ("imgs/{camera}/{frame:08d}.jpg", "masks/{camera}/{frame:08d}.jpg"),
)
RATE = 30.0
LEAST_FRAMES = 2  # of a clip
Y_UP = np.array([0.0, 1, 0])


def is_avatarrex(source: Path) -> bool:
    """Whether a folder has this layout."""
    return any((source / name).is_file() for name in CALIBRATIONS) and (source / POSES).is_file()


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

    Frames that a camera lacks are left out: each run of frames that all cameras have is a clip. The world is turned so
    that Y is up. Errors: InputError with one sentence.
    """
    poses = read_smplx(source / POSES)
    turn = rotation.between(poses.up, Y_UP)
    calibration = next(source / name for name in CALIBRATIONS if (source / name).is_file())
    cameras = tuple(_camera(name, said, calibration, turn) for name, said in _cameras(calibration).items())
    images, masks = _patterns(source, cameras)
    skeleton = read_surfaces(template, size=FigureSize(height=height), leave_out=leave_out).skeleton
    clip = on_template(poses, skeleton, turn=turn, rate=rate, where=str(template))
    motion = folder / "motion" / "poses.npz"
    runs = _complete(source, images, cameras, len(poses))
    if not runs:
        raise InputError(f"{source}: no two frames in a row are there for all {len(cameras)} cameras")
    write_poses(motion, skeleton, clip)
    return Capture(
        folder=folder,
        name=source.name,
        rate=rate,
        template=template,
        cameras=cameras,
        clips=tuple(
            CaptureClip(f"frames_{first:06d}", motion, first, frames, first_image=first) for first, frames in runs
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
        said = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as JSON: {error}") from error
    if not isinstance(said, dict) or not said or not all(isinstance(one, dict) for one in said.values()):
        raise InputError(f"{path}: expected an object with an object for each camera")
    return said


def _camera(name: str, said: dict[str, Any], path: Path, turn: Array) -> CaptureCamera:
    where = f"{path}: {name}"
    for key in ("K", "R", "T", "imgSize"):
        if key not in said:
            raise InputError(f"{where}: holds no {key}")
    intrinsic, turned = (_square(said[key], f"{where}: {key}") for key in ("K", "R"))
    width, height = finite_array(said["imgSize"], f"{where}: imgSize", (2,))
    matrix = np.eye(4)
    matrix[:3, :3] = turned @ rotation.to_matrix(turn).T
    matrix[:3, 3] = finite_array(np.ravel(said["T"]), f"{where}: T", (3,))
    coefficients = finite_array(np.ravel(said.get("distCoeff") or UNDISTORTED), f"{where}: distCoeff", (None,))
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


def _patterns(source: Path, cameras: Sequence[CaptureCamera]) -> tuple[str, str]:
    for images, masks in PATTERNS:
        if any((source / images.format(camera=camera.name, frame=0)).parent.is_dir() for camera in cameras):
            return images, masks
    tried = ", ".join(images for images, _ in PATTERNS)
    raise InputError(f"{source}: found no pictures of camera {cameras[0].name}; looked for {tried}")


def _complete(source: Path, images: str, cameras: Sequence[CaptureCamera], frames: int) -> list[tuple[int, int]]:
    """First frame and number of frames of each run that all cameras have."""
    there = [
        all((source / images.format(camera=camera.name, frame=frame)).is_file() for camera in cameras)
        for frame in range(frames)
    ]
    edges = np.flatnonzero(np.diff([False, *there, False]))
    return [(int(a), int(b - a)) for a, b in edges.reshape(-1, 2) if b - a >= LEAST_FRAMES]
