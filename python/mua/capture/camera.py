"""A calibrated camera of a capture, and what it becomes where its image is cut or made smaller.

Cameras have OpenCV's axes: x to the right, y down, z forward. Pixels count from the image's upper left corner, so the
first pixel's centre lies at (0.5, 0.5). The world is in metres, right-handed and Y up.
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera

COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")  # of OpenCV's distortion
UNDISTORTED = (0.0,) * len(COEFFICIENTS)
_AXES = np.diag([1.0, -1, -1, 1])  # OpenCV's camera axes and an eye's: y down and up, z forward and back


@dataclass(frozen=True, eq=False)
class CaptureCamera:
    """One calibrated camera; its distortion is undone where images are read."""

    name: str
    size: tuple[int, int]  # width, height, pixels
    focal: tuple[float, float]  # along columns and rows, pixels
    centre: tuple[float, float]  # column and row of the principal point, pixels
    world_to_camera: Array  # [4, 4] metres
    distortion: tuple[float, ...] = UNDISTORTED  # COEFFICIENTS
    held_out: bool = False

    def camera(self) -> Camera:
        """The pinhole to render with; of a distorted camera, what it would see without distortion."""
        (width, height), (fx, fy), (cx, cy) = self.size, self.focal, self.centre
        projection = np.array(
            [
                [2 * fx / width, 0, 1 - 2 * cx / width, 0],
                [0, 2 * fy / height, 2 * cy / height - 1, 0],
                [0, 0, -1, -2 * NEAR],
                [0, 0, -1, 0],
            ]
        )
        return Camera(_AXES @ self.world_to_camera, projection, self.size)

    @property
    def position(self) -> Array:
        """[3] world, metres."""
        return np.asarray(-self.world_to_camera[:3, :3].T @ self.world_to_camera[:3, 3])

    @property
    def field_of_view(self) -> float:
        """From the left to the right edge of the image, degrees."""
        left, right = self.centre[0] / self.focal[0], (self.size[0] - self.centre[0]) / self.focal[0]
        return float(np.degrees(np.arctan(left) + np.arctan(right)))

    def cropped(self, box: tuple[int, int, int, int]) -> Self:
        """The camera of a part of its image: left, upper, right and lower edge in pixels, which may lie outside."""
        left, upper, right, lower = box
        centre = (self.centre[0] - left, self.centre[1] - upper)
        return replace(self, size=(right - left, lower - upper), centre=centre)

    def resized(self, size: tuple[int, int]) -> Self:
        """The camera of its whole image at another size."""
        x, y = size[0] / self.size[0], size[1] / self.size[1]
        focal = (self.focal[0] * x, self.focal[1] * y)
        return replace(self, size=size, focal=focal, centre=(self.centre[0] * x, self.centre[1] * y))
