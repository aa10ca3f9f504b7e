"""Quads to images as a torch function, forward and backward by Warp on the CPU or on CUDA."""

# mypy: disable-error-code="no-untyped-call"
# (Warp's functions have no types)

import threading
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import Any, TypeVar

import torch
import warp as wp

from mua.splatting.projection import Eye, TorchSplats, colors_seen, half_extents, project
from mua.splatting.tiles import TILE, Tiles, assign, join, split
from mua.splatting.warp_passes import passes
from mua.training.threads import in_order

PARTS = 4  # of an image's tiles on the CPU, at most as many at once
T = TypeVar("T")

# Warp compiles and loads a kernel when it is first launched, which two threads must not do at once.
_FIRST = threading.Lock()
_LAUNCHED: set[tuple[Any, str]] = set()  # kernels and the devices that they are loaded on

REALS = {torch.float32: wp.float32, torch.float64: wp.float64}
BLOCKS = {"cpu": (2, 4), "cuda": (1, 1)}  # columns and rows of the pixels of a thread


def rasterise(
    splats: TorchSplats,
    eye: Eye,
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
    background: torch.Tensor | None = None,  # [3] or [H, W, 3] sRGB
    *,
    threads: int | None = None,  # that draw on the CPU, with gradients as well; None: as many as torch computes with
) -> torch.Tensor:
    """Premultiplied sRGB and alpha [H, W, 4], or sRGB [H, W, 3] over a background: what the reference renderer draws.

    It differs where the transmittance falls below 1e-5: nothing is blended there any more.
    """
    (image,) = rasterise_views(splats, [eye], bounds, threads=threads)
    return image if background is None else image[..., :3] + (1 - image[..., 3:]) * background


def rasterise_views(
    splats: TorchSplats,
    eyes: Sequence[Eye],
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
    *,
    threads: int | None = None,  # as of `rasterise`
) -> list[torch.Tensor]:
    """Premultiplied sRGB and alpha [H, W, 4] of several cameras, each of a size of its own, by one launch."""
    quads = [project(splats, eye, bounds) for eye in eyes]
    colors = [colors_seen(splats, one.splats, eye) for one, eye in zip(quads, eyes, strict=True)]
    shapes = [one.shapes for one in quads]
    return draw_quads(list(zip(shapes, colors, strict=True)), [eye.screen for eye in eyes], threads=threads)


def draw_quads(
    quads: Sequence[tuple[torch.Tensor, torch.Tensor]],  # shapes [M, 6] and colours [M, 3] of quads, front to back
    screens: Sequence[tuple[int, int]],  # width, height, pixels
    *,
    threads: int | None = None,  # as of `rasterise`
) -> list[torch.Tensor]:
    """Premultiplied colour and alpha [H, W, 4] of each screen."""
    shapes, colors = (torch.cat(parts) for parts in zip(*quads, strict=True))
    assigned = [_tiles(own.detach(), screen) for (own, _), screen in zip(quads, screens, strict=True)]
    images: torch.Tensor = _Draw.apply(
        shapes, colors, join(assigned, [len(own) for own, _ in quads]), threads or torch.get_num_threads()
    )
    parts = images.split([one.pixels for one in assigned])
    return [part.reshape(height, width, 4) for part, (width, height) in zip(parts, screens, strict=True)]


def largest_shares(
    splats: TorchSplats,
    eye: Eye,
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
    *,
    least: float = 0.0,  # of the shares that count
) -> torch.Tensor:
    """The largest share of any pixel's colour that each splat gives, [N] in 0..1; 0 where it is below `least`."""
    quads = project(splats, eye, bounds)
    shapes = quads.shapes.detach().contiguous()
    largest = shapes.new_zeros(len(shapes))
    _launch("weigh", _tiles(shapes, eye.screen), [shapes, largest], least)
    return torch.zeros_like(splats.opacities).index_copy(0, quads.splats, largest)


def _tiles(shapes: torch.Tensor, screen: tuple[int, int]) -> Tiles:
    return assign(shapes[:, :2], half_extents(shapes), screen)


class _Draw(torch.autograd.Function):
    @staticmethod
    def forward(context: Any, shapes: torch.Tensor, colors: torch.Tensor, tiles: Tiles, threads: int) -> torch.Tensor:
        shapes, colors = shapes.contiguous(), colors.contiguous()
        image, left = shapes.new_empty(tiles.pixels, 4), shapes.new_empty(tiles.pixels)
        ends = torch.empty(tiles.pixels, dtype=torch.int32, device=shapes.device)
        _by_parts(tiles, lambda part: _launch("forward", part, [shapes, colors, image, left, ends]), threads)
        context.save_for_backward(shapes, colors, left, ends)
        context.tiles, context.threads = tiles, threads
        return image

    @staticmethod
    def backward(context: Any, *gradients: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        shapes, colors, left, ends = context.saved_tensors
        gradient = gradients[0].contiguous()

        def added(part: Tiles) -> tuple[torch.Tensor, torch.Tensor]:
            by_shapes, by_colors = torch.zeros_like(shapes), torch.zeros_like(colors)
            _launch("backward", part, [shapes, colors, left, ends, gradient, by_shapes, by_colors])
            return by_shapes, by_colors

        shares = zip(*_by_parts(context.tiles, added, context.threads), strict=True)
        by_shapes, by_colors = (torch.stack(own).sum(dim=0) for own in shares)
        return by_shapes, by_colors, None, None


def _by_parts(tiles: Tiles, work: Callable[[Tiles], T], threads: int) -> list[T]:
    """Results of all tiles, or of parts of them side by side: on the CPU Warp computes in the thread that calls it.

    There are as many parts whatever the threads, so that results do not depend on them.
    """
    if tiles.quads.device.type != "cpu":
        return [work(tiles)]
    return list(in_order(work, split(tiles, PARTS), threads=min(threads, PARTS)))


def _launch(name: str, tiles: Tiles, tensors: list[torch.Tensor], *numbers: float) -> None:
    """A pass over the pixels of some tiles."""
    device, block = wp.device_from_torch(tensors[0].device), BLOCKS[tensors[0].device.type]
    kernel = getattr(passes(REALS[tensors[0].dtype], block), name)
    held = (tiles.places, tiles.starts, tiles.quads, *tensors)
    arrays = [wp.from_torch(tensor, requires_grad=False) for tensor in held]
    stream = wp.stream_from_torch(tensors[0].device) if device.is_cuda else None
    dim = len(tiles.places) * TILE * TILE // (block[0] * block[1])
    with nullcontext() if (kernel, device.alias) in _LAUNCHED else _FIRST:
        wp.launch(kernel, dim=dim, inputs=[*arrays, *numbers], device=device, stream=stream)
        _LAUNCHED.add((kernel, device.alias))
