"""The rig that a teacher and its student share: skeleton, skinned template and texture space."""

from dataclasses import dataclass

from mua.arrays import Array
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.expressions import Expressions
from mua.rig.texel_map import TexelMap


@dataclass(frozen=True, eq=False)
class Rig:
    """A skinned template of a few thousand vertices and the texels on it (paper, Data Assumption)."""

    skeleton: Skeleton
    mesh: Mesh  # the template; its vertices are the canonical (bind) pose
    skin_indices: Array  # [V, 8] int32
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    texels: TexelMap
    expressions: Expressions | None = None  # over the vertices of the template; None: the character has none
