"""The skirt: half a circle of cloth hung from the waist, falling in folds."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.figure import COLUMNS
from mua.teachers.procedural.grid import Part, angles, close, rows_by_length, smoothstep
from mua.teachers.procedural.joints import INDEX, NAMES

SKIRT_COLUMNS = 72
RINGS = 16
FOLDS = 9
HEM = 0.39  # y, metres
_HEM_RADIUS = np.array([0.40, 0.38])  # x, z
_FOLD_DEPTH = 0.042
_WAVE = 0.008  # metres that the hem rises where a fold stands out


def _weights(points: Array) -> Array:
    """Hips, with a growing share for the thigh of each side so that a step does not pierce the cloth."""
    x, y, z = np.moveaxis(points, -1, 0)
    thigh = 0.45 * smoothstep(0.95, 0.55, y)
    left = smoothstep(-0.8, 0.8, x / np.maximum(np.hypot(x, z), 1e-6))
    waist = 0.5 * smoothstep(0.98, 1.08, y)
    weights = np.zeros((*points.shape[:-1], len(NAMES)))
    weights[..., INDEX["LeftUpLeg"]] = thigh * left
    weights[..., INDEX["RightUpLeg"]] = thigh * (1 - left)
    weights[..., INDEX["Spine"]] = waist
    weights[..., INDEX["Hips"]] = 1 - thigh - waist
    return weights


def build_skirt(trunk: Array, phases: Array) -> Part:
    """From the last ring of the trunk's points to the hem; `phases` [2] make the folds irregular."""
    theta = angles(SKIRT_COLUMNS)
    shared = np.round(np.arange(SKIRT_COLUMNS + 1) * COLUMNS / SKIRT_COLUMNS).astype(int)
    waist = trunk[-1][shared]
    down = np.linspace(0, 1, RINGS)[:, None]
    fold = np.cos(FOLDS * theta + 0.5 * np.sin(2 * theta + phases[0]) + 0.4 * np.sin(3 * theta + phases[1]))
    swell = down**0.9 + _FOLD_DEPTH / _HEM_RADIUS[0] * smoothstep(0.05, 1.0, down) * fold
    round_waist = np.stack(
        [0.112 * np.sin(theta), np.full_like(theta, trunk[-1, 0, 1]), 0.082 * np.cos(theta)], axis=-1
    )
    reach = np.stack([_HEM_RADIUS[0] * np.sin(theta), np.zeros_like(theta), _HEM_RADIUS[1] * np.cos(theta)], axis=-1)
    points = round_waist + swell[..., None] * (reach - round_waist * [1, 0, 1])
    points[..., 1] = trunk[-1, 0, 1] + (HEM - trunk[-1, 0, 1]) * down + _WAVE * down**2 * fold
    points[0] = waist
    turned_in = points[-1] * [0.97, 1, 0.97] + [0, 0.015, 0]
    points = close(np.concatenate([points, turned_in[None]]))
    loose = 0.15 + 0.85 * smoothstep(1.03, HEM + 0.1, points[..., 1])
    return Part("skirt", points, (0, 0, 192, 58), rows_by_length(points), loose, _weights(points))
