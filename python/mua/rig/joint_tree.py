"""Which joint hangs on which, and which one carries the body: the file's hierarchy, corrected by the clips.

Control rigs move deforming joints by constraints, through controls that were never bound to the mesh; then the
parent in the file says little about what carries a joint, and the clips say it.
"""

import re

import numpy as np

from mua.arrays import Array
from mua.rig.bind_pose import Bind, rotations_of
from mua.rig.rigid_motion import RigidMotion, local_offsets

MOVES = 1e-3  # of the character's size: a joint's offset that changes less does not count as animated
LEAVES = 0.02  # of the character's size: a joint that strays more from its place beside another is not carried by it
TIE = 1e-3  # of the character's size: joints that keep a place about equally well; the nearest is taken
HIPS = ("hips", "pelvis")


def find_root(names: list[str], bind: Bind, *, motions: list[RigidMotion]) -> int:
    """The joint that may move: where the whole body hangs, if clips move it, else the highest moved, else the hips."""
    below = mass_below(bind)
    body = 0.5 * bind.mass.sum()
    trunk = int(np.flatnonzero(below >= below.max() * (1 - 1e-9)).max())  # the lowest joint above all weights
    moved = np.zeros(len(names), bool)
    for motion in motions:
        offsets = local_offsets(motion.rotations, motion.positions, bind.parents)
        moved |= np.ptp(offsets, axis=0).max(axis=-1) > MOVES * _size(bind)
    if moved[_with_ancestors(trunk, bind.parents)].any():
        return trunk
    highest = [int(j) for j in np.flatnonzero(moved) if below[j] >= body]
    hips = [j for j, name in enumerate(names) if is_hips(name) and below[j] >= body]
    return [*highest, *hips, trunk][0]


def reattached(names: list[str], bind: Bind, *, motions: list[RigidMotion]) -> tuple[Bind, tuple[str, ...]]:
    """Hang joints that no bound joint carries on the one whose side they keep in every clip.

    Controls, which then carry nothing, are left out. Where a joint keeps to no other, or there are no clips, the
    file's hierarchy stays. Returns the joints and a sentence on what changed.
    """
    if not motions:
        return bind, ()
    stray = _Stray(bind, motions)
    above = [_with_ancestors(j, bind.parents) for j in range(len(names))]
    orphans = {
        j for j, parent in enumerate(bind.parents) if bind.trusted[j] and not _is_carried(j, parent, bind, stray)
    }
    root = find_root(names, bind, motions=motions)
    top = root if bind.trusted[root] else min(orphans, key=lambda j: (len(above[j]), j))
    orphans -= set(above[top])
    attached = [
        int(j)
        for j in np.flatnonzero(bind.trusted)
        if not orphans & set(above[j]) and (top in above[j] or j in above[top])
    ]
    parents = bind.parents.copy()
    moved = len(orphans)
    while orphans:
        distances = {j: stray(j, attached) for j in sorted(orphans)}
        child = min(distances, key=lambda j: distances[j].min())
        least = distances[child].min()
        if least > LEAVES:
            return bind, ()
        apart = np.linalg.norm(bind.places[attached] - bind.places[child], axis=1)
        parents[child] = attached[int(np.argmin(np.where(distances[child] <= least + TIE, apart, np.inf)))]
        orphans.remove(child)
        attached += [int(j) for j in np.flatnonzero(bind.trusted) if child in above[j] and not orphans & set(above[j])]
    kept = _kept(bind, parents)
    left_out = len(names) - len(kept.nodes)
    if not moved and not left_out:
        return bind, ()
    return kept, (
        f"{moved} joints hang on others than in the file, as the clips show, and {left_out} without weights and "
        f"without a bind pose are left out.",
    )


class _Stray:
    """How far joints leave their bind-pose place beside others in sampled frames, relative to the character."""

    FRAMES = 200  # enough to see a joint leave, whatever the length of the clips

    def __init__(self, bind: Bind, motions: list[RigidMotion]) -> None:
        total = sum(len(motion.positions) for motion in motions)
        step = max(1, total // self.FRAMES)
        self._rotations = np.concatenate([motion.rotations for motion in motions])[::step]
        self._positions = np.concatenate([motion.positions for motion in motions])[::step]
        self._bind_rotations = rotations_of(bind.matrices)
        self._places = bind.places
        self._size = _size(bind)

    def __call__(self, joint: int, holders: list[int]) -> Array:
        """The largest distance for each of the joints that might hold `joint`."""
        apart = self._positions[:, joint, None] - self._positions[:, holders]
        offsets = np.einsum("fiba,fib->fia", self._rotations[:, holders], apart)
        bound = np.einsum("iba,ib->ia", self._bind_rotations[holders], self._places[joint] - self._places[holders])
        return np.linalg.norm(offsets - bound, axis=-1).max(axis=0) / self._size


def mass_below(bind: Bind) -> Array:
    """The weights [J] that hang on each joint and all below it."""
    below = bind.mass.copy()
    for j in range(len(below) - 1, -1, -1):
        if bind.parents[j] >= 0:
            below[bind.parents[j]] += below[j]
    return below


def _is_carried(joint: int, parent: int, bind: Bind, stray: _Stray) -> bool:
    return parent >= 0 and bool(bind.trusted[parent]) and bool(stray(joint, [int(parent)])[0] <= LEAVES)


def _kept(bind: Bind, parents: Array) -> Bind:
    """The trusted joints under their new parents [J], parents before children."""
    above = [[a for a in _with_ancestors(j, parents) if bind.trusted[a]] for j in range(len(parents))]
    order = sorted(np.flatnonzero(bind.trusted).tolist(), key=lambda j: [*reversed(above[j])])
    rank = {j: n for n, j in enumerate(order)}
    kept = np.array([rank[above[j][1]] if len(above[j]) > 1 else -1 for j in order], np.int32)
    columns = {
        name: getattr(bind, name)[order] for name in ("nodes", "matrices", "stretch", "places", "mass", "trusted")
    }
    return Bind(parents=kept, **columns)


def _with_ancestors(joint: int, parents: Array) -> list[int]:
    """The joint, its parent, and so on to the top."""
    found = []
    while joint >= 0:
        found.append(int(joint))
        joint = int(parents[joint])
    return found


def _size(bind: Bind) -> float:
    return float(np.ptp(bind.places, axis=0).max()) or 1.0  # a single joint has no size


def is_hips(name: str) -> bool:
    """Whether a joint's name says that it is the middle of the hips."""
    words = re.findall("[a-z]+", name.lower())
    return any(word.endswith(HIPS) for word in words) and not {"l", "r", "left", "right"} & set(words)
