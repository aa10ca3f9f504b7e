"""Head and hair: a tube shaped ring by ring, features raised on its front, and a parted bob around it."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.figure import COLUMNS, trunk_ring, trunk_weights
from mua.teachers.procedural.grid import Part, angles, close, rows_by_length, smoothstep, spline
from mua.teachers.procedural.joints import INDEX, NAMES

HAIR_COLUMNS = 40
EYE = np.array([0.031, 1.587])  # x, y
NOSE_TIP, MOUTH = 1.553, 1.526  # y

_FRONT_DENSITY = 0.35  # columns gather at the face

# ring, half width, front z, back z, y at the sides, at the front, at the back
_HEAD = np.array(
    [
        [0, 0.054, 0.068, -0.080, 1.672, 1.690, 1.640],
        [1, 0.061, 0.078, -0.090, 1.655, 1.672, 1.625],
        [3, 0.069, 0.088, -0.094, 1.632, 1.642, 1.605],
        [6, 0.072, 0.091, -0.094, 1.605, 1.610, 1.585],
        [9, 0.071, 0.088, -0.090, 1.582, 1.583, 1.567],
        [12, 0.069, 0.089, -0.083, 1.562, 1.558, 1.552],
        [15, 0.065, 0.090, -0.075, 1.545, 1.535, 1.540],
        [17, 0.061, 0.089, -0.069, 1.533, 1.519, 1.531],
        [19, 0.055, 0.088, -0.064, 1.520, 1.502, 1.521],
        [21, 0.047, 0.084, -0.061, 1.506, 1.486, 1.510],
        [22, 0.042, 0.070, -0.059, 1.497, 1.478, 1.503],
        [23, 0.041, 0.048, -0.058, 1.486, 1.470, 1.494],
        [24, 0.042, 0.035, -0.058, 1.472, 1.452, 1.482],
        [26, 0.048, 0.033, -0.061, 1.445, 1.424, 1.460],
    ]
)
_CROWN, _ENDS = 1.712, 1.490  # y of the hair
_PART = -0.45  # angle of the parting
# fraction of the way from crown to ends, half width, front z, back z, y
_HAIR = np.array(
    [
        [0.00, 0.000, 0.000, 0.000, _CROWN],
        [0.10, 0.030, 0.040, -0.044, 1.707],
        [0.25, 0.062, 0.078, -0.082, 1.686],
        [0.40, 0.080, 0.096, -0.102, 1.650],
        [0.55, 0.087, 0.104, -0.110, 1.606],
        [0.75, 0.091, 0.106, -0.107, 1.560],
        [0.90, 0.092, 0.104, -0.098, 1.515],
        [1.00, 0.086, 0.096, -0.086, _ENDS],
    ]
)


def _features(points: Array) -> Array:
    """Raise nose, lips and cheeks and hollow the eyes on the front of the head."""
    x, y, z = np.moveaxis(points, -1, 0)
    bridge = smoothstep(1.602, NOSE_TIP, y) * smoothstep(1.540, 1.549, y)
    width = 0.0065 + 0.0035 * smoothstep(1.575, NOSE_TIP, y)
    depth = 0.021 * bridge * np.exp(-((x / width) ** 2))
    depth += 0.004 * np.exp(-((x / 0.016) ** 2) - ((y - MOUTH) / 0.008) ** 2)
    for side in (-1, 1):
        depth -= 0.006 * np.exp(-(((side * x - EYE[0]) / 0.013) ** 2) - ((y - EYE[1]) / 0.010) ** 2)
        depth += 0.003 * np.exp(-(((side * x - 0.042) / 0.014) ** 2) - ((y - 1.556) / 0.014) ** 2)
    return np.stack([x, y, z + depth * (z > 0.03)], axis=-1)


def build_head(trunk: Array) -> Part:
    """From inside the hair down to the base of the neck, welded to the first ring of the trunk's points."""
    keys = spline(_HEAD, np.arange(_HEAD[-1, 0] + 1))
    phi = angles(COLUMNS)
    points = close(_features(trunk_ring(keys, phi - _FRONT_DENSITY * np.sin(phi))))
    points = np.concatenate([points, trunk[:1]])
    loose = np.zeros(points.shape[:2])
    return Part("head", points, (0.5, 0.34, 1.0, 0.64), rows_by_length(points), loose, trunk_weights(points))


def build_hair() -> Part:
    """A chin-length bob, parted over the left eye; its last rings turn in toward the neck."""
    theta = angles(HAIR_COLUMNS)
    gap = np.abs((theta - _PART + np.pi) % (2 * np.pi) - np.pi)
    length = 0.36 + 0.64 * smoothstep(0.25, 1.25, gap)
    down = np.linspace(0, 1, 14)[:, None] * length
    width, front, back, height = np.moveaxis(spline(_HAIR, down), -1, 0)
    sine, cosine = np.sin(theta), np.cos(theta)
    outer = np.stack([width * sine, height, np.where(cosine > 0, front, -back) * cosine], axis=-1)
    inward = np.array([0.55, 1, 0.55]) * outer[-1] + np.array([0, 0.012, 0])
    points = close(np.concatenate([outer, inward[None]]))
    weights = np.zeros((*points.shape[:2], len(NAMES)))
    weights[..., INDEX["Head"]] = 1
    loose = 0.5 * smoothstep(1.6, _ENDS, points[..., 1])
    return Part("hair", points, (0.68, 0.64, 1.0, 1.0), rows_by_length(points), loose, weights)
