"""A capture: cameras around a person, clips that they filmed, and where the files lie."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

from mua.atlas.character_surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.capture.camera import CaptureCamera
from mua.capture.poses import cut_poses, every, template_poses
from mua.capture.view import Files, View, read_view
from mua.characters.figure_size import FigureSize
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.files.inputs import CAPTURE
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.rig.character import Character

FORMAT, VERSION = "mua-capture", 1
FRAME = "{frame"  # how the place of a frame's number begins in a pattern
ATLAS = 1024  # texels of the template's base-colour atlas along a side


@dataclass(frozen=True)
class CaptureClip:
    """Frames that all cameras filmed; frame k shows pose `first` + k of the motion."""

    name: str
    motion: Path
    first: int  # pose of the motion, at the capture's rate, that frame 0 shows
    frames: int
    held_out: bool = False
    first_image: int = 0  # what {frame} is for frame 0, or the frame of the video that shows it


@dataclass(frozen=True, eq=False)
class Capture:
    """A folder with images of a person. Patterns are paths below it that name {clip}, {camera} and {frame}."""

    folder: Path
    name: str
    rate: float  # frames per second
    template: Path
    cameras: tuple[CaptureCamera, ...]
    clips: tuple[CaptureClip, ...]
    images: str  # pattern of images, or of videos where it names no {frame}
    masks: str | None = None  # as images; None: the alpha of the images
    backgrounds: str | None = None  # pattern of the empty set, an image for each camera
    meshes: str | None = None  # pattern of surfaces in the world, metres
    tracks: str | None = None  # pattern of points followed through a clip, in the world
    tracks_2d: str | None = None  # pattern of points followed through a camera's images of a clip
    template_height: float | None = None  # metres; None: as the file says
    leave_out: tuple[str, ...] = ()  # meshes, nodes or materials of the template that nobody filmed
    trim_masks: int = 0  # pixels by which masks are made narrower all round, because they show background

    @property
    def file(self) -> Path:
        """The capture.json that describes the capture."""
        return self.folder / CAPTURE

    def camera(self, name: str) -> CaptureCamera:
        """The camera of a name; raises InputError where there is none."""
        return _named(self.cameras, name, f"{self.file}: cameras")

    def clip(self, name: str) -> CaptureClip:
        """The clip of a name; raises InputError where there is none."""
        return _named(self.clips, name, f"{self.file}: clips")

    def place(self, pattern: str, *, clip: str = "", camera: str = "", frame: int = 0) -> Path:
        """The file that a pattern names; `frame` counts from 0 in the clip."""
        number = frame + (self.clip(clip).first_image if clip else 0)
        return self.folder / pattern.format(clip=clip, camera=camera, frame=number)

    def view(
        self,
        clip: str,
        frame: int,  # from 0 in the clip
        camera: str,
        *,
        crop: bool = False,
        rows: int | None = None,
    ) -> View:
        """A camera's view of a frame, without distortion: image, mask, background and the pinhole that fits them.

        With `crop` only the box around the mask and a margin; with `rows` as if the whole image had so many rows.
        Errors: InputError with one sentence that names the file where an image is missing or is not the camera's.
        """
        seen, filmed = self.camera(camera), self.clip(clip)
        if not 0 <= frame < filmed.frames:
            raise InputError(f"{self.file}: frame is {frame}; clip {clip!r} has frames 0 to {filmed.frames - 1}")
        return read_view(self.files(clip, frame, camera), seen, crop=crop, rows=rows)

    def files(self, clip: str, frame: int, camera: str) -> Files:
        """The files of a view's images."""
        image, mask, background = (
            None if pattern is None else self.place(pattern, clip=clip, camera=camera, frame=frame)
            for pattern in (self.images, self.masks, self.backgrounds)
        )
        assert image is not None
        return Files(image, mask, background, self.clip(clip).first_image + frame, self.trim_masks)

    @cached_property
    def surfaces(self) -> Surfaces:
        """The template's skinned surface as its file has it, in metres; read once."""
        return read_surfaces(self.template, size=FigureSize(height=self.template_height), leave_out=self.leave_out)

    def character(self) -> Character:
        """The template with one UV layout and one image for all its materials; charts are cut where it has none."""
        return build_atlas(self.surfaces, uv="auto", size=ATLAS)

    def motion(self, clip: str) -> Clip:
        """The poses of a clip's frames on the template's skeleton, at the capture's rate: one for each frame.

        Errors: InputError where the motion cannot be read, does not fit the template, or is too short.
        """
        return every(self.moving(clip), self.steps)

    def moving(self, clip: str) -> Clip:
        """The motion of a clip with the poses between frames: `steps` from one frame to the next."""
        filmed = self.clip(clip)
        whole = self._poses(clip, self.steps)
        return cut_poses(whole, filmed.motion, first=filmed.first, frames=filmed.frames, steps=self.steps)

    @property
    def steps(self) -> int:
        """Poses from one frame to the next, so that they are at least as close in time as those of a window."""
        return math.ceil(RATE / self.rate)

    def whole_motion(self, clip: str) -> Clip:
        """All poses of a clip's motion, also those before and after what was filmed."""
        return self._poses(clip, 1)

    def _poses(self, clip: str, steps: int) -> Clip:
        return template_poses(self.clip(clip).motion, self.surfaces, rate=steps * self.rate, name=clip)


Named = TypeVar("Named", CaptureCamera, CaptureClip)


def _named(listed: Sequence[Named], name: str, where: str) -> Named:
    for one in listed:
        if one.name == name:
            return one
    raise InputError(f"{where}: none is called {name!r}; there are {', '.join(one.name for one in listed)}")
