"""How well the posed template fits the masks of some views of a capture."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture, CaptureClip
from mua.capture.silhouette import COVERED, overlap, pixels, posed_template, shown, silhouette
from mua.capture.view import smaller

ROWS = 256  # of the images that are compared
FRAMES = 5  # of each clip that are looked at
POINTS = 1000  # triangles whose colours are compared, at most
FACING = 0.5  # cosine between normal and camera, from which on a triangle's colour is trusted
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
    colours: Array  # [POINTS, 3] of triangles all over the template, 0..1; NaN where the view does not show one

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
    view = capture.view(clip, frame, camera.name, rows=rows)
    small, mask = smaller(camera, rows), view.mask >= COVERED
    covered = posed.covers(clip, frame, small)
    corners = posed.vertices[clip][frame][posed.surfaces.faces[:: -(-len(posed.surfaces.faces) // POINTS)]]
    return Seen(clip, frame, small, mask, covered, overlap(covered, mask), _colours(corners, small, view.image, mask))


def _colours(
    corners: Array,  # [P, 3, 3] metres
    camera: CaptureCamera,
    image: Array,  # [h, w, 3]
    mask: Array,  # [h, w] bool
) -> Array:
    """The colours [P, 3] of triangles; NaN where they are turned away, or outside image or mask."""
    places, _ = pixels(camera, corners.mean(axis=1))
    column, row = np.clip(places, 0, np.subtract(camera.size, 1)).astype(int).T
    seen = shown(corners, camera, facing=FACING) & mask[row, column]
    return np.where(seen[:, None], image[row, column], np.nan)


def by_camera(views: Sequence[Seen]) -> Mapping[str, list[Seen]]:
    """Views of each camera by its name."""
    ordered = sorted(views, key=lambda view: view.camera.name)
    return {name: list(of) for name, of in groupby(ordered, key=lambda view: view.camera.name)}


def mean_overlap(views: Sequence[Seen]) -> float:
    """The mean over views, 0 where there are none."""
    return float(np.mean([view.overlap for view in views])) if views else 0.0
