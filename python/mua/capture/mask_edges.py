"""Masks that are wider or narrower than the posed template all round, or that have holes: a sentence each."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.ndimage import binary_erosion, binary_fill_holes, distance_transform_edt

from mua.arguments import amount
from mua.arrays import Array
from mua.capture.capture import Capture
from mua.capture.fit import Seen
from mua.capture.silhouette import overlap

TRIED = 12  # views that are looked at
REACH, STEP = 6.0, 0.5  # pixels of the compared images by which outlines are moved
BETTER = 0.05  # overlap by which moved outlines must fit better
FITTING = 0.7  # overlap that they must reach, or something else is wrong
HOLES = 0.005  # of what a mask covers, from which on holes are worth a sentence
INSIDE = 3  # pixels within the template's outline, where no gap between arm and body can be


def wide_or_narrow(capture: Capture, views: Sequence[Seen]) -> Iterator[str]:
    """Whether outlines would fit if they were some pixels further out, or further in, all round."""
    some = [views[i] for i in np.unique(np.linspace(0, len(views) - 1, TRIED).astype(int))] if views else []
    if not some:
        return
    moves = np.arange(-REACH, REACH + STEP, STEP)
    fits = np.mean([_fits(view, moves) for view in some], axis=0)
    best = int(np.argmax(fits))
    now, then = fits[moves == 0][0], fits[best]
    if then < max(now + BETTER, FITTING):
        return
    finer = float(np.mean([capture.camera(view.camera.name).size[1] / view.camera.size[1] for view in some]))
    found = (
        f"All round, outlines and masks overlap by {now:.0%}; they would by {then:.0%} if masks were "
        f"{amount(max(1, round(abs(moves[best]) * finer)), 'pixel')}"
    )
    if moves[best] > 0:
        yield f"{found} narrower: set trim_masks where they show background, else make the template thicker."
    else:
        yield f"{found} wider: make masks that cut nothing off, or the template thinner."


def holes(views: Sequence[Seen]) -> Iterator[str]:
    """Whether masks leave out what lies inside the person and on the template."""
    shares = [_holes(view) for view in views]
    with_holes = [view for view, share in zip(views, shares, strict=True) if share > HOLES]
    if with_holes:
        worst = int(np.argmax(shares))
        yield (
            f"{len(with_holes)} of {len(views)} masks have holes where the template is; the largest are "
            f"{shares[worst]:.1%} of the mask of {views[worst]}. Fill them: where there are "
            "often holes, the teacher becomes clear."
        )


def _fits(view: Seen, moves: Array) -> list[float]:
    """The overlaps of a mask with the outline moved out by so many pixels."""
    inside, outside = (distance_transform_edt(of) for of in (view.covered, ~view.covered))
    depth = np.where(view.covered, inside - 0.5, 0.5 - outside)  # from the outline to the middle of each pixel
    return [overlap(depth > -move, view.mask) for move in moves]


def _holes(view: Seen) -> float:
    missing = binary_fill_holes(view.mask) & ~view.mask & binary_erosion(view.covered, iterations=INSIDE)
    return float(missing.sum() / view.mask.sum())
