"""How much of a teacher a student explains, and whether bands, bases or coefficients miss the rest.

Errors are taken on the full-resolution texture of frames that the recording keeps whole, over the valid texels, in raw
channels. Four images of each frame stand beside the teacher's: the mean texture of the training frames; the best that
the dynamic subbands could do (D1 and D0 at their mean); the best coefficients for the trained bases; the student's own.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import torch

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.decode import unposed_clip_frame
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS, GEOMETRY, SH_C0
from mua.recording import Recording, WholeFrame
from mua.student.bases import BestCoefficients
from mua.student.model import Student
from mua.training.threads import in_order
from mua.training.torch_threads import few_threads, thread_share

TRAINING = "training"
MESH = "mesh"  # the canonical vertices, beside the attributes of the texture
PICTURES = ("mean", "bands", "best", "student")

# what an RMS error of 1 in raw channels means to a person
UNITS = {
    "offset": ("mm", 1000.0),
    "rotation": ("degrees", math.degrees(2)),  # of a small turn: 2 |dq| radians over the four components
    "scale": ("%", 100.0),  # of a length: d log s
    "opacity": ("logit", 1.0),
    "SH": ("/255", 255 * SH_C0),  # as if all of it were the constant term
    "mesh": ("mm", 1000.0),
}


@dataclass(frozen=True, eq=False)
class Picture:
    """What stands beside a teacher's frame."""

    texture: Array  # [N, 23] raw channels
    mesh: Array | None = None  # [V, 3] canonical vertices, metres
    outside: float = 0.0  # share of the pose that training did not show


@dataclass
class Errors:
    """Sums of squared errors of one group of frames by attribute and image."""

    frames: int = 0
    outside: float = 0.0  # shares of the poses that training did not show
    squares: dict[tuple[str, str], float] = field(default_factory=dict)
    vectors: dict[str, int] = field(default_factory=dict)

    def add(self, frame: WholeFrame, pictures: Mapping[str, Picture]) -> None:
        """Count one frame."""
        self.frames += 1
        for name, picture in pictures.items():
            self.outside += picture.outside
            by_channel = np.square(picture.texture - frame.texture, dtype=np.float64).sum(axis=0)
            for attribute, channels in ATTRIBUTES.items():
                self._count(attribute, name, float(by_channel[channels].sum()))
            if picture.mesh is not None:
                self._count(MESH, name, float(np.square(picture.mesh - frame.mesh, dtype=np.float64).sum()))
        for attribute in ATTRIBUTES:
            self.vectors[attribute] = self.vectors.get(attribute, 0) + len(frame.texture)
        self.vectors[MESH] = self.vectors.get(MESH, 0) + len(frame.mesh)

    def _count(self, attribute: str, picture: str, square: float) -> None:
        self.squares[attribute, picture] = self.squares.get((attribute, picture), 0.0) + square

    def __add__(self, other: "Errors") -> "Errors":
        """Both groups as one."""
        squares, vectors = dict(self.squares), dict(self.vectors)
        for key, square in other.squares.items():
            squares[key] = squares.get(key, 0.0) + square
        for attribute, count in other.vectors.items():
            vectors[attribute] = vectors.get(attribute, 0) + count
        return Errors(self.frames + other.frames, self.outside + other.outside, squares, vectors)

    @property
    def mean_outside(self) -> float:
        """Mean share of a pose that training did not show."""
        return self.outside / self.frames if self.frames else 0.0

    def rms(self, attribute: str, picture: str) -> float:
        """Root mean square error of a vector (all components of the attribute together) in its unit."""
        return UNITS[attribute][1] * math.sqrt(self.squares[attribute, picture] / self.vectors[attribute])

    def explained(self, attribute: str, picture: str = "student") -> float:
        """Share of the variance about the mean texture that an image explains; nan where nothing varies."""
        variance = self.squares[attribute, "mean"]
        return 1 - self.squares[attribute, picture] / variance if variance > 0 else math.nan


def evaluate(
    recording: Recording,
    student: Student,
    *,
    avatar: Avatar,  # as read back from its file
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> dict[str, Errors]:
    """Errors by group: all training frames together, then each held-out clip by its name."""
    comparer = _Comparer(recording, student, avatar)
    groups: dict[str, Errors] = {}
    frames, threads = recording.whole_frames(), few_threads()
    with thread_share(threads):
        counted = in_order(comparer.errors, frames, threads=threads)
        for done, (group, own) in enumerate(counted, start=1):
            groups[group] = groups.get(group, Errors()) + own
            progress(done, recording.whole_count)
    return dict(sorted(groups.items(), key=lambda item: item[0] != TRAINING))


def held_out_errors(groups: Mapping[str, Errors]) -> Errors | None:
    """Errors of all held-out clips together; None where there is no such clip."""
    held = [errors for name, errors in groups.items() if name != TRAINING]
    return sum(held[1:], start=held[0]) if held else None


class _Comparer:
    """Holds what every frame is compared with."""

    def __init__(self, recording: Recording, student: Student, avatar: Avatar) -> None:
        self.recording, self.student, self.avatar = recording, student, avatar
        self.mean = Picture(recording.mean_texture(), recording.mean_mesh())
        parts = zip(student.branches, (GEOMETRY, APPEARANCE), strict=True)
        self.best = [(BestCoefficients(branch), channels) for branch, channels in parts]

    def errors(self, frame: WholeFrame) -> tuple[str, Errors]:
        """The group of a frame, and its errors alone."""
        counted = Errors()
        counted.add(frame, self.pictures(frame))
        return frame.clip.name if frame.clip.held_out else TRAINING, counted

    def pictures(self, frame: WholeFrame) -> dict[str, Picture]:
        """The images of a frame by name."""
        bands, best = self._closest(frame)
        own = unposed_clip_frame(self.avatar, frame.clip, frame=frame.index)
        return {
            "mean": self.mean,
            "bands": Picture(bands),
            "best": Picture(best),
            "student": Picture(own.texture, own.mesh, own.outside),
        }

    @torch.no_grad()
    def _closest(self, frame: WholeFrame) -> tuple[Array, Array]:
        """The texture [N, 23] whose D1 and D0 are at their mean, and that of the best coefficients."""
        bands = self.recording.subbands(slice(0, CHANNELS), [frame.row], held_out=frame.clip.held_out)
        alphas = [best(bands.of(channels)) for best, channels in self.best]
        best = self.student.synthesize((alphas[0], alphas[1]))
        return self.student.texture(bands)[0].numpy(), self.student.texture(best)[0].numpy()
