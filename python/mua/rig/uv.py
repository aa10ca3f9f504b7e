"""One texture space for all materials of a character: artists' charts kept, moved apart or cut anew."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from mua.arrays import Array
from mua.rig.assemble import Surfaces
from mua.rig.bake_texture import bake_texture
from mua.rig.character import Character, Mesh
from mua.rig.charts import areas, find_charts, isometric, overlapping, pack, starved, unwrap
from mua.rig.texel_map import build_texel_map, cover

UvMode: TypeAlias = Literal["keep", "unwrap", "auto"]

JUDGED_SIZE = 512  # texels along the map in which overlap is counted
LOSS_ALLOWED = 0.02  # share of texels claimed twice, or of surface with next to no texels
EMPHASIS = 2.0  # charts that their artist made finer or coarser stay so, up to this factor of length
BORDER = 1e-3  # a UV this far beyond the texture counts as inside


@dataclass(frozen=True)
class _Source:
    """The surface with the UVs that its file gave it."""

    surfaces: Surfaces
    positions: Array  # [F, 3, 3] metres
    corners: Array  # [F, 3, 2] raw UV, 0 where there are none
    present: Array  # [F] bool, there are some
    charts: Array  # [F]
    starved: Array  # [F] bool, has next to no texels for its surface, or none


@dataclass(frozen=True)
class _Layout:
    """Where each face lies in the atlas."""

    corners: Array  # [F, 3, 2]
    as_is: bool  # the atlas is the only material's own texture
    notes: tuple[str, ...] = ()


def build_atlas(surfaces: Surfaces, *, uv: UvMode, size: int) -> Character:
    """Give a character one UV layout and one picture for all its materials.

    `keep` leaves every chart where its artist put it, several materials side by side as whole squares; `unwrap` cuts
    everything anew with xatlas; `auto` keeps the only texture's layout unless more than 2 % of the valid texels are
    claimed twice or the surface has next to no texels; else it moves the artist's charts apart and cuts anew only what
    overlaps itself or is starved of texels.

    The picture is `size` x `size`, or the only material's own where that is square and its layout is kept.
    """
    source = _read(surfaces)
    if uv == "unwrap":
        layout = _lay_out(source, np.ones(len(surfaces.faces), bool), "it was asked for")
    else:
        layout = _keep(source)
        trouble = _trouble(source, layout)
        if uv == "auto" and (trouble or not layout.as_is):
            wound = overlapping(source.corners, source.charts)[source.charts] > LOSS_ALLOWED
            layout = _lay_out(source, wound | source.starved, trouble or "its materials have a texture each")
        elif trouble:
            layout = _Layout(layout.corners, layout.as_is, (f"The UV layout was kept although {trouble}.",))
    return _character(source, layout, size)


def _read(surfaces: Surfaces) -> _Source:
    """Look up the UVs of all corners and find the charts that they make."""
    present = surfaces.uv_faces[:, 0] >= 0
    corners = np.zeros((len(surfaces.faces), 3, 2))
    corners[present] = surfaces.uv[surfaces.uv_faces[present]]
    rows = np.column_stack([np.repeat(surfaces.face_material, 3), surfaces.faces.ravel(), corners.reshape(-1, 2)])
    positions, nodes = surfaces.vertices[surfaces.faces], _numbered(rows)
    charts = find_charts(nodes, corners)
    return _Source(
        surfaces=surfaces,
        positions=positions,
        corners=corners,
        present=present,
        charts=charts,
        starved=starved(corners, positions, nodes, charts=charts) | ~present,
    )


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
    """What a layout loses, as the end of a sentence; None where that is little."""
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
    because: str,
) -> _Layout:
    """Keep the other faces' charts, cut these anew, and pack all of them at the scale of the surface."""
    corners, charts = source.corners.copy(), source.charts.copy()
    if anew.any():
        corners[anew] = _cut(source, anew)
        rows = np.column_stack([source.surfaces.faces[anew].ravel(), corners[anew].reshape(-1, 2)])
        charts[anew] = charts.max() + 1 + find_charts(_numbered(rows), corners[anew])
    charts = np.unique(charts, return_inverse=True)[1]
    total = charts.max() + 1
    emphasis = (np.bincount(charts, _emphasis(source)) / np.bincount(charts))[charts, None, None]
    flat = isometric(corners, source.positions, charts) * emphasis
    cut = len(np.unique(charts[anew]))
    note = (
        f"The UV layout was made anew because {because}: {total - cut} charts of the file are kept but moved, and "
        f"{np.count_nonzero(anew):,} of {len(anew):,} triangles are cut into {cut} new charts."
    )
    return _Layout(pack(flat, charts), as_is=False, notes=(note,))


def _emphasis(source: _Source) -> Array:
    """How much finer in length [F] each face's chart is drawn than its material on average, within bounds."""
    drawn, surface = areas(source.corners), areas(isometric(source.corners, source.positions, source.charts))
    finer = np.ones(len(drawn))
    for group, power in ((source.charts, 0.5), (source.surfaces.face_material, -0.5)):
        area, there = np.bincount(group, drawn)[group], np.bincount(group, surface)[group]
        finer *= np.divide(area, there, out=np.ones(len(drawn)), where=(area > 0) & (there > 0)) ** power
    return np.clip(np.where(drawn > 0, finer, 1.0), 1 / EMPHASIS, EMPHASIS)


def _cut(
    source: _Source,
    anew: Array,  # [F] bool
) -> Array:
    """New UVs [n, 3, 2] in the unit square for the faces that need them."""
    flat = unwrap(source.surfaces.vertices, source.surfaces.faces[anew])
    return flat / max(flat.max(), np.finfo(float).tiny)


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
    """The character in its new texture space, with the picture that belongs to it."""
    surfaces = source.surfaces
    uv, uv_faces = np.unique(layout.corners.reshape(-1, 2), axis=0, return_inverse=True)
    mesh = Mesh(
        vertices=surfaces.vertices, faces=surfaces.faces, uv=uv, uv_faces=uv_faces.reshape(-1, 3).astype(np.int32)
    )
    picture = surfaces.materials[surfaces.face_material[0]].image
    if not layout.as_is or picture.shape[0] != picture.shape[1]:
        texels = build_texel_map(mesh, size)
        picture = bake_texture(texels, source.corners, surfaces.face_material, materials=surfaces.materials)
    return Character(
        name=surfaces.name,
        skeleton=surfaces.skeleton,
        mesh=mesh,
        skin_indices=surfaces.skin_indices,
        skin_weights=surfaces.skin_weights,
        base_color=picture,
        clips=surfaces.clips,
        notes=surfaces.notes + layout.notes,
    )


def _numbered(
    rows: Array,  # [3 F, k], one for each corner
) -> Array:
    """Equal rows as equal numbers: [F, 3] int."""
    return np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1, 3)


def _per_chart(fold: np.ufunc, values: Array, charts: Array) -> Array:
    """Fold the faces' values [F, ...] into one for each chart [K, ...]."""
    order = np.argsort(charts, kind="stable")
    starts = np.searchsorted(charts[order], np.arange(charts.max() + 1))
    return fold.reduceat(values[order], starts)
