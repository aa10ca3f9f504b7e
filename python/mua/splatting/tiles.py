"""Which quads each tile of some screens draws, front to back: what all passes of the rasteriser read."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import torch

TILE = 8  # pixels along a side: few splats of a tile miss any of its pixels


@dataclass(frozen=True, eq=False)
class Tiles:
    """The quads of every tile, screen by screen and row by row of tiles; T tiles, P pairs of a tile and a quad."""

    places: torch.Tensor  # [T, 5] int32: column and row of the first pixel; its screen's width, height, first pixel
    starts: torch.Tensor  # [T + 1] int32 into `quads`
    quads: torch.Tensor  # [P] int32, ascending within a tile
    pixels: int  # of all screens


def assign(
    middle: torch.Tensor,  # [M, 2] pixels
    extent: torch.Tensor,  # [M, 2] half width and height of the box around each quad, pixels
    screen: tuple[int, int],
) -> Tiles:
    """Tiles of the quads of one screen, given front to back."""
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
    return Tiles(_places(screen, middle.device), starts.int(), quads[by_tile.indices].int(), screen[0] * screen[1])


def join(
    tiles: Sequence[Tiles],
    counts: Sequence[int],  # quads of each
) -> Tiles:
    """Several screens as one call draws them: their quads, and their pixels, follow each other."""
    before = zip(
        accumulate([0, *(one.pixels for one in tiles)]),
        accumulate([0, *(len(one.quads) for one in tiles)]),
        accumulate([0, *counts]),
        strict=True,
    )
    places, starts, quads = [], [], []
    for one, (pixels, pairs, first) in zip(tiles, before, strict=False):
        places.append(one.places + one.places.new_tensor([0, 0, 0, 0, pixels]))
        starts.append(one.starts[:-1] + pairs)
        quads.append(one.quads + first)
    pairs = sum(len(one.quads) for one in tiles)
    starts.append(tiles[0].starts.new_tensor([pairs]))
    return Tiles(torch.cat(places), torch.cat(starts), torch.cat(quads), sum(one.pixels for one in tiles))


def split(
    tiles: Tiles,
    count: int,
) -> list[Tiles]:
    """The same tiles in parts of about as many pairs; quads and pixels are counted as in the whole."""
    work = tiles.starts + torch.arange(len(tiles.starts), device=tiles.starts.device)  # an empty tile takes time too
    wanted = torch.linspace(0, float(work[-1]), count + 1, device=work.device)
    ends = torch.searchsorted(work, wanted.round().to(work.dtype)).tolist()
    return [
        Tiles(tiles.places[low:high], tiles.starts[low : high + 1], tiles.quads, tiles.pixels)
        for low, high in pairwise(ends)
        if high > low
    ]


def _places(screen: tuple[int, int], device: torch.device) -> torch.Tensor:
    """Places [T, 5] of the tiles of one screen."""
    width, height = screen
    row, column = torch.meshgrid(torch.arange(0, height, TILE), torch.arange(0, width, TILE), indexing="ij")
    same = torch.tensor([width, height, 0]).expand(row.numel(), 3)
    return torch.cat([torch.stack([column.flatten(), row.flatten()], dim=1), same], dim=1).int().to(device)
