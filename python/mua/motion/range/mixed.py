"""Random poses that a person could take: every limb on its own, left and right apart, at any speed."""

import numpy as np

from mua.arrays import Array
from mua.motion.range.angles import INDEX, LIMITS, NAMES
from mua.motion.range.body import BODY, JOINT, rotations
from mua.motion.range.played import clip_of
from mua.pose.clip import Clip
from mua.pose.joint_names import SIDES

POSES = 24  # of a clip
QUICKEST, SLOWEST = 0.1, 0.6  # seconds in which a pose is reached
FASTEST = 500.0  # degrees a second of an angle between two poses; a joint of several angles turns twice as fast
TRIES = 24  # of each pose, of which the one is taken whose limbs are the least within the body
UPRIGHT = 0.75  # of the poses; the others lean, lie or stand on their heads
LEANS = {True: 18.0, False: 100.0}  # degrees, by whether it is upright
# Limbs as lines between two joints, and how thick they are in metres
_SOLID = (("hips", "spine 3", 0.13), ("spine 3", "neck", 0.12), ("neck", "head", 0.1), ("head", "head", 0.11))
_ARM = (("forearm", "hand", 0.04), ("hand", "middle 3", 0.03))
_LEG = (("shin", "foot", 0.05), ("foot", "toe", 0.04))
_THIGH = ("thigh", "shin", 0.08)


def mixed(name: str, rng: np.random.Generator) -> Clip:
    """A clip of random poses, each of which is as likely anywhere within the limits of its angles."""
    poses = random_poses(rng)
    seconds = np.exp(rng.uniform(np.log(QUICKEST), np.log(SLOWEST), POSES))
    seconds[1:] = np.maximum(seconds[1:], abs(np.diff(poses, axis=0)).max(axis=1) / FASTEST)
    return clip_of(name, seconds, poses)


def random_poses(rng: np.random.Generator, tries: int = TRIES) -> Array:
    """Angles [P, A] of poses that keep their limbs out of the body as well as the best of `tries` does."""
    tried = _anything(rng, POSES * tries)
    depth = within(tried).reshape(POSES, tries)
    return tried.reshape(POSES, tries, -1)[np.arange(POSES), np.argmin(depth, axis=1)]


def _anything(rng: np.random.Generator, count: int) -> Array:
    """Angles [N, A]: those of limbs evenly within their limits, those of the trunk mostly near the middle."""
    angles = np.zeros((count, len(NAMES)))
    for name, (low, high) in LIMITS.items():
        limb = " " in name
        spread = rng.uniform(0, 1, count) if limb else rng.beta(2, 2, count)
        angles[:, INDEX[name]] = low + (high - low) * spread
    upright = rng.uniform(size=count) < UPRIGHT
    most = np.where(upright, LEANS[True], LEANS[False])
    for name in ("lean", "tilt"):
        angles[:, INDEX[name]] = rng.uniform(-1, 1, count) * most
    angles[:, INDEX["turn"]] = rng.uniform(-60, 60, count)
    return angles


def within(angles: Array) -> Array:
    """How deep limbs are within trunk, head and each other [N], in metres, summed over the limbs of poses [N, A]."""
    _, at = BODY.world(rotations(angles), BODY.with_root(np.zeros((len(angles), 3))))
    depth = np.zeros(len(angles))
    for side, other in (SIDES, SIDES[::-1]):
        thighs = [(f"{one} {_THIGH[0]}", f"{one} {_THIGH[1]}", _THIGH[2]) for one in SIDES]
        for limbs, solids in ((_ARM, (*_SOLID, *thighs)), (_LEG, (*_SOLID, thighs[SIDES.index(other)]))):
            solids = (*solids, *((f"{other} {a}", f"{other} {b}", thick) for a, b, thick in limbs))
            for begin, end, thin in limbs:
                points = _along(at, f"{side} {begin}", f"{side} {end}")
                for above, below, thick in solids:
                    apart = _distance(points, at[:, JOINT[above]], at[:, JOINT[below]])
                    depth += np.maximum(thick + thin - apart, 0).max(axis=1)
    return depth


def _along(at: Array, begin: str, end: str) -> Array:
    """Points [N, 3, 3] on a bone: in its middle, near its end and at it."""
    share = np.array([0.5, 0.8, 1.0])[:, None]
    return at[:, None, JOINT[begin]] * (1 - share) + at[:, None, JOINT[end]] * share


def _distance(points: Array, begin: Array, end: Array) -> Array:
    """Distances [N, P] from points [N, P, 3] to lines that begin and end at [N, 3]."""
    axis = (end - begin)[:, None]
    from_begin = points - begin[:, None]
    share = np.sum(from_begin * axis, axis=-1) / np.maximum(np.sum(axis * axis, axis=-1), 1e-12)
    return np.linalg.norm(from_begin - np.clip(share, 0, 1)[..., None] * axis, axis=-1)
