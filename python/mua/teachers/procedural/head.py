"""Head and hair: a tube shaped ring by ring, features raised on its front, and a parted bob around it."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.figure import COLUMNS, trunk_ring, trunk_weights
from mua.teachers.procedural.grid import Part, angles, close, rows_by_length, smoothstep, spline
from mua.teachers.procedural.joints import INDEX, NAMES

HAIR_COLUMNS = 40
EYE = np.array([0.031, 1.587])  # x, y
NOSE_TIP, MOUTH = 1.553, 1.526  # y

_FRONT_DENSITY = 0.62  # columns gather at the face and spread evenly again down the neck

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
        [22, 0.041, 0.070, -0.057, 1.497, 1.478, 1.503],
        [23, 0.038, 0.046, -0.055, 1.486, 1.470, 1.494],
        [24, 0.038, 0.032, -0.054, 1.472, 1.452, 1.482],
        [26, 0.043, 0.030, -0.058, 1.447, 1.424, 1.460],
    ]
)
# ring, how much finer the texels below it are: eyes, brows and mouth are looked at most
_FACE_DENSITY = ((2, 1.0), (4, 1.8), (6, 3.0), (11, 3.0), (13, 1.8), (15, 2.4), (18, 2.4), (21, 1.2), (23, 0.8))
_CROWN, _ENDS = 1.712, 1.488  # y of the hair
# fraction of the way from crown to ends, half width, front z, back z, y
_HAIR = np.array(
    [
        [0.00, 0.000, 0.000, 0.000, _CROWN],
        [0.08, 0.028, 0.036, -0.040, 1.708],
        [0.20, 0.056, 0.070, -0.076, 1.692],
        [0.33, 0.074, 0.091, -0.098, 1.662],
        [0.50, 0.083, 0.100, -0.109, 1.615],
        [0.72, 0.089, 0.102, -0.108, 1.562],
        [0.88, 0.093, 0.102, -0.099, 1.516],
        [1.00, 0.088, 0.094, -0.084, _ENDS],
    ]
)
_HAIRLINE = 0.27  # the same fraction, above the forehead
_PARTING = -0.3  # its angle
_STRANDS = 0.022  # metres by which the longest strands hang below the shortest


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
    phi, below_chin = angles(COLUMNS), smoothstep(20, 27, np.arange(len(keys)))[:, None]
    points = close(_features(trunk_ring(keys, phi - _FRONT_DENSITY * (1 - below_chin) * np.sin(phi))))
    points = np.concatenate([points, trunk[:1]])
    density = np.interp(np.arange(len(points) - 1), *np.transpose(_FACE_DENSITY))
    return Part(
        "head",
        points,
        cell=(0.5, 0.34, 1.0, 0.64),
        rows=rows_by_length(points, density),
        looseness=np.zeros(points.shape[:2]),
        weights=trunk_weights(points),
    )


def build_hair() -> Part:
    """A chin-length bob, parted on the right and swept to the left; its last ring turns in toward the head."""
    theta = angles(HAIR_COLUMNS)
    theta = theta - 0.3 * np.sin(theta)  # more columns in front, where lengths differ
    drawn = np.where(theta < 0, smoothstep(-0.45, -1.3, theta), smoothstep(0.36, 1.3, theta))
    hairline = _HAIRLINE + 0.05 * np.clip((theta - _PARTING) / 0.8, -1, 1) ** 2
    length = hairline + (1 - hairline) * drawn
    down = np.linspace(0, 1, 13)[:, None] * length
    width, front, back, height = np.moveaxis(spline(_HAIR, down), -1, 0)
    sine, cosine = np.sin(theta), np.cos(theta)
    close_to_face = 1 - 0.07 * smoothstep(0.7, 1.0, down / length) * (1 - drawn)
    depth = np.where(cosine > 0, front, -back) * cosine
    height = height - 0.018 * cosine * down**2  # longer toward the chin
    height = height - _STRANDS * (0.5 + 0.25 * np.sin(17 * theta + 1) + 0.25 * np.sin(11 * theta)) * down**6
    outer = np.stack([width * sine * close_to_face, height, depth * close_to_face], axis=-1)
    inward = outer[-1] * np.array([0.72, 1, 0.72]) + np.array([0, 0.012, 0])
    points = close(np.concatenate([outer, inward[None]]))
    weights = np.zeros((*points.shape[:2], len(NAMES)))
    weights[..., INDEX["Head"]] = 1
    loose = 0.5 * smoothstep(1.6, _ENDS, points[..., 1])
    return Part("hair", points, (0.68, 0.64, 1.0, 0.88), rows_by_length(points), loose, weights)
