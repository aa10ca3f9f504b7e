"""Skin, face, hair and shoes."""

import numpy as np

from mua.arrays import Array
from mua.teachers.procedural.brush import Surface, color, filled, inside, over
from mua.teachers.procedural.grid import bump, smoothstep
from mua.teachers.procedural.head import EYE, MOUTH, NOSE_TIP

SKIN, BLUSH, SHADE, GLOW = color("e8bb9d"), color("dd8f78"), color("b57f66"), color("f6d6bf")
LIP, LOWER_LIP, MOUTH_LINE = color("ad4745"), color("c9625c"), color("6e2b2c")
WHITE, IRIS, IRIS_LIGHT = color("f4efe9"), color("36563f"), color("7da06f")
LASH, BROW = color("241612"), color("4a2c20")
HAIR, HAIR_LIGHT = color("3b2018"), color("6b3d27")
SHOE, NAIL = color("c8452f"), color("f3cfc0")


def _ellipse(x: Array, y: Array, wide: float, high: float) -> Array:
    """Signed distance (about) to an ellipse about the origin."""
    return np.asarray((np.hypot(x / wide, y / high) - 1) * min(wide, high))


def _eye(face: Array, x: Array, y: Array, glint: float) -> Array:
    """One eye with its brow, x growing outward from its centre; `glint` is the x of the light in it."""
    lifted = y - 0.08 * x  # the outer corner a little higher
    bow = np.sqrt(np.clip(1 - (x / 0.0168) ** 2, 0, 1))
    upper, lower = lifted - 0.0088 * bow, -lifted - 0.0066 * bow
    open_eye = inside(np.maximum(np.maximum(upper, lower), np.abs(x) - 0.0168))
    iris = np.hypot(x, lifted - 0.0012)
    face = over(face, SHADE, 0.55 * inside(np.abs(upper - 0.0042) - 0.0006) * (np.abs(x) < 0.015))  # crease of the lid
    face = over(face, WHITE, open_eye)
    face = over(face, IRIS, inside(iris - 0.0078) * open_eye)
    face = over(face, IRIS_LIGHT, 0.8 * inside(np.hypot(x, lifted + 0.0006) - 0.0052) * open_eye)
    face = over(face, LASH, inside(iris - 0.0036) * open_eye)
    face = over(face, SHADE, 0.5 * smoothstep(-0.005, 0, upper) * open_eye)  # the lid's shadow
    face = over(face, WHITE, inside(np.hypot(x - glint, lifted - 0.0038) - 0.0017))
    face = over(face, SHADE, 0.6 * inside(np.abs(lower - 0.0004) - 0.0005) * (np.abs(x) < 0.016))
    lash = np.abs(upper - 0.0006) - 0.0013 - 0.05 * np.maximum(x, 0)
    face = over(face, LASH, inside(np.maximum(lash, np.abs(x - 0.001) - 0.0178)))
    ends = 0.08 * np.maximum(x - 0.002, 0) + 0.12 * np.maximum(-x - 0.010, 0)
    brow = np.abs(y - 0.0225 + 9 * (x - 0.004) ** 2) - 0.0026 + ends
    return over(face, BROW, 0.75 * inside(np.maximum(brow, np.abs(x - 0.001) - 0.019), edge=0.002))


def _mouth(face: Array, x: Array, y: Array) -> Array:
    """Closed lips that smile, about the middle of the line between them."""
    away, line = np.clip(1 - np.abs(x) / 0.0225, 0, 1), y - 9 * x**2 + 0.0006 * np.cos(x * 280)
    upper = line - 0.0068 * away**0.75 + 0.0014 * bump(x, 0 * y, 0.003, 1)
    lower = -line - 0.0074 * np.sqrt(np.clip(1 - (x / 0.0215) ** 2, 0, 1))
    shown = inside(np.maximum(np.maximum(upper, lower), np.abs(x) - 0.0225), edge=0.0018)
    face = over(face, np.where(line[..., None] > 0, LIP, LOWER_LIP), shown)
    face = over(face, GLOW, 0.35 * bump(x, line + 0.0042, 0.008, 0.0016))
    face = over(face, MOUTH_LINE, 0.8 * inside(np.maximum(np.abs(line) - 0.0005, np.abs(x) - 0.0225)))
    return over(face, SHADE, 0.5 * bump(x, y + 0.0125, 0.010, 0.003))  # below the lower lip


def _scalp(x: Array, y: Array, z: Array) -> Array:
    """Skin, and in the shadow of the hair above it, as dark as hair below it."""
    beyond = y - 1.672 + np.where(x > -0.024, 11, 50) * (x + 0.024) ** 2  # metres above the edge over the forehead
    shadow = np.maximum(smoothstep(-0.02, 0.006, beyond), smoothstep(0.056, 0.07, np.abs(x)))
    skin = over(filled(x, SKIN), SHADE, 0.5 * shadow * smoothstep(1.49, 1.52, y) * (z > 0.02))
    hidden = np.maximum(smoothstep(0.012, 0.022, beyond), smoothstep(0.04, 0.01, z))
    return over(skin, HAIR, hidden * smoothstep(1.5, 1.53, y))


def _modelled(face: Array, x: Array, y: Array) -> Array:
    """Soft colours of cheeks and lids, and the light on the nose."""
    side, below_tip = np.abs(x), y - NOSE_TIP
    cheeks = 0.5 * bump(side - 0.043, y - 1.552, 0.017, 0.013) + 0.15 * bump(x, below_tip + 0.002, 0.01, 0.008)
    face = over(face, BLUSH, cheeks)
    face = over(face, SHADE, 0.35 * bump(side - EYE[0] + 0.002, y - EYE[1] - 0.011, 0.018, 0.007))  # lids
    face = over(face, SHADE, 0.30 * bump(side - 0.0125, y - 1.572, 0.004, 0.018))  # beside the nose
    face = over(face, GLOW, 0.5 * (bump(x, y - 1.575, 0.004, 0.02) + bump(x, below_tip - 0.002, 0.004, 0.003)))
    return over(face, SHADE, 0.6 * inside(_ellipse(side - 0.0065, below_tip + 0.0075, 0.0034, 0.0018)))  # nostrils


def paint_head(surface: Surface) -> Array:
    """Scalp, face and skin down to the neckline, the features painted from the front."""
    x, y, z = np.moveaxis(surface.points, -1, 0)
    bare = _scalp(x, y, z)
    face = _modelled(bare, x, y)
    for sign in (-1, 1):
        face = _eye(face, sign * x - EYE[0], y - EYE[1], -0.0026 * sign)
    return np.where((z > 0.02)[..., None], _mouth(face, x, y - MOUTH), bare)


def paint_hair(surface: Surface) -> Array:
    """Strands of two browns that run from the parting to the ends."""
    strand = 0.5 + 0.25 * np.sin(surface.around * 131 + 2 * np.sin(surface.along * 9))
    strand += 0.25 * np.sin(surface.around * 83 + 1.0)
    sheen = 0.35 + 0.5 * np.exp(-(((surface.along - 0.085) / 0.03) ** 2))
    return over(filled(surface.around, HAIR), HAIR_LIGHT, sheen * (0.5 + strand))


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
