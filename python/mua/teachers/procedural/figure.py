"""Trunk, arms and legs of the figure: tubes lofted through tables of rings (metres, A-pose)."""

import re

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.grid import Cell, Part, angles, bump, close, mirrored, rows_by_length, smoothstep, spline
from mua.teachers.procedural.joints import ARM_DIRECTION, FOREARM, INDEX, NAMES, PLACES, UPPER_ARM, chain_weights

COLUMNS = 48  # of trunk and head
ARM_COLUMNS = 20  # the perimeter of an armhole in quads
LEG_COLUMNS = 18
_FINGER_COLUMNS = 6
SLEEVE_END = 0.365  # metres along the arm

_TRIM_EDGE = 0.45  # ring of the trunk where the neckline's trim ends
_ARMHOLE_ROWS = slice(2, 6)
_LEFT_ARMHOLE = slice(33, 39)  # columns of quads
_RIGHT_ARMHOLE = slice(9, 15)

# ring, half width, front z, back z, y at the sides, at the front, at the back
_TRUNK = np.array(
    [
        [0, 0.130, 0.071, -0.095, 1.413, 1.354, 1.412],
        [1, 0.153, 0.078, -0.101, 1.405, 1.337, 1.397],
        [3, 0.150, 0.091, -0.107, 1.345, 1.303, 1.348],
        [5, 0.147, 0.103, -0.107, 1.290, 1.268, 1.297],
        [7, 0.140, 0.110, -0.100, 1.240, 1.232, 1.245],
        [9, 0.128, 0.097, -0.091, 1.190, 1.186, 1.192],
        [11, 0.117, 0.087, -0.084, 1.142, 1.140, 1.143],
        [13, 0.109, 0.081, -0.079, 1.098, 1.098, 1.098],
        [15, 0.107, 0.079, -0.078, 1.062, 1.062, 1.062],
        [17, 0.112, 0.083, -0.081, 1.030, 1.030, 1.030],
    ]
)

# metres along the arm, half thickness across it in the plane of the arms, half depth
_ARM = np.array(
    [
        [0.040, 0.048, 0.050],
        [0.070, 0.045, 0.047],
        [0.120, 0.041, 0.043],
        [0.200, 0.037, 0.038],
        [0.265, 0.0345, 0.036],
        [0.300, 0.036, 0.038],
        [0.365, 0.046, 0.048],
    ]
)
_HAND = np.array(
    [
        [0.350, 0.030, 0.031],
        [0.380, 0.030, 0.031],
        [0.430, 0.026, 0.028],
        [0.470, 0.020, 0.024],
        [0.500, 0.0165, 0.023],
        [0.530, 0.0165, 0.031],
        [0.560, 0.0155, 0.037],
        [0.590, 0.0125, 0.037],
        [0.604, 0.010, 0.034],
        [0.610, 0.0, 0.0],
    ]
)
# name, metres along the arm and ahead of its axis of the root, length, radius (metres), direction: along, palm, ahead
_FINGERS = (
    ("thumb", 0.522, 0.018, 0.063, 0.0125, (0.77, 0.15, 0.55)),
    ("index finger", 0.592, 0.0275, 0.074, 0.0092, (1.0, 0.0, 0.07)),
    ("middle finger", 0.594, 0.0092, 0.082, 0.0094, (1.0, 0.0, 0.01)),
    ("ring finger", 0.592, -0.0092, 0.076, 0.0090, (1.0, 0.02, -0.05)),
    ("little finger", 0.586, -0.0265, 0.062, 0.0082, (1.0, 0.05, -0.12)),
)
# share of a finger's length, and of its radius
_FINGER_RINGS = np.array([[0, 1.05], [0.45, 1.0], [0.75, 0.9], [0.9, 0.74], [0.97, 0.45], [1, 0]])
_CURL = 2.2  # per metre: how the fingers bend toward the palm
_SLEEVE_RINGS = np.array([0.045, 0.07, 0.1, 0.135, 0.17, 0.205, 0.24, 0.265, 0.29, 0.325, 0.36, 0.365])
SLEEVE_EDGE = len(_SLEEVE_RINGS)  # the ring of the arm where cloth ends
_HAND_RINGS = np.array([0.35, 0.38, 0.42, 0.46, 0.49, 0.515, 0.54, 0.565, 0.585, 0.598, 0.606, 0.61])

# ring, centre x, y, z, tilt (degrees, 90: the ring stands and faces forward), half width, reach to front and back
_LEG = np.array(
    [
        [0, 0.086, 0.880, 0.000, 0, 0.082, 0.085, 0.090],
        [2, 0.084, 0.740, 0.004, 0, 0.072, 0.076, 0.076],
        [4, 0.081, 0.580, 0.006, 0, 0.058, 0.060, 0.056],
        [5, 0.080, 0.520, 0.006, 0, 0.052, 0.054, 0.048],
        [6, 0.079, 0.475, 0.006, 0, 0.046, 0.048, 0.043],
        [7, 0.078, 0.430, 0.002, 0, 0.044, 0.044, 0.047],
        [9, 0.077, 0.335, -0.006, 0, 0.046, 0.038, 0.057],
        [11, 0.075, 0.215, -0.012, 0, 0.034, 0.031, 0.041],
        [12, 0.074, 0.150, -0.015, 0, 0.0265, 0.027, 0.031],
        [13, 0.074, 0.105, -0.018, 4, 0.0265, 0.030, 0.034],
        [14, 0.074, 0.080, -0.014, 22, 0.032, 0.042, 0.048],
        [15, 0.075, 0.060, -0.004, 48, 0.034, 0.048, 0.070],
        [16, 0.077, 0.042, 0.026, 74, 0.034, 0.038, 0.060],
        [17, 0.080, 0.032, 0.060, 86, 0.036, 0.030, 0.045],
        [18, 0.083, 0.024, 0.098, 90, 0.041, 0.024, 0.034],
        [19, 0.085, 0.020, 0.130, 90, 0.038, 0.018, 0.030],
        [20, 0.086, 0.017, 0.155, 90, 0.026, 0.014, 0.022],
        [21, 0.087, 0.015, 0.166, 90, 0.012, 0.008, 0.012],
        [22, 0.087, 0.014, 0.170, 90, 0.0, 0.0, 0.0],
    ]
)

_SPINE_LINKS = (("Hips", 0.0, 0.0), ("Spine", 1.03, 0.05), ("Spine1", 1.13, 0.05), ("Spine2", 1.23, 0.05))
_NECK_LINKS = (*_SPINE_LINKS, ("Neck", 1.43, 0.03), ("Head", 1.485, 0.025))


def trunk_weights(points: Array) -> Array:
    """Weights [..., J] along spine, neck and head by height, the back of the neck rising with the jaw line."""
    return chain_weights(points[..., 1] + 0.3 * np.minimum(points[..., 2], 0.05) * (points[..., 1] > 1.4), _NECK_LINKS)


def trunk_ring(keys: Array, theta: Array) -> Array:
    """Points [R, C + 1, 3] of rings given as (half width, front z, back z, y at sides, front, back)."""
    width, front, back, side, ahead, behind = (keys[:, i, None] for i in range(6))
    sine, cosine = np.sin(theta), np.cos(theta)
    middle = (front + back) / 2 * 0.4
    squareness = 0.9  # a little fuller than an ellipse
    across = width * np.sign(sine) * np.abs(sine) ** squareness
    depth = np.where(cosine > 0, front - middle, middle - back) * np.sign(cosine) * np.abs(cosine) ** squareness
    height = side + np.where(cosine > 0, ahead - side, behind - side) * cosine**2
    return np.stack([across, height, middle + depth], axis=-1)


def _bust(points: Array) -> Array:
    x, y, z = np.moveaxis(points, -1, 0)
    depth = 0.020 * sum(bump(x - side, y - 1.243, 0.042, 0.042) for side in (-0.066, 0.066))
    return np.stack([x, y, z + depth * (z > 0)], axis=-1)


def build_trunk() -> Part:
    """From the neckline to the waist, with a rectangular hole for each arm."""
    keys = spline(_TRUNK, np.r_[0, _TRIM_EDGE, np.arange(1, _TRUNK[-1, 0] + 1)])
    points = close(_bust(trunk_ring(keys, angles(COLUMNS))))
    hole = np.zeros((len(points) - 1, COLUMNS), dtype=bool)
    hole[_ARMHOLE_ROWS, _LEFT_ARMHOLE] = hole[_ARMHOLE_ROWS, _RIGHT_ARMHOLE] = True
    return Part(
        "trunk",
        points,
        cell=(0, 138, 88, 192),
        rows=rows_by_length(points, np.where(np.arange(len(points) - 1) < 2, 2.0, 1.0)),
        looseness=np.broadcast_to(0.15 * smoothstep(0, 3, np.arange(len(points)))[:, None], points.shape[:2]),
        weights=trunk_weights(points),
        hole=hole,
    )


def _armhole(trunk: Array) -> Array:
    """The perimeter [C + 1, 3] of the left armhole, from the middle of its back edge under the arm to the front."""
    top, bottom = _ARMHOLE_ROWS.start, _ARMHOLE_ROWS.stop
    front, back = _LEFT_ARMHOLE.start, _LEFT_ARMHOLE.stop
    middle = (top + bottom) // 2
    path = [(row, back) for row in range(middle, bottom)]
    path += [(bottom, column) for column in range(back, front, -1)]
    path += [(row, front) for row in range(bottom, top, -1)]
    path += [(top, column) for column in range(front, back)]
    path += [(row, back) for row in range(top, middle + 1)]
    return np.stack([trunk[place] for place in path])


def _arm_ring(along: Array, keys: Array) -> Array:
    """Rings [R, C + 1, 3] at `along` [R] or [R, C + 1] metres from the shoulder; keys [R, 2]: half sizes."""
    theta = angles(ARM_COLUMNS)
    across = np.array([-ARM_DIRECTION[1], ARM_DIRECTION[0], 0.0])
    outward = (keys[:, :1] * np.sin(theta))[..., None] * across
    ahead = (keys[:, 1:] * np.cos(theta))[..., None] * np.array([0.0, 0, 1])
    center = PLACES["LeftArm"] + np.broadcast_to(along, outward.shape[:2])[..., None] * ARM_DIRECTION
    return np.asarray(center + outward + ahead)


def _arm_points(trunk: Array) -> Array:
    """The left arm [R, C + 1, 3]: armhole, sleeve, the sleeve's edge folded inward, forearm and hand."""
    theta = angles(ARM_COLUMNS)
    lean = 0.045 * smoothstep(0.16, 0.03, _SLEEVE_RINGS)[:, None]  # first rings lean like the armhole
    sleeve = _arm_ring(_SLEEVE_RINGS[:, None] - lean * np.sin(theta), spline(_ARM, _SLEEVE_RINGS))
    rounded = smoothstep(0.16, 0.03, _SLEEVE_RINGS)[:, None] * np.where(theta > 0, 0.009, 0.012) * np.sin(theta)
    sleeve += rounded[..., None] * np.abs([ARM_DIRECTION[1], ARM_DIRECTION[0], 0.0])
    hand = _arm_ring(_HAND_RINGS[:, None], spline(_HAND, _HAND_RINGS))
    points = np.concatenate([_armhole(trunk)[None], sleeve, hand])
    return close(points)


def along_arm(points: Array) -> Array:
    """Metres [...] along the straight arm of either side."""
    mirrored_x = np.stack([np.abs(points[..., 0]), points[..., 1], points[..., 2]], axis=-1)
    return np.asarray((mirrored_x - PLACES["LeftArm"]) @ ARM_DIRECTION)


def arm_weights(along: Array) -> Array:
    """Weights [..., J] of the left arm's chain at `along` metres from the shoulder."""
    links = (("LeftArm", 0.0, 0.0), ("LeftForeArm", UPPER_ARM, 0.045), ("LeftHand", UPPER_ARM + FOREARM, 0.03))
    return chain_weights(along, links)


def build_arm(trunk: Array) -> Part:
    """The left arm in its sleeve, welded to the armhole of the trunk's points."""
    points = _arm_points(trunk)
    along = along_arm(points)
    loose = np.zeros(points.shape[:2])
    loose[: len(_SLEEVE_RINGS) + 1] = (0.15 + 0.3 * smoothstep(0.25, SLEEVE_END, np.r_[0, _SLEEVE_RINGS]))[:, None]
    return Part("left arm", points, (128, 98, 160, 168), rows_by_length(points), loose, arm_weights(along))


def build_fingers() -> tuple[Part, ...]:
    """The fingers of the left hand, thumb first: tubes rooted in the palm and bent toward it."""
    palm = np.array([ARM_DIRECTION[1], -ARM_DIRECTION[0], 0.0])
    parts = []
    for place, (name, along, depth, length, radius, pointing) in enumerate(_FINGERS):
        root = PLACES["LeftArm"] + along * ARM_DIRECTION + np.array([0, 0, depth])
        ahead = pointing[0] * ARM_DIRECTION + pointing[1] * palm + np.array([0, 0, pointing[2]])
        points = _finger(root, ahead / np.linalg.norm(ahead), palm, length=length, radius=radius)
        weights = chain_weights(np.zeros(points.shape[:2]), (("LeftHand", 0.0, 0.0),))
        cell = (128 + 12 * place, 168, 140 + 12 * place, 180)
        rows = rows_by_length(points, np.array([0.8, 1, 1.5, 2, 2.5]))  # finest at the tip
        parts.append(Part(f"left {name}", points, cell, rows, np.zeros(points.shape[:2]), weights))
    return tuple(parts)


def _finger(root: Array, ahead: Array, palm: Array, *, length: float, radius: float) -> Array:
    """A tube [R, C + 1, 3] from `root` with a round tip, bent toward `palm`."""
    across = np.cross(ahead, [0.0, 0, 1])
    across /= np.linalg.norm(across)
    theta = angles(_FINGER_COLUMNS)
    ring = np.sin(theta)[:, None] * -across + np.cos(theta)[:, None] * np.cross(across, ahead)
    reach, wide = length * _FINGER_RINGS[:, 0], radius * _FINGER_RINGS[:, 1]
    middle = root + reach[:, None] * ahead + (_CURL * reach**2)[:, None] * palm
    return close(middle[:, None] + wide[:, None, None] * ring)


def build_leg() -> Part:
    """The left leg and its shoe, open at the top under the skirt."""
    keys = spline(_LEG, np.r_[0, 2.5, np.arange(5, _LEG[-1, 0] + 1)])
    x, y, z, tilt, width, front, back = (keys[:, i, None] for i in range(7))
    theta, tilt = angles(LEG_COLUMNS), np.radians(tilt)
    reach = np.where(np.cos(theta) > 0, front, back) * np.cos(theta)
    points = np.stack(
        np.broadcast_arrays(x + width * np.sin(theta), y + reach * np.sin(tilt), z + reach * np.cos(tilt)), axis=-1
    )
    points = close(points.copy())
    points[..., 1] = np.maximum(points[..., 1], 0)
    hidden = np.where(np.arange(len(points) - 1) < 2, 0.4, 1.0)
    rows = rows_by_length(points, hidden)
    links = (("LeftUpLeg", 0.0, 0.0), ("LeftLeg", -0.485, 0.05), ("LeftFoot", -0.09, 0.03))
    weights = chain_weights(-points[..., 1], links)
    foot = smoothstep(0.085, 0.125, points[..., 2]) * (points[..., 1] < 0.1)
    weights = weights * (1 - foot)[..., None] + chain_weights(foot, (("LeftToeBase", 0.0, 0.0),)) * foot[..., None]
    return Part("left leg", points, (88, 98, 108, 192), rows, np.zeros(points.shape[:2]), weights)


def other_side(part: Part, *, cell: Cell) -> Part:
    """The right twin of a left part; its joints are those of the right side."""
    swap = {"Left": "Right", "Right": "Left"}
    partner = [INDEX[re.sub("^(Left|Right)", lambda side: swap[side[0]], name)] for name in NAMES]
    return Part(
        part.name.replace("left", "right"),
        mirrored(part.points),
        cell,
        part.rows,
        part.looseness[:, ::-1],
        part.weights[:, ::-1][..., partner],
    )
