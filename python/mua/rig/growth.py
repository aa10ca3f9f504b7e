"""How large expressions make the triangles of a surface: a lid that closes, a mouth that opens."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from mua.arrays import Array
from mua.rig.charts import areas
from mua.rig.expressions import Expressions


def moved_areas(
    expressions: Expressions,
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Iterator[tuple[Array, Array]]:
    """For each expression, the triangles [n] that it moves and their areas [n] at its whole weight."""
    for start, stop in pairwise(expressions.starts):
        at = expressions.vertices[start:stop]
        places, touched = vertices.copy(), np.zeros(len(vertices), bool)
        places[at] += expressions.offsets[start:stop]
        touched[at] = True
        rows = np.flatnonzero(touched[faces].any(axis=1))
        yield rows, areas(places[faces[rows]])


def largest_areas(
    expressions: Expressions | None,
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Array:
    """The area [F] of each triangle in the expression that makes it largest, or at rest."""
    largest = areas(vertices[faces])
    for rows, area in moved_areas(expressions, vertices, faces) if expressions is not None else ():
        largest[rows] = np.maximum(largest[rows], area)
    return largest
