"""Surfaces made of flat squares whose every texel has a known colour."""

import numpy as np
from people import upright

from mua.arrays import Array
from mua.atlas.surfaces import Surfaces
from mua.rig.character import Character, Mesh
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.scene import Material, Wrap

ONE_JOINT = upright(("root",), [-1])


def grid_points(cells: int) -> Array:
    """The corners [N, 2] of a unit square's cells, row after row."""
    line = np.linspace(0, 1, cells + 1)
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)


def grid_faces(rows: int, columns: int) -> Array:
    """Two triangles for each cell between such corners, the lower ones first: [2 R C, 3]."""
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    lower = np.stack([corner, corner + 1, corner + columns + 1], axis=1)
    upper = np.stack([corner + 1, corner + columns + 2, corner + columns + 1], axis=1)
    return np.concatenate([lower, upper])


def joined(*meshes: Mesh) -> Mesh:
    """Meshes as one, which share neither vertices nor UVs."""
    vertices, corners = (np.cumsum([0, *(len(getattr(m, name)) for m in meshes)]) for name in ("vertices", "uv"))
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + at for m, at in zip(meshes, vertices, strict=False)]).astype(np.int32),
        np.concatenate([m.uv for m in meshes]),
        np.concatenate([m.uv_faces + at for m, at in zip(meshes, corners, strict=False)]).astype(np.int32),
    )


def patch(cells: int, *, at: float, uv: Array, width: float = 1.0) -> tuple[Array, Array, Array]:
    """A square of `cells` x `cells` quads in the plane x = at .. at + width, its UV the 2 x 2 map (and shift) `uv`."""
    grid = grid_points(cells)
    vertices = np.column_stack([grid[:, 0] * width + at, grid[:, 1] * width, np.zeros(len(grid))])
    return vertices, grid_faces(cells, cells), grid @ uv[:2] + uv[2]


def surfaces_of(*patches: tuple[Array, Array, Array], images: tuple[Array, ...], wrap: Wrap = "repeat") -> Surfaces:
    """Patches as one character; patch k uses image k, or the last."""
    starts = np.cumsum([0] + [len(p[0]) for p in patches])
    faces = np.concatenate([p[1] + start for p, start in zip(patches, starts, strict=False)]).astype(np.int32)
    vertices = np.concatenate([p[0] for p in patches])
    material = np.repeat(np.arange(len(patches)), [len(p[1]) for p in patches])
    return Surfaces(
        name="patches",
        skeleton=ONE_JOINT,
        vertices=vertices,
        faces=faces,
        uv=np.concatenate([p[2] for p in patches]),
        uv_faces=faces,
        face_material=np.minimum(material, len(images) - 1).astype(np.int32),
        materials=tuple(Material(f"material {k}", image, wrap, wrap) for k, image in enumerate(images)),
        skin_indices=np.zeros((len(vertices), 8), np.int32),
        skin_weights=np.tile(np.array([1, 0, 0, 0, 0, 0, 0, 0], np.float32), (len(vertices), 1)),
        clips=(),
        notes=("An earlier note.",),
    )


def ramp(size: int) -> Array:
    """Red grows with u, green with v; both are linear, so that bilinear sampling is exact away from the border."""
    centre = (np.arange(size) + 0.5) / size * 255
    image = np.zeros((size, size, 4), np.uint8)
    image[..., 0], image[..., 1], image[..., 2], image[..., 3] = np.rint(centre), np.rint(centre)[:, None], 7, 200
    return image


def plain(*color: int) -> Array:
    return np.array(color, np.uint8).reshape(1, 1, 4)


def uv_map(u: float, v: float, *, at: tuple[float, float]) -> Array:
    """Rows of a map that scales a patch to u x v and moves it."""
    return np.array([[u, 0], [0, v], at])


def texels_and_colours(character: Character) -> tuple[TexelMap, Array]:
    texels = build_texel_map(character.mesh, len(character.base_color))
    return texels, character.base_color.reshape(-1, 4)[texels.texels].astype(int)


def points(character: Character, texels: TexelMap) -> Array:
    corners = character.mesh.vertices[character.mesh.faces[texels.triangles]]
    return np.einsum("nk,nkd->nd", texels.barycentrics, corners)
