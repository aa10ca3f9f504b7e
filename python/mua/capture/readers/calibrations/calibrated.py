"""A camera as a calibration file gives it: in any unit, in a world of any axes, perhaps without a size of images."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from mua import rotation
from mua.arguments import finite_array
from mua.arrays import Array
from mua.capture.camera import COEFFICIENTS, UNDISTORTED, CaptureCamera
from mua.errors import InputError

ROUNDING = 1e-3  # what a few digits leave of a rotation
SAME_ASPECT = 0.005  # by which sides may differ in proportion in images that were only made smaller
OPENCV_PIXEL = 0.5  # from where OpenCV counts, the first pixel's centre, to that pixel's corner


@dataclass(frozen=True, eq=False)
class Calibrated:
    """A camera of a calibration file; its first pixel's corner is at (0, 0)."""

    name: str
    where: str  # file and camera, as sentences name them
    size: tuple[int, int] | None  # width, height, pixels; None where the file does not say
    focal: tuple[float, float]
    centre: tuple[float, float]
    distortion: tuple[float, ...]
    world_to_camera: Array  # [4, 4], lengths in the file's unit

    @classmethod
    def of_opencv(
        cls,
        name: str,
        where: str,
        *,
        matrix: Any,  # [3, 3]
        distortion: Any,  # [4 or more], OpenCV's
        turn: Any,  # [3] axis times angle, or [3, 3]
        translation: Any,  # [3]
        size: Any = None,  # [2]
    ) -> Self:
        """A camera from OpenCV's matrices, as files hold them; raises InputError for impossible values."""
        intrinsic = finite_array(matrix, f"{where}: camera matrix", (3, 3))
        if abs(intrinsic[0, 1]) > ROUNDING * abs(intrinsic[0, 0]):
            raise InputError(f"{where}: the skew is {intrinsic[0, 1]:g}, expected 0")
        return cls.of_pinhole(
            name,
            where,
            size=size,
            focal=(intrinsic[0, 0], intrinsic[1, 1]),
            centre=intrinsic[:2, 2] + OPENCV_PIXEL,
            distortion=coefficients(distortion, where),
            world_to_camera=rigid(turn, translation, where),
        )

    @classmethod
    def of_pinhole(
        cls,
        name: str,
        where: str,
        *,
        size: Any,  # [2], or None
        focal: Any,  # [2] pixels
        centre: Any,  # [2] pixels from the first one's corner
        world_to_camera: Array,  # [4, 4]
        distortion: tuple[float, ...] = UNDISTORTED,
    ) -> Self:
        """A camera of finite numbers in pixels; raises InputError for focal lengths or a size that cannot be."""
        (fx, fy), (column, row) = focal, centre
        if fx <= 0 or fy <= 0:
            raise InputError(f"{where}: the focal lengths are {fx:g} and {fy:g}, expected above 0")
        return cls(
            name=name,
            where=where,
            size=None if size is None else _size(size, where),
            focal=(float(fx), float(fy)),
            centre=(float(column), float(row)),
            distortion=distortion,
            world_to_camera=world_to_camera,
        )

    def camera(
        self,
        size: tuple[int, int],  # width, height of the images
        *,
        name: str,  # of the images
        scale: float,  # metres in one unit of the file
        axes: Array,  # [3, 3] from our world to the file's
    ) -> CaptureCamera:
        """The camera of images, which may be smaller than those that were calibrated."""
        matrix = self.world_to_camera.copy()
        matrix[:3, :3] = matrix[:3, :3] @ axes
        matrix[:3, 3] *= scale
        found = CaptureCamera(name, self.size or size, self.focal, self.centre, matrix, self.distortion)
        if found.size == size:
            return found
        across, down = size[0] / found.size[0], size[1] / found.size[1]
        if abs(across / down - 1) > SAME_ASPECT:
            raise InputError(
                f"{self.where}: was calibrated for images of {found.size[0]} x {found.size[1]}, those of {name} are "
                f"{size[0]} x {size[1]}; expected the same, or both sides smaller by the same factor"
            )
        return found.resized(size)


def coefficients(values: Any, where: str) -> tuple[float, ...]:
    """OpenCV's distortion as this project has it; raises InputError for a model with more than its five numbers."""
    found = finite_array(np.ravel(values), f"{where}: distortion", (None,))
    if found[len(COEFFICIENTS) :].any():
        raise InputError(
            f"{where}: the distortion has {len(found)} coefficients; expected {', '.join(COEFFICIENTS)}. Undistort the "
            "images first"
        )
    padded = [*found.tolist(), *[0.0] * len(COEFFICIENTS)][: len(COEFFICIENTS)]
    return tuple(float(value) for value in padded)


def rigid(turn: Any, translation: Any, where: str) -> Array:
    """World to camera [4, 4] of a rotation vector or matrix and a translation."""
    values = finite_array(np.ravel(turn), f"{where}: rotation", (None,))
    if len(values) not in (3, 9):
        raise InputError(f"{where}: rotation has {len(values)} numbers, expected 3 or 9")
    matrix = np.eye(4)
    matrix[:3, :3] = values.reshape(3, 3) if len(values) == 9 else _of_vector(values)
    if abs(matrix[:3, :3] @ matrix[:3, :3].T - np.eye(3)).max() > ROUNDING or np.linalg.det(matrix[:3, :3]) < 0:
        raise InputError(f"{where}: the rotation matrix is not orthonormal and right-handed")
    matrix[:3, 3] = finite_array(np.ravel(translation), f"{where}: translation", (3,))
    return matrix


def _of_vector(
    vector: Array,  # [3] axis times angle
) -> Array:
    angle = float(np.linalg.norm(vector))
    axis = vector / angle if angle > 0 else np.array([1.0, 0, 0])
    return rotation.to_matrix(rotation.from_axis_angle(axis, angle))


def _size(values: Any, where: str) -> tuple[int, int]:
    width, height = finite_array(values, f"{where}: size", (2,))
    if width < 1 or height < 1:
        raise InputError(f"{where}: size is {width:g} x {height:g}, expected width and height in pixels")
    return int(width), int(height)
