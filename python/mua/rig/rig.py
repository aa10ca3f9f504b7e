"""What a teacher and its student share: skeleton, skinned template and texture space."""

from dataclasses import dataclass

from mua.arrays import Array
from mua.rig.carriers import carry_texels
from mua.rig.character import Character, Mesh
from mua.rig.skeleton import Skeleton
from mua.rig.template import make_template
from mua.rig.texel_map import TexelMap


@dataclass(frozen=True)
class Rig:
    """A skinned template of a few thousand vertices and the texels on it (paper, Data Assumption)."""

    skeleton: Skeleton
    mesh: Mesh  # the template; its vertices are the canonical (bind) pose
    skin_indices: Array  # [V, 8] int32
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    texels: TexelMap


def build_rig(character: Character, *, texels: int, template_vertices: int = 5000) -> tuple[Rig, Array]:
    """Make the template of a character and the map of `texels` x `texels` texels on it.

    Also returns, for each template vertex, the vertex of the dense mesh that it is: [V] int32.
    """
    template = make_template(character, vertices=template_vertices)
    rig = Rig(
        skeleton=character.skeleton,
        mesh=template.mesh,
        skin_indices=template.skin_indices,
        skin_weights=template.skin_weights,
        texels=carry_texels(character, template, size=texels).kept,
    )
    return rig, template.source_vertices
