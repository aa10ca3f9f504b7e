"""Which quads each tile of the screen draws, front to back: what both passes of the rasteriser read."""

from dataclasses import dataclass

import torch

TILE = 16  # pixels along a side


@dataclass(frozen=True, eq=False)
class Tiles:
    """The quads of every tile, row by row of tiles; P pairs of a tile and a quad."""

    columns: int
    rows: int
    starts: torch.Tensor  # [columns rows + 1] int32 into `quads`
    quads: torch.Tensor  # [P] int32, ascending within a tile


def assign(
    middle: torch.Tensor,  # [M, 2] pixels
    extent: torch.Tensor,  # [M, 2] half width and height of the box around each quad, pixels
    screen: tuple[int, int],  # width, height, pixels
) -> Tiles:
    """Tiles of the quads, given front to back."""
    columns, rows = (-(-side // TILE) for side in screen)
    limit = torch.tensor(screen, device=middle.device)
    # The first and the last pixel whose centre the box holds.
    first = (middle - extent - 0.5).ceil().clamp(min=0).long()
    last = torch.minimum((middle + extent - 0.5).floor().long(), limit - 1)
    low, size = first // TILE, (last // TILE - first // TILE + 1) * (last >= first).all(dim=1, keepdim=True)
    count = size.prod(dim=1)
    quads = torch.repeat_interleave(count)
    within = torch.arange(len(quads), device=middle.device) - (count.cumsum(0) - count)[quads]
    row, column = low[quads, 1] + within // size[quads, 0], low[quads, 0] + within % size[quads, 0]
    by_tile = torch.sort(row * columns + column, stable=True)
    counts = torch.bincount(by_tile.values, minlength=columns * rows)
    starts = torch.cat([counts.new_zeros(1), counts.cumsum(0)])
    return Tiles(columns, rows, starts.int(), quads[by_tile.indices].int())
