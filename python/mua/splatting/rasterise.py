"""Quads to an image as a torch function, forward and backward by Warp on the CPU or on CUDA."""

# mypy: disable-error-code="no-untyped-call"
# (Warp's functions have no types)

from typing import Any

import torch
import warp as wp

from mua.splatting.kernels import passes
from mua.splatting.projection import Eye, TorchSplats, half_extents, project
from mua.splatting.tiles import TILE, Tiles, assign

REALS = {torch.float32: wp.float32, torch.float64: wp.float64}


def rasterise(
    splats: TorchSplats,
    eye: Eye,
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
    background: torch.Tensor | None = None,  # [3] or [H, W, 3] sRGB
) -> torch.Tensor:
    """Premultiplied sRGB and alpha [H, W, 4], or sRGB [H, W, 3] over a background: what the reference renderer draws.

    It differs where the transmittance falls below 1e-5: nothing is blended there any more.
    """
    quads = project(splats, eye, bounds)
    image = draw_quads(quads.shapes, quads.colors, eye.screen)
    return image if background is None else image[..., :3] + (1 - image[..., 3:]) * background


def draw_quads(
    shapes: torch.Tensor,  # [M, 6] of mua.splatting.projection.Quads, front to back
    colors: torch.Tensor,  # [M, 3]
    screen: tuple[int, int],  # width, height, pixels
) -> torch.Tensor:
    """Premultiplied colour and alpha [H, W, 4]."""
    shape = shapes.detach()
    tiles = assign(shape[:, :2], half_extents(shape), screen)
    width, height = screen
    image: torch.Tensor = _Draw.apply(shapes, colors, tiles, screen)
    return image.reshape(height, width, 4)


def largest_shares(
    splats: TorchSplats,
    eye: Eye,
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
) -> torch.Tensor:
    """The largest share of any pixel's colour that each splat gives, [N] in 0..1; 0 of those out of the picture."""
    quads = project(splats, eye, bounds)
    shapes = quads.shapes.detach().contiguous()
    tiles = assign(shapes[:, :2], half_extents(shapes), eye.screen)
    largest = shapes.new_zeros(len(shapes))
    _launch(passes(REALS[shapes.dtype]).weigh, tiles, eye.screen, [shapes, largest])
    return torch.zeros_like(splats.opacities).index_copy(0, quads.splats, largest)


class _Draw(torch.autograd.Function):
    @staticmethod
    def forward(
        context: Any, shapes: torch.Tensor, colors: torch.Tensor, tiles: Tiles, screen: tuple[int, int]
    ) -> torch.Tensor:
        pixels = screen[0] * screen[1]
        shapes, colors = shapes.contiguous(), colors.contiguous()
        image, left = shapes.new_empty(pixels, 4), shapes.new_empty(pixels)
        ends = torch.empty(pixels, dtype=torch.int32, device=shapes.device)
        kernels = passes(REALS[shapes.dtype])
        _launch(kernels.forward, tiles, screen, [shapes, colors, image, left, ends])
        context.save_for_backward(shapes, colors, left, ends)
        context.tiles, context.screen = tiles, screen
        return image

    @staticmethod
    def backward(context: Any, *gradients: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        shapes, colors, left, ends = context.saved_tensors
        by_shapes, by_colors = torch.zeros_like(shapes), torch.zeros_like(colors)
        kernels = passes(REALS[shapes.dtype])
        tensors = [shapes, colors, left, ends, gradients[0].contiguous(), by_shapes, by_colors]
        _launch(kernels.backward, context.tiles, context.screen, tensors)
        return by_shapes, by_colors, None, None


def _launch(kernel: Any, tiles: Tiles, screen: tuple[int, int], tensors: list[torch.Tensor]) -> None:
    """A thread for each pixel of each tile."""
    device = wp.device_from_torch(tensors[0].device)
    arrays = [wp.from_torch(tensor, requires_grad=False) for tensor in (tiles.starts, tiles.quads, *tensors)]
    stream = wp.stream_from_torch(tensors[0].device) if device.is_cuda else None
    threads = tiles.columns * tiles.rows * TILE * TILE
    wp.launch(kernel, dim=threads, inputs=[tiles.columns, *screen, *arrays], device=device, stream=stream)
