"""A scene's joints and clips as a skeleton of rigid joints, which turn and move in their parents."""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.bind_pose import Bind, bind_pose, rotations_of
from mua.characters.joint_tree import find_root, mass_below, reattached
from mua.characters.rigid_motion import RigidMotion, local_offsets, local_rotations, rigid_motion
from mua.pose.clip import Clip, Stretches
from mua.pose.skeleton import Pose, Skeleton
from mua.scene import Motion, Scene, Source

HELD = 1e-4  # of the character's size: a joint that leaves its bind place in its parent by less keeps it
STRETCHED = 1e-3  # of a scale of 1: a joint that scales the surface by less is taken to be rigid
EXACT = 1e-6  # the same for root and joints above it, which move all others
TOLD_SCALE = 0.01


@dataclass(frozen=True, eq=False)
class Rigged:
    """A skeleton, the nodes that its joints were, its clips, and a sentence for each thing changed or lost."""

    skeleton: Skeleton
    nodes: Array  # [J] int nodes of the scene
    clips: tuple[Clip, ...]
    notes: tuple[str, ...]


def rigid_skeleton(scene: Scene, bind: Bind) -> Rigged:
    """Make the scene's joints rigid: rotations, and translations wherever a clip moves what the mesh hangs on."""
    motions = [rigid_motion(motion, bind) for motion in scene.motions]
    bind, notes = reattached([scene.node_names[node] for node in bind.nodes], bind, motions=motions)
    if notes:
        motions = [rigid_motion(motion, bind) for motion in scene.motions]
    names = unique_names([scene.node_names[node] for node in bind.nodes])
    bind_world = rotations_of(bind.matrices)
    skeleton = Skeleton(
        names=names,
        parents=bind.parents,
        bind_rotations=rotation.from_matrix(local_rotations(bind_world, bind.parents)),
        bind_translations=local_offsets(bind_world, bind.places, bind.parents),
        root=find_root(list(names), bind, motions=motions),
    )
    offsets = [local_offsets(motion.rotations, motion.positions, bind.parents) for motion in motions]
    moved = _moved(skeleton, bind, offsets)
    clips = []
    for source, motion, offset in zip(scene.motions, motions, offsets, strict=True):
        local = rotation.from_matrix(local_rotations(motion.rotations, bind.parents))
        translations = np.where(moved[:, None], offset, skeleton.bind_translations)
        stretches = _stretches(motion, bind)
        clips.append(Clip(source.name, source.rate, local, translations, stretches=stretches))
    return Rigged(
        skeleton, bind.nodes, tuple(clips), (*notes, *_scale_note(scene, skeleton, bind=bind, motions=motions))
    )


def rest_pose(source: Source, skeleton: Skeleton) -> Pose:
    """The pose of a skeleton that the nodes of its source have at rest, which the bind pose need not be."""
    bind = bind_pose(source.scene)
    motion = rigid_motion(Motion("rest", 1.0, source.scene.rest[None]), bind)
    rows = [int(np.flatnonzero(bind.nodes == node)[0]) for node in source.nodes]
    turned, placed = motion.rotations[0, rows], motion.positions[0, rows]
    local = rotation.from_matrix(local_rotations(turned, skeleton.parents))
    return Pose(local, local_offsets(turned, placed, skeleton.parents))


def roles_of(scene: Scene, rigged: Rigged) -> dict[str, str]:
    """The body part of each joint of which the scene says it, by the joint's name."""
    pairs = zip(rigged.skeleton.names, rigged.nodes, strict=True)
    return {name: scene.roles[int(node)] for name, node in pairs if int(node) in scene.roles}


def unique_names(names: list[str]) -> tuple[str, ...]:
    """The names, with a number after each that an earlier one took."""
    taken: dict[str, int] = {}
    unique = []
    for name in names:
        taken[name] = taken.get(name, 0) + 1
        unique.append(name if taken[name] == 1 else f"{name}_{taken[name]}")
    return tuple(unique)


def _stretches(motion: RigidMotion, bind: Bind) -> Stretches | None:
    """How the joints that hold the mesh stretch it, None where none does."""
    joints = np.flatnonzero((motion.scales.max(axis=0) > STRETCHED) & (bind.mass > 0))
    return Stretches(joints, motion.stretches[:, joints]) if len(joints) else None


def _moved(skeleton: Skeleton, bind: Bind, offsets: list[Array]) -> Array:
    """Joints [J] that some clip moves in their parents away from the bind pose, of those that carry the mesh."""
    apart = np.zeros(len(skeleton.names))
    for offset in offsets:
        apart = np.maximum(apart, np.linalg.norm(offset - skeleton.bind_translations, axis=-1).max(axis=0))
    leads = np.isin(np.arange(len(apart)), [skeleton.root, *skeleton.ancestors(skeleton.root)])
    carries = leads | (mass_below(bind) > 0) if bind.mass.any() else np.ones(len(apart), bool)
    moved = carries & (apart > np.where(leads, EXACT, HELD) * skeleton.size)
    moved[skeleton.root] = True
    return moved


def _scale_note(scene: Scene, skeleton: Skeleton, *, bind: Bind, motions: list[RigidMotion]) -> tuple[str, ...]:
    """A sentence on the largest scale, which rigid joints do not carry."""
    scales = [(0.0, "", "")]
    for source, motion in zip(scene.motions, motions, strict=True):
        scaled = motion.scales.max(axis=0) * (bind.mass > 0)
        scales.append((float(scaled.max()), skeleton.names[int(scaled.argmax())], source.name))
    scale, joint, clip = max(scales)
    if scale <= TOLD_SCALE:
        return ()
    return (
        f"Animated scales go into the mesh, and so only into what is baked; the largest is {100 * scale:.0f} %, of "
        f"{joint} in clip {clip}.",
    )
