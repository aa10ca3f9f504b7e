"""Cameras and views that fit worse than the others, and what would make them fit: a sentence each."""

from collections.abc import Iterator, Sequence

import numpy as np

from mua.capture.camera_fit import OF_ALL, Fit, drawn, in_lens, in_place, in_time
from mua.capture.fit import Posed, Seen, by_camera, mean_overlap
from mua.capture.silhouette import overlap

POOR = 0.6  # overlap below which outline and mask do not show the same thing
OUTLIER = 0.75  # share of the median overlap below which a view or camera stands apart from others
BELOW = 0.05  # overlap by which a camera that is worth a look lies below the others
TRIED = 0.03  # overlap by which a camera lies below the others before causes are tried
GAIN = 0.1  # overlap by which another frame must fit a mask better
BETTER = 0.02  # overlap by which another moment or place must make a camera fit better
BENT = 0.006  # overlap by which another lens must fit better: it bends little where the person is


def cameras_apart(posed: Posed, views: Sequence[Seen]) -> Iterator[str]:
    """Cameras that fit worse than the others and what explains it, and views that fit worse than their camera."""
    for name, of in by_camera(views).items():
        mean, others = mean_overlap(of), _others(views, name)
        if mean < others - TRIED and (cause := _explained(posed, of, others - BELOW)) is not None:
            yield f"Camera {name}: overlaps by {mean:.0%}, the others typically by {others:.0%}; {cause}."
        elif mean < OUTLIER * others:
            yield (
                f"Camera {name}: overlaps by {mean:.0%}, a camera typically by {others:.0%}; its calibration, or which "
                "images it has, cannot be right."
            )
        else:
            middle = float(np.median([view.overlap for view in of]))
            yield from (_view_apart(posed, view, middle) for view in of if view.overlap < OUTLIER * middle)


def cameras_below(views: Sequence[Seen]) -> Iterator[str]:
    """Cameras that fit less well than the others, whether or not anything explains it."""
    for name, of in by_camera(views).items():
        mean, others = mean_overlap(of), _others(views, name)
        if OUTLIER * others <= mean <= others - BELOW:
            yield (
                f"Camera {name}: overlaps by {mean:.0%}, the others typically by {others:.0%}: "
                "look at its masks, then at its calibration."
            )


def missing_lens(posed: Posed, views: Sequence[Seen]) -> Iterator[str]:
    """Whether all cameras would fit better with another distortion."""
    cameras = [drawn(posed, of, OF_ALL) for of in by_camera(views).values()]
    fit = in_lens(cameras) if cameras else None
    if fit is not None and fit.gain > BENT:
        yield (
            f"Outlines and masks overlap by {fit.now:.1%}; they would by {fit.then:.1%} if k1 of each camera's "
            f"distortion were {abs(fit.change):g} {'larger' if fit.change > 0 else 'smaller'}: was distortion left out?"
        )


def _others(views: Sequence[Seen], name: str) -> float:
    """How well a camera typically fits, this one aside."""
    means = [mean_overlap(of) for other, of in by_camera(views).items() if other != name]
    return float(np.median(means)) if means else 0.0


def _explained(posed: Posed, of: Sequence[Seen], least: float) -> str | None:
    """The change of a camera's clock or place that makes it fit by `least`."""
    person = np.mean([posed.vertices[view.clip][view.frame].mean(axis=0) for view in of], axis=0)
    distance = float(np.linalg.norm(of[0].camera.position - person))
    time, place = in_time(posed, of), in_place(drawn(posed, of), distance)
    if time is not None and time.then > least and time.gain > max(BETTER, place.gain):
        return f"it would by {time.then:.0%} if {_moment(time)}"
    if place.then > least and place.gain > BETTER:
        return (
            f"it would by {place.then:.0%} if it pointed {100 * place.change:.1f} cm beside (at the person): calibrate "
            "it again"
        )
    return None


def _moment(fit: Fit) -> str:
    frames = f"{abs(fit.change):g} frame{'s' if abs(fit.change) > 1 else ''}"
    return f"its images were numbered {frames} {'higher' if fit.change > 0 else 'lower'}"


def _view_apart(posed: Posed, view: Seen, middle: float) -> str:
    """A sentence on a view that fits badly, with the frame that its mask fits best."""
    fits = [
        overlap(posed.covers(view.clip, frame, view.camera), view.mask)
        for frame in range(len(posed.vertices[view.clip]))
    ]
    best = int(np.argmax(fits))
    finding = f"{str(view).capitalize()}: overlaps by {view.overlap:.0%}, its camera typically by {middle:.0%}"
    if best != view.frame and fits[best] > max(view.overlap + GAIN, POOR):
        return f"{finding}; the mask fits frame {best} by {fits[best]:.0%}."
    return f"{finding}; the mask or the pose cannot be right."
