"""Points of a template that 3D keypoints show, by the keypoints' names, and the lengths of the person's limbs."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.capture.readers.keypoints import Keypoints
from mua.errors import InputError
from mua.motion.facing import front_of
from mua.pose.joint_names import SIDES, Roles, roles
from mua.pose.skeleton import Skeleton

JOINTS = {  # keypoint to the role of a joint; names of OpenPose, HALPE, COCO, OpenCap and MediaPipe
    "neck": "neck",
    **{
        f"{side[0]}{name}": f"{side} {part}"
        for side in SIDES
        for name, part in {
            "hip": "thigh",
            "knee": "shin",
            "ankle": "foot",
            "shoulder": "upper_arm",
            "elbow": "forearm",
            "wrist": "hand",
        }.items()
    },
}
# Keypoints on the skin: the role of the joint that moves them, and where on its part: up, forward.
SKIN = {
    "head": ("head", (1, 0)),
    "nose": ("head", (0, 1)),
    **{
        f"{side[0]}{name}": (f"{side} foot", (0, along))
        for side in SIDES
        for name, along in {"bigtoe": 1, "footindex": 1, "heel": -1}.items()
    },
}
LIMBS = (("thigh", "shin"), ("shin", "foot"), ("upper_arm", "forearm"), ("forearm", "hand"))
LEAST = 8  # joints that must be found
LEAST_SCALE, MOST_SCALE = 0.75, 1.35  # of a limb
LOOSE = 0.3  # weight of keypoints whose place on a template is not exact
TOP_WEIGHT = 0.5  # of a vertex's skin weights, which makes it part of a joint's body part


@dataclass(frozen=True, eq=False)
class Target:
    """A point of the template that a keypoint shows."""

    name: str
    keypoint: int  # its number in the file
    role: str
    joint: int
    offset: Array  # [3] from the joint, in its axes, metres
    weight: float


def find_targets(keypoints: Keypoints, surfaces: Surfaces) -> list[Target]:
    """The keypoints that are known by name and that the template has a joint for.

    Errors: InputError where they are too few to pose arms and legs.
    """
    skeleton, found = surfaces.skeleton, roles(surfaces.skeleton, surfaces.roles)
    targets = [
        target
        for number, name in enumerate(keypoints.names)
        if np.isfinite(keypoints.points[:, number]).any()
        and (target := _target(name, number, surfaces, skeleton, found)) is not None
    ]
    joints = [target for target in targets if not target.offset.any()]
    if len(joints) < LEAST:
        names = ", ".join(target.name for target in joints) or "none"
        raise InputError(
            f"{keypoints.path}: {len(joints)} keypoints are joints of the template ({names}); "
            f"expected at least {LEAST} of {', '.join(JOINTS)}. The file has {', '.join(keypoints.names)}"
        )
    return targets


def limb_scales(
    skeleton: Skeleton,
    targets: Sequence[Target],
    points: Array,  # [F, K, 3]
) -> tuple[Array, float]:
    """Scales [J] of the way from each joint's parent to it over the template's, and the scale of all limbs together."""
    at = {target.role: number for number, target in enumerate(targets) if not target.offset.any()}
    _, bind = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    scales, ours, theirs = np.ones(len(skeleton.names)), 0.0, 0.0
    for upper, lower in LIMBS:
        roles_of = [(f"{side} {upper}", f"{side} {lower}") for side in SIDES]
        pairs = [(at[a], at[b]) for a, b in roles_of if a in at and b in at]
        measured = [(a, b, long) for a, b in pairs if (long := _apart(points[:, a], points[:, b])) is not None]
        if not measured:
            continue
        ends = [(targets[a].joint, targets[b].joint) for a, b, _ in measured]
        length = sum(long for _, _, long in measured)
        own = sum(float(np.linalg.norm(bind[a] - bind[b])) for a, b in ends)
        theirs, ours = theirs + length, ours + own
        for top, joint in ends:
            chain = [joint, *skeleton.ancestors(joint)]
            scales[chain[: chain.index(top)]] = np.clip(length / own, LEAST_SCALE, MOST_SCALE)
    return scales, theirs / ours if ours else 1.0


def well_seen(keypoints: Keypoints, targets: Sequence[Target]) -> int:
    """The first frame that shows enough to begin with; raises InputError where there is none."""
    seen = np.isfinite(keypoints.points[:, [target.keypoint for target in targets]]).all(axis=2).sum(axis=1)
    if seen.max() < LEAST:
        raise InputError(
            f"{keypoints.path}: no frame has {LEAST} of the keypoints that are used; the most is {seen.max()}"
        )
    return int((seen >= LEAST).argmax())


def _apart(
    a: Array,  # [F, 3]
    b: Array,
) -> float | None:
    """The median distance of two keypoints; None where no frame shows both."""
    distances = np.linalg.norm(a - b, axis=1)
    seen = np.isfinite(distances)
    return float(np.median(distances[seen])) if seen.any() else None


def _target(name: str, number: int, surfaces: Surfaces, skeleton: Skeleton, found: Roles) -> Target | None:
    short = re.sub("[^a-z]", "", re.sub("^left", "l", re.sub("^right", "r", name.strip().lower())))
    if (role := JOINTS.get(short)) in found:
        assert role is not None
        return Target(name, number, role, found[role][0], np.zeros(3), LOOSE if role == "neck" else 1.0)
    if short in SKIN and (of := SKIN[short][0]) in found:
        place = _on_skin(surfaces, skeleton, found[of][0], SKIN[short][1])
        return None if place is None else Target(name, number, of, found[of][0], place, LOOSE)
    return None


def _on_skin(surfaces: Surfaces, skeleton: Skeleton, joint: int, along: tuple[int, int]) -> Array | None:
    """The outermost point of what a joint and those below it move, in the joint's axes."""
    below = np.array([joint in (one, *skeleton.ancestors(one)) for one in range(len(skeleton.names))])
    weight = (surfaces.skin_weights * below[surfaces.skin_indices]).sum(axis=1)
    part = surfaces.vertices[weight > TOP_WEIGHT]
    if not len(part):
        return None
    azimuth = front_of(skeleton, skeleton.bind_rotations, skeleton.bind_translations)
    up, ahead = along
    direction = up * np.array([0.0, 1, 0]) + ahead * np.array([np.sin(azimuth), 0, np.cos(azimuth)])
    turned, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    outermost = part[(part @ direction).argmax()]
    return rotation.rotate(rotation.conjugate(turned[joint]), outermost - at[joint])
