"""One texture space for all materials of a character: artists' charts, scaled by what is seen of them, or cut anew."""

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import xatlas

from mua.arrays import Array, unique_rows
from mua.atlas.allocation import wanted_fineness
from mua.atlas.bake_texture import bake_texture
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.chart_packing import pack
from mua.atlas.chart_quality import distorted, even, overlapping, starved
from mua.atlas.detail import Detail, UvMode, factors, split_by_factor
from mua.atlas.opacity import without_unseen
from mua.atlas.redraw import redrawn
from mua.rig.body_parts import body_parts
from mua.rig.character import Character, Mesh
from mua.rig.charts import areas, find_charts
from mua.rig.texel_map import build_texel_map, cover

JUDGED_SIZE = 512  # texels along the map in which overlap is counted
LOSS_ALLOWED = 0.02  # share of texels claimed twice, or of surface with next to no texels
BORDER = 1e-3  # a UV this far beyond the texture counts as inside
BLOCK = 20_000  # triangles cut together: xatlas takes time by the square of a chart's, and may fall to tiny charts then


@dataclass(frozen=True, eq=False)
class _Source:
    """The surface with the UVs that its file gave it."""

    surfaces: Surfaces
    positions: Array  # [F, 3, 3] metres
    corners: Array  # [F, 3, 2] raw UV, 0 where there are none
    present: Array  # [F] bool, there are some
    nodes: Array  # [F, 3] equal where corners share vertex, UV and material
    charts: Array  # [F]
    distorted: Array  # [F] bool, its whole chart is
    starved: Array  # [F] bool, has next to no texels for its surface, or none


@dataclass(frozen=True, eq=False)
class _Layout:
    """Where each face lies in the atlas."""

    corners: Array  # [F, 3, 2]
    as_is: bool  # the atlas is the only material's own texture
    notes: tuple[str, ...] = ()


def build_atlas(surfaces: Surfaces, *, uv: UvMode, size: int, detail: Detail | None = None) -> Character:
    """Give a character one UV layout and one image for all its materials.

    `auto` scales the artist's charts by what is seen of them and by `detail`, packs them, and cuts anew only what
    overlaps itself, is distorted or is starved of texels; `unwrap` cuts everything anew with xatlas; `keep` leaves
    every chart where its artist put it, several materials side by side as whole squares.

    The image is `size` x `size`, or the only material's own where that is square and its layout is kept.
    """
    surfaces = without_unseen(surfaces)
    corners = _corners(surfaces)
    if uv == "keep":
        source = _read(surfaces, corners)
        layout = _keep(source)
        trouble = _trouble(source, layout)
        notes = (f"The UV layout was kept although {trouble}.",) if trouble else ()
        layout = _Layout(layout.corners, layout.as_is, notes)
    else:
        with ThreadPoolExecutor(1) as pool:  # beside what decides which charts are kept
            parts = _parts(surfaces)
            wanted = pool.submit(wanted_fineness, surfaces, corners, parts=parts, chosen=detail or {})
            source = _read(surfaces, corners)
            wound = overlapping(source.corners, source.charts)[source.charts] > LOSS_ALLOWED
            anew = wound | source.starved if uv == "auto" else np.ones(len(source.charts), bool)
            anew = _with_distorted(source, anew)
            layout = _lay_out(source, anew, detail or {}, parts=parts, wanted=wanted)
    return _character(source, layout, size)


def _corners(surfaces: Surfaces) -> Array:
    """The UVs [F, 3, 2] of all corners, 0 where there are none."""
    present = surfaces.uv_faces[:, 0] >= 0
    corners = np.zeros((len(surfaces.faces), 3, 2))
    corners[present] = surfaces.uv[surfaces.uv_faces[present]]
    return corners


def _read(surfaces: Surfaces, corners: Array) -> _Source:
    """Find the charts that the UVs [F, 3, 2] of all corners make."""
    present = surfaces.uv_faces[:, 0] >= 0
    rows = np.column_stack([np.repeat(surfaces.face_material, 3), surfaces.faces.ravel(), corners.reshape(-1, 2)])
    positions, nodes = surfaces.vertices[surfaces.faces], _numbered(rows)
    charts = find_charts(nodes, corners)
    far_off = distorted(corners, positions, charts)
    return _Source(
        surfaces=surfaces,
        positions=positions,
        corners=corners,
        present=present,
        nodes=nodes,
        charts=charts,
        distorted=far_off,
        starved=starved(corners, positions, nodes, charts=charts, distorted=far_off) | ~present,
    )


def _with_distorted(
    source: _Source,
    anew: Array,  # [F] bool, faces whose UVs are of no use
) -> Array:
    """These faces [F] bool and those of charts that are distorted, charts that lost faces as they are without them."""
    rest = np.isin(source.charts, source.charts[anew]) & ~anew
    found = anew | source.distorted
    found[rest] = distorted(source.corners[rest], source.positions[rest], source.charts[rest])
    return np.asarray(found)


def _keep(source: _Source) -> _Layout:
    """The artist's layout: charts moved by whole tiles into their texture, several textures side by side."""
    materials, face_material = source.surfaces.materials, source.surfaces.face_material
    repeats = np.array([(m.wrap_u == "repeat", m.wrap_v == "repeat") for m in materials])
    low = _per_chart(np.minimum, source.corners.min(axis=1), source.charts)
    corners = source.corners - (np.floor(low + BORDER)[source.charts] * repeats[face_material])[:, None]
    beyond = ((corners < -BORDER) | (corners > 1 + BORDER)).any(axis=(1, 2))
    anew = ~source.present | _per_chart(np.logical_or, beyond, source.charts)[source.charts]
    if len(np.unique(face_material)) == 1 and not anew.any():
        return _Layout(corners, as_is=True)
    sheet = np.where(anew, len(materials), face_material)
    corners[anew] = _cut(source, anew) if anew.any() else 0
    return _Layout(_side_by_side(corners, sheet, areas(source.positions)), as_is=False)


def _trouble(source: _Source, layout: _Layout) -> str | None:
    """What a layout loses, as the end of a sentence; None where it loses little."""
    if not source.present.all():
        return f"{np.count_nonzero(~source.present):,} of its {len(source.present):,} triangles have no UVs"
    owner, claims = cover(layout.corners * JUDGED_SIZE, JUDGED_SIZE)
    valid, twice = np.count_nonzero(owner >= 0), np.count_nonzero(claims > 1)
    if twice > LOSS_ALLOWED * valid:
        return f"{twice / valid:.0%} of its texels are claimed by more than one triangle"
    surface = areas(source.positions)
    short = surface[source.starved].sum() / surface.sum()
    return f"{short:.0%} of its surface has next to no texels" if short > LOSS_ALLOWED else None


def _lay_out(
    source: _Source,
    anew: Array,  # [F] bool, faces whose UVs are of no use
    detail: Detail,
    *,
    parts: Array,  # [F] into BODY_PARTS
    wanted: Future[Array],  # of wanted_fineness
) -> _Layout:
    """Keep the other faces' charts, cut these anew, and pack all of them at the scale of the surface and its detail."""
    surfaces = source.surfaces
    corners, charts, nodes = source.corners.copy(), source.charts.copy(), source.nodes.copy()
    if anew.any():
        corners[anew] = _cut(source, anew)
        rows = np.column_stack([surfaces.faces[anew].ravel(), corners[anew].reshape(-1, 2)])
        nodes[anew] = nodes.max() + 1 + _numbered(rows)
        charts[anew] = charts.max() + 1 + find_charts(nodes[anew], corners[anew])
    surface = areas(source.positions)
    finer, absent = factors(parts, surface, detail)
    cut, kept = len(np.unique(charts[anew])), len(np.unique(charts[~anew]))
    charts, finer = split_by_factor(nodes, corners, charts=charts, surface=surface, finer=finer)
    finer *= wanted.result()
    flat = redrawn(even(corners, source.positions, charts), charts, finer)
    return _Layout(pack(flat, charts), as_is=False, notes=(_note(anew, kept=kept, cut=cut), *absent))


def _parts(surfaces: Surfaces) -> Array:
    """The part of the body [F] of each face."""
    skin = surfaces.skin_indices, surfaces.skin_weights
    return body_parts(surfaces.skeleton, surfaces.faces, *skin, stated=surfaces.roles)


def _note(
    anew: Array,  # [F] bool
    *,
    kept: int,
    cut: int,
) -> str:
    """A sentence on what was done to the file's charts."""
    if not kept:
        return f"All {len(anew):,} triangles are cut into {cut} new UV charts."
    note = f"{kept} charts of the file's UV layout are kept, finer where more is seen"
    if not cut:
        return f"{note}."
    useless = f"{np.count_nonzero(anew):,} of {len(anew):,} triangles overlap, are distorted or have next to no texels"
    return f"{note}; {useless} and are cut into {cut} new charts."


def _cut(
    source: _Source,
    anew: Array,  # [F] bool
) -> Array:
    """New UVs [n, 3, 2] in the unit square, cut and flattened by xatlas, for the faces that need them."""
    vertices, faces, positions = source.surfaces.vertices, source.surfaces.faces[anew], source.positions[anew]
    size = np.sqrt(areas(positions).mean())  # xatlas drops what is smaller than 1e-7 square units: lashes
    blocks = _blocks(positions.mean(axis=1), np.arange(len(faces)))
    atlas = xatlas.Atlas()
    for block in blocks:
        kept, index = np.unique(faces[block], return_inverse=True)
        scaled = np.ldexp(vertices[kept], -np.frexp(size)[1]).astype(np.float32)
        atlas.add_mesh(scaled, index.reshape(-1, 3).astype(np.uint32))
    atlas.generate()
    flat = np.empty((len(faces), 3, 2))
    for number, block in enumerate(blocks):
        _, corners, uv = atlas.get_mesh(number)
        flat[block] = uv[corners].astype(np.float64) * (atlas.width, atlas.height)
    return flat / max(flat.max(), np.finfo(float).tiny)


def _blocks(
    centres: Array,  # [F, 3] of all triangles
    some: Array,  # [n] triangles
) -> list[Array]:
    """Some triangles halved across their longest side until no block has more than BLOCK."""
    if len(some) <= BLOCK:
        return [some]
    ordered = some[np.argsort(centres[some, np.argmax(np.ptp(centres[some], axis=0))], kind="stable")]
    return [block for half in np.array_split(ordered, 2) for block in _blocks(centres, half)]


def _side_by_side(
    corners: Array,  # [F, 3, 2] in 0..1
    sheet: Array,  # [F] the texture of each face
    surface: Array,  # [F] m2
) -> Array:
    """Place each texture as a square whose side is a power of 1/2, about as large as its surface: [F, 3, 2].

    Squares taken from large to small along a Z-order curve of the unit square fill it without gaps.
    """
    sheets, index = np.unique(sheet, return_inverse=True)
    share = np.bincount(index, surface) / max(surface.sum(), np.finfo(float).tiny)
    halvings = np.rint(-np.log2(np.maximum(share, 1e-4)) / 2).astype(int)
    while (0.25**halvings).sum() > 1:
        halvings += 1
    origins, taken = np.empty((len(sheets), 2)), 0.0
    for k in np.argsort(halvings, kind="stable"):
        steps = [int(taken * 4**level) % 4 for level in range(1, halvings[k] + 1)]
        origins[k] = sum(np.array([step % 2, step // 2]) * 0.5**level for level, step in enumerate(steps, 1))
        taken += 0.25 ** halvings[k]
    return corners * 0.5 ** halvings[index][:, None, None] + origins[index][:, None]


def _character(source: _Source, layout: _Layout, size: int) -> Character:
    """The character in its new texture space, with the image that belongs to it."""
    surfaces = source.surfaces
    uv, _, uv_faces = unique_rows(layout.corners.reshape(-1, 2))
    mesh = Mesh(
        vertices=surfaces.vertices, faces=surfaces.faces, uv=uv, uv_faces=uv_faces.reshape(-1, 3).astype(np.int32)
    )
    material = surfaces.materials[surfaces.face_material[0]]
    picture = material.image
    made = not layout.as_is or surfaces.corner_colors is not None or material.alpha_mode == "mask"
    if made or picture.shape[0] != picture.shape[1]:
        texels = build_texel_map(mesh, size)
        colors = surfaces.corner_colors
        picture = bake_texture(
            texels, source.corners, surfaces.face_material, materials=surfaces.materials, colors=colors
        )
    return Character(
        name=surfaces.name,
        skeleton=surfaces.skeleton,
        mesh=mesh,
        skin_indices=surfaces.skin_indices,
        skin_weights=surfaces.skin_weights,
        base_color=picture,
        clips=surfaces.clips,
        notes=surfaces.notes + layout.notes,
        source=surfaces.source,
        roles=surfaces.roles,
        expressions=surfaces.expressions,
    )


def _numbered(
    rows: Array,  # [3 F, k], one for each corner
) -> Array:
    """Equal rows as equal numbers: [F, 3] int."""
    return unique_rows(rows)[2].reshape(-1, 3)


def _per_chart(fold: np.ufunc, values: Array, charts: Array) -> Array:
    """Fold the faces' values [F, ...] into one for each chart [K, ...]."""
    order = np.argsort(charts, kind="stable")
    starts = np.searchsorted(charts[order], np.arange(charts.max() + 1))
    return fold.reduceat(values[order], starts)
