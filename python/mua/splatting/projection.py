"""Splats to the screen of one camera in torch: the same ellipses, culling and order as mua.kernels.splat_project.

Gradients reach everything, the camera's matrices as well; which splats are seen, and their order, are taken as fixed.
"""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import torch

from mua.avatar.camera import Camera
from mua.avatar.decode import Splats
from mua.channels import SH_C0, SH_C1
from mua.kernels.splat_draw import WEIGHT
from mua.kernels.splat_project import AWAY, GUARD, LAST_KEY, LEAST_OPACITY, LEAST_VARIANCE, PIXEL_VARIANCE, REACH


@dataclass(frozen=True, eq=False)
class TorchSplats:
    """N posed splats as mua.avatar.decode.Splats holds them, in one dtype and on one device."""

    centres: torch.Tensor  # [N, 3] world, metres
    rotations: torch.Tensor  # [N, 4] world, wxyz, unit
    scales: torch.Tensor  # [N, 3] standard deviations, metres
    opacities: torch.Tensor  # [N] in 0..1
    sh: torch.Tensor  # [N, 12] degree 1, coefficient-major
    turns: torch.Tensor  # [N, 4] from the space of the SH to the world, unit
    normals: torch.Tensor | None = None  # [N, 3] of the triangles of one-sided texels, 0 of others; None: draw all

    @classmethod
    def of(
        cls, splats: Splats, dtype: torch.dtype = torch.float32, device: torch.device | str = "cpu"
    ) -> "TorchSplats":
        """The same splats as tensors."""
        given: dict[str, Any] = {one.name: getattr(splats, one.name, None) for one in fields(cls)}
        given["turns"] = splats.texel_dq[:, :4]
        held = {name: np.ascontiguousarray(values) for name, values in given.items() if values is not None}
        return cls(**{name: torch.as_tensor(values, dtype=dtype, device=device) for name, values in held.items()})


@dataclass(frozen=True, eq=False)
class Eye:
    """A camera as tensors."""

    view: torch.Tensor  # [4, 4] world to eye, metres
    projection: torch.Tensor  # [4, 4] eye to clip
    screen: tuple[int, int]  # width, height, pixels

    @classmethod
    def of(cls, camera: Camera, like: torch.Tensor) -> "Eye":
        """In the dtype and on the device of `like`."""
        view, projection = (torch.as_tensor(m).to(like) for m in (camera.view, camera.projection))
        return cls(view, projection, camera.screen)


@dataclass(frozen=True, eq=False)
class Quads:
    """The M splats that are seen, front to back."""

    splats: torch.Tensor  # [M] int64 into the splats
    shapes: torch.Tensor  # [M, 6] middle (column, row); uu, uv, vv from offset to (u, v) in the quad; peak of alpha


def project(
    splats: TorchSplats,
    eye: Eye,
    bounds: torch.Tensor,  # [2, 3] world box over which depth is keyed
) -> Quads:
    """The quads that the camera sees, front to back."""
    near = eye.projection.detach()[2, 3] / -2
    shapes, before = _shapes(splats, eye, near)
    with torch.no_grad():
        shown = before & _on_screen(shapes, eye.screen) & (splats.opacities >= LEAST_OPACITY)
        if splats.normals is not None:
            shown &= facing(splats.centres, splats.normals, eye.view) <= AWAY
        seen = torch.nonzero(shown)[:, 0]
        keys = _keys(splats.centres[seen], eye.view, near, bounds)
        chosen = seen[torch.sort(keys, stable=True).indices].flip(0)
    return Quads(chosen, shapes[chosen])


def half_extents(
    shapes: torch.Tensor,  # [M, 6]
) -> torch.Tensor:
    """Half width and height [M, 2] of the upright box around each quad, pixels."""
    uu, uv, vv = shapes[:, 2:5].unbind(1)
    size = torch.stack([vv.abs() + uv.abs(), uu.abs() + uv.abs()], dim=1)
    return size / (uu * vv - uv * uv)[:, None]


def facing(
    centres: torch.Tensor,  # [N, 3]
    normals: torch.Tensor,  # [N, 3] of any length
    view: torch.Tensor,  # [4, 4]
) -> torch.Tensor:
    """How far normals are turned away from an eye, [N]: -1 towards it, 1 away; 0 where there is no normal."""
    eye = centres @ view[:3, :3].T + view[:3, 3]
    lengths = (normals.norm(dim=1) * eye.norm(dim=1)).clamp(min=torch.finfo(centres.dtype).tiny)
    return ((normals @ view[:3, :3].T) * eye).sum(dim=1) / lengths


def _shapes(splats: TorchSplats, eye: Eye, near: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """[N, 6] of Quads, and whether each splat [N] lies beyond the near plane."""
    turn = eye.view[:3, :3]
    at = splats.centres @ turn.T + eye.view[:3, 3]
    depth = (-at[:, 2]).clamp(min=near)
    flip = torch.tensor([1.0, -1.0]).to(at)  # rows run down
    half = torch.tensor(eye.screen).to(at) / 2 * flip
    focal, skew = torch.diagonal(eye.projection)[:2], eye.projection[:2, 2]
    ndc = at[:, :2] / depth[:, None] * focal - skew
    slope = (ndc.clamp(-GUARD, GUARD) + skew) / focal
    jacobian = (half * focal / depth[:, None])[:, :, None] * (turn[:2] + slope[:, :, None] * turn[2])
    half_axes = jacobian @ (matrices(splats.rotations) * splats.scales[:, None, :])  # [N, 2, 3]
    covariance = half_axes @ half_axes.mT
    a, b, c = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    mean, stretch = (a + c) / 2, (a - c) / 2
    tiny = torch.finfo(at.dtype).tiny
    spread = (stretch**2 + b**2 + tiny).sqrt()
    variances = torch.stack([mean + spread, mean - spread], dim=1).clamp(min=LEAST_VARIANCE)
    wide = (variances + PIXEL_VARIANCE).sqrt()
    # The symmetric root of the wide covariance is total / 2 + turned (stretch, b; b, -stretch).
    total = wide.sum(dim=1)
    unclamped = mean - spread > LEAST_VARIANCE
    turned = torch.where(unclamped, 1.0, (variances[:, 0] - variances[:, 1]) / (2 * spread)) / total
    size = REACH * wide.prod(dim=1)
    inverse = torch.stack([total / 2 - turned * stretch, -turned * b, total / 2 + turned * stretch]) / size
    peak = WEIGHT * splats.opacities * (variances.prod(dim=1).sqrt() / wide.prod(dim=1))
    middle = (ndc * flip + 1) * half.abs()
    return torch.cat([middle, inverse.T, peak[:, None]], dim=1), -at[:, 2] > near


def matrices(quaternions: torch.Tensor) -> torch.Tensor:
    """Rotation matrices [..., 3, 3] of unit quaternions [..., 4]."""
    w, x, y, z = quaternions.unbind(-1)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return torch.stack([torch.stack(row, dim=-1) for row in rows], dim=-2)


def _on_screen(shapes: torch.Tensor, screen: tuple[int, int]) -> torch.Tensor:
    """Whether the box around each quad [N] reaches into the screen."""
    extent, middle = half_extents(shapes), shapes[:, 0:2]
    return ((middle + extent > 0) & (middle - extent < torch.tensor(screen).to(middle))).all(dim=1)


def _keys(centres: torch.Tensor, view: torch.Tensor, near: torch.Tensor, bounds: torch.Tensor) -> torch.Tensor:
    """Keys [M] int32, back to front, of mua.kernels.splat_project."""
    spare = (bounds[1] - bounds[0]).norm() / 2
    forward, offset = -view[2, :3], -view[2, 3]
    low, high = torch.sort(bounds * forward, dim=0).values
    nearest = torch.maximum(low.sum() + offset - spare, near)
    farthest = high.sum() + offset + spare
    span = (farthest - nearest).clamp(min=torch.finfo(centres.dtype).tiny)
    fraction = ((farthest - (centres @ forward + offset)) / span).clamp(0, 1)
    return (fraction * LAST_KEY + 0.5).floor().to(torch.int32)


def colors_seen(
    splats: TorchSplats,
    chosen: torch.Tensor,  # [M] int64 into the splats
    eye: Eye,
) -> torch.Tensor:
    """sRGB colours [M, 3], not below 0, of mua.kernels.splat_draw.splat_colors."""
    position = -eye.view[:3, :3].T @ eye.view[:3, 3]
    direction = torch.nn.functional.normalize(splats.centres[chosen] - position, dim=1)
    turned = (direction[:, None] @ matrices(splats.turns[chosen]))[:, 0]  # by the transpose: back
    x, y, z = turned[:, :, None].unbind(1)
    c0, c1, c2, c3 = splats.sh[chosen].reshape(-1, 4, 3).unbind(1)
    return (0.5 + SH_C0 * c0 + SH_C1 * (-y * c1 + z * c2 - x * c3)).clamp(min=0)
