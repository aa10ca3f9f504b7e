"""Carries textures over from the UVs that a file came with to the UVs of the atlas."""

import numpy as np

from mua.arrays import Array
from mua.atlas.filtering import bilinear, bled, filled, reduced
from mua.atlas.opacity import cut_out
from mua.atlas.pictures import multiplied
from mua.rig.charts import areas
from mua.rig.texel_map import TexelMap
from mua.scene import Material, Wrap, wrapped


def bake_texture(
    texels: TexelMap,  # of the atlas
    corners: Array,  # [F, 3, 2] UV that the materials' images belong to
    face_material: Array,  # [F] into materials
    *,
    materials: tuple[Material, ...],
    colors: Array | None = None,  # [F, 3, 4] linear colour and opacity of the corners, multiplied in
) -> Array:
    """Sample every texel of the atlas where its point lay in its material's image: [S, S, 4] uint8 sRGB.

    Images finer than the atlas are averaged first. Texels that no triangle covers take the colour of the nearest that
    one does, so that interpolation across chart borders never meets a foreign colour.
    """
    picture = np.zeros((texels.size * texels.size, 4), np.uint8)
    points = np.einsum("nk,nkd->nd", texels.barycentrics, corners[texels.triangles])
    for index, material in enumerate(materials):
        rows, faces = face_material[texels.triangles] == index, face_material == index
        if not rows.any():
            continue
        thinned = material.alpha_mode == "mask" and colors is not None and colors[faces, :, 3].min() < 1
        image = _averaged(material, corners[faces], int(rows.sum()), cut=not thinned)
        found = _sample(image, points[rows], wraps=(material.wrap_u, material.wrap_v))
        if colors is not None:
            factors = np.einsum("nk,nkc->nc", texels.barycentrics[rows], colors[texels.triangles[rows]])
            found = multiplied(found, factors)
        if thinned:
            found[:, 3] = np.where(found[:, 3] >= material.least, 255, 0)
        picture[texels.texels[rows]] = found
    empty = np.ones((texels.size, texels.size), bool)
    empty.flat[texels.texels] = False
    return filled(picture.reshape(texels.size, texels.size, 4), empty)


def _averaged(
    material: Material,
    corners: Array,  # [F, 3, 2] UV of the triangles that use it
    wanted: int,  # texels that these triangles have in the atlas
    *,
    cut: bool,  # a mask is cut out already, as vertices do not change its opacity
) -> Array:
    """Its image reduced by the whole factor by which it is finer than the atlas, no colour in it foreign: uint8."""
    image, used = material.image, areas(corners).sum()
    if material.alpha_mode == "mask" and cut:
        image = cut_out(material, np.sqrt(used * image.shape[0] * image.shape[1] / wanted))
    return bled(reduced(image, int(np.sqrt(used * image.shape[0] * image.shape[1] / wanted))))


def _sample(
    image: Array,  # [h, w, 4] uint8
    points: Array,  # [n, 2] UV
    *,
    wraps: tuple[Wrap, Wrap],
) -> Array:
    """Bilinear interpolation between texel centres: [n, 4] uint8."""
    height, width = image.shape[:2]
    place = points * (width, height) - 0.5
    first = np.floor(place).astype(np.int64)
    columns = wrapped(first[:, 0], width, wraps[0]), wrapped(first[:, 0] + 1, width, wraps[0])
    rows = wrapped(first[:, 1], height, wraps[1]), wrapped(first[:, 1] + 1, height, wraps[1])
    return np.rint(bilinear(image, rows, columns, place - first)).astype(np.uint8)
