"""How well the posed template fits the masks of some views of a capture."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture, CaptureClip
from mua.capture.silhouette import COVERED, overlap, posed_template, silhouette
from mua.capture.view import smaller

ROWS = 256  # of the images that are compared
FRAMES = 5  # of each clip that are looked at
VIEWS = 160  # at most, unless a number of frames is asked for


@dataclass(frozen=True, eq=False)
class Seen:
    """One view, beside what the template covers in it."""

    clip: str
    frame: int
    camera: CaptureCamera  # of the smaller image
    mask: Array  # [h, w] bool
    covered: Array  # [h, w] bool
    overlap: float  # 0..1

    def __str__(self) -> str:
        return f"camera {self.camera.name}, clip {self.clip}, frame {self.frame}"


@dataclass(frozen=True, eq=False)
class Posed:
    """The template in the poses of all clips that could be read."""

    surfaces: Surfaces
    vertices: Mapping[str, Array]  # [F, V, 3] metres, by clip

    @classmethod
    def of(cls, capture: Capture, clips: Sequence[CaptureClip]) -> "Posed":
        surfaces = capture.surfaces
        return cls(surfaces, {clip.name: posed_template(surfaces, capture.motion(clip.name)) for clip in clips})

    def covers(self, clip: str, frame: int, camera: CaptureCamera) -> Array:
        """Whether the template covers each pixel of an image, [h, w] bool."""
        return silhouette(self.vertices[clip][frame], self.surfaces.faces, camera)


def chosen_frames(capture: Capture, clip: CaptureClip, frames: int | None) -> list[int]:
    """Frames of a clip to look at, spread over all of it; `frames` of them, all for 0, or a few for None."""
    if frames is None:
        frames = min(FRAMES, max(1, VIEWS // (len(capture.cameras) * len(capture.clips))))
    count = min(frames or clip.frames, clip.frames)
    if count == clip.frames:
        return list(range(count))
    return [round(at) for at in np.linspace(0, clip.frames - 1, count + 2)[1:-1]]


def look_at(capture: Capture, posed: Posed, clip: str, frame: int, camera: CaptureCamera) -> Seen:
    """Read a view and draw the template into it; raises InputError where it cannot be read."""
    rows = min(ROWS, camera.size[1])
    mask = capture.view(clip, frame, camera.name, rows=rows).mask >= COVERED
    small = smaller(camera, rows)
    covered = posed.covers(clip, frame, small)
    return Seen(clip, frame, small, mask, covered, overlap(covered, mask))


def by_camera(views: Sequence[Seen]) -> Mapping[str, list[Seen]]:
    """Views of each camera by its name."""
    ordered = sorted(views, key=lambda view: view.camera.name)
    return {name: list(of) for name, of in groupby(ordered, key=lambda view: view.camera.name)}


def mean_overlap(views: Sequence[Seen]) -> float:
    """The mean over views, 0 where there are none."""
    return float(np.mean([view.overlap for view in views])) if views else 0.0
