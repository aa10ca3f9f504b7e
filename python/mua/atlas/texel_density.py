"""How fine the texels are on each part of a character, as a sentence."""

import numpy as np

from mua.arrays import Array
from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.character import Character
from mua.rig.charts import areas
from mua.rig.texel_map import build_texel_map

MILLIMETRES = 1000
FINEST = 10  # percentile of the widths of a part's texels that counts as its finest
FINER = 0.7  # of the part's median: finer ones are worth a word


def describe_texels(character: Character, size: int) -> str:
    """The share of `size` x `size` texels that are in use, and how wide a texel is on each part of the body."""
    mesh = character.mesh
    texels = build_texel_map(mesh, size)
    parts = body_parts(
        character.skeleton, mesh.faces, character.skin_indices, character.skin_weights, stated=character.roles
    )
    surface = np.bincount(parts, areas(mesh.vertices[mesh.faces]), minlength=len(BODY_PARTS))
    part_of, width = parts[texels.triangles], MILLIMETRES * np.sqrt(_surfaces(character, size))[texels.triangles]
    held = np.bincount(part_of, minlength=len(BODY_PARTS))
    widths = [
        f"{MILLIMETRES * np.sqrt(surface[k] / held[k]):.1f} mm on the {part}{_finest(width[part_of == k])}"
        for k, part in enumerate(BODY_PARTS)
        if held[k] > 0
    ]
    share = len(texels.texels) / size**2
    return f"{share:.0%} of {size} x {size} texels are in use; a texel is wide: {', '.join(widths)}."


def _surfaces(character: Character, size: int) -> Array:
    """The surface [F] that a texel has on each triangle, m2."""
    mesh = character.mesh
    drawn = areas(mesh.uv[mesh.uv_faces]) * size**2
    return np.divide(areas(mesh.vertices[mesh.faces]), drawn, out=np.zeros(len(drawn)), where=drawn > 0)


def _finest(
    widths: Array,  # [n] millimetres
) -> str:
    """The finest texels of a part, in brackets, where they are much finer than most."""
    finest = np.percentile(widths, FINEST)
    return f" ({finest:.1f} at its finest)" if finest < FINER * np.median(widths) else ""
