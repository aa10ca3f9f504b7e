"""How far masks can be trusted: those that fit the posed template much worse than usual count less in training."""

from collections.abc import Callable, Iterator
from contextlib import suppress

import numpy as np

from mua.capture.capture import Capture
from mua.capture.fit import chosen_frames
from mua.capture.silhouette import COVERED, POINTS, rough_overlap
from mua.capture.view import View
from mua.errors import InputError
from mua.rig.skinning import Skinning

ROWS = 128  # of the images from which the usual overlap is found
FULL, NONE = 0.8, 0.5  # of the usual overlap: from the first on a view counts in full, below the second not at all


class MaskTrust:
    """Weights of views; the usual overlap is the median over some of them."""

    def __init__(self, capture: Capture) -> None:
        """Look at a few of the frames that are trained on; raises InputError where no mask shows the template."""
        surfaces = capture.surfaces
        some = slice(None, None, max(1, len(surfaces.vertices) // POINTS))
        self._points = surfaces.vertices[some]
        self._skinning = Skinning(surfaces.skin_indices[some], surfaces.skin_weights[some])
        motions = {clip.name: capture.motion(clip.name) for clip in capture.clips}
        self._joints = {n: surfaces.skeleton.skinning(m.rotations, m.translations) for n, m in motions.items()}
        found = [*_sample_overlaps(capture, self._overlap)]
        self.usual = float(np.median([one for one in found if one] or [0]))  # empty masks say nothing
        if not any(found):
            clip = next(clip for clip in capture.clips if not clip.held_out)
            camera = next(camera for camera in capture.cameras if not camera.held_out)
            frame = chosen_frames(capture, clip, None)[0]
            if not found:
                capture.view(clip.name, frame, camera.name)  # says why it cannot be read, as all others
            files = capture.files(clip.name, frame, camera.name)
            raise InputError(
                f"{files.mask or files.image}: none of {len(found)} masks that were looked at, of which this is the "
                f"first, shows the posed template; mua-capture check {capture.folder} says why"
            )

    def weight(self, clip: str, frame: int, view: View) -> float:
        """How much a view counts, 0..1; 0 where its mask covers nothing."""
        share = self._overlap(clip, frame, view) / max(self.usual, np.finfo(float).tiny)
        return float(np.clip((share - NONE) / (FULL - NONE), 0, 1))

    def _overlap(self, clip: str, frame: int, view: View) -> float:
        points = self._skinning.linear(self._joints[clip][frame], self._points)
        return rough_overlap(points, view.pinhole, view.mask >= COVERED)


def _sample_overlaps(capture: Capture, overlap: Callable[[str, int, View], float]) -> Iterator[float]:
    """Overlaps of a few training views; those that cannot be read are left out, and reported where they are needed."""
    cameras = [camera for camera in capture.cameras if not camera.held_out]
    for clip in (clip for clip in capture.clips if not clip.held_out):
        for frame in chosen_frames(capture, clip, None):
            for camera in cameras:
                with suppress(InputError):
                    view = capture.view(clip.name, frame, camera.name, crop=True, rows=min(ROWS, camera.size[1]))
                    yield overlap(clip.name, frame, view)
