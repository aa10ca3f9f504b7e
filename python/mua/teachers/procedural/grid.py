"""Parts of a figure as grids of points, each with its own rectangle of the atlas, and their welding into one mesh."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.interpolate import PchipInterpolator

from mua.arrays import Array
from mua.rig.character import Mesh

GRID = (
    192  # texels a side of the smallest texture: charts begin and end with whole texels, so that borders have no gaps
)
GUTTER = 1  # of these texels, half of the empty strip between two charts


Cell: TypeAlias = tuple[int, int, int, int]  # a rectangle of the atlas in texels of GRID


@dataclass(frozen=True, eq=False)
class Part:
    """A tube: rings from its upper to its lower end, columns counter-clockwise from above, seam at the back.

    Neighbouring parts are welded where their points coincide; so are the first and the last column.
    """

    name: str
    points: Array  # [R, C + 1, 3] metres, rings by columns, seen from outside as an image is read
    cell: Cell  # left, top, right, bottom in the atlas, gutter included
    rows: Array  # [R] 0..1 where the rings lie along the chart
    looseness: Array  # [R, C + 1]
    weights: Array  # [R, C + 1, J]
    hole: Array | None = None  # [R - 1, C] quads left out

    @property
    def chart(self) -> tuple[float, float, float, float]:
        """The cell without its gutter, in UV."""
        left, top, right, bottom = self.cell
        return (left + GUTTER) / GRID, (top + GUTTER) / GRID, (right - GUTTER) / GRID, (bottom - GUTTER) / GRID


def below(cell: Cell) -> Cell:
    """The cell of equal size under another one in the atlas."""
    left, top, right, bottom = cell
    return left, bottom, right, 2 * bottom - top


def spline(keys: Array, at: Array) -> Array:
    """Interpolate rows of `keys` [K, 1 + n] (position first, ascending) at positions [...], without overshoot."""
    return np.asarray(PchipInterpolator(keys[:, 0], keys[:, 1:])(at))


def smoothstep(low: float, high: float, x: Array) -> Array:
    """0 below `low`, 1 above `high`, smooth between; reversed where low > high."""
    t = np.clip((x - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))


def bump(x: Array, y: Array, wide: float, high: float) -> Array:
    """1 at the origin, falling softly to 0 over `wide` and `high`."""
    return np.asarray(np.exp(-((x / wide) ** 2) - (y / high) ** 2))


def angles(columns: int) -> Array:
    """[C + 1] angles from the back (-pi) over the right side, front (0) and left side to the back again."""
    return np.linspace(-np.pi, np.pi, columns + 1)


def close(points: Array) -> Array:
    """Make the last column of a grid [R, C + 1, 3] coincide with the first to the bit."""
    points[:, -1] = points[:, 0]
    return points


def mirrored(points: Array) -> Array:
    """The grid [R, C + 1, 3] mirrored to the other side of the body, still facing outward."""
    return np.asarray(points[:, ::-1] * np.array([-1.0, 1, 1]))


def rows_by_length(
    points: Array,  # [R, C + 1, 3]
    density: Array | float = 1.0,  # [R - 1] how much finer than elsewhere the texels between two rings shall be
) -> Array:
    """[R] chart positions of rings in proportion to their mean distance."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(axis=1) * density
    return np.concatenate([[0], np.cumsum(steps) / steps.sum()])


def _part_uv(part: Part) -> Array:
    u0, v0, u1, v1 = part.chart
    columns = np.linspace(u0, u1, part.points.shape[1])
    rows = v0 + (v1 - v0) * part.rows
    return np.stack(np.broadcast_arrays(columns[None, :], rows[:, None]), axis=-1).reshape(-1, 2)


def _part_faces(part: Part) -> Array:
    """Two triangles [F, 3] a quad, split along the shorter diagonal."""
    rings, columns = part.points.shape[:2]
    corner = np.arange(rings * columns).reshape(rings, columns)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], axis=-1)
    quads = quads[~part.hole] if part.hole is not None else quads.reshape(-1, 4)
    place = part.points.reshape(-1, 3)[quads]
    falling = np.linalg.norm(place[:, 0] - place[:, 2], axis=1) <= np.linalg.norm(place[:, 1] - place[:, 3], axis=1)
    split = np.where(falling[:, None], [[0, 1, 2, 0, 2, 3]], [[0, 1, 3, 1, 2, 3]])
    return np.take_along_axis(quads, split, axis=1).reshape(-1, 3)


def weld(parts: tuple[Part, ...]) -> tuple[Mesh, Array, Array]:
    """One mesh of all parts, with skin weights [V, J] and looseness [V] averaged where points coincide.

    Quads with coinciding corners (poles, rings of different counts) become the triangles that remain of them.
    """
    points = np.concatenate([part.points.reshape(-1, 3) for part in parts])
    sizes = [part.points.shape[0] * part.points.shape[1] for part in parts]
    starts = np.cumsum([0, *sizes[:-1]])
    uv_faces = np.concatenate([_part_faces(part) + start for part, start in zip(parts, starts, strict=True)])
    _, first, place = np.unique(points.round(7), axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # of appearance, so that neighbours stay near each other
    first, place = first[order], np.argsort(order)[place.reshape(-1)]
    faces = place[uv_faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces, uv_faces = faces[whole], uv_faces[whole]

    used, faces = np.unique(faces, return_inverse=True)
    used_uv, uv_faces = np.unique(uv_faces, return_inverse=True)
    mesh = Mesh(
        vertices=points[first[used]],
        faces=faces.reshape(-1, 3).astype(np.int32),
        uv=np.concatenate([_part_uv(part) for part in parts])[used_uv],
        uv_faces=uv_faces.reshape(-1, 3).astype(np.int32),
    )
    values = np.concatenate(
        [
            np.concatenate([part.weights, part.looseness[..., None]], axis=-1).reshape(size, -1)
            for part, size in zip(parts, sizes, strict=True)
        ]
    )
    sums = np.zeros((len(first), values.shape[1]))
    np.add.at(sums, place, values)
    means = (sums / np.bincount(place, minlength=len(first))[:, None])[used]
    return mesh, means[:, :-1], means[:, -1]
