"""Coarser levels of an avatar's texture: every 2 x 2 texels become one, again and again (schemas/README.md, section 9).

A level is computed from what the file holds, so that every file has its levels and none is larger for it.
"""

from dataclasses import replace
from typing import TypeVar

import numpy as np

from mua.arrays import Array
from mua.avatar.model import Branch, Model
from mua.channels import STATIC_LEVELS
from mua.rig.texel_map import TexelMap

REACH = 6.0  # texels: what lies farther apart in space belongs to other surfaces, though it is beside in the texture
GROWTH = 1.85  # of the standard deviations where one splat stands for four: the figure then covers as much as before
TURN = 1.0  # between quaternions: what is turned farther, or has the other sign, has no part in a mean rotation
MOST_TAPS = 32  # of a wavelet: UpsampleTexels holds no more samples of a tile of a level that is not upsampled

M = TypeVar("M", bound=Model)


def coarsest(avatar: Model) -> int:
    """The coarsest level that an avatar has, 0 where it has but one.

    Details that vary with the frame would have to be computed to be averaged: such levels are not left out.
    """
    details = max(len(avatar.geometry.details), len(avatar.appearance.details))
    if len(avatar.wavelet.rec_lo) > MOST_TAPS:
        return 0
    return min(STATIC_LEVELS, avatar.wavelet.levels - details)


def at_level(avatar: M, level: int) -> M:
    """The avatar with a texture of half as many texels along a side, `level` times, at most `coarsest` of it."""
    for _ in range(level):
        avatar = _coarser(avatar)
    return avatar


def texel_length(avatar: Model) -> float:
    """The side of a texel on the surface, metres: of all of the template in equal parts; 0 without texels."""
    a, b, c = np.swapaxes(avatar.coarse.mean[avatar.rig.mesh.faces].astype(float), 0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    count = len(avatar.rig.texels.texels)
    return float(np.sqrt(area / count)) if count else 0.0


def _coarser(avatar: M) -> M:
    """The next level."""
    texels, statics = avatar.rig.texels, avatar.geometry.static.astype(float)
    points = _points(avatar)
    kept, members = _blocks(texels, points + statics[:3].T, REACH * texel_length(avatar))
    count = (members >= 0).sum(axis=1)
    geometry = _means(statics, members)
    geometry[:3] += _means(points.T, members) - points[kept].T
    geometry[3:7] = _means(statics[3:7], _turned_alike(statics[3:7], members, kept))
    geometry[7:10] += np.log(GROWTH) * np.log2(count) / 2
    appearance = _means(avatar.appearance.static.astype(float), members)
    return replace(
        avatar,
        rig=replace(avatar.rig, texels=_halved(texels, kept, members)),
        wavelet=replace(avatar.wavelet, coarser=avatar.wavelet.coarser + 1),
        geometry=_with_static(avatar.geometry, geometry),
        appearance=_with_static(avatar.appearance, appearance),
    )


def _points(avatar: Model) -> Array:
    """Where the texels lie on the mean canonical mesh, [N, 3] metres."""
    texels = avatar.rig.texels
    corners = avatar.coarse.mean[avatar.rig.mesh.faces[texels.triangles]].astype(float)
    return np.asarray(np.einsum("nk,nkc->nc", texels.barycentrics.astype(float), corners))


def _blocks(
    texels: TexelMap,
    places: Array,  # [N, 3] of the texels, metres
    reach: float,  # metres
) -> tuple[Array, Array]:
    """The texel [B] that gives each block of 2 x 2 its place on the mesh, and the block's members [B, 4], -1 for none.

    It is the one that has most others within reach, the first of equals; the members are those within its reach.
    """
    row, column = np.divmod(texels.texels.astype(np.int64), texels.size)
    _, block = np.unique(row // 2 * (texels.size // 2) + column // 2, return_inverse=True)
    members = np.full((block.max(initial=-1) + 1, 4), -1)
    members[block, row % 2 * 2 + column % 2] = np.arange(len(block))
    held = members >= 0
    at = places[members] if len(places) else np.zeros((*members.shape, 3))
    near = np.linalg.norm(at[:, :, None] - at[:, None], axis=-1) <= reach
    near &= held[:, :, None] & held[:, None]
    chief = np.argmax(near.sum(axis=2), axis=1)
    rows = np.arange(len(members))
    return members[rows, chief], np.where(near[rows, chief], members, -1)


def _means(
    values: Array,  # [c, N]
    members: Array,  # [B, 4] into N, -1 for none
) -> Array:
    """Means [c, B] over the members."""
    held = members >= 0
    sums = np.zeros((len(values), len(members)))
    for place, there in zip(members.T, held.T, strict=True):
        sums[:, there] += values[:, place[there]]
    return np.asarray(sums / np.maximum(held.sum(axis=1), 1))


def _turned_alike(
    rotations: Array,  # [4, N]
    members: Array,  # [B, 4]
    kept: Array,  # [B]
) -> Array:
    """Those of the members [B, 4] that are turned nearly as the one that is kept."""
    apart = rotations[:, members] - rotations[:, kept, None] if len(kept) else np.zeros((4, 0, 4))
    return np.where(np.linalg.norm(apart, axis=0) <= TURN, members, -1)


def _halved(
    texels: TexelMap,
    kept: Array,  # [B]
    members: Array,  # [B, 4]
) -> TexelMap:
    """Blocks as texels of half the size, each where the texel lies that is kept, one-sided where all members are."""
    row, column = np.divmod(texels.texels[kept], texels.size)
    return replace(
        texels,
        size=texels.size // 2,
        texels=(row // 2 * (texels.size // 2) + column // 2).astype(np.int32),
        triangles=texels.triangles[kept],
        barycentrics=texels.barycentrics[kept],
        one_sided=None if texels.one_sided is None else np.all(texels.one_sided[members] | (members < 0), axis=1),
    )


def _with_static(branch: Branch, static: Array) -> Branch:
    return replace(branch, static=static.astype(np.float32))
