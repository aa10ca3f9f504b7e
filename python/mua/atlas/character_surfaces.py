"""A character before its materials share one atlas."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.rig.expressions import Expressions
from mua.scene import Material, Source


@dataclass(frozen=True, eq=False)
class Surfaces:
    """A rigged character whose materials still have a texture each; `mua.atlas.uv.build_atlas` makes it a Character.

    UV as in glTF: u to the right along columns, v down along rows; values outside 0..1 follow the material's wrap.
    """

    name: str
    skeleton: Skeleton
    vertices: Array  # [V, 3] float64 bind pose, metres, welded
    faces: Array  # [F, 3] int32 into vertices
    uv: Array  # [T, 2] float64, raw
    uv_faces: Array  # [F, 3] int32 into uv; -1 in all three corners where the source has no UVs
    face_material: Array  # [F] int32 into materials
    materials: tuple[Material, ...]
    skin_indices: Array  # [V, 8] int32 joints, largest weight first, 0 where the weight is 0
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    clips: tuple[Clip, ...]
    notes: tuple[str, ...]
    source: Source | None = None  # what it was made of
    corner_colors: Array | None = None  # [F, 3, 4] linear, multiplied into the materials; None where all are white
    roles: Mapping[str, str] = field(default_factory=dict)  # joint to body part, where the file itself says it
    unit: float = 1.0  # metres as which one metre of the file is taken
    size_notes: tuple[str, ...] = ()  # those of the notes that say so
    expressions: Expressions | None = None  # over the vertices; None: the character has none
