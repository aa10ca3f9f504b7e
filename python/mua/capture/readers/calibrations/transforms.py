"""The transforms.json of Nerfstudio and instant-ngp: a camera for every image, with OpenGL's axes.

The format: https://docs.nerf.studio/quickstart/data_conventions.html
"""

import json
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from mua.arguments import finite_array
from mua.capture.readers.calibrations.calibrated import Calibrated, coefficients, rigid
from mua.errors import InputError

PINHOLES = ("OPENCV", "PINHOLE", "SIMPLE_PINHOLE")
NEEDED = ("fl_x", "fl_y", "cx", "cy", "w", "h")  # pixels, from the first one's corner
LENS = ("k1", "k2", "p1", "p2", "k3", "k4")
OPENGL = np.diag([1.0, -1, -1, 1])


def is_transforms(path: Path) -> bool:
    """Whether a file is called as one of these programs calls it."""
    return path.name.startswith("transforms") and path.suffix.lower() == ".json"


def read_transforms(path: Path) -> tuple[Calibrated, ...]:
    """A camera for every image, called as the image without its suffix: `cam00`, or `cam00/000000`.

    Errors: InputError that names file, image and value.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as JSON: {error}") from error
    frames = content.get("frames") if isinstance(content, dict) else None
    if not isinstance(frames, list) or not frames or not all(isinstance(one, dict) for one in frames):
        raise InputError(f"{path}: expected an object with a list of at least one of frames")
    return tuple(_camera({**content, **frame}, f"{path}: {frame.get('file_path', 'a frame')}") for frame in frames)


def _camera(fields: dict[str, Any], where: str) -> Calibrated:
    for needed in ("file_path", "transform_matrix", *NEEDED):
        if needed not in fields:
            raise InputError(f"{where}: holds no {needed}; expected {', '.join(NEEDED)} in pixels")
    model = fields.get("camera_model", PINHOLES[0])
    if model not in PINHOLES or fields.get("is_fisheye"):
        raise InputError(f"{where}: camera_model is {model!r}, or a fisheye; undistort the images first")
    fx, fy, column, row, width, height = (float(finite_array(fields[key], f"{where}: {key}", ())) for key in NEEDED)
    matrix = finite_array(fields["transform_matrix"], f"{where}: transform_matrix", (4, 4))
    camera_to_world = rigid(matrix[:3, :3], matrix[:3, 3], where)
    return Calibrated.of_pinhole(
        _name(str(fields["file_path"])),
        where,
        size=(width, height),
        focal=(fx, fy),
        centre=(column, row),
        world_to_camera=OPENGL @ np.linalg.inv(camera_to_world),
        distortion=coefficients([fields.get(key, 0.0) for key in LENS], where),
    )


def _name(file: str) -> str:
    """The camera of an image, whose path begins with the folder of all of them."""
    parts = PurePosixPath(file).with_suffix("").parts
    return "/".join(parts[1:] or parts)
