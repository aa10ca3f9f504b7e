"""From a deformed and lit surface, by vertex, to the Gaussian texture, by texel."""

from concurrent.futures import ThreadPoolExecutor
from copy import copy

import numpy as np
from scipy import sparse

from mua import rotation
from mua.arrays import Array
from mua.channels import CHANNELS, SH_C0, SH_C1
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.rig.texel_map import TexelMap, build_texel_map
from mua.teacher import Light
from mua.teachers.simulated.hidden import SOLID, showing_instead
from mua.texture.albedo import FINER, finer_picture, sample_albedo
from mua.texture.deconvolution import deconvolved
from mua.texture.depths import depths
from mua.texture.sh import LINEAR
from mua.texture.sharpness import Sharpness, sharpness
from mua.texture.sheet_opacity import surfel_opacities
from mua.texture.stretch import SurfelStretch
from mua.texture.surfels import rest_surfels

MOST_OPAQUE = 5.0  # logit of a texel whose alpha is 1
MOST_CLEAR = 6.0  # negative logit of one whose alpha is 0: below what changes an 8-bit image, so that it is not drawn
SHEEN_TINT = 0.5  # how far the sheen has the colour of the surface, as cloth does, rather than that of the lamp


class SurfaceTexels:
    """The texels of a rig as points of the dense surface that the rig's template stands for."""

    def __init__(
        self,
        character: Character,
        rig: Rig,
    ) -> None:
        mesh, texels = character.mesh, rig.texels
        dense = build_texel_map(mesh, texels.size)
        rows = np.searchsorted(dense.texels, texels.texels)  # those of the rig are among them
        triangles, barycentrics = dense.triangles[rows], dense.barycentrics[rows]
        corners = mesh.faces[triangles]
        self._dense = _weights(corners, barycentrics, len(mesh.vertices))
        self._coarse = _weights(rig.mesh.faces[texels.triangles], texels.barycentrics, len(rig.mesh.vertices))
        relief = self._dense @ mesh.vertices - self._coarse @ rig.mesh.vertices
        picture = finer_picture(character.base_color, texels.size)
        wanted = sharpness(picture)
        uv = np.einsum("nk,nkc->nc", barycentrics, mesh.uv[mesh.uv_faces[triangles]])
        albedo = sample_albedo(character.base_color, uv, texels.size)
        with ThreadPoolExecutor(2) as pool:
            sharp = pool.submit(_sharp, picture, wanted)
            shown = pool.submit(showing_instead, character, corners, barycentrics, solid=albedo[:, 3] >= SOLID)
            surfels = rest_surfels(
                mesh,
                size=texels.size,
                texels=texels.texels,
                triangles=triangles,
                barycentrics=barycentrics,
                wanted=wanted.at(texels.texels),
            )
        relief += surfels.aside
        deviations = np.exp(surfels.log_scales[:, :2])
        below = depths(self._dense @ mesh.vertices, normals=surfels.normals, deviations=deviations.min(axis=1))
        relief -= below[:, None] * surfels.normals
        at_home = _at_home(uv, texels) & ~surfels.at_border  # beyond it lies the image of another chart
        albedo[at_home, :3] = sharp.result()[texels.texels[at_home]]
        albedo[:, :3] = albedo[shown.result(), :3]
        self._relief, self._rest, self._log_scales, self._albedo = (
            np.ascontiguousarray(rows.T, dtype=np.float32)
            for rows in (relief, surfels.smooth, surfels.log_scales, albedo[:, :3])
        )
        self._stretch = SurfelStretch(
            mesh.vertices,
            mesh.faces,
            triangles=triangles,
            barycentrics=barycentrics,
            rotations=surfels.smooth,
            deviations=deviations,
        )
        self._turned_to_lines = np.ascontiguousarray((surfels.rotations - surfels.smooth).T, dtype=np.float32)
        alpha = np.clip(surfel_opacities(albedo[:, 3]), 1e-6, 1 - 1e-6)
        self._opacity = np.clip(np.log(alpha / (1 - alpha)), -MOST_CLEAR, MOST_OPAQUE)

    def corrected(
        self,
        by: Array,  # [N, 9] beside offsets, log scales and albedo (mua.fidelity.fitting)
    ) -> "SurfaceTexels":
        """The same texels with corrections; these stay as they are."""
        other, planes = copy(self), by.T.astype(np.float32)
        other._relief = self._relief + planes[0:3]
        other._log_scales = self._log_scales + planes[3:6]
        other._albedo = self._albedo + planes[6:9]
        return other

    def texture(
        self,
        displacement: Array,  # [V, 3] of the dense surface from the bind pose, canonical space, metres
        coarse_displacement: Array,  # [T, 3] of the template's vertices
        *,
        turn: Array,  # [V, 4] of the surface about its vertices beside R_tex, canonical space; unit, w >= 0
        moved: Array,  # [V, 3] the dense surface in the world, metres
        dual: Array,  # [V, 8] bind pose to world; the real part is R_tex
        strain: Array,  # [V, 6] of the surface about its vertices
        light: Light,  # its sheen in canonical space
    ) -> Array:
        """Raw channels [N, 23] float32, stored channel by channel: each is a plane of its own."""
        planes = np.empty((CHANNELS, self._relief.shape[1]), dtype=np.float32)
        planes[0:3] = self._relief + self._at_texels(displacement) - _planes(self._coarse, coarse_displacement)
        planes[3:7] = _turned(self._at_texels(turn), self._rest)
        planes[3:7] += self._turned_to_lines  # the same in all poses, so that what moves stays smooth
        planes[7:10] = self._log_scales
        planes[7:9] += self._stretch(moved, self._at_texels(strain), rotation.multiply(dual[:, :4], turn))
        planes[10] = self._opacity
        planes[11:14] = (self._albedo * self._at_texels(light.gain) - 0.5) / np.float32(SH_C0)
        slope = self._at_texels(light.sheen / SH_C1)
        tint = 1 - SHEEN_TINT + SHEEN_TINT * self._albedo
        for first, (axis, sign) in zip((14, 17, 20), LINEAR, strict=True):
            np.multiply(tint, sign * slope[axis], out=planes[first : first + 3])
        return planes.T

    def leaning(
        self,
        turn: Array,  # [V, 4] of the surface about its vertices; unit, w >= 0
    ) -> Array:
        """How far [N, 3] texels move that lie aside of the surface where it turns."""
        relief = self._relief.T
        return rotation.rotate(rotation.normalize(self._at_texels(turn).T), relief) - relief

    def places(
        self,
        vertices: Array,  # [V, 3] of the dense surface
        texels: Array,  # [n] int, rows among the valid texels
    ) -> Array:
        """Positions [n, 3] of some texels on the surface."""
        return np.asarray(self._dense[texels] @ vertices)

    def _at_texels(self, values: Array) -> Array:
        return _planes(self._dense, values)


def _at_home(
    uv: Array,  # [N, 2] of each texel's point, v down
    texels: TexelMap,
) -> Array:
    """Which texels [N] have their point in their own square of the texture."""
    row, column = np.divmod(texels.texels, texels.size)
    apart = np.abs(uv * texels.size - 0.5 - np.stack([column, row], axis=1)).max(axis=1)
    return np.asarray(apart <= 0.5)


def _sharp(picture: Array, wanted: Sharpness) -> Array:
    """Colours [S * S, 3] that are as near to the image as the surfels can show them."""
    size = len(picture) // FINER
    opacity = 1 / (1 + np.exp(-MOST_OPAQUE))
    return deconvolved(picture[..., :3], opacity, wanted.spreads.reshape(size, size)).reshape(-1, 3)


def _planes(weights: sparse.csr_matrix, values: Array) -> Array:
    """Interpolate values [V, c] to texels, as planes [c, N] float32."""
    return np.stack([weights @ column for column in np.asarray(values, dtype=np.float32).T])


def _weights(corners: Array, barycentrics: Array, vertices: int) -> sparse.csr_matrix:
    """The matrix [N, V] float32 that interpolates from vertices to barycentric points."""
    starts = np.arange(len(corners) + 1) * 3
    values = np.asarray(barycentrics, dtype=np.float32).ravel()
    return sparse.csr_matrix((values, corners.ravel(), starts), shape=(len(corners), vertices))


def _turned(turn: Array, rest: Array) -> Array:
    """Products of quaternions as planes [4, N], the first brought to unit length: the turn after the rest."""
    aw, ax, ay, az = turn / np.sqrt(np.sum(turn * turn, axis=0))
    bw, bx, by, bz = rest
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ]
    )
