"""Eyes that are joints, which a file turns by gaze: as expressions, whose weight 1 moves what hangs on an eye.

A target moves its vertices along straight lines, where a joint would turn them: half of a turn by 30 degrees is 15
degrees, and 3.4 % nearer to the joint (1 - cos 15 degrees). Range maps:
https://github.com/vrm-c/vrm-specification/blob/master/specification/VRMC_vrm-1.0/lookAt.md
"""

from dataclasses import replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.pose.expression_rules import LOOKS
from mua.pose.expression_vocabulary import known_expression
from mua.scene import Part, Scene, Target

SIDES = ("Left", "Right")
WAYS = ("Out", "In", "Up", "Down")
GAZE = tuple(f"eyeLook{way}{side}" for side in SIDES for way in WAYS)  # ARKit's


def with_gaze(
    scene: Scene,  # faces +Z
    bind: Bind,
) -> Scene:
    """The scene with a target for each way in which gaze turns either eye; as it is where expressions show the gaze."""
    nodes, reach = bind.nodes.tolist(), scene.face_rules.reach
    eyes = [nodes.index(node) for node in scene.face_rules.eyes if node in nodes]
    shown = {known_expression(target.name) for part in scene.parts for target in part.targets} & {*GAZE, *LOOKS}
    if len(eyes) != len(SIDES) or shown:
        return scene
    eyes.sort(key=lambda eye: -float(bind.places[eye, 0]))  # the left one first
    turns = [
        (f"eyeLook{way}{side}", eye, _turn(way, reach[way], outward))
        for side, eye, outward in zip(SIDES, eyes, (1, -1), strict=True)
        for way in WAYS
        if reach[way] > 0
    ]
    return replace(scene, parts=tuple(_gazing(scene, part, bind, turns) for part in scene.parts))


def _turn(way: str, degrees: float, outward: int) -> Array:
    """The rotation [3, 3] of an eye that looks one way; `outward` is 1 where that is towards +X."""
    axis = {"Out": (0, outward, 0), "In": (0, -outward, 0), "Up": (-1, 0, 0), "Down": (1, 0, 0)}[way]
    return rotation.to_matrix(rotation.from_axis_angle(np.array(axis), np.radians(degrees)))


def _gazing(scene: Scene, part: Part, bind: Bind, turns: list[tuple[str, int, Array]]) -> Part:
    """The part with targets for those of its vertices that hang on an eye, by their weights there."""
    skin = scene.skins[part.skin]
    joints = np.searchsorted(bind.nodes, skin.joints)
    held = joints[part.joints]  # [N, K]
    targets = []
    for name, eye, turn in turns:
        share = np.sum(part.weights * (held == eye), axis=1)
        at = np.flatnonzero(share)
        if not len(at):
            continue
        own = (bind.matrices[joints] @ skin.inverse_binds)[part.joints[at]]  # [n, K, 4, 4]
        matrices = np.einsum("nk,nkij->nij", part.weights[at], own)
        linear = matrices[:, :3, :3]
        apart = np.einsum("nij,nj->ni", linear, part.positions[at]) + matrices[:, :3, 3] - bind.places[eye]
        moved = share[at, None] * (apart @ (turn - np.eye(3)).T)
        targets.append(Target(name, at, np.linalg.solve(linear, moved[..., None])[..., 0]))
    return replace(part, targets=(*part.targets, *targets))
