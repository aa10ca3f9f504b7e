"""From the pieces that a scene file holds to one surface on one rigid skeleton; shared by all readers."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

from mua.arrays import Array
from mua.motion.clip import Clip
from mua.rig.skeleton import Skeleton

Wrap: TypeAlias = Literal["repeat", "clamp", "mirror"]


@dataclass(frozen=True)
class Material:
    """Base colour of some faces: a picture with the material's factor already multiplied in."""

    name: str
    image: Array  # [h, w, 4] uint8 sRGB, at least 1 x 1; alpha is opacity (255 where the material is opaque)
    wrap_u: Wrap = "repeat"
    wrap_v: Wrap = "repeat"


@dataclass(frozen=True)
class Surfaces:
    """A rigged character whose materials still have a texture each; `mua.rig.uv.build_atlas` makes it a Character.

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
