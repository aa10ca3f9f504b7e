"""An avatar's meshes as other programs read them: the template with a texture, and the detailed geometry."""

import io
from dataclasses import dataclass

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array, unique_rows
from mua.asset.avatar import Avatar
from mua.avatar.decode import Splats
from mua.export.splats import mean_colors
from mua.player.surface import surface_mesh
from mua.rig.texel_map import TexelMap
from mua.texture.surfels import vertex_normals


@dataclass(frozen=True, eq=False)
class SkinnedMesh:
    """The template in the bind pose, a vertex for each of its UVs; metres."""

    vertices: Array  # [P, 3]
    normals: Array  # [P, 3] unit
    uv: Array  # [P, 2] v down
    faces: Array  # [F, 3] counter-clockwise seen from outside
    joints: Array  # [P, 8] int, largest weight first
    weights: Array  # [P, 8] rows sum to 1
    texture: Array  # [S, S, 3] uint8 sRGB

    @property
    def png(self) -> bytes:
        """The texture as a file."""
        content = io.BytesIO()
        Image.fromarray(self.texture).save(content, "PNG")
        return content.getvalue()

    @property
    def colors(self) -> Array:
        """sRGB [P, 3] of the texture at the vertices, in 0..1."""
        size = len(self.texture)
        column, row = np.clip((self.uv * size).astype(int), 0, size - 1).T
        return np.asarray(self.texture[row, column] / 255)


@dataclass(frozen=True, eq=False)
class DetailedMesh:
    """The triangles over the texels; each texel is a vertex."""

    faces: Array  # [T, 3] counter-clockwise seen from outside


def skinned_mesh(
    avatar: Avatar,
    splats: Splats,  # the frame whose colours are painted
) -> SkinnedMesh:
    """The template of an avatar, painted with the mean colours of its splats."""
    mesh, rig = avatar.rig.mesh, avatar.rig
    corners = np.stack([mesh.faces.ravel(), mesh.uv_faces.ravel()], axis=1)
    pairs, _, index = unique_rows(corners)
    vertex, uv = pairs.T
    normals = vertex_normals(mesh.vertices.astype(float), mesh.faces)
    return SkinnedMesh(
        vertices=mesh.vertices[vertex],
        normals=normals[vertex],
        uv=mesh.uv[uv],
        faces=index.reshape(-1, 3),
        joints=rig.skin_indices[vertex],
        weights=rig.skin_weights[vertex],
        texture=painted(rig.texels, mean_colors(splats.sh)),
    )


def painted(
    texels: TexelMap,
    colors: Array,  # [N, 3] sRGB of the valid texels
) -> Array:
    """The texture [S, S, 3] uint8; a texel that is not valid has the colour of the nearest one that is."""
    image = np.zeros((texels.size**2, 3), np.uint8)
    image[texels.texels] = np.rint(np.clip(colors, 0, 1) * 255)
    empty = np.ones(texels.size**2, bool)
    empty[texels.texels] = False
    rows, columns = distance_transform_edt(
        empty.reshape(texels.size, texels.size), return_distances=False, return_indices=True
    )
    return np.asarray(image.reshape(texels.size, texels.size, 3)[rows, columns])


def detailed_mesh(avatar: Avatar) -> DetailedMesh:
    """The triangles of an avatar's detailed geometry; its vertices are the centres of the splats."""
    return DetailedMesh(surface_mesh(avatar).triangles.astype(np.int64))


def detailed_normals(
    splats: Splats,
    mesh: DetailedMesh,
) -> Array:
    """Unit normals [N, 3] of the detailed geometry."""
    return vertex_normals(splats.centres.astype(float), mesh.faces)
