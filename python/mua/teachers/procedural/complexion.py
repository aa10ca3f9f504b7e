"""Skin, face, hair and shoes."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.brush import Surface, color, filled, inside, over
from mua.teachers.procedural.grid import smoothstep
from mua.teachers.procedural.head import EYE, MOUTH, NOSE_TIP

SKIN, BLUSH, LIPS = color("e8bb9d"), color("dd8f78"), color("b9504a")
WHITE, IRIS, LASH, BROW = color("f6f1ea"), color("4d6b52"), color("2a1a15"), color("4a2c20")
HAIR, HAIR_LIGHT = color("3b2018"), color("6b3d27")
SHOE, NAIL = color("c8452f"), color("f3cfc0")


def _ellipse(x: Array, y: Array, wide: float, high: float) -> Array:
    """Signed distance (about) to an ellipse about the origin."""
    return np.asarray((np.hypot(x / wide, y / high) - 1) * min(wide, high))


def _eye(face: Array, x: Array, y: Array) -> Array:
    """One eye, x growing outward from its centre."""
    lifted = y - 0.07 * x  # the outer corner a little higher
    almond = np.abs(lifted) - 0.0072 * np.sqrt(np.clip(1 - (x / 0.0155) ** 2, 0, 1))
    white = inside(np.maximum(almond, np.abs(x) - 0.0155))
    face = over(face, WHITE, white)
    face = over(face, IRIS, inside(np.hypot(x, lifted - 0.0005) - 0.0066) * white)
    face = over(face, LASH, inside(np.hypot(x, lifted - 0.0005) - 0.0033) * white)
    face = over(face, WHITE, inside(np.hypot(x + 0.002, lifted - 0.003) - 0.0012) * white)
    lid = np.abs(lifted - 0.0072 * np.sqrt(np.clip(1 - (x / 0.0165) ** 2, 0, 1))) - 0.0016 - 0.05 * np.maximum(x, 0)
    face = over(face, LASH, inside(np.maximum(lid, np.abs(x - 0.001) - 0.0175)))
    brow = np.abs(y - 0.0205 + 12 * (x - 0.003) ** 2) - 0.0017 + 0.04 * np.maximum(x, 0)
    return over(face, BROW, inside(np.maximum(brow, np.abs(x - 0.001) - 0.0175)) * 0.85)


def paint_head(surface: Surface) -> Array:
    """Neck and face, the features painted from the front."""
    x, y, z = np.moveaxis(surface.points, -1, 0)
    front = z > 0.02
    scalp = smoothstep(0.04, 0.01, z) * smoothstep(1.5, 1.53, y) + smoothstep(1.672, 1.69, y)
    face = over(filled(x, SKIN), HAIR, np.minimum(scalp, 1))
    for side in (-1, 1):
        cheek = np.exp(-(((side * x - 0.043) / 0.016) ** 2) - ((y - 1.552) / 0.013) ** 2)
        face = over(face, BLUSH, 0.45 * cheek * front)
        socket = np.exp(-(((side * x - EYE[0]) / 0.018) ** 2) - ((y - EYE[1] - 0.008) / 0.009) ** 2)
        face = over(face, BLUSH, 0.35 * socket * front)
        face = np.where(front[..., None], _eye(face, side * x - EYE[0], y - EYE[1]), face)
        nostril = _ellipse(side * x - 0.006, y - NOSE_TIP + 0.0095, 0.003, 0.0016)
        face = over(face, BLUSH, inside(nostril) * front)
    smile = y - MOUTH - 8 * x**2
    bow = 0.0062 * (1 - (np.abs(x) / 0.022) ** 1.6) - 0.0012 * np.exp(-((x / 0.003) ** 2))
    lips = np.maximum(smile - np.where(np.abs(x) < 0.022, bow, -1), -smile - 0.0072 * (1 - (x / 0.022) ** 2))
    face = over(face, LIPS, inside(np.maximum(lips, np.abs(x) - 0.022)) * front)
    return over(face, LASH, 0.5 * inside(np.maximum(np.abs(smile) - 0.0005, np.abs(x) - 0.02)) * front)


def paint_hair(surface: Surface) -> Array:
    """Strands of two browns that run from the parting to the ends."""
    strand = 0.5 + 0.25 * np.sin(surface.around * 131 + 2 * np.sin(surface.along * 9))
    strand += 0.25 * np.sin(surface.around * 83 + 1.0)
    return over(filled(surface.around, HAIR), HAIR_LIGHT, 0.6 * strand)


def paint_finger(surface: Surface) -> Array:
    """Skin with a blush at the tip and a pale nail on its back."""
    end = surface.along.max()
    skin = over(filled(surface.around, SKIN), BLUSH, 0.35 * smoothstep(0.55 * end, end, surface.along))
    nail = _ellipse((np.abs(surface.around - 0.5) - 0.25) * 0.05, surface.along - 0.85 * end, 0.005, 0.007)
    return over(skin, NAIL, 0.8 * inside(nail) * (surface.around > 0.5))


def paint_leg(surface: Surface) -> Array:
    """Bare leg in a flat shoe cut low over the instep."""
    _, y, z = np.moveaxis(surface.points, -1, 0)
    opening = np.where(z < 0.09, 0.048 - 0.018 * np.clip((z + 0.05) / 0.14, 0, 1), 1.0)
    return over(filled(y, SKIN), SHOE, inside(y - opening))
