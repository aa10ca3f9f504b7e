"""What a capture is: cameras around a person, clips that they filmed, and where the files lie.

The world is in metres, right-handed and Y up. Cameras have OpenCV's axes: x to the right, y down, z forward.
Pixels count from the picture's upper left corner, so the first pixel's centre lies at (0.5, 0.5).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self, TypeVar

import numpy as np

from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.errors import InputError

FILE, FORMAT, VERSION = "capture.json", "mua-capture", 1
COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")  # of OpenCV's distortion
UNDISTORTED = (0.0,) * len(COEFFICIENTS)
FRAME = "{frame"  # how the place of a frame's number begins in a pattern
_AXES = np.diag([1.0, -1, -1, 1])  # OpenCV's camera axes and an eye's: y down and up, z forward and back


@dataclass(frozen=True, eq=False)
class CaptureCamera:
    """One calibrated camera; its distortion is undone where pictures are read."""

    name: str
    size: tuple[int, int]  # width, height, pixels
    focal: tuple[float, float]  # along columns and rows, pixels
    centre: tuple[float, float]  # column and row of the principal point, pixels
    world_to_camera: Array  # [4, 4] metres
    distortion: tuple[float, ...] = UNDISTORTED  # COEFFICIENTS
    held_out: bool = False

    def camera(self) -> Camera:
        """The same pinhole as a view; of a distorted camera, what it would see without distortion."""
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

    def cropped(self, box: tuple[int, int, int, int]) -> Self:
        """The camera of a part of its picture: left, upper, right and lower edge in pixels, which may lie outside."""
        left, upper, right, lower = box
        centre = (self.centre[0] - left, self.centre[1] - upper)
        return replace(self, size=(right - left, lower - upper), centre=centre)

    def resized(self, size: tuple[int, int]) -> Self:
        """The camera of its whole picture at another size."""
        x, y = size[0] / self.size[0], size[1] / self.size[1]
        focal = (self.focal[0] * x, self.focal[1] * y)
        return replace(self, size=size, focal=focal, centre=(self.centre[0] * x, self.centre[1] * y))


@dataclass(frozen=True)
class CaptureClip:
    """Frames that all cameras filmed; frame k shows pose `first` + k of the motion."""

    name: str
    motion: Path
    first: int  # pose of the motion, at the capture's rate, that frame 0 shows
    frames: int
    held_out: bool = False


@dataclass(frozen=True, eq=False)
class Capture:
    """A folder with pictures of a person. Patterns are paths below it that name {clip}, {camera} and {frame}."""

    folder: Path
    name: str
    rate: float  # frames per second
    template: Path
    cameras: tuple[CaptureCamera, ...]
    clips: tuple[CaptureClip, ...]
    images: str  # pattern of pictures, or of videos where it names no {frame}
    masks: str | None = None  # as images; None: the alpha of the images
    backgrounds: str | None = None  # pattern of the empty set, a picture for each camera
    meshes: str | None = None  # pattern of surfaces in the world, metres
    tracks: str | None = None  # pattern of points followed through a clip
    template_height: float | None = None  # metres; None: as the file says
    leave_out: tuple[str, ...] = ()  # meshes, nodes or materials of the template that nobody filmed

    @property
    def file(self) -> Path:
        """What describes the capture."""
        return self.folder / FILE

    def camera(self, name: str) -> CaptureCamera:
        """The camera of a name; raises InputError where there is none."""
        return _named(self.cameras, name, f"{self.file}: cameras")

    def clip(self, name: str) -> CaptureClip:
        """The clip of a name; raises InputError where there is none."""
        return _named(self.clips, name, f"{self.file}: clips")

    def place(self, pattern: str, *, clip: str = "", camera: str = "", frame: int = 0) -> Path:
        """The file that a pattern names."""
        return self.folder / pattern.format(clip=clip, camera=camera, frame=frame)


Named = TypeVar("Named", CaptureCamera, CaptureClip)


def _named(listed: Sequence[Named], name: str, where: str) -> Named:
    for one in listed:
        if one.name == name:
            return one
    raise InputError(f"{where}: none is called {name!r}; there are {', '.join(one.name for one in listed)}")
