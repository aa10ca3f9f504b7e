"""A rigged, textured character as all readers return it: one skeleton, one mesh, one atlas."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.rig.expressions import Expressions
from mua.scene import Source


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles, counter-clockwise seen from outside, whose UV corners are indexed apart from their positions.

    UV as in glTF: u to the right along columns, v down along rows, both in 0..1 over the texture.
    """

    vertices: Array  # [V, 3] float64 bind pose, metres; one vertex per place on the surface (welded)
    faces: Array  # [F, 3] int32 into vertices
    uv: Array  # [T, 2] float64
    uv_faces: Array  # [F, 3] int32 into uv


@dataclass(frozen=True, eq=False)
class Character:
    """The dense surface that a teacher deforms, with the bind pose as canonical pose."""

    name: str
    skeleton: Skeleton
    mesh: Mesh
    skin_indices: Array  # [V, 8] int32 joints, largest weight first, 0 where the weight is 0
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    base_color: Array  # [S, S, 4] uint8 sRGB atlas; alpha is opacity
    clips: tuple[Clip, ...] = ()
    looseness: Array | None = None  # [V] 0 (skin) .. 1 (hanging cloth); None: the simulation estimates it
    notes: tuple[str, ...] = field(default=())  # the reader's decisions that a user should know, a sentence each
    source: Source | None = None  # content of the file, to compare with; None: no file, or nothing to compare
    roles: Mapping[str, str] = field(default_factory=dict)  # joint to body part, where the file states it
    expressions: Expressions | None = None  # over the vertices of `mesh`; None: the character has none

    @property
    def expression_names(self) -> tuple[str, ...]:
        """The names of its expressions; empty where it has none."""
        return () if self.expressions is None else self.expressions.names
