"""Errors of cameras, estimated from masks: clock, place and lens are varied until the template fits."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from mua.arrays import Array
from mua.capture.camera import CaptureCamera
from mua.capture.fit import Posed, Seen, mean_overlap
from mua.capture.lens import distorted
from mua.capture.silhouette import FINER, fine_silhouette, overlap

TRIED = 6  # views of a camera that other places are tried on
OF_ALL = 2  # views of each camera that other lenses are tried on
LATER = 3  # frames by which a camera may be before or behind the others
SHIFTED = 0.04  # of an image's longer side that outlines may lie beside masks
BENDS = (-0.3, -0.2, -0.1, 0.1, 0.2)  # k1 that are tried
SCALES = (0.95, 0.97, 0.99, 1.01, 1.03, 1.05)  # of images: a template that is too thin is no lens


@dataclass(frozen=True)
class Fit:
    """A change, and the mean overlap without and with it."""

    now: float
    then: float
    change: float  # frames, metres at the person, or k1

    @property
    def gain(self) -> float:
        return self.then - self.now


@dataclass(frozen=True, eq=False)
class Drawn:
    """A view, beside what the template covers in it to a part of a pixel."""

    camera: CaptureCamera
    mask: Array  # [h, w] bool
    covered: Array  # [FINER h, FINER w] bool

    def fits(self, columns: Array, rows: Array) -> float:
        """The overlap, where each pixel shows what the pinhole does at a place [h, w]."""
        height, width = self.covered.shape
        column, row = (np.floor(FINER * at).astype(int) for at in (columns, rows))
        inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
        return overlap(inside & self.covered[row.clip(0, height - 1), column.clip(0, width - 1)], self.mask)


def drawn(posed: Posed, views: Sequence[Seen], count: int = TRIED) -> list[Drawn]:
    """Some of one camera's views."""
    some = [views[i] for i in np.unique(np.linspace(0, len(views) - 1, count).astype(int))]
    faces = posed.surfaces.faces
    return [
        Drawn(view.camera, view.mask, fine_silhouette(posed.vertices[view.clip][view.frame], faces, view.camera))
        for view in some
    ]


def in_time(posed: Posed, views: Sequence[Seen]) -> Fit | None:
    """The shift in frames at which poses fit one camera's images best; None where too few can be compared."""
    found = []
    for shift in (shift for shift in range(-LATER, LATER + 1) if shift):
        own = [view for view in views if 0 <= view.frame + shift < len(posed.vertices[view.clip])]
        if 2 * len(own) >= len(views):
            fits = [overlap(posed.covers(v.clip, v.frame + shift, v.camera), v.mask) for v in own]
            found.append(Fit(mean_overlap(own), float(np.mean(fits)), shift))
    return max(found, key=lambda fit: fit.gain, default=None)


def in_place(views: Sequence[Drawn], distance: float) -> Fit:
    """How far outlines of one camera lie beside its masks, metres at the person, who is `distance` metres away."""
    camera, best = views[0].camera, (0.0, 0.0)
    reach = max(1, round(SHIFTED * max(camera.size)))
    columns, rows = _middles(camera)

    def fits(move: tuple[float, float]) -> float:
        return float(np.mean([view.fits(columns - move[0], rows - move[1]) for view in views]))

    for step in (1.0, 1 / FINER):  # of a pixel
        around = range(-reach, reach + 1)
        best = max(((best[0] + x * step, best[1] + y * step) for x, y in product(around, around)), key=fits)
        reach = FINER - 1
    return Fit(fits((0, 0)), fits(best), distance * float(np.hypot(*np.divide(best, camera.focal))))


def in_lens(cameras: Sequence[Sequence[Drawn]]) -> Fit:
    """The k1 that all cameras lack, beside the best that another size of the template would do."""
    bent = {k1: _mean(cameras, [_bent(of[0].camera, k1) for of in cameras]) for k1 in (0.0, *BENDS)}
    scaled = max(_mean(cameras, [_scaled(of[0].camera, scale) for of in cameras]) for scale in SCALES)
    best = max(bent, key=lambda k1: bent[k1])
    return Fit(max(bent[0.0], scaled), bent[best], best)


def _mean(cameras: Sequence[Sequence[Drawn]], places: Sequence[tuple[Array, Array]]) -> float:
    return float(np.mean([view.fits(*at) for of, at in zip(cameras, places, strict=True) for view in of]))


def _bent(camera: CaptureCamera, k1: float) -> tuple[Array, Array]:
    """Where a pinhole shows what each pixel of a lens does, to the first order, which no lens makes fold over."""
    x, y = distorted(*_straight(camera), (-k1, 0.0, 0.0, 0.0, 0.0))
    return x * camera.focal[0] + camera.centre[0], y * camera.focal[1] + camera.centre[1]


def _scaled(camera: CaptureCamera, scale: float) -> tuple[Array, Array]:
    x, y = _straight(camera)
    return x * camera.focal[0] / scale + camera.centre[0], y * camera.focal[1] / scale + camera.centre[1]


def _straight(camera: CaptureCamera) -> tuple[Array, Array]:
    """The pixels' middles [h, w] at a distance of 1."""
    columns, rows = _middles(camera)
    return (columns - camera.centre[0]) / camera.focal[0], (rows - camera.centre[1]) / camera.focal[1]


def _middles(camera: CaptureCamera) -> tuple[Array, Array]:
    rows, columns = np.mgrid[: camera.size[1], : camera.size[0]] + 0.5
    return columns, rows
