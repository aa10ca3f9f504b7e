"""Which triangles a material leaves clear everywhere, and images whose opacity is cut off at a threshold."""

from dataclasses import replace

import numpy as np
from PIL import Image
from scipy.ndimage import maximum_filter

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.filtering import bled
from mua.errors import InputError
from mua.scene import Material, wrapped

FINEST = 1024  # texels along the finest map of what is seen
STEPS = 32  # samples along a triangle's longest side, at most one texel apart on the map that is coarse enough
SAMPLES_AT_ONCE = 1 << 20
EDGE = 3  # texels of a cut-out image for each one of the atlas, so that its edges come out smooth
LARGEST_CUT_OUT = 4096  # texels along a side


def without_unseen(surfaces: Surfaces) -> Surfaces:
    """Leave out the triangles whose material is clear all over them, and say which materials show nothing.

    Raises an InputError where nothing would be left.
    """
    seen = np.ones(len(surfaces.faces), bool)
    hidden = []
    for index, material in enumerate(surfaces.materials):
        faces = np.flatnonzero(surfaces.face_material == index)
        mapped = surfaces.uv_faces[faces, 0] >= 0
        corners = np.zeros((len(faces), 3, 2))
        corners[mapped] = surfaces.uv[surfaces.uv_faces[faces[mapped]]]
        seen[faces] = _seen(material, corners, mapped)
        if surfaces.corner_colors is not None:
            seen[faces] &= 255 * surfaces.corner_colors[faces, :, 3].max(axis=1) >= material.least
        if len(faces) and not seen[faces].any():
            hidden.append(
                f"Material {material.name} is fully transparent (its alpha is 0) and is left out; "
                f"--alpha {material.name}=opaque shows it."
            )
    if seen.all():
        return surfaces
    if not seen.any():
        raise InputError(f"{surfaces.name}: the alpha of every material is 0, expected a visible one")
    of_hidden = ~np.isin(surfaces.face_material, np.unique(surfaces.face_material[seen]))
    clear = np.count_nonzero(~seen & ~of_hidden)
    notes = [f"{clear:,} triangles that are fully transparent are left out."] if clear else []
    return replace(_only(surfaces, seen), notes=(*surfaces.notes, *hidden, *notes))


def cut_out(
    material: Material,
    density: float,  # texels of its image for one of the atlas, in length
) -> Array:
    """A material's image, solid from its cut-off on and clear below: [h, w, 4] uint8, enlarged where it is coarse."""
    image = bled(material.image)
    height, width = image.shape[:2]
    finer = int(np.ceil(EDGE / max(density, EDGE / LARGEST_CUT_OUT)))
    finer = min(finer, LARGEST_CUT_OUT // max(height, width))
    if finer > 1 and image[..., 3].min() < image[..., 3].max():
        size = (width * finer, height * finer)
        image = np.asarray(Image.merge("RGBA", [_enlarged(image[..., k], size) for k in range(4)]))
    return np.dstack([image[..., :3], np.where(image[..., 3] >= material.least, 255, 0).astype(np.uint8)])


def _enlarged(plane: Array, size: tuple[int, int]) -> Image.Image:
    return Image.fromarray(np.ascontiguousarray(plane)).resize(size, Image.Resampling.BILINEAR)


def _seen(
    material: Material,
    corners: Array,  # [n, 3, 2] UV
    present: Array,  # [n] bool, there are UVs
) -> Array:
    """Whether any texel under each triangle [n] shows; never False for one that is seen."""
    shows = material.image[..., 3] >= material.least
    if shows.all() or not shows.any():
        return np.full(len(corners), shows.any())
    maps = _pyramid(maximum_filter(shows, 3, mode="wrap"))
    seen = ~present
    sides = np.abs(corners - np.roll(corners, 1, axis=1)).max(axis=(1, 2))
    level = np.ceil(np.log2(np.maximum(sides * max(maps[0].shape) / STEPS, 1))).astype(int)
    level = np.minimum(level, len(maps) - 1)
    steps = np.arange(STEPS + 1)
    grid = np.array([(a, b, STEPS - a - b) for a in steps for b in steps[: STEPS + 1 - a]]) / STEPS
    for k in np.unique(level[present]):
        rows = np.flatnonzero(present & (level == k))
        for some in np.array_split(rows, -(-len(rows) * len(grid) // SAMPLES_AT_ONCE)):
            points = np.einsum("gk,nkd->ngd", grid, corners[some]) * maps[k].shape[::-1]
            column, row = np.floor(points).astype(np.int64).transpose(2, 0, 1)
            height, width = maps[k].shape
            there = maps[k][wrapped(row, height, material.wrap_v), wrapped(column, width, material.wrap_u)]
            seen[some] = there.any(axis=1)
    return seen


def _pyramid(shows: Array) -> list[Array]:
    """Maps [2^i, 2^j] bool of where anything shows, each half as fine as the one before."""
    height, width = (min(1 << (count - 1).bit_length(), FINEST) for count in shows.shape)
    maps = [_any_in_cells(_any_in_cells(shows, height).T, width).T]
    while min(maps[-1].shape) > 1:
        a = maps[-1]
        maps.append(a[::2, ::2] | a[1::2, ::2] | a[::2, 1::2] | a[1::2, 1::2])
    return maps


def _any_in_cells(rows: Array, count: int) -> Array:
    """Whether any of the rows [n, m] that a cell of `count` touches shows: [count, m]."""
    edges = np.arange(count + 1) * len(rows) / count
    first, last = np.floor(edges[:-1]).astype(int), np.ceil(edges[1:]).astype(int)
    sums = np.concatenate([np.zeros((1, rows.shape[1]), int), np.cumsum(rows, axis=0)])
    return np.asarray(sums[last] > sums[first])


def _only(
    surfaces: Surfaces,
    seen: Array,  # [F] bool
) -> Surfaces:
    """These faces, and the vertices and materials that they use."""
    used, faces = np.unique(surfaces.faces[seen], return_inverse=True)
    shown, face_material = np.unique(surfaces.face_material[seen], return_inverse=True)
    return replace(
        surfaces,
        vertices=surfaces.vertices[used],
        faces=faces.reshape(-1, 3).astype(np.int32),
        uv_faces=surfaces.uv_faces[seen],
        face_material=face_material.reshape(-1).astype(np.int32),
        materials=tuple(surfaces.materials[k] for k in shown),
        skin_indices=surfaces.skin_indices[used],
        skin_weights=surfaces.skin_weights[used],
        expressions=None if surfaces.expressions is None else surfaces.expressions.at(used),
        corner_colors=None if surfaces.corner_colors is None else surfaces.corner_colors[seen],
    )
