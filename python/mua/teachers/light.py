"""Light that a surface sends out, whatever it comes from."""

from dataclasses import dataclass

from mua.arrays import Array


@dataclass(frozen=True, eq=False)
class Light:
    """Light that a surface sends out, by vertex, in world space."""

    gain: Array  # [V, 3 rgb] display value over albedo
    sheen: Array  # [V, 3 xyz] change of display value with the unit direction from camera to surface
