"""Which joint hangs on which, and which one carries the body: the file's hierarchy, corrected by the clips.

Control rigs move deforming joints by constraints, through controls that were never bound to the mesh; then the
parent in the file says little about what carries a joint, and the clips say it.
"""

import re

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind, rotations_of
from mua.characters.rigid_motion import RigidMotion, local_offsets
from mua.scene import upwards

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
    if moved[[*upwards(trunk, bind.parents)]].any():
        return trunk
    highest = [int(j) for j in np.flatnonzero(moved) if below[j] >= body]
    hips = [j for j, name in enumerate(names) if is_hips(name) and below[j] >= body]
    return [*highest, *hips, trunk][0]


def reattached(names: list[str], bind: Bind, *, motions: list[RigidMotion]) -> tuple[Bind, tuple[str, ...]]:
    """Hang joints on those that carry them: by the clips, and so that the root leads all that the mesh hangs on.

    Returns the joints and a sentence on what changed.
    """
    root = find_root(names, bind, motions=motions)
    stray = _Stray(bind, motions)
    parents, kept = _by_clips(bind, root, stray) if motions else _as_filed(bind)
    parents = _led(bind, parents, root, stray) if kept[root] else parents
    moved, left_out = int(np.count_nonzero((parents != bind.parents) & kept)), int(np.count_nonzero(~kept))
    if not moved and not left_out:
        return bind, ()
    return _ordered(bind, parents, kept), (_note(moved, left_out, shown=bool(motions)),)


def _note(moved: int, left_out: int, *, shown: bool) -> str:
    """The sentence on joints that hang elsewhere and those that are left out; `shown`: by clips."""
    parts = []
    if moved:
        others = "joint hangs on another" if moved == 1 else "joints hang on others"
        parts.append(
            f"{moved} {others} than in the file, {'as the clips show' if shown else 'so that the root leads all'}"
        )
    if left_out:
        idle, are = ("joint", "is") if left_out == 1 else ("joints", "are")
        parts.append(f"{left_out} {idle} without weights and without a bind pose {are} left out")
    return ", and ".join(parts) + "."


def _as_filed(bind: Bind) -> tuple[Array, Array]:
    return bind.parents.copy(), np.ones(len(bind.parents), bool)


def _by_clips(bind: Bind, root: int, stray: "_Stray") -> tuple[Array, Array]:
    """Parents [J] and which joints [J] are kept: joints that no bound joint carries go beside whom they keep in clips.

    Controls, which then carry nothing, are left out. A joint that keeps to no other stays where the file has it, if
    that is in the body; else the whole file's hierarchy stays.
    """
    above = [[*upwards(j, bind.parents)] for j in range(len(bind.parents))]
    carries = mass_below(bind) > 0 if bind.mass.any() else bind.trusted
    weighted = np.flatnonzero(bind.trusted & carries).tolist()
    orphans = {j for j in weighted if not _is_carried(j, int(bind.parents[j]), bind, stray)}
    top = root if bind.trusted[root] else min(orphans, key=lambda j: (len(above[j]), j))
    orphans -= set(above[top])
    attached = [
        int(j)
        for j in np.flatnonzero(bind.trusted)
        if not orphans & set(above[j]) and (top in above[j] or j in above[top])
    ]
    body = {j for j in attached if top in above[j]}
    parents = bind.parents.copy()
    while orphans:
        distances = {j: stray(j, attached).min() for j in sorted(orphans)}
        child = min(distances, key=lambda j: distances[j])
        stays = [j for j in distances if parents[j] in body]
        if distances[child] <= LEAVES:
            parents[child] = _holder(child, attached, bind, stray)
        elif stays:
            child = stays[0]
        else:
            return _as_filed(bind)
        orphans.remove(child)
        joined = [int(j) for j in np.flatnonzero(bind.trusted) if child in above[j] and not orphans & set(above[j])]
        attached += joined
        body |= set(joined) if parents[child] in body else set()
    return parents, bind.trusted


def _led(bind: Bind, parents: Array, root: int, stray: "_Stray") -> Array:
    """Parents [J] so that what the mesh hangs on is led by the root: feet that a rig steers from above it, say.

    Such a joint goes where it strays least. What keeps its place beside a joint above the root stays there.
    """
    leads = [*upwards(root, parents)]
    body = [j for j in range(len(parents)) if root in upwards(j, parents)]
    carries = mass_below(bind) > 0
    led = parents.copy()
    for joint in np.flatnonzero(carries).tolist():
        parent = int(parents[joint])
        if joint in leads or not (parent < 0 or parent in leads[1:]):
            continue
        if parent < 0 or stray(joint, [parent])[0] > LEAVES:
            led[joint] = _holder(joint, body, bind, stray)
    return led


class _Stray:
    """How far joints leave their bind-pose place beside others in sampled frames, relative to the character."""

    FRAMES = 200  # enough to see a joint leave, whatever the length of the clips

    def __init__(self, bind: Bind, motions: list[RigidMotion]) -> None:
        self._bind_rotations = rotations_of(bind.matrices)
        self._places = bind.places
        step = max(1, sum(len(motion.positions) for motion in motions) // self.FRAMES)
        turned = [motion.rotations for motion in motions] or [self._bind_rotations[None]]
        placed = [motion.positions for motion in motions] or [self._places[None]]
        self._rotations, self._positions = (np.concatenate(found)[::step] for found in (turned, placed))
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


def _holder(joint: int, holders: list[int], bind: Bind, stray: "_Stray") -> int:
    """The joint of `holders` from whose side `joint` strays least; of about equal ones, the nearest."""
    distances = stray(joint, holders)
    apart = np.linalg.norm(bind.places[holders] - bind.places[joint], axis=1)
    return holders[int(np.argmin(np.where(distances <= distances.min() + TIE, apart, np.inf)))]


def _ordered(bind: Bind, parents: Array, kept: Array) -> Bind:
    """The kept [J] joints under their new parents [J], parents before children."""
    above = [[a for a in upwards(j, parents) if kept[a]] for j in range(len(parents))]
    order = sorted(np.flatnonzero(kept).tolist(), key=lambda j: [*reversed(above[j])])
    rank = {j: n for n, j in enumerate(order)}
    found = np.array([rank[above[j][1]] if len(above[j]) > 1 else -1 for j in order], np.int32)
    columns = {
        name: getattr(bind, name)[order] for name in ("nodes", "matrices", "stretch", "places", "mass", "trusted")
    }
    return Bind(parents=found, **columns)


def _size(bind: Bind) -> float:
    return float(np.ptp(bind.places, axis=0).max()) or 1.0  # a single joint has no size


def is_hips(name: str) -> bool:
    """Whether a joint's name says that it is the middle of the hips."""
    words = re.findall("[a-z]+", name.lower())
    return any(word.endswith(HIPS) for word in words) and not {"l", "r", "left", "right"} & set(words)
