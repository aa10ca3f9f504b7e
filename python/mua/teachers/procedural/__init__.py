"""The procedural character: a dressed figure with its own clips, made from nothing but a seed."""

from dataclasses import replace

import numpy as np

from mua.limits import MAX_INFLUENCES
from mua.rig.character import Character
from mua.teachers.procedural.figure import build_arm, build_fingers, build_leg, build_trunk, other_side
from mua.teachers.procedural.grid import below, weld
from mua.teachers.procedural.head import build_hair, build_head
from mua.teachers.procedural.joints import build_skeleton
from mua.teachers.procedural.motions import build_clips
from mua.teachers.procedural.paint import paint
from mua.teachers.procedural.skin import eased, strongest
from mua.teachers.procedural.skirt import build_skirt

__all__ = ["procedural_character"]


def procedural_character(*, seed: int = 0) -> Character:
    """A clothed human figure, 1.7 m tall, facing +Z in an A-pose, that walks, turns, reaches and dances.

    The seed varies the fall of the skirt's folds. Same seed, same bytes.
    """
    rng = np.random.default_rng(seed)
    skeleton = build_skeleton()
    trunk = build_trunk()
    arm, fingers, leg = build_arm(trunk.points), build_fingers(), build_leg()
    parts = (
        build_skirt(trunk.points, rng.uniform(-np.pi, np.pi, size=2)),
        trunk,
        build_head(trunk.points),
        build_hair(),
        arm,
        other_side(arm, cell=(160, 98, 192, 168)),
        *fingers,
        *(other_side(finger, cell=below(finger.cell)) for finger in fingers),
        leg,
        other_side(leg, cell=(108, 98, 128, 192)),
    )
    mesh, weights, looseness = weld(parts)
    indices, weights = strongest(eased(mesh, weights, rounds=16), MAX_INFLUENCES)
    mesh = replace(mesh, vertices=eased(mesh, mesh.vertices, rounds=6))
    return Character(
        name="procedural",
        skeleton=skeleton,
        mesh=mesh,
        skin_indices=indices,
        skin_weights=weights,
        base_color=paint(parts),
        clips=build_clips(skeleton),
        looseness=looseness,
    )
