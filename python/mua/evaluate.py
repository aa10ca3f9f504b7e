"""How much of a teacher a student explains, and whether bands, bases or coefficients miss the rest.

Errors are taken on the full-resolution texture of frames that the recording keeps whole, over the valid texels, in raw
channels. Four pictures of each frame stand beside the teacher's: the mean texture of the training frames; the best that
the dynamic subbands could do (D1 and D0 at their mean); the best coefficients for the learnt bases; the student's own.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import torch

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.decode import decode_clip_frame
from mua.recording import Recording, WholeFrame
from mua.student.model import Bands, Student
from mua.student.train import best_coefficients
from mua.texture.channels import APPEARANCE, ATTRIBUTES, GEOMETRY, SH_C0
from mua.texture.fill import Fill
from mua.wavelets import analyse_lowpass, wavedec2

TRAINING = "training"
PICTURES = ("mean", "bands", "best", "student")

# what an RMS error of 1 in raw channels means to a person
UNITS = {
    "offset": ("mm", 1000.0),
    "rotation": ("degrees", math.degrees(2)),  # of a small turn: 2 |dq| radians over the four components
    "scale": ("%", 100.0),  # of a length: d log s
    "opacity": ("logit", 1.0),
    "SH": ("/255", 255 * SH_C0),  # as if all of it were the constant term
}


@dataclass
class Errors:
    """Sums of squared errors of one group of frames by attribute and picture."""

    frames: int = 0
    squares: dict[str, dict[str, float]] = field(
        default_factory=lambda: {name: dict.fromkeys(PICTURES, 0.0) for name in (*ATTRIBUTES, "mesh")}
    )
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys((*ATTRIBUTES, "mesh"), 0))

    def rms(self, attribute: str, picture: str) -> float:
        """Root mean square error of a vector (all components of the attribute together) in its unit."""
        scale = UNITS[attribute][1] if attribute in UNITS else 1000.0
        return scale * math.sqrt(self.squares[attribute][picture] / max(self.counts[attribute], 1))

    def explained(self, attribute: str, picture: str = "student") -> float:
        """Share of the variance about the mean texture that a picture explains; nan where nothing varies."""
        variance = self.squares[attribute]["mean"]
        return 1 - self.squares[attribute][picture] / variance if variance > 0 else math.nan


def evaluate(
    recording: Recording,
    student: Student,
    *,
    avatar: Avatar,  # as read back from its file
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> dict[str, Errors]:
    """Errors by group: all training frames together, then each held-out clip by its name."""
    judge = _Judge(recording, student, avatar)
    groups: dict[str, Errors] = {}
    total = recording.whole_count
    for done, frame in enumerate(recording.whole_frames(), 1):
        group = frame.clip.name if frame.clip.held_out else TRAINING
        judge.add(groups.setdefault(group, Errors()), frame)
        progress(done, total)
    return dict(sorted(groups.items(), key=lambda item: item[0] != TRAINING))


class _Judge:
    """Holds what every frame is compared with."""

    def __init__(self, recording: Recording, student: Student, avatar: Avatar) -> None:
        self.student, self.avatar = student, avatar
        self.mean = recording.mean_texture()
        self.mesh = recording.mean_mesh()
        self.fill = Fill(recording.rig.texels)

    def add(self, errors: Errors, frame: WholeFrame) -> None:
        posed = decode_clip_frame(self.avatar, frame.clip, frame=frame.index)
        bands, best = self._closest(frame.texture)
        pictures = {"mean": self.mean, "bands": bands, "best": best, "student": posed.texture}
        for picture, texture in pictures.items():
            squares = np.square(texture - frame.texture, dtype=np.float64).sum(axis=0)
            for attribute, channels in ATTRIBUTES.items():
                errors.squares[attribute][picture] += float(squares[channels].sum())
        for picture, mesh in {"mean": self.mesh, "student": posed.canonical}.items():
            errors.squares["mesh"][picture] += float(np.square(mesh - frame.mesh, dtype=np.float64).sum())
        errors.frames += 1
        for attribute in ATTRIBUTES:
            errors.counts[attribute] += len(frame.texture)
        errors.counts["mesh"] += len(frame.mesh)

    @torch.no_grad()
    def _closest(self, texture: Array) -> tuple[Array, Array]:
        """The texture whose D1 and D0 are at their mean, and the one of the best coefficients, [N, 23]."""
        image = self.fill(torch.as_tensor(texture, dtype=torch.float32))
        ll, (d3, d2) = wavedec2(analyse_lowpass(image, self.student.wavelet, 2), self.student.wavelet, 2)
        bands = Bands(ll[None], d3.transpose(0, 1)[None], d2.transpose(0, 1)[None])
        parts = zip(self.student.branches, (GEOMETRY, APPEARANCE), strict=True)
        alphas = [best_coefficients(branch, bands.of(channels)) for branch, channels in parts]
        best = self.student.synthesize((alphas[0], alphas[1]))
        return self.student.texture(bands)[0].numpy(), self.student.texture(best)[0].numpy()
