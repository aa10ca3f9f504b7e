"""A scene's matrices over time as clips of a skeleton whose joints only rotate, and whose root also moves."""

import re
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.clip import Clip
from mua.rig.bind_pose import Bind, rotations_of
from mua.rig.scene import Motion, Scene
from mua.rig.skeleton import Skeleton

MOVES = 1e-3  # of the character's size: a joint's offset that changes less does not count as animated
HIPS = ("hips", "pelvis")
TOLD_MILLIMETRES = 1.0  # a smaller loss is not worth a sentence
TOLD_SCALE = 0.01


@dataclass(frozen=True)
class _Rigid:
    """Joints of one motion: world rotations, positions, and what rigid joints cannot follow."""

    rotations: Array  # [F, J, 3, 3]
    positions: Array  # [F, J, 3] metres
    offsets: Array  # [F, J, 3] positions in the parent joint's rotated frame, metres
    scales: Array  # [F, J] largest deviation of a scale from 1


def rigid_skeleton(scene: Scene, bind: Bind) -> tuple[Skeleton, tuple[Clip, ...], tuple[str, ...]]:
    """The skeleton, its clips and a sentence for each thing that rigid joints lose."""
    rigid = [_rigid(motion, bind) for motion in scene.motions]
    names = unique_names([scene.node_names[node] for node in bind.nodes])
    root = _root(names, bind, rigid=rigid)
    bind_world = rotations_of(bind.matrices)
    skeleton = Skeleton(
        names=names,
        parents=bind.parents,
        bind_rotations=rotation.from_matrix(_relative(bind_world, bind.parents)),
        bind_translations=_offsets(bind_world, bind.places, bind.parents),
        root=root,
    )
    clips = []
    for motion, joints in zip(scene.motions, rigid, strict=True):
        local = rotation.from_matrix(_relative(joints.rotations, bind.parents))
        clips.append(Clip(motion.name, motion.rate, local, _root_translation(skeleton, local, joints.positions)))
    return skeleton, tuple(clips), _losses(scene, skeleton, bind=bind, rigid=rigid)


def unique_names(names: list[str]) -> tuple[str, ...]:
    """The names, with a number after each that an earlier one took."""
    taken: dict[str, int] = {}
    unique = []
    for name in names:
        taken[name] = taken.get(name, 0) + 1
        unique.append(name if taken[name] == 1 else f"{name}_{taken[name]}")
    return tuple(unique)


def _rigid(motion: Motion, bind: Bind) -> _Rigid:
    worlds = motion.worlds[:, bind.nodes]
    deformation = worlds @ np.linalg.inv(bind.matrices)
    turned = rotations_of(deformation)
    residual = np.swapaxes(turned, -1, -2) @ deformation[..., :3, :3] @ np.linalg.inv(bind.stretch)
    rotations = turned @ rotations_of(bind.matrices)
    positions = worlds[..., :3, 3]
    return _Rigid(
        rotations,
        positions,
        _offsets(rotations, positions, bind.parents),
        np.abs(residual - np.eye(3)).max(axis=(-1, -2)),
    )


def _relative(world: Array, parents: Array) -> Array:
    """Local rotation matrices [..., J, 3, 3] of world ones."""
    local = world.copy()
    child = np.flatnonzero(parents >= 0)
    local[..., child, :, :] = np.swapaxes(world[..., parents[child], :, :], -1, -2) @ world[..., child, :, :]
    return local


def _offsets(world: Array, positions: Array, parents: Array) -> Array:
    """Local translations [..., J, 3] of world rotations [..., J, 3, 3] and positions [..., J, 3]."""
    offsets = positions.copy()
    child = np.flatnonzero(parents >= 0)
    apart = positions[..., child, :] - positions[..., parents[child], :]
    offsets[..., child, :] = np.einsum("...ji,...j->...i", world[..., parents[child], :, :], apart)
    return offsets


def _root_translation(skeleton: Skeleton, local: Array, positions: Array) -> Array:
    """Root translations [F, 3] that put the root joint where the source has it, whatever stands above it."""
    parent = skeleton.parents[skeleton.root]
    if parent < 0:
        return positions[:, skeleton.root]
    turned, placed = skeleton.world(local, np.zeros((len(local), 3)))
    return rotation.rotate(
        rotation.conjugate(turned[:, parent]), positions[:, skeleton.root] - placed[:, parent]
    )


def _root(names: tuple[str, ...], bind: Bind, *, rigid: list[_Rigid]) -> int:
    """The joint that may move: where the whole body hangs, if clips move it, else the highest moved, else the hips."""
    below = _mass_below(bind)
    body = 0.5 * bind.mass.sum()
    trunk = int(max(np.flatnonzero(below >= below.max() * (1 - 1e-9))))  # the lowest joint above all weights
    moved = _moved(bind, rigid)
    joint = trunk
    while joint >= 0:
        if moved[joint]:
            return trunk
        joint = int(bind.parents[joint])
    highest = [j for j in np.flatnonzero(moved) if below[j] >= body]
    if highest:
        return int(highest[0])
    hips = [j for j, name in enumerate(names) if _is_hips(name) and below[j] >= body]
    return hips[0] if hips else trunk


def _mass_below(bind: Bind) -> Array:
    """The weights [J] that hang on each joint and all below it."""
    below = bind.mass.copy()
    for j in range(len(below) - 1, -1, -1):
        if bind.parents[j] >= 0:
            below[bind.parents[j]] += below[j]
    return below


def _moved(bind: Bind, rigid: list[_Rigid]) -> Array:
    """Which joints [J] have an offset that some clip changes."""
    size = np.ptp(bind.places, axis=0).max()
    moved = np.zeros(len(bind.nodes), bool)
    for joints in rigid:
        moved |= np.ptp(joints.offsets, axis=0).max(axis=-1) > MOVES * size
    return moved


def _is_hips(name: str) -> bool:
    words = re.findall("[a-z]+", name.lower())
    return any(word.endswith(HIPS) for word in words) and not {"l", "r", "left", "right"} & set(words)


def _losses(scene: Scene, skeleton: Skeleton, *, bind: Bind, rigid: list[_Rigid]) -> tuple[str, ...]:
    used = _mass_below(bind) > 0
    used[skeleton.root] = False
    shifts, scales = [(0.0, "", "")], [(0.0, "", "")]
    for motion, joints in zip(scene.motions, rigid, strict=True):
        apart = np.linalg.norm(joints.offsets - skeleton.bind_translations, axis=-1).max(axis=0) * used
        scaled = joints.scales.max(axis=0) * (bind.mass > 0)
        shifts.append((float(apart.max()), skeleton.names[int(apart.argmax())], motion.name))
        scales.append((float(scaled.max()), skeleton.names[int(scaled.argmax())], motion.name))
    notes = []
    shift, joint, clip = max(shifts)
    if shift * 1000 > TOLD_MILLIMETRES:
        notes.append(
            f"Translations of joints other than {skeleton.names[skeleton.root]} are dropped; "
            f"the largest is {shift * 1000:.0f} mm, of {joint} in clip {clip}."
        )
    scale, joint, clip = max(scales)
    if scale > TOLD_SCALE:
        notes.append(f"Animated scales are dropped; the largest is {100 * scale:.0f} %, of {joint} in clip {clip}.")
    return tuple(notes)
