"""Capsules around a character's bones: the body that cloth must not enter and that shades its surroundings."""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.rig.character import Character

PERSON = 1.75  # metres; lengths of the simulation are for a figure of this size and scale with it
THINNEST = 0.02  # least radius in metres of a person's bones that are used: arms and legs, not fingers
SHORTEST = 0.03  # metres
BODY = 0.6  # vertices of larger looseness are clothes and say nothing about the body


@dataclass(frozen=True, eq=False)
class Bones:
    """Capsules in the bind pose, each moved by one joint."""

    joints: Array  # [C] int
    ends: Array  # [C, 2, 3] metres
    radii: Array  # [C] metres

    def posed(
        self,
        joints: Array,  # [J, 8] bind pose to world
    ) -> Array:
        """Ends [C, 2, 3] in the world."""
        return rotation.dual_transform(joints[self.joints][:, None], self.ends)


def figure_scale(vertices: Array) -> float:
    """The size of a character [V, 3] over that of a person."""
    return float(np.ptp(vertices, axis=0).max()) / PERSON


def fit_bones(character: Character, looseness: Array) -> Bones:
    """Fit a capsule to each joint that has a child and enough skin of its own; the radius is the median distance."""
    skeleton, vertices = character.skeleton, character.mesh.vertices
    scale = figure_scale(vertices)
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    found = []
    for joint in range(len(skeleton.names)):
        skin = vertices[(character.skin_indices[:, 0] == joint) & (looseness < BODY)]
        if not len(skin):
            continue
        end = _far_end(skin, places[joint], places[skeleton.parents == joint])
        radius = float(np.median(capsule_distance(skin, places[joint], end)))
        if radius > THINNEST * scale and np.linalg.norm(end - places[joint]) > SHORTEST * scale:
            found.append((joint, [places[joint], end], radius))
    joints, ends, radii = zip(*found, strict=True) if found else ((), (), ())
    return Bones(np.array(joints, dtype=int), np.array(ends).reshape(-1, 2, 3), np.array(radii))


def capsule_distance(
    points: Array,  # [..., 3]
    start: Array,  # [..., 3]
    end: Array,  # [..., 3]
) -> Array:
    """Distances [...] of points from segments."""
    axis = end - start
    along = np.sum((points - start) * axis, axis=-1) / np.maximum(np.sum(axis * axis, axis=-1), 1e-12)
    return np.asarray(np.linalg.norm(points - start - np.clip(along, 0, 1)[..., None] * axis, axis=-1))


def _far_end(skin: Array, joint: Array, children: Array) -> Array:
    """The end of a bone: at the child farthest along the skin, or where the skin ends for the last of a chain."""
    reach = skin.mean(axis=0) - joint
    if len(children):
        return np.asarray(children[np.argmax((children - joint) @ reach)])
    direction = reach / max(float(np.linalg.norm(reach)), 1e-9)
    return np.asarray(joint + direction * np.quantile((skin - joint) @ direction, 0.8))
