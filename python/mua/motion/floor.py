"""A body's place: the path of its hips, scaled to its legs, with feet on the floor."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.contacts import LOW, STANDING, UNDER, floor_of, planted, standing
from mua.motion.detached import detached_joints
from mua.motion.rest_alignment import IDENTITY, Rest, Y, body_turn
from mua.pose.joint_names import SIDES

SOLES = ("foot", "toe")
GOING = 0.2  # legs per second of the hips above standing feet from which these show how far a step carries
LIKELY = 1.5  # times the ratio of the legs: paces beyond it come from feet that do not stand
LOWEST = 0.25  # of the leg: a clip higher above the floor than this never stands and stays where it is


CARRIED_BY = (
    ("spine", "hips"),
    *(
        (f"{side} {part}", f"{side} {limb}")
        for part, limb in (("forearm", "upper_arm"), ("hand", "forearm"), ("shin", "thigh"), ("foot", "shin"))
        for side in SIDES
    ),
)


def placed(rest: Rest, rotations: Array, source_at: Array, *, rate: float, honest: bool) -> tuple[Array, list[str]]:
    """Local translations [F, T, 3] of the target that carry its hips along the source's path, and notes.

    honest: whether the source's rest pose shows a body, and so how high its feet stand.
    """
    target = rest.target
    translations = np.tile(target.bind_translations, (len(rotations), 1, 1))
    hips = hips_of(rest)
    if not hips:
        return translations, ["no hips; it stays in place."]
    _, at = target.world(rotations, attached(rest, rotations, translations))
    scale, leg = leg_scale(rest)
    path = hips_path(rest, source_at)
    pace = _pace(rest, at - at[:, hips].mean(axis=1)[:, None], source_at, path, rate=rate, scale=scale, leg=leg)
    path = path * np.array([pace, scale, pace])
    turned, at = target.world(rotations, led(rest, rotations, path))
    if not _soles(rest):
        return led(rest, rotations, path - standing(foot_heights(rest, turned, at)) * Y), []
    lift, notes = _lift(rest, turned, at, source_at if honest else None, scale, leg, rate)
    return led(rest, rotations, path + lift * Y), notes


def hips_of(rest: Rest) -> list[int]:
    """The joints of the target whose middle its hips are: where the legs begin, else the hips alone; [] without."""
    legs = [joint for side in SIDES if (joint := rest.joint(f"{side} thigh")) is not None]
    return legs if len(legs) == 2 else [joint for joint in (rest.joint("hips"),) if joint is not None]


def hips_path(rest: Rest, source_at: Array) -> Array:
    """Where the source's hips are [F, 3], of its joints' places [F, S, 3]."""
    return np.asarray(source_at[:, [rest.matches.chains[joint][0] for joint in hips_of(rest)]].mean(axis=1))


def foot_heights(rest: Rest, turned: Array, at: Array) -> Array:
    """How high above the floor the feet of the target are, [F, P] metres: as at rest, 0 where it has no legs.

    Legs without feet end on the floor at rest, straight below them.
    """
    if soles := _soles(rest):
        return np.asarray(at[:, soles, 1] - rest.target_at[soles, 1] + floor_of(rest.target_at, under=UNDER))
    floor = min(floor_of(rest.target_at), 0.0)
    heights = [np.zeros(len(at))]
    for side in SIDES:
        joint = next((j for part in ("shin", "thigh") if (j := rest.joint(f"{side} {part}")) is not None), None)
        if joint is not None:
            since = rotation.multiply(turned[:, joint], rotation.conjugate(rest.target_turned[joint]))
            down = (floor - rest.target_at[joint, 1]) * Y
            ends = at[:, joint, 1] + rotation.rotate(since, np.broadcast_to(down, at[:, joint].shape))[:, 1]
            heights.append(ends - floor)
    return np.stack(heights[1:] or heights, axis=1)


def _soles(rest: Rest) -> list[int]:
    return [joint for side in SIDES for part in SOLES if (joint := rest.joint(f"{side} {part}")) is not None]


def led(rest: Rest, rotations: Array, path: Array) -> Array:
    """Local translations [F, T, 3] of the target with its hips on a path [F, 3]."""
    target, mover = rest.target, _mover(rest)
    translations = np.tile(target.bind_translations, (len(rotations), 1, 1))
    turned, at = target.world(rotations, attached(rest, rotations, translations.copy()))
    parent = int(target.parents[mover])
    above = turned[:, parent] if parent >= 0 else np.broadcast_to(IDENTITY, turned[:, 0].shape)
    shift = path - at[:, hips_of(rest)].mean(axis=1)
    translations[:, mover] += rotation.rotate(rotation.conjugate(above), shift)
    return attached(rest, rotations, translations)


def _pace(rest: Rest, at: Array, source_at: Array, path: Array, *, rate: float, scale: float, leg: float) -> float:
    """How much farther along the floor the target's hips go than the source's, so that standing feet stand.

    at: target's joints relative to its hips [F, T, 3]. path: the source's hips [F, 3]. A standing foot goes backwards
    below the hips as fast as they go forward; `scale`, by the legs' lengths, where no foot does.
    """
    ends = [pair for side in SIDES for part in SOLES if (pair := rest.matches.ends(f"{side} {part}")) is not None]
    if not ends or len(at) < 2:
        return scale
    targets, sources = (list(joints) for joints in zip(*ends, strict=True))
    stands = planted(source_at[:, sources], rate, leg / scale)
    over = np.array([0, 2])
    below = source_at[:, sources] - path[:, None]
    back, source_back = (np.gradient(feet[..., over], axis=0)[stands] for feet in (at[:, targets], below))
    if np.sum(source_back**2) <= np.count_nonzero(stands) * (GOING * leg / scale / rate) ** 2:
        return scale
    pace = float(np.sum(source_back * back) / np.sum(source_back**2))
    return pace if scale / LIKELY < pace < scale * LIKELY else scale


def _mover(rest: Rest) -> int:
    """The joint whose translation moves the whole body: the skeleton's root, or hips or a spine that carry it too."""
    above, roles = rest.target.ancestors(rest.target.root), rest.matches.roles
    trunk = (*roles["hips"], *roles.get("spine", ()))
    return min((joint for joint in trunk if joint in above), default=rest.target.root)


def attached(rest: Rest, rotations: Array, translations: Array) -> Array:
    """Translations [F, T, 3] after which joints that do not hang on what carries them in a body are where it ends.

    Rigs for IK have hands and feet of that kind, others a chest beside the pelvis or parts of the trunk on the root.
    """
    target = rest.target
    pairs = [(rest.joint(role), rest.joint(carrier)) for role, carrier in CARRIED_BY]
    for joint, limb in (*pairs, *detached_joints(rest).items()):
        if joint is None or limb is None or limb in target.ancestors(joint) or joint in target.ancestors(limb):
            continue
        parent = int(target.parents[joint])
        turned, at = target.world(rotations, translations)
        since = rotation.multiply(turned[:, limb], rotation.conjugate(rest.target_turned[limb]))
        wanted = at[:, limb] + rotation.rotate(since, rest.target_at[joint] - rest.target_at[limb])
        if parent >= 0:
            wanted = rotation.rotate(rotation.conjugate(turned[:, parent]), wanted - at[:, parent])
        translations[:, joint] = wanted
    return translations


def leg_scale(rest: Rest) -> tuple[float, float]:
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


def _all_bones(rest: Rest) -> Array:
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


def _lift(
    rest: Rest, turned: Array, at: Array, source_at: Array | None, scale: float, leg: float, rate: float
) -> tuple[float, list[str]]:
    """Metres by which to raise the target so that standing feet are as high as the source's, and what to say of it.

    The height of a foot is that above its place in the rest pose, stood upright where it lies: files that turn only the
    root to another up axis have such. Where the source's rest pose shows no body
    (`source_at` is None) or stands neither on the floor (ASF skeletons rest about the hips) nor where the clip's feet
    stand, the clip's lower foot is taken to stand, unless the whole clip is far above the floor and its feet do not
    step on one level up there.
    """
    soles, heights = _soles(rest), foot_heights(rest, turned, at)
    height = standing(heights)
    expected = 0.0
    feet = [rest.matches.chains[joint][0] for joint in soles]
    upright = rotation.rotate(rotation.conjugate(body_turn(rest)), rest.source_at)
    rise = None if source_at is None else scale * standing(source_at[:, feet, 1] - upright[feet, 1])
    if rise is not None and (floor_of(upright) == 0 or abs(rise) < LOWEST * leg):
        expected = rise if rise >= -LOWEST * leg else 0.0  # below: a path that starts at the origin, not on the floor
    elif height > LOWEST * leg:
        if _level(heights, leg) and _steps(at[:, soles], rate, leg):
            return -height, [f"its feet step {height:.2f} m above the height 0; they are put on the floor."]
        expected = height
    notes = []
    if expected > LOWEST * leg:
        notes.append(f"its feet never come nearer to the floor than {expected:.2f} m; the height is kept.")
    return expected - height, notes


def _level(heights: Array, leg: float) -> bool:
    """Whether the lower of the feet, at heights [F, P] in metres, is most of the time where it stands."""
    lower = heights.min(axis=1)
    return bool(np.median(lower) - np.quantile(lower, STANDING) < LOW * leg)


def _steps(feet: Array, rate: float, leg: float) -> bool:
    """Whether some foot [F, P, 3] stands at times and moves at others."""
    stands = planted(feet, rate, leg)
    return bool((stands.any(axis=0) & ~stands.all(axis=0)).any())
