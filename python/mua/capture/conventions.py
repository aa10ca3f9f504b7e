"""Conventions of other tools' calibrations: axes, units and directions, tried until the template fits."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import permutations, product

import numpy as np

from mua.arrays import Array
from mua.capture.camera import CaptureCamera
from mua.capture.fit import Posed, Seen, mean_overlap
from mua.capture.silhouette import overlap, rough_overlap
from mua.errors import InputError

TRIED = 8  # views that every convention is tried on
KEPT = 4  # conventions that are tried by outlines, after all were tried by points
BETTER = 0.15  # of overlap, by which another convention must fit better
LENGTHS = {1.0: "", 1e-3: "lengths are in millimetres", 1e-2: "lengths are in centimetres"}
OPENGL = np.diag([1.0, -1, -1, 1])
LETTERS = "XYZ"


@dataclass(frozen=True, eq=False)
class Convention:
    """A way in which matrices may have been written that is not ours."""

    inverse: bool  # camera to world in place of world to camera
    opengl: bool  # camera axes: y up, z back
    world: Array  # [3, 3] from our world's axes to theirs
    length: float  # metres of their unit

    def applied(self, camera: CaptureCamera) -> CaptureCamera:
        """The camera as it is where its matrix was written so."""
        matrix = np.linalg.inv(camera.world_to_camera) if self.inverse else camera.world_to_camera.copy()
        matrix = OPENGL @ matrix if self.opengl else matrix
        matrix[:3, :3] = matrix[:3, :3] @ self.world
        matrix[:3, 3] *= self.length
        return replace(camera, world_to_camera=matrix)

    @property
    def count(self) -> int:
        """How many of the four differ from ours."""
        return self.inverse + self.opengl + (self.length != 1) + (not np.array_equal(self.world, np.eye(3)))

    def __str__(self) -> str:
        differences = ["the matrices are camera_to_world, expected their inverse"] if self.inverse else []
        differences += ["the cameras' axes are OpenGL's (y up, z back)"] if self.opengl else []
        if not np.array_equal(self.world, np.eye(3)):
            rows = [f"{'-' if row.sum() < 0 else ''}{LETTERS[int(np.abs(row).argmax())]}" for row in self.world]
            differences.append(f"the calibration's world has other axes: its X, Y, Z are our {', '.join(rows)}")
        return " and ".join([*differences, *([LENGTHS[self.length]] if self.length != 1 else [])])


def read_axes(text: str) -> Array:
    """The matrix [3, 3] from our world to another, of what its X, Y and Z are in ours, such as "X,-Z,Y"."""
    words = [word.strip().upper() for word in text.split(",")]
    matrix = np.array(
        [[(word[-1:] == letter) * (-1.0 if word[:1] == "-" else 1.0) for letter in LETTERS] for word in words]
    )
    plain = all(word.removeprefix("-") in tuple(LETTERS) for word in words)
    if not plain or matrix.shape != (3, 3) or not np.isclose(np.linalg.det(matrix), 1):
        raise InputError(
            f"--axes {text}: expected what X, Y and Z of the calibration are in a right-handed world with Y up, "
            "such as X,-Z,Y for one with Z up"
        )
    return matrix


def better_convention(posed: Posed, views: Sequence[Seen]) -> tuple[Convention, float, float] | None:
    """The convention under which the template fits the masks far better; with both overlaps."""
    some = [views[i] for i in np.unique(np.linspace(0, len(views) - 1, TRIED).astype(int))]
    ranked = sorted(_conventions(), key=lambda one: (-_by_points(posed, some, one), one.count))[:KEPT]
    scores = [_by_outlines(posed, some, one) for one in ranked]
    best, now = int(np.argmax(scores)), mean_overlap(some)
    return (ranked[best], scores[best], now) if scores[best] > now + BETTER else None


def _conventions() -> Iterator[Convention]:
    for inverse, opengl, length in product((False, True), (False, True), LENGTHS):
        for world in _axes():
            yield Convention(inverse, opengl, world, length)


def _axes() -> Iterator[Array]:
    """The 24 ways to name three axes at right angles without a mirror."""
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        matrix = np.zeros((3, 3))
        matrix[range(3), order] = signs
        if np.linalg.det(matrix) > 0:
            yield matrix


def _by_points(posed: Posed, views: Sequence[Seen], convention: Convention) -> float:
    cameras = [convention.applied(view.camera) for view in views]
    return float(
        np.mean(
            [
                rough_overlap(posed.vertices[view.clip][view.frame], camera, view.mask)
                for view, camera in zip(views, cameras, strict=True)
            ]
        )
    )


def _by_outlines(posed: Posed, views: Sequence[Seen], convention: Convention) -> float:
    cameras = [convention.applied(view.camera) for view in views]
    drawn = [posed.covers(view.clip, view.frame, camera) for view, camera in zip(views, cameras, strict=True)]
    return float(np.mean([overlap(covered, view.mask) for covered, view in zip(drawn, views, strict=True)]))
