"""Skeletons: plain ones, a person in T-pose with other proportions and joint axes, and motion for it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.motion import retarget as retargeting
from mua.motion.match import match_joints, require_limbs
from mua.motion.source import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

# Chains of at most 12 joints, some 100 operations each on lengths up to 10 m, divided by bones of at least 0.1 m.
POSITION_BOUND = 12 * 100 * 10 * np.finfo(float).eps
ANGLE_BOUND = POSITION_BOUND / 0.1

LIMBS = [
    (f"{side}{bone}", f"{side}{end}")
    for side in ("Left", "Right")
    for bone, end in (("Arm", "ForeArm"), ("ForeArm", "Hand"), ("UpLeg", "Leg"), ("Leg", "Foot"))
]

# Parents, and world positions of a person in T-pose who faces +Z and stands on the floor, metres; the right side is
# mirrored.
JOINTS = {
    "Hips": ("", (0, 1.0, 0)),
    "Spine": ("Hips", (0, 1.1, 0)),
    "Spine1": ("Spine", (0, 1.2, 0.01)),
    "Spine2": ("Spine1", (0, 1.32, 0)),
    "Neck": ("Spine2", (0, 1.5, -0.02)),
    "Head": ("Neck", (0, 1.6, 0.01)),
    "HeadTop_End": ("Head", (0, 1.8, 0.03)),
    "LeftShoulder": ("Spine2", (0.06, 1.45, 0)),
    "LeftArm": ("LeftShoulder", (0.18, 1.45, -0.01)),
    "LeftForeArm": ("LeftArm", (0.46, 1.45, -0.01)),
    "LeftHand": ("LeftForeArm", (0.72, 1.45, 0)),
    "LeftHandMiddle1": ("LeftHand", (0.82, 1.45, 0)),
    "LeftUpLeg": ("Hips", (0.1, 0.94, 0)),
    "LeftLeg": ("LeftUpLeg", (0.1, 0.52, 0.01)),
    "LeftFoot": ("LeftLeg", (0.1, 0.1, -0.02)),
    "LeftToeBase": ("LeftFoot", (0.1, 0.02, 0.11)),
    "LeftToe_End": ("LeftToeBase", (0.1, 0.0, 0.17)),
}
PARENTS = {name: parent for name, (parent, _) in JOINTS.items()}


def upright(names: Sequence[str], parents: Any, offsets: Any = None, *, root: int = 0) -> Skeleton:
    """Joints that are not turned at rest, at [J, 3] metres from their parents, or all in one place."""
    turned = np.tile([1.0, 0, 0, 0], (len(names), 1))
    places = np.zeros((len(names), 3)) if offsets is None else np.array(offsets, float)
    return Skeleton(tuple(names), np.array(parents, np.int32), turned, places, root)


def chain(*names: str) -> Skeleton:
    """Joints one below the other."""
    return upright(names, np.arange(-1, len(names) - 1), np.ones((len(names), 3)))


def still(skeleton: Skeleton, frames: int = 1, *, root: Any = None, rate: float = 30.0) -> Clip:
    """The bind pose, held; its root at another place, [3] or [F, 3] metres."""
    at = skeleton.bind_translations[skeleton.root] if root is None else root
    translations = skeleton.with_root(np.broadcast_to(at, (frames, 3)))
    return Clip("still", rate, np.tile(skeleton.bind_rotations, (frames, 1, 1)), translations)


def person(*, arms_down: float = 0, legs_apart: float = 0, size: float = 1, axes: int | None = None) -> Skeleton:
    """The T-pose, arms lowered and legs set apart (feet roll along) by degrees; joint axes random by seed `axes`."""
    at = {name: np.array(place) * size for name, (_, place) in JOINTS.items()}
    swing(at, "LeftArm", -arms_down)
    swing(at, "LeftUpLeg", legs_apart)
    parents = dict(PARENTS)
    for name in [name for name in at if name.startswith("Left")]:
        at["Right" + name[4:]] = at[name] * [-1, 1, 1]
        parents["Right" + name[4:]] = parents[name].replace("Left", "Right")
    names = tuple(at)
    turned = np.tile([1.0, 0, 0, 0], (len(names), 1))
    if axes is not None:
        turned = Rotation.random(len(names), random_state=axes).as_quat(scalar_first=True)
    index = np.array([names.index(parents[name]) if parents[name] else -1 for name in names], dtype=np.int32)
    above = np.where(index[:, None] < 0, [1.0, 0, 0, 0], turned[index])
    origin = np.array([at[parents[name]] if parents[name] else np.zeros(3) for name in names])
    local = rotation.rotate(rotation.conjugate(above), np.array(list(at.values())) - origin)
    return Skeleton(names, index, rotation.multiply(rotation.conjugate(above), turned), local, root=0)


def swing(at: dict[str, np.ndarray], joint: str, degrees: float) -> None:
    """Turn everything below a left joint about Z through it."""
    turn, centre = Rotation.from_euler("z", degrees, degrees=True), at[joint]
    below = {joint}
    for name, parent in PARENTS.items():
        if parent in below:
            below.add(name)
            at[name] = centre + turn.apply(at[name] - centre)


def random_clip(skeleton: Skeleton, frames: int = 9) -> Clip:
    """Every joint up to about 60 degrees away from bind, the root also along a path."""
    random = np.random.default_rng(8)
    turns = Rotation.from_rotvec(random.normal(size=(frames * len(skeleton.names), 3)) * 0.4).as_quat(scalar_first=True)
    rotations = rotation.multiply(turns.reshape(frames, -1, 4), skeleton.bind_rotations)
    above = int(skeleton.parents[skeleton.root])
    turned, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    path = random.normal(size=(frames, 3)) * [1, 0.1, 1]
    if above >= 0:
        path = rotation.rotate(rotation.conjugate(turned[above]), path)
    translation = skeleton.bind_translations[skeleton.root] + path
    return Clip("clip", 30.0, rotations, skeleton.with_root(translation))


def world(skeleton: Skeleton, clip: Clip) -> tuple[np.ndarray, np.ndarray]:
    return skeleton.world(clip.rotations, clip.translations)


def walk(skeleton: Skeleton, frames: int = 60, speed: float = 1.2, rate: float = 30.0) -> Clip:
    """Steps along +Z of a person with plain axes: each foot stands for half of a second, knees and elbows bend."""
    at = dict(zip(skeleton.names, skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)[1], strict=True))
    thigh, shin = (np.linalg.norm(at[a] - at[b]) for a, b in (("LeftUpLeg", "LeftLeg"), ("LeftLeg", "LeftFoot")))
    time = np.arange(frames) / rate
    rotations = np.tile(skeleton.bind_rotations, (frames, 1, 1))
    drop = 0.06 * (thigh + shin)  # keeps a knee's bend in the longest stride
    for side, phase in (("Left", 0.0), ("Right", 0.5)):
        cycle = (time + phase) % 1.0
        ankle = at[f"{side}Foot"] - at[f"{side}UpLeg"]
        swing = np.clip((cycle - 0.5) / 0.5, 0, 1)
        ahead = np.where(cycle < 0.5, speed * (0.25 - cycle), speed * (swing - 0.5) / 2)
        height = ankle[1] + drop + 0.15 * np.sin(np.pi * swing) * (thigh + shin)
        pitch, bend = _two_bones(thigh, shin, ahead, -height)
        for joint, angle in ((f"{side}UpLeg", pitch), (f"{side}Leg", bend), (f"{side}Foot", -pitch - bend)):
            turns = Rotation.from_rotvec(angle[:, None] * [1, 0, 0]).as_quat(scalar_first=True)
            rotations[:, skeleton.names.index(joint)] = turns
        arm = Rotation.from_euler("zy", np.stack([np.full(frames, -1.2), 0.3 * np.sin(2 * np.pi * cycle)], axis=-1))
        fold = Rotation.from_rotvec((-0.4 - 0.2 * np.sin(2 * np.pi * cycle))[:, None] * [0, 1, 0])
        for joint, turn in (("Arm", arm), ("ForeArm", fold)):
            quaternion = turn.as_quat(scalar_first=True) * ([1, 1, 1, 1] if side == "Left" else [1, 1, -1, -1])
            rotations[:, skeleton.names.index(side + joint)] = quaternion
    path = skeleton.bind_translations[0] + np.stack([0 * time, 0 * time - drop, speed * time], axis=-1)
    return Clip("walk", rate, rotations, skeleton.with_root(path))


def _two_bones(upper: float, lower: float, ahead: np.ndarray, below: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Turns about X of two bones that hang along -Y so that their end is `ahead` along Z and `below` along -Y."""
    reach = np.minimum(np.hypot(ahead, below), (upper + lower) * (1 - 1e-9))
    inner = np.arccos((upper**2 + reach**2 - lower**2) / (2 * upper * reach))
    bend = np.pi - np.arccos((upper**2 + lower**2 - reach**2) / (2 * upper * lower))
    return -np.arctan2(ahead, below) - inner, bend


def bone_aligned(skeleton: Skeleton, clip: Clip) -> tuple[Skeleton, Clip]:
    """The same motion of the same places as studios export it: at rest every joint's first bone lies along +X."""
    turned = np.tile([1.0, 0, 0, 0], (len(skeleton.names), 1))  # from a joint's new space to its old one
    for joint in reversed(range(1, len(skeleton.names))):
        bone = skeleton.bind_translations[joint]
        if length := np.linalg.norm(bone):
            turned[skeleton.parents[joint]] = rotation.between(np.array([1.0, 0, 0]), bone / length)
    above = np.where(skeleton.parents[:, None] < 0, [1.0, 0, 0, 0], turned[skeleton.parents])
    offsets = rotation.rotate(rotation.conjugate(above), skeleton.bind_translations)
    straight = Skeleton(
        skeleton.names, skeleton.parents, np.tile([1.0, 0, 0, 0], (len(offsets), 1)), offsets, skeleton.root
    )
    rotations = rotation.multiply(rotation.conjugate(above), rotation.multiply(clip.rotations, turned))
    translations = rotation.rotate(np.broadcast_to(rotation.conjugate(above), rotations.shape), clip.translations)
    return straight, Clip(clip.name, clip.rate, rotations, translations)


def retarget(
    source: SourceMotion, target: Skeleton, *, mapping: Mapping[str, str] | None = None, rate: float = 30.0
) -> tuple[Clip, tuple[str, ...]]:
    """Motion on a target whose joints are matched as those of a character are, and notes."""
    matches = match_joints(source.skeleton, target, mapping, source_said=source.said)
    if not mapping:
        require_limbs(source.skeleton, target, matches)
    return retargeting.retarget(source, target, matches, rate=rate)


def bone(skeleton: Skeleton, clip: Clip, begin: str, end: str) -> np.ndarray:
    """Unit directions [F, 3] in the world from joint to joint."""
    at = world(skeleton, clip)[1]
    along = at[:, skeleton.names.index(end)] - at[:, skeleton.names.index(begin)]
    return np.asarray(along / np.linalg.norm(along, axis=-1, keepdims=True))


def angle(a: np.ndarray, b: np.ndarray) -> float:
    """The largest angle between unit vectors, radians."""
    return float(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)).max())


def with_offset(skeleton: Skeleton, joint: str, offset: Any) -> Skeleton:
    """The same with a joint elsewhere in its parent."""
    offsets = skeleton.bind_translations.copy()
    offsets[skeleton.names.index(joint)] = offset
    return replace(skeleton, bind_translations=offsets)


def assert_turned_as_at_rest(skeleton: Skeleton, turned: np.ndarray, *names: str) -> None:
    """`turned` [J, 4] are rotations in the world."""
    rest, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    joints = [skeleton.names.index(name) for name in names]
    np.testing.assert_allclose(np.abs(np.sum(turned[joints] * rest[joints], axis=1)), 1, atol=POSITION_BOUND)
