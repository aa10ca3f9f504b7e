"""Put motion of one skeleton onto another by what every bone does in the world.

For a target joint t that follows source joint s:

    R_t(f) = W  R_s(f) R_s(rest)^-1  A_t  R_t(bind)

A_t brings the target's bind pose to the source's rest pose: the turn of the whole body, then limb by limb the shortest
rotation between the bones' directions, so that a T-pose, an A-pose and legs apart all mean the same. W turns the result
so that the source's rest faces where the target's bind faces. The hips' path is scaled by the ratio of leg lengths and
set so that standing feet keep the height that they have in the bind pose.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.clip import Clip
from mua.motion.descriptor import heading_of
from mua.motion.match import Matches, match_joints
from mua.motion.resample import resample
from mua.motion.source import SourceMotion
from mua.rig.skeleton import Skeleton

SIDES = ("left", "right")
LIMBS = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}  # bones aligned: where they end
SOLES = ("foot", "toe")
STANDING = 0.05  # quantile over frames of the lower foot's height that counts as standing
ON_FLOOR = 0.1  # of the height: a rest pose whose lowest joint is this near to 0 stands on the floor
LOWEST = 0.25  # of the leg: a clip higher above the floor than this never stands and stays where it is
CLEARLY = 10  # times nearer to the shin's plane than to the vertical one: a foot that rolls with its leg

IDENTITY = np.array([1.0, 0, 0, 0])
Y = np.array([0.0, 1, 0])


@dataclass(frozen=True)
class _Rest:
    """Both skeletons at rest in the world, and which source joints move which target joints."""

    target: Skeleton
    target_turned: Array  # [T, 4]
    target_at: Array  # [T, 3] metres
    source: Skeleton
    source_turned: Array  # [S, 4]
    source_at: Array  # [S, 3] metres
    matches: Matches

    def joint(self, role: str) -> int | None:
        """The first matched target joint of a role."""
        return self.matches.joint(role)

    def places(self, role: str) -> Array | None:
        """[2, 3] where a role begins on target and source, None if it is not matched."""
        ends = self.matches.ends(role)
        return None if ends is None else np.stack([self.target_at[ends[0]], self.source_at[ends[1]]])

    def middle(self, part: str) -> Array | None:
        """[2, 3] the middle between left and right."""
        left, right = (self.places(f"{side} {part}") for side in SIDES)
        return None if left is None or right is None else (left + right) / 2


def retarget(
    source: SourceMotion, target: Skeleton, *, mapping: Mapping[str, str] | None = None, rate: float = 30.0
) -> tuple[Clip, tuple[str, ...]]:
    """Return the motion of `source` on `target` at `rate` frames per second, and notes worth telling the user.

    mapping: target joint names to source joint names, before any match by name. Joints that nothing matches keep their
    bind rotation. Errors: InputError if no joint name matches or `mapping` names an unknown joint.
    """
    return retarget_matched(source, target, match_joints(source.skeleton, target, mapping), rate=rate)


def retarget_matched(
    source: SourceMotion, target: Skeleton, matches: Matches, *, rate: float = 30.0
) -> tuple[Clip, tuple[str, ...]]:
    """The same for joints that are matched already."""
    rest = _rest(source.skeleton, target, matches)
    clip = resample(source.clip, rate)
    upright = _body_turn(rest)
    facing = rotation.conjugate(heading_of(upright))
    source_turned, source_at = source.skeleton.world(clip.rotations, clip.translations)
    moved = rotation.multiply(facing, rotation.multiply(source_turned, rotation.conjugate(rest.source_turned)))
    rotations = _local_rotations(rest, _alignments(rest, upright), moved)
    translation, notes = _translation(rest, rotations, rotation.rotate(facing, source_at))
    notes = [f"{clip.name}: {note}" for note in notes]
    if unmatched := len(target.names) - len(rest.matches.chains):
        notes.append(
            f"{unmatched} of {len(target.names)} joints match none of the motion and keep their bind rotation."
        )
    return Clip(clip.name, rate, rotations, target.with_root(translation)), (*source.notes, *notes)


def _rest(source: Skeleton, target: Skeleton, matches: Matches) -> _Rest:
    target_rest = target.world(target.bind_rotations, target.bind_translations)
    source_rest = source.world(source.bind_rotations, source.bind_translations)
    return _Rest(target, *target_rest, source, *source_rest, matches=matches)


def _body_turn(rest: _Rest) -> Array:
    """The rotation [4] from the target's bind to the source's rest pose as whole bodies, identity where unknown."""
    top = next((places for role in ("head", "neck", "spine") if (places := rest.places(role)) is not None), None)
    bottom = middle if (middle := rest.middle("thigh")) is not None else rest.places("hips")
    across = next(
        (pair for part in ("thigh", "upper_arm", "shoulder") if (pair := _across(rest, part)) is not None), None
    )
    if top is None or bottom is None or across is None:
        return IDENTITY
    pairs = [(_nearest_axis(up), left) for up, left in zip(top - bottom, across, strict=True)]
    if not all(np.cross(left, up).any() for up, left in pairs):
        return IDENTITY
    frames = [_frame(up, left) for up, left in pairs]
    return rotation.multiply(rotation.from_matrix(frames[1]), rotation.conjugate(rotation.from_matrix(frames[0])))


def _across(rest: _Rest, part: str) -> Array | None:
    """[2, 3] from right to left."""
    left, right = (rest.places(f"{side} {part}") for side in SIDES)
    return None if left is None or right is None else left - right


def _nearest_axis(v: Array) -> Array:
    """The signed coordinate axis [3] nearest to v [3]: what is up for a body that leans in its rest pose."""
    axis = int(np.argmax(np.abs(v)))
    return np.asarray(np.sign(v[axis]) * np.eye(3)[axis])


def _frame(up: Array, left: Array) -> Array:
    """Rotation matrix [3, 3] with columns left, up, forward; `up` [3] is kept, `left` [3] made square to it."""
    forward = _unit(np.cross(left, up))
    return np.stack([np.cross(up, forward), up, forward], axis=-1)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v))


def _alignments(rest: _Rest, upright: Array) -> dict[int, Array]:
    """A_t [4] of every matched target joint, from the root outwards: each starts from that of the joint above."""
    found: dict[int, Array] = {}
    parts = {joint: role for role, joints in rest.matches.roles.items() for joint in joints}
    for joint in sorted(rest.matches.chains):
        above = int(rest.target.parents[joint])
        while above >= 0 and above not in found:
            above = int(rest.target.parents[above])
        base = found.get(above, upright)
        role = parts.get(joint, "")
        side, _, part = role.rpartition(" ")
        if part == "foot":
            found[joint] = _sole_alignment(rest, side, upright, base)
        elif part in LIMBS:
            found[joint] = _bone_alignment(rest, role, f"{side} {LIMBS[part]}", base)
        else:
            found[joint] = base
    return found


def _bone_alignment(rest: _Rest, role: str, end: str, base: Array) -> Array:
    """`base` [4], then the shortest rotation that lays the target's bone from `role` to `end` along the source's."""
    begins, ends = rest.places(role), rest.places(end)
    if begins is None or ends is None:
        return base
    lengths = np.linalg.norm(ends - begins, axis=-1)
    if not lengths.all():
        return base
    target_bone, source_bone = (ends - begins) / lengths[:, None]
    return rotation.multiply(rotation.between(rotation.rotate(base, target_bone), source_bone), base)


def _sole_alignment(rest: _Rest, side: str, upright: Array, base: Array) -> Array:
    """The rotation [4] between the level soles of target and source at rest."""
    knee, ankle, ball = (rest.places(f"{side} {part}") for part in ("shin", "foot", "toe"))
    toe = rest.joint(f"{side} toe")
    if knee is None or ankle is None or ball is None or toe is None:
        return base
    tips = (
        _first_child(rest.target, rest.target_at, toe),
        _first_child(rest.source, rest.source_at, rest.matches.chains[toe][1]),
    )
    up = np.stack([Y, _nearest_axis(rotation.rotate(upright, Y))])
    target_sole, source_sole = (_sole_frame(knee[i], ankle[i], ball[i], tips[i], up[i]) for i in range(2))
    if target_sole is None or source_sole is None:
        return base
    return rotation.multiply(rotation.from_matrix(source_sole), rotation.conjugate(rotation.from_matrix(target_sole)))


def _first_child(skeleton: Skeleton, at: Array, joint: int) -> Array | None:
    children = np.flatnonzero(skeleton.parents == joint)
    return at[children[0]] if len(children) else None


def _sole_frame(knee: Array, ankle: Array, ball: Array, tip: Array | None, up: Array) -> Array | None:
    """Columns left, up, forward of a sole at rest, which is level along the foot; None where toes point up or nowhere.

    Across the foot it is level too, unless the foot continues a leg that is set apart, as in the zero pose of ASF
    skeletons: there ball and toes lie in one plane with the shin rather than with the vertical.
    """
    toes = ball - ankle if tip is None else tip - ball
    level, rolled = (np.cross(above, toes) for above in (up, knee - ankle))
    if not (level.any() and rolled.any()):
        return None
    level, rolled = _unit(level), _unit(rolled)
    rolls = CLEARLY * abs(rolled @ (ball - ankle)) < abs(level @ (ball - ankle))
    left = rolled if rolls else level
    forward = _unit(np.cross(left, up))
    return np.stack([left, np.cross(forward, left), forward], axis=-1)


def _local_rotations(rest: _Rest, alignments: dict[int, Array], moved: Array) -> Array:
    """Local rotations [F, T, 4] of the target, from the world rotations [F, S, 4] of the source since its rest pose."""
    target = rest.target
    turned = np.empty((len(moved), len(target.names), 4))
    local = np.empty_like(turned)
    for joint, parent in enumerate(target.parents):
        above = turned[:, parent] if parent >= 0 else IDENTITY
        if joint in rest.matches.chains:
            bound = rotation.multiply(alignments[joint], rest.target_turned[joint])
            turned[:, joint] = rotation.multiply(moved[:, rest.matches.chains[joint][1]], bound)
            local[:, joint] = rotation.normalize(rotation.multiply(rotation.conjugate(above), turned[:, joint]))
        else:
            local[:, joint] = target.bind_rotations[joint]
            turned[:, joint] = rotation.multiply(above, local[:, joint])
    return local


def _translation(rest: _Rest, rotations: Array, source_at: Array) -> tuple[Array, list[str]]:
    """Local translation [F, 3] of the target's root that carries the hips along the source's path, and notes."""
    target, matches = rest.target, rest.matches
    turned, at = target.world(rotations, np.broadcast_to(target.bind_translations, (*rotations.shape[:-1], 3)))
    scale, leg = _leg_scale(rest)
    legs = [joint for side in SIDES if (joint := rest.joint(f"{side} thigh")) is not None]
    hips = legs if len(legs) == 2 else [joint for joint in (rest.joint("hips"),) if joint is not None]
    if not hips:
        return np.tile(target.bind_translations[target.root], (len(rotations), 1)), ["no hips; it stays in place."]
    path = scale * source_at[:, [matches.chains[joint][0] for joint in hips]].mean(axis=1)
    shift = path - at[:, hips].mean(axis=1)
    lift = _lift(rest, at + shift[:, None], source_at, scale)
    notes = []
    if -lift > LOWEST * leg:
        notes.append(f"its feet never come nearer to the floor than {-lift:.2f} m; the height is kept.")
    else:
        shift[:, 1] += lift
    parent = target.parents[target.root]
    if parent >= 0:
        shift = rotation.rotate(rotation.conjugate(turned[:, parent]), shift)
    return target.bind_translations[target.root] + shift, notes


def _leg_scale(rest: _Rest) -> tuple[float, float]:
    """Target size over source size, and the target's leg in metres: by the legs, else by all matched bones."""
    lengths = np.zeros(2)
    for side in SIDES:
        chain = [rest.places(f"{side} {part}") for part in ("thigh", "shin", "foot")]
        known = [places for places in chain if places is not None]
        if len(known) == len(chain):
            lengths += np.linalg.norm(np.diff(np.stack(known), axis=0), axis=-1).sum(axis=0)
    if not lengths.all():
        lengths = _all_bones(rest)
    return (float(lengths[0] / lengths[1]), float(lengths[0]) / 2) if lengths.all() else (1.0, 1.0)


def _all_bones(rest: _Rest) -> Array:
    """[2] summed lengths of the bones between matched joints, on target and source."""
    total = np.zeros(2)
    for joint, (first, _) in rest.matches.chains.items():
        parent = int(rest.target.parents[joint])
        if parent in rest.matches.chains:
            bones = (
                rest.target_at[joint] - rest.target_at[parent],
                rest.source_at[first] - rest.source_at[rest.matches.chains[parent][0]],
            )
            total += np.linalg.norm(bones, axis=-1)
    return total


def _lift(rest: _Rest, at: Array, source_at: Array, scale: float) -> float:
    """Metres by which to raise the target so that standing feet are as high as the source's, 0 without feet.

    The height of a foot is that above its place in the rest pose. Where the source's rest pose does not stand on the
    floor (ASF skeletons rest about the hips), the clip's lower foot is taken to stand.
    """
    soles = [joint for side in SIDES for part in SOLES if (joint := rest.joint(f"{side} {part}")) is not None]
    if not soles:
        return 0.0
    feet = [rest.matches.chains[joint][0] for joint in soles]
    floor = 0.0 if _stands(rest.target_at) else rest.target_at[:, 1].min()
    lowest = np.min(at[:, soles, 1] - (rest.target_at[soles, 1] - floor), axis=1)
    lowest_source = np.min(source_at[:, feet, 1] - rest.source_at[feet, 1], axis=1)
    expected = scale * np.quantile(lowest_source, STANDING) if _stands(rest.source_at) else 0.0
    return float(expected - np.quantile(lowest, STANDING))


def _stands(at: Array) -> bool:
    """Whether a rest pose [J, 3] stands on the floor at height 0."""
    return bool(abs(at[:, 1].min()) < ON_FLOOR * np.ptp(at[:, 1]))
