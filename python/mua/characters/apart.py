"""What makes a file no single figure: joints bound in one point, figures side by side, vertices gone astray."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.characters.messages import FIGURES, STRAY, Messages
from mua.errors import InputError
from mua.scene import Part, Scene

POINT = 1e-6  # of the extent of the joints at rest: bound within this they stand in one point
AS_TALL = 0.5  # of the tallest figure: what stands on joints of its own and is lower belongs to a figure
MIDDLE = 0.5, 99.5  # percentiles of the vertices that make the figure
ASTRAY = 5.0  # times its size: vertices farther away are none of it


def require_apart(scene: Scene, bind: Bind, path: Path) -> None:
    """Raise an InputError where joints with weights stand apart at rest, but all in one point in the bind pose."""
    held = bind.mass > 0
    rest = np.ptp(scene.rest[bind.nodes[held], :3, 3], axis=0).max()
    if rest > 0 and np.ptp(bind.matrices[held, :3, 3], axis=0).max() < POINT * rest:
        raise InputError(
            f"{path}: all {held.sum()} joints with weights stand in one point in the bind pose, because their inverse "
            "bind matrices are missing or equal; export the skeleton again with its bind pose"
        )


def apart_notes(
    scene: Scene,
    bind: Bind,
    vertices: Array,  # [N, 3] of all parts in turn, metres
) -> tuple[str, ...]:
    """Sentences on figures that stand beside the largest, and on vertices far from all others."""
    ends = np.cumsum([len(part.positions) for part in scene.parts])[:-1]
    shown = [places[np.unique(part.faces)] for part, places in zip(scene.parts, np.split(vertices, ends), strict=True)]
    messages = Messages()
    for part in _beside(scene, bind, shown):
        messages.add(FIGURES, part.node or part.name)
    low, high = np.percentile(np.concatenate(shown), MIDDLE, axis=0)
    reach = ASTRAY * (high - low).max()
    for part, places in zip(scene.parts, shown, strict=True):
        far = int(((places < low - reach) | (places > high + reach)).any(axis=1).sum())
        if far:
            messages.add(STRAY, f"{far:,} of {part.node or part.name}")
    return messages.notes()


def _beside(scene: Scene, bind: Bind, shown: list[Array]) -> Iterator[Part]:
    """The parts of figures that stand beside the one with most vertices, on joints of their own."""
    roots = np.array([_root(scene, bind, part) for part in scene.parts])
    figures = {
        root: np.concatenate([shown[p] for p in np.flatnonzero(roots == root)]) for root in np.unique(roots).tolist()
    }
    figures = {root: places for root, places in figures.items() if len(places)}
    largest = max(figures, key=lambda root: len(figures[root]))
    tall = AS_TALL * max(float(np.ptp(places[:, 1])) for places in figures.values())
    for part, root in zip(scene.parts, roots.tolist(), strict=True):
        places = figures.get(root, figures[largest])
        if np.ptp(places[:, 1]) >= tall and _side_by_side(places, figures[largest]):
            yield part


def _root(scene: Scene, bind: Bind, part: Part) -> int:
    """The topmost joint above the one that holds most of a part."""
    masses = np.bincount(part.joints.ravel(), part.weights.ravel())
    joint = int(np.searchsorted(bind.nodes, scene.skins[part.skin].joints[int(masses.argmax())]))
    while bind.parents[joint] >= 0:
        joint = int(bind.parents[joint])
    return joint


def _side_by_side(a: Array, b: Array) -> bool:
    """Whether a plane along X or Z parts two clouds of points [n, 3]."""
    clear = (a.min(axis=0) > b.max(axis=0)) | (b.min(axis=0) > a.max(axis=0))
    return bool(clear[0] or clear[2])
