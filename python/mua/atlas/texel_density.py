"""How fine the texels are on each part of a character, as a sentence."""

import numpy as np

from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.character import Character
from mua.rig.charts import areas
from mua.rig.texel_map import build_texel_map

MILLIMETRES = 1000


def describe_texels(character: Character, size: int) -> str:
    """The share of `size` x `size` texels that are in use, and how wide a texel is on each part of the body."""
    mesh = character.mesh
    texels = build_texel_map(mesh, size)
    parts = body_parts(
        character.skeleton, mesh.faces, character.skin_indices, character.skin_weights, stated=character.roles
    )
    surface = np.bincount(parts, areas(mesh.vertices[mesh.faces]), minlength=len(BODY_PARTS))
    held = np.bincount(parts[texels.triangles], minlength=len(BODY_PARTS))
    widths = [
        f"{MILLIMETRES * np.sqrt(surface[k] / held[k]):.1f} mm on the {part}"
        for k, part in enumerate(BODY_PARTS)
        if held[k] > 0
    ]
    share = len(texels.texels) / size**2
    return f"{share:.0%} of {size} x {size} texels are in use; a texel is wide: {', '.join(widths)}."
