"""Images by gsplat's CUDA kernels (https://docs.gsplat.studio), as an alternative to mua.splatting.rasterise."""

from collections.abc import Sequence

import torch

from mua.splatting.projection import Eye, TorchSplats, colors_seen

PIXEL_VARIANCE = 1 / 12  # px^2, the variance of a pixel's square; gsplat's own 0.3 would blur more than the player does
TO_OPENCV = (1.0, -1.0, -1.0)  # its cameras look along +Z, Y down


def gsplat_views(
    splats: TorchSplats,  # on CUDA
    eyes: Sequence[Eye],
) -> list[torch.Tensor]:
    """Premultiplied sRGB and alpha [H, W, 4] of several cameras, each of a size of its own.

    Gaussians are sampled at the middle of a pixel, with the opacity that keeps their integral, and end where alpha
    falls to 1/255. Our rasteriser integrates a window over the pixel, as the player does. One-sided splats are drawn
    from both sides.
    """
    return [_view(splats, eye) for eye in eyes]


def intrinsics(
    eye: Eye,
) -> torch.Tensor:
    """OpenCV's matrix [3, 3] of a camera, pixels; the first pixel's centre is at (0.5, 0.5)."""
    width, height = eye.screen
    (fx, _, skew_x), (_, fy, skew_y) = eye.projection[:2, :3]
    zero, one = torch.zeros_like(fx), torch.ones_like(fx)
    rows = [
        [fx * width / 2, zero, (1 - skew_x) * width / 2],
        [zero, fy * height / 2, (1 + skew_y) * height / 2],
        [zero, zero, one],
    ]
    return torch.stack([torch.stack(row) for row in rows])


def _view(splats: TorchSplats, eye: Eye) -> torch.Tensor:
    from gsplat import rasterization  # a package of its own, which compiles CUDA when it is loaded first

    every = torch.arange(len(splats.centres), device=splats.centres.device)
    flip = torch.diag(eye.view.new_tensor([*TO_OPENCV, 1.0]))
    width, height = eye.screen
    colors, alphas, _ = rasterization(
        splats.centres,
        splats.rotations,
        splats.scales,
        splats.opacities,
        colors_seen(splats, every, eye),
        (flip @ eye.view)[None],
        intrinsics(eye)[None],
        width,
        height,
        near_plane=float(eye.projection.detach()[2, 3] / -2),
        eps2d=PIXEL_VARIANCE,
        rasterize_mode="antialiased",
    )
    return torch.cat([colors[0], alphas[0]], dim=-1)
