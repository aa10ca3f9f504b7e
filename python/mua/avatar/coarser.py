"""Levels of detail: every 2 x 2 texels of a texture become one, again and again (schemas/README.md, section 9).

Which texels become one is decided here, when a file is written; the file holds it, and readers only gather.
"""

from dataclasses import replace
from typing import TypeVar

import numpy as np

from mua.arrays import Array
from mua.avatar.model import Branch, Model
from mua.channels import most_levels
from mua.limits import GROWTH
from mua.rig.texel_map import CHIEF, MEMBER, TURNED, TexelMap

REACH = 6.0  # texels; neighbours in the texture that lie farther apart in space belong to different surfaces
TURN = 1.0  # largest distance between quaternions that are averaged; larger turns and opposite signs are left out

M = TypeVar("M", bound=Model)


def coarsest(avatar: Model) -> int:
    """The coarsest level of an avatar; 0 where there is only one."""
    if avatar.rig.texels.levels is not None:
        return len(avatar.rig.texels.levels)
    details = max(len(avatar.geometry.details), len(avatar.appearance.details))
    return most_levels(avatar.wavelet.levels, details, taps=len(avatar.wavelet.rec_lo))


def at_level(avatar: M, level: int) -> M:
    """The avatar with the side of its texture halved `level` times, at most `coarsest` times."""
    if level and avatar.rig.texels.levels is None:
        avatar = with_levels(avatar)
    for _ in range(level):
        avatar = _coarser(avatar)
    return avatar


def with_levels(avatar: M) -> M:
    """The avatar with its levels decided anew, and the length of its texels measured."""
    undecided = _with_texels(avatar, replace(avatar.rig.texels, levels=None, length=None))
    level, levels = undecided, []
    for _ in range(coarsest(undecided)):
        levels.append(_decide(level))
        level = _coarser(_with_texels(level, replace(level.rig.texels, levels=(levels[-1],))))
    held = replace(avatar.rig.texels, levels=tuple(levels), length=texel_length(undecided))
    return _with_texels(avatar, held)


def texel_length(avatar: Model) -> float:
    """Side of a texel on the surface in metres, the template's area divided among its texels; 0 without texels."""
    if avatar.rig.texels.length is not None:
        return avatar.rig.texels.length
    a, b, c = np.swapaxes(avatar.coarse.mean[avatar.rig.mesh.faces].astype(float), 0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    count = len(avatar.rig.texels.texels)
    return float(np.float32(np.sqrt(area / count))) if count else 0.0


def _decide(avatar: Model) -> Array:
    """A byte [B] for each block of 2 x 2 texels: two bits for each of the four say what it is to the block.

    The chief, which gives the block its place on the mesh, is the texel that has most others within reach, the first of
    equals; the members are those within its reach.
    """
    texels, statics = avatar.rig.texels, avatar.geometry.static.astype(float)
    four = texels.blocks()[1]
    held, places = four >= 0, _points(avatar) + statics[:3].T
    at = places[four] if len(places) else np.zeros((*four.shape, 3))
    reach = REACH * texel_length(_with_texels(avatar, replace(texels, length=None)))
    near = np.linalg.norm(at[:, :, None] - at[:, None], axis=-1) <= reach
    near &= held[:, :, None] & held[:, None]
    rows, chief = np.arange(len(four)), np.argmax(near.sum(axis=2), axis=1)
    apart = statics[3:7, four] - statics[3:7, four[rows, chief]][:, :, None] if len(four) else np.zeros((4, 0, 4))
    kinds = near[rows, chief] * np.where(np.linalg.norm(apart, axis=0) <= TURN, TURNED, MEMBER)
    kinds[rows, chief] = CHIEF
    return np.asarray((kinds << 2 * np.arange(4)).sum(axis=1).astype(np.uint8))


def _coarser(avatar: M) -> M:
    """The next coarser level."""
    texels, statics = avatar.rig.texels, avatar.geometry.static.astype(float)
    kept, members, turned = texels.gathered()
    points, count = _points(avatar), (members >= 0).sum(axis=1)
    geometry = _means(statics, members)
    geometry[:3] += _means(points.T, members) - points[kept].T
    geometry[3:7] = _means(statics[3:7], turned)
    geometry[7:10] += np.log(GROWTH) * np.log2(count) / 2
    appearance = _means(avatar.appearance.static.astype(float), members)
    return replace(
        _with_texels(avatar, texels.halved()),
        wavelet=replace(avatar.wavelet, coarser=avatar.wavelet.coarser + 1),
        geometry=_with_static(avatar.geometry, geometry),
        appearance=_with_static(avatar.appearance, appearance),
    )


def _points(avatar: Model) -> Array:
    """Where the texels lie on the mean canonical mesh, [N, 3] metres."""
    texels = avatar.rig.texels
    corners = avatar.coarse.mean[avatar.rig.mesh.faces[texels.triangles]].astype(float)
    return np.asarray(np.einsum("nk,nkc->nc", texels.barycentrics.astype(float), corners))


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


def _with_texels(avatar: M, texels: TexelMap) -> M:
    return replace(avatar, rig=replace(avatar.rig, texels=texels))


def _with_static(branch: Branch, static: Array) -> Branch:
    return replace(branch, static=static.astype(np.float32))
