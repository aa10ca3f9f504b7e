"""Cameras that show the same points of the person in other colours: exposure and white balance that differ."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from mua.arrays import Array
from mua.capture.fit import Seen, by_camera

APART = 0.08  # of a colour, by which a camera that is worth a sentence differs from most
DARK = 0.05  # colours below say nothing about exposure
SHARED = 50  # points that two cameras must show to be compared


def different_colours(views: Sequence[Seen]) -> Iterator[str]:
    """The cameras whose colours differ from what cameras typically show."""
    apart = {name: gains for name, gains in colour_gains(views).items() if np.abs(gains).max() > APART}
    held_out = [name for name, of in by_camera(views).items() if name in apart and of[0].camera.held_out]
    if apart:
        listed = "; ".join(
            f"{name} by {red:+.0%}, {green:+.0%}, {blue:+.0%}" for name, (red, green, blue) in apart.items()
        )
        yield (
            "Cameras show the same points of the person redder, greener or bluer than most: "
            f"{listed}. Training fits this"
            + (f", but mua-eval counts it as error of what {', '.join(held_out)} sees." if held_out else ".")
        )


def colour_gains(views: Sequence[Seen]) -> Mapping[str, Array]:
    """How much brighter [3] each camera shows points than the cameras typically do, 0.1 for a tenth.

    Of two cameras that show the same points, the median of the colours' ratio counts, as some points are hidden. All
    pairs agree in least squares with one gain of each camera.
    """
    named = {name: _logs(of, views) for name, of in by_camera(views).items()}
    pairs, values, weights = [], [], []
    for i, j in combinations(range(len(named)), 2):
        ratio = np.subtract(*(list(named.values())[k] for k in (i, j)))
        ratio = ratio[np.isfinite(ratio).all(axis=1)]
        if len(ratio) >= SHARED:
            pairs.append(np.eye(len(named))[i] - np.eye(len(named))[j])
            values.append(np.median(ratio, axis=0))
            weights.append(np.sqrt(len(ratio)))
    if not pairs:
        return {}
    weight = np.array(weights)[:, None]
    gains = np.linalg.lstsq(np.array(pairs) * weight, np.array(values) * weight, rcond=None)[0]
    return dict(zip(named, np.expm1(gains - np.median(gains, axis=0)), strict=True))


def _logs(of: Sequence[Seen], views: Sequence[Seen]) -> Array:
    """Logarithms [M P, 3] of one camera's colours, of all M moments that any camera shows."""
    own = {(view.clip, view.frame): view.colours for view in of}
    nothing = np.full_like(views[0].colours, np.nan)
    moments = dict.fromkeys((view.clip, view.frame) for view in views)
    colours = np.concatenate([own.get(moment, nothing) for moment in moments])
    return np.log(np.where(colours > DARK, colours, np.nan))
