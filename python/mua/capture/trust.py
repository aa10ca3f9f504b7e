"""How far masks can be trusted: those that fit the posed template much worse than usual count less in training."""

import numpy as np

from mua.capture.capture import Capture
from mua.capture.fit import chosen_frames
from mua.capture.outline import COVERED, posed_template, rough_overlap
from mua.capture.view import View
from mua.errors import InputError

ROWS = 128  # of the pictures from which the usual overlap is found
FULL, NONE = 0.8, 0.5  # of the usual overlap: from the first on a view counts in full, below the second not at all


class MaskTrust:
    """Weights of views; the usual overlap is the median over some of them."""

    def __init__(self, capture: Capture) -> None:
        """Pose the template in all clips and look at a few frames of each in all cameras."""
        self._vertices = {
            clip.name: posed_template(capture.surfaces, capture.motion(clip.name)) for clip in capture.clips
        }
        found = []
        for clip in capture.clips:
            for frame in chosen_frames(capture, clip, None):
                for camera in capture.cameras:
                    try:
                        view = capture.view(clip.name, frame, camera.name, rows=min(ROWS, camera.size[1]))
                    except InputError:  # told by the check, or where it is needed
                        continue
                    found.append(self._overlap(clip.name, frame, view))
        self.usual = float(np.median(found)) if found else 0.0

    def weight(self, clip: str, frame: int, view: View) -> float:
        """How much a view counts, 0..1; 0 where its mask covers nothing."""
        share = self._overlap(clip, frame, view) / max(self.usual, np.finfo(float).tiny)
        return float(np.clip((share - NONE) / (FULL - NONE), 0, 1))

    def _overlap(self, clip: str, frame: int, view: View) -> float:
        return rough_overlap(self._vertices[clip][frame], view.pinhole, view.mask >= COVERED)
