"""The grid on which charts are packed: where a shape fits, and where it lies closest to what is there."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.atlas.chart_shapes import GUTTER, Shape, grown
from mua.atlas.occupancy import Occupancy, beside, each_bit, first_bits, places

GRID = 512  # cells along the square that is meant to be filled
ROOM = 1.25  # cells along the whole grid, over those of the square
LEAST = 1 + 2 * GUTTER  # cells along the smallest chart with its gutters
NEAR = (2, 3, 5)  # cells from what is taken or from the border: within each of them a cell counts once more
FARTHEST = max(NEAR)
SAMPLES = 32  # cells of an outline that are looked at
MOST = 1000  # places that are compared for one way of a chart


@dataclass(frozen=True)
class Place:
    """Where a shape would lie."""

    reach: int  # cells along the square that holds it and all before it
    score: float  # how near its outline lies to what is taken
    shape: Shape
    row: int
    column: int

    @property
    def at(self) -> Array:
        """Column and row."""
        return np.array([self.column, self.row])


class PackingGrid:
    """The taken cells of the grid, and the side of the square around them."""

    def __init__(self, longest: int, count: int) -> None:
        """`longest` cells are the longest run of any shape; `count` of the smallest fit, however many these are."""
        self.reach = GRID
        self._side = int(ROOM * max(GRID, LEAST * np.sqrt(count)))
        self._taken = Occupancy(self._side, longest)
        self._near = np.zeros((self._side + 2 * FARTHEST,) * 2, np.uint8)  # FARTHEST cells wider on all sides
        for by in NEAR:
            self._near[FARTHEST : FARTHEST + by] += 1
            self._near[FARTHEST + by :, FARTHEST : FARTHEST + by] += 1

    def best(self, choice: Sequence[Shape]) -> Place | None:
        """The place and the way closest to what is taken or to the border, within the square so far if any fits."""
        for bound in (self.reach, self._side):
            found = [place for shape in choice if (place := self._closest(shape, bound))]
            if found:
                return max(found, key=lambda place: (-place.reach, place.score))
        return None

    def take(self, place: Place) -> None:
        """Lay a chart down."""
        solid = place.shape.solid
        self._taken.take(solid, place.row, place.column)
        wide = np.pad(solid, FARTHEST)
        around = np.sum([grown(wide, by) for by in NEAR], axis=0, dtype=np.uint8)
        under = self._near[place.row :, place.column :][: wide.shape[0], : wide.shape[1]]
        np.maximum(under, around, out=under)
        self.reach = place.reach

    def fill(self, box: tuple[int, ...], count: int) -> list[tuple[int, int]]:
        """Take as many boxes of this height and width, gutters included, row by row: the column and row of each."""
        height, width = box
        found: list[tuple[int, int]] = []
        for bound in (self.reach, self._side):
            if len(found) == count:
                break
            free = each_bit(self._free(Shape.box(height, width), bound))
            solid = np.zeros((self._side, self._side), bool)
            for row, column in zip(*(at.tolist() for at in np.nonzero(free)), strict=True):
                if len(found) == count:
                    break
                if free[row, column]:
                    down, right = row + height - GUTTER, column + width - GUTTER
                    free[row:down, max(column - width + GUTTER + 1, 0) : right] = False
                    solid[row + GUTTER : down, column + GUTTER : right] = True
                    found.append((column, row))
                    self.reach = max(self.reach, row + height, column + width)
            self._taken.take(solid, 0, 0)
        return found

    def _free(self, shape: Shape, bound: int) -> Array:
        """Places of a shape's first corner, as bits [rows, stride]: it hits nothing and stays within `bound` cells."""
        height, width = shape.mask.shape
        rows, columns = bound - height + 1, bound - width + 1
        if rows <= 0 or columns <= 0:
            return np.zeros((0, self._taken.stride), np.uint8)
        return ~self._taken.blocked(shape.runs, rows) & first_bits(self._taken.stride, columns)

    def _closest(self, shape: Shape, bound: int) -> Place | None:
        """The best place for one shape, None where it fits nowhere."""
        row, column = places(beside(self._free(shape, bound)))
        if not len(row):
            return None
        height, width = shape.mask.shape
        reach = np.maximum(np.maximum(row + height, column + width), self.reach)
        least = np.flatnonzero(reach == reach.min())
        least = least[:: -(-len(least) // MOST)]
        row, column = row[least], column[least]
        down, right = (at[:: -(-len(at) // SAMPLES)] for at in shape.outline)
        stride = len(self._near)
        looked_at = ((row + FARTHEST) * stride + column + FARTHEST)[:, None] + (down * stride + right)
        score = self._near.ravel()[looked_at].mean(axis=1)
        top = int(score.argmax())
        return Place(int(reach[least[0]]), float(score[top]), shape, int(row[top]), int(column[top]))
