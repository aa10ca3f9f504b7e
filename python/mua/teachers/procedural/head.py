"""Head down to the neckline: a tube shaped ring by ring, features raised on its front, and a parted bob around it."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.figure import COLUMNS, trunk_ring, trunk_weights
from mua.teachers.procedural.grid import Part, angles, bump, close, rows_by_length, smoothstep, spline
from mua.teachers.procedural.joints import INDEX, NAMES

HAIR_COLUMNS = 40
EYE = np.array([0.031, 1.584])  # x, y
NOSE_TIP, MOUTH = 1.553, 1.526  # y

# ring, half width, front z, back z, y at the sides, at the front, at the back
_HEAD = np.array(
    [
        [-2, 0.0, 0.0, 0.0, 1.692, 1.692, 1.692],
        [0, 0.050, 0.062, -0.076, 1.664, 1.681, 1.632],
        [1, 0.060, 0.077, -0.089, 1.651, 1.668, 1.621],
        [3, 0.069, 0.088, -0.094, 1.632, 1.642, 1.605],
        [6, 0.072, 0.091, -0.094, 1.605, 1.610, 1.585],
        [9, 0.071, 0.088, -0.090, 1.582, 1.583, 1.567],
        [12, 0.069, 0.087, -0.083, 1.562, 1.558, 1.552],
        [15, 0.065, 0.088, -0.075, 1.545, 1.535, 1.540],
        [17, 0.061, 0.087, -0.069, 1.533, 1.519, 1.531],
        [19, 0.054, 0.086, -0.064, 1.520, 1.502, 1.521],
        [20, 0.049, 0.082, -0.062, 1.512, 1.492, 1.515],
        [21, 0.044, 0.070, -0.060, 1.505, 1.484, 1.510],
        [22, 0.040, 0.054, -0.057, 1.497, 1.477, 1.503],
        [23, 0.038, 0.041, -0.055, 1.486, 1.468, 1.494],
        [24, 0.038, 0.032, -0.054, 1.472, 1.452, 1.482],
        [26, 0.043, 0.030, -0.058, 1.447, 1.424, 1.460],
        [27, 0.054, 0.036, -0.064, 1.430, 1.405, 1.445],
        [28, 0.080, 0.050, -0.076, 1.423, 1.390, 1.436],
        [29, 0.104, 0.062, -0.087, 1.418, 1.372, 1.424],
    ]
)
_RINGS = np.r_[-2, 0, 1.5, 3, 4.5, np.linspace(6, 20, 20), 21, 22, 23, 24.5, 26, 27, 28, 29]  # closest on the face
# ring, how much finer the texels below it are: eyes, brows and mouth are looked at most
_FACE_DENSITY = np.array(
    [
        [0, 0.5],
        [2, 0.8],
        [5, 2.0],
        [6, 4.5],
        [10.5, 4.5],
        [12, 2.8],
        [15, 3.2],
        [16, 4.5],
        [18, 4.0],
        [20, 2.2],
        [22, 0.9],
    ]
)
_FRONT = np.array([[-np.pi, -np.pi], [-1.9, -0.62], [0, 0], [1.9, 0.62], [np.pi, np.pi]])  # columns gather at the face
_CROWN, _ENDS = 1.712, 1.485  # y of the hair
# fraction of the way from crown to ends, half width, front z, back z, y
_HAIR = np.array(
    [
        [0.00, 0.000, 0.000, 0.000, _CROWN],
        [0.08, 0.028, 0.036, -0.040, 1.708],
        [0.20, 0.056, 0.070, -0.076, 1.692],
        [0.33, 0.074, 0.093, -0.098, 1.662],
        [0.50, 0.083, 0.100, -0.109, 1.615],
        [0.72, 0.089, 0.102, -0.110, 1.562],
        [0.86, 0.091, 0.101, -0.106, 1.520],
        [0.95, 0.088, 0.098, -0.100, 1.497],
        [1.00, 0.083, 0.092, -0.093, _ENDS],
    ]
)
_HAIRLINE = 0.3  # the same fraction, above the forehead
_PARTING = -0.3  # its angle
_FACE_EDGES = 0.95, 2 * np.pi - 1.0  # angles to which the hair falls beside the face: left, and round to the right


def _features(points: Array) -> Array:
    """Raise nose, lips, chin and cheeks and hollow the eyes on the front of the head."""
    x, y, z = np.moveaxis(points, -1, 0)
    side = np.abs(x)
    bridge = np.clip((1.604 - y) / (1.604 - NOSE_TIP), 0, 1) * smoothstep(1.538, 1.551, y)
    depth = 0.014 * bridge * np.exp(-((x / 0.009) ** 2))
    depth += 0.006 * bump(x, y - NOSE_TIP, 0.009, 0.008) + 0.005 * bump(side - 0.011, y - 1.549, 0.006, 0.007)
    depth += 0.004 * bump(x, y - MOUTH - 0.003, 0.016, 0.004) + 0.005 * bump(x, y - MOUTH + 0.005, 0.014, 0.005)
    depth += 0.004 * bump(x, y - 1.497, 0.014, 0.009) + 0.003 * bump(side - 0.042, y - 1.556, 0.014, 0.014)
    depth -= 0.006 * bump(side - EYE[0] + 0.004, y - EYE[1] - 0.001, 0.016, 0.010)
    return np.stack([x, y, z + depth * (z > 0.03)], axis=-1)


def build_head(trunk: Array) -> Part:
    """From inside the hair down to the neckline, welded to the first ring of the trunk's points."""
    phi, below_chin = angles(COLUMNS), smoothstep(20, 27, _RINGS)[:, None]
    theta = below_chin * phi + (1 - below_chin) * spline(_FRONT, phi)[:, 0]
    points = close(_features(trunk_ring(spline(_HEAD, _RINGS), theta)))
    points = np.concatenate([points, trunk[:1]])
    density = np.interp(_RINGS, *_FACE_DENSITY.T)
    return Part(
        "head",
        points,
        cell=(0, 58, 88, 138),
        rows=rows_by_length(points, density),
        looseness=np.zeros(points.shape[:2]),
        weights=trunk_weights(points),
    )


def _strands() -> Array:
    """Points [R, C + 1, 3] from a parting on the right to the ends; from above, strands are straight."""
    around = np.linspace(0, 1, HAIR_COLUMNS + 1)
    forward = _HAIRLINE * np.clip(np.abs(2 * around - 1) / 0.6 - 2 / 3, 0, 1)  # at the back all fall from the crown
    root = forward * np.array([[np.sin(_PARTING)], [np.cos(_PARTING)]])
    end = _FACE_EDGES[0] + (_FACE_EDGES[1] - _FACE_EDGES[0]) * around
    down = np.linspace(0, 1, 12)[:, None]
    across, ahead = ((1 - down) * a + down * b for a, b in zip(root, (np.sin(end), np.cos(end)), strict=True))
    fraction = np.hypot(across, ahead)
    width, front, back, height = np.moveaxis(spline(_HAIR, np.minimum(fraction, 1)), -1, 0)
    sine, cosine = across / np.maximum(fraction, 1e-9), ahead / np.maximum(fraction, 1e-9)
    height = height - 0.01 * cosine * fraction**2  # longer toward the chin
    return np.stack([width * sine, height, np.where(cosine > 0, front, -back) * cosine], axis=-1)


def build_hair() -> Part:
    """A chin-length bob; a column more on either side of the face turns in toward the head."""
    points = _strands()
    tucked = points[:, [0, -1]] * [0.9, 1, 0.9]
    points = np.concatenate([tucked[:, :1], points, tucked[:, 1:]], axis=1)
    weights = np.zeros((*points.shape[:2], len(NAMES)))
    weights[..., INDEX["Head"]] = 1
    loose = 0.4 * smoothstep(1.6, _ENDS, points[..., 1])
    rows = rows_by_length(points, np.where(np.arange(len(points) - 1) == 0, 1.8, 1.0))  # no gap along the parting
    return Part("hair", points, (88, 58, 192, 98), rows, loose, weights)
