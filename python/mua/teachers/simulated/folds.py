"""Folds of cloth: where skinning squeezes a loose surface, it rises and falls in a pattern of its own.

A simulated sheet buckles only from its imperfections; here they are a random relief of one wavelength, fixed to the
cloth, whose height grows with the squeeze.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.rig.bones import figure_scale
from mua.teachers.simulated.smoothing import low_pass
from mua.texture.surfels import SurfaceFrames, vertex_normals

WAVELENGTH = 0.08  # metres on a person, of the folds
HEIGHT = 0.012  # metres on a person: standard deviation of the loosest cloth when fully squeezed
FULL_SQUEEZE = 0.3  # log of length lost at which folds near their full height


class Folds:
    """The relief of one character's cloth."""

    def __init__(
        self,
        vertices: Array,  # [V, 3] bind pose, metres
        faces: Array,  # [F, 3]
        *,
        looseness: Array,  # [V] 0..1
        rng: np.random.Generator,
        scale: float | None = None,  # size of the figure over that of a person; None: these are all of its vertices
    ) -> None:
        scale = figure_scale(vertices) if scale is None else scale
        self._normals = vertex_normals(vertices, faces)
        self._surface = SurfaceFrames(vertices, faces)
        self._smooth = low_pass(vertices, faces, WAVELENGTH * scale)
        longer = low_pass(vertices, faces, 2 * WAVELENGTH * scale)
        relief = self._smooth(self._smooth(rng.standard_normal(len(vertices))))
        relief -= longer(relief)
        self._height = HEIGHT * scale * looseness**2 * relief / max(float(relief.std()), 1e-12)

    def __call__(
        self,
        target: Array,  # [V, 3] skinned positions
        turn: Array,  # [V, 4] skinned rotations
    ) -> Array:
        """The skinned positions with folds [V, 3]."""
        if not self._height.any():  # rigid all over
            return target
        risen = self._height * self._smooth(np.tanh(self._surface.squeeze(target) / FULL_SQUEEZE))
        return np.asarray(target + risen[:, None] * rotation.rotate(turn, self._normals))
