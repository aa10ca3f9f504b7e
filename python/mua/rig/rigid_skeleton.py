"""A scene's joints and clips as a skeleton whose joints only rotate, and whose root also moves."""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.clip import Clip
from mua.rig.bind_pose import Bind, bind_pose, rotations_of
from mua.rig.joint_tree import find_root, mass_below, reattached
from mua.rig.rigid_motion import RigidMotion, local_offsets, local_rotations, rigid_motion
from mua.rig.scene import Motion, Scene, Source
from mua.rig.skeleton import Pose, Skeleton

TOLD_MILLIMETRES = 1.0  # a smaller loss is not worth a sentence
TOLD_SCALE = 0.01


@dataclass(frozen=True)
class Rigged:
    """A skeleton, the nodes that its joints were, its clips, and a sentence for each thing changed or lost."""

    skeleton: Skeleton
    nodes: Array  # [J] int nodes of the scene
    clips: tuple[Clip, ...]
    notes: tuple[str, ...]


def rigid_skeleton(scene: Scene, bind: Bind) -> Rigged:
    """Make the scene's joints rigid: rotations only, and a translation of the root."""
    motions = [rigid_motion(motion, bind) for motion in scene.motions]
    bind, told = reattached([scene.node_names[node] for node in bind.nodes], bind, motions=motions)
    if told:
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
    clips = []
    for source, motion in zip(scene.motions, motions, strict=True):
        local = rotation.from_matrix(local_rotations(motion.rotations, bind.parents))
        at = _root_translation(skeleton, local, motion.positions)
        clips.append(Clip(source.name, source.rate, local, skeleton.with_root(at)))
    return Rigged(skeleton, bind.nodes, tuple(clips), (*told, *_losses(scene, skeleton, bind=bind, motions=motions)))


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


def _root_translation(skeleton: Skeleton, local: Array, positions: Array) -> Array:
    """Root translations [F, 3] that put the root joint where the source has it, whatever stands above it."""
    parent = skeleton.parents[skeleton.root]
    if parent < 0:
        return positions[:, skeleton.root]
    turned, placed = skeleton.world(local, skeleton.with_root(np.zeros((len(local), 3))))
    return rotation.rotate(rotation.conjugate(turned[:, parent]), positions[:, skeleton.root] - placed[:, parent])


def _losses(scene: Scene, skeleton: Skeleton, *, bind: Bind, motions: list[RigidMotion]) -> tuple[str, ...]:
    """Sentences on the largest translation and scale that rigid joints do not follow."""
    carries = mass_below(bind) > 0
    exact = skeleton.root  # the root is where the source has it, whatever is lost above
    while exact >= 0:
        carries[exact] = False
        exact = int(skeleton.parents[exact])
    shifts, scales = [(0.0, "", "")], [(0.0, "", "")]
    for source, motion in zip(scene.motions, motions, strict=True):
        offsets = local_offsets(motion.rotations, motion.positions, bind.parents)
        apart = np.linalg.norm(offsets - skeleton.bind_translations, axis=-1).max(axis=0) * carries
        scaled = motion.scales.max(axis=0) * (bind.mass > 0)
        shifts.append((float(apart.max()), skeleton.names[int(apart.argmax())], source.name))
        scales.append((float(scaled.max()), skeleton.names[int(scaled.argmax())], source.name))
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
