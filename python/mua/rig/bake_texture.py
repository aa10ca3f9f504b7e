"""Carries textures over from the UVs that a file came with to the UVs of the atlas."""

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array
from mua.rig.charts import areas
from mua.rig.pictures import multiplied
from mua.rig.scene import Material, Wrap
from mua.rig.texel_map import TexelMap


def bake_texture(
    texels: TexelMap,  # of the atlas
    corners: Array,  # [F, 3, 2] UV that the materials' pictures belong to
    face_material: Array,  # [F] into materials
    *,
    materials: tuple[Material, ...],
    colors: Array | None = None,  # [F, 3, 4] linear colour and opacity of the corners, multiplied in
) -> Array:
    """Sample every texel of the atlas where its point lay in its material's picture: [S, S, 4] uint8 sRGB.

    Pictures finer than the atlas are averaged first. Texels that no triangle covers take the colour of the nearest that
    one does, so that interpolation across chart borders never meets a foreign colour.
    """
    picture = np.zeros((texels.size * texels.size, 4), np.uint8)
    points = np.einsum("nk,nkd->nd", texels.barycentrics, corners[texels.triangles])
    for index, material in enumerate(materials):
        rows = face_material[texels.triangles] == index
        if rows.any():
            picture[texels.texels[rows]] = _sample(
                _averaged(material.image, corners[face_material == index], int(rows.sum())),
                points[rows],
                wraps=(material.wrap_u, material.wrap_v),
            )
    if colors is not None:
        factors = np.einsum("nk,nkc->nc", texels.barycentrics, colors[texels.triangles])
        picture[texels.texels] = multiplied(picture[texels.texels], factors)
    empty = np.ones((texels.size, texels.size), bool)
    empty.flat[texels.texels] = False
    return _fill_from_nearest(picture.reshape(texels.size, texels.size, 4), empty)


def _averaged(
    image: Array,  # [h, w, 4] uint8
    corners: Array,  # [F, 3, 2] UV of the triangles that use it
    wanted: int,  # texels that these triangles have in the atlas
) -> Array:
    """The picture reduced by the whole factor by which it is finer than the atlas: [h', w', 4] uint8."""
    texels = areas(corners).sum() * image.shape[0] * image.shape[1]
    factor = int(np.sqrt(texels / wanted))
    return np.asarray(Image.fromarray(image).reduce(factor)) if factor > 1 else image


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
    right, down = (place - first).T[:, :, None]
    columns = [_wrapped(first[:, 0] + step, width, wraps[0]) for step in (0, 1)]
    rows = [_wrapped(first[:, 1] + step, height, wraps[1]) for step in (0, 1)]
    upper = image[rows[0], columns[0]] * (1 - right) + image[rows[0], columns[1]] * right
    lower = image[rows[1], columns[0]] * (1 - right) + image[rows[1], columns[1]] * right
    return np.rint(upper * (1 - down) + lower * down).astype(np.uint8)


def _wrapped(index: Array, count: int, wrap: Wrap) -> Array:
    """Texel indices brought into 0..count - 1 as the material's sampler does."""
    if wrap == "repeat":
        return index % count
    if wrap == "mirror":
        there = index % (2 * count)
        return np.minimum(there, 2 * count - 1 - there)
    return np.clip(index, 0, count - 1)


def _fill_from_nearest(
    picture: Array,  # [S, S, 4]
    empty: Array,  # [S, S] bool
) -> Array:
    """The picture with every empty texel replaced by the nearest that is not."""
    if empty.all() or not empty.any():
        return picture
    rows, columns = distance_transform_edt(empty, return_distances=False, return_indices=True)
    return picture[rows, columns]
