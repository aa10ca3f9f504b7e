"""Images that lie otherwise than their camera was calibrated, are of another camera, or of another size."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeAlias

import numpy as np

from mua.arrays import Array
from mua.capture.apart import POOR
from mua.capture.camera import CaptureCamera
from mua.capture.fit import Posed, Seen, by_camera, mean_overlap
from mua.capture.silhouette import overlap, rough_overlap

LOOKED_AT = 3  # views of a camera that faults are tried on
BETTER = 0.15  # of overlap, by which a mask must fit better
SIZES = (4.0, 3.0, 2.0, 1.5)  # of images, relative to those that a camera may have been calibrated with
TURNS: dict[str, Callable[[Array], Array]] = {  # what makes an image right
    "the images were turned by 180°": partial(np.rot90, k=2),
    "the images were turned by 90° to the left": partial(np.rot90, k=1),
    "the images were turned by 90° to the right": partial(np.rot90, k=3),
    "the images were mirrored, left to right": np.fliplr,
    "the images were mirrored, top to bottom": np.flipud,
}
_Fits: TypeAlias = Callable[[Seen], float]


@dataclass(frozen=True)
class ImageFault:
    """What would make a camera's images fit."""

    remedy: str
    now: float  # overlap, 0 to 1
    then: float


def image_faults(posed: Posed, views: Sequence[Seen]) -> dict[str, ImageFault]:
    """The faults of cameras that hardly fit, by their names; those that nothing tried explains have none."""
    found = {}
    cameras = {view.camera.name: view.camera for view in views}
    for name, of in by_camera(views).items():
        now = mean_overlap(of)
        if now >= POOR:
            continue
        some = [of[i] for i in np.unique(np.linspace(0, len(of) - 1, LOOKED_AT).astype(int))]
        fits = {remedy: float(np.mean([fit(view) for view in some])) for remedy, fit in _remedies(posed, some, cameras)}
        best = max(fits, key=lambda remedy: fits[remedy])
        if fits[best] > max(POOR, now + BETTER):
            found[name] = ImageFault(best, now, fits[best])
    return found


def sentences(faults: Mapping[str, ImageFault], cameras: int) -> Iterator[str]:
    """A sentence for each remedy, with the cameras that need it."""
    for remedy in dict.fromkeys(fault.remedy for fault in faults.values()):
        of = {name: fault for name, fault in faults.items() if fault.remedy == remedy}
        every = len(of) == cameras > 1
        named = "All cameras" if every else f"Camera{'s' * (len(of) > 1)} {', '.join(of)}"
        now, then = (np.mean([getattr(fault, when) for fault in of.values()]) for when in ("now", "then"))
        yield f"{named}: outlines and masks overlap by {now:.0%}; they would by {then:.0%} if {remedy}."


def _remedies(posed: Posed, views: Sequence[Seen], cameras: Mapping[str, CaptureCamera]) -> Iterator[tuple[str, _Fits]]:
    for remedy, turn in TURNS.items():
        yield remedy, partial(_turned, turn=turn)
    for size in SIZES:
        for scale, words in ((size, f"multiplied by {size:g}"), (1 / size, f"divided by {size:g}")):
            yield f"focal and centre were {words}: they are of images of another size", partial(_scaled, posed, scale)
    others = {name: one for name, one in cameras.items() if one.size == views[0].camera.size}
    rough = {name: sum(_roughly(posed, camera, view) for view in views) for name, camera in others.items()}
    likeliest = max(rough, key=lambda name: rough[name])
    yield f"they had the calibration of camera {likeliest}", partial(_drawn_by, posed, others[likeliest])


def _turned(view: Seen, *, turn: Callable[[Array], Array]) -> float:
    mask = turn(view.mask)
    return overlap(view.covered, mask) if mask.shape == view.covered.shape else 0.0


def _scaled(posed: Posed, scale: float, view: Seen) -> float:
    (fx, fy), (cx, cy) = view.camera.focal, view.camera.centre
    camera = replace(view.camera, focal=(fx * scale, fy * scale), centre=(cx * scale, cy * scale))
    return _drawn_by(posed, camera, view)


def _drawn_by(posed: Posed, camera: CaptureCamera, view: Seen) -> float:
    return overlap(posed.covers(view.clip, view.frame, camera), view.mask)


def _roughly(posed: Posed, camera: CaptureCamera, view: Seen) -> float:
    return rough_overlap(posed.vertices[view.clip][view.frame], camera, view.mask)
