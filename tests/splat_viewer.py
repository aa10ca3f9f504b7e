"""Another program's view of exported splats: plyfile reads them, and 3D Gaussian Splatting as published draws them.

Written from the paper (Kerbl et al. 2023, https://doi.org/10.1145/3592433) and, for `antialiased`, Mip-Splatting
(Yu et al. 2024, https://arxiv.org/abs/2311.16493); it shares no code with mua.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import gaussforge
import numpy as np
import plyfile

from mua.camera import Camera

Array = np.ndarray
DILATION = 0.3  # square pixels, of the published renderers
END = 2.015  # standard deviations
C0, C1 = 0.28209479177387814, 0.4886025119029199


@dataclass(frozen=True, eq=False)
class Read:
    """N splats, float64, as a file has them."""

    centres: Array  # [N, 3]
    log_scales: Array  # [N, 3]
    wxyz: Array  # [N, 4]
    logits: Array  # [N]
    constant: Array  # [N, 3 rgb]
    linear: Array  # [N, 3 coefficients, 3 rgb]

    def colors(self, direction: Array) -> Array:
        """Colours [N, 3] in unit directions [N, 3] from the camera."""
        x, y, z = direction.T[:, :, None]
        first, second, third = self.linear.swapaxes(0, 1)
        return np.maximum(0.5 + C0 * self.constant + C1 * (-y * first + z * second - x * third), 0)

    def covariances(self) -> Array:
        """[N, 3, 3]."""
        axes = matrices(self.wxyz) * np.exp(self.log_scales)[:, None]
        return axes @ axes.swapaxes(1, 2)


def matrices(wxyz: Array) -> Array:
    """Rotation matrices [N, 3, 3]; the quaternions need not be unit."""
    w, x, y, z = (wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True)).T
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)


def read_ply(path: Path) -> Read:
    """By plyfile, names as 3D Gaussian Splatting gave them."""
    vertex = plyfile.PlyData.read(str(path))["vertex"]

    def columns(*names: str) -> Array:
        return np.stack([np.asarray(vertex[name], float) for name in names], axis=1)

    rest = columns(*(f"f_rest_{k}" for k in range(9))).reshape(-1, 3, 3)  # channel, coefficient
    return Read(
        columns("x", "y", "z"),
        columns("scale_0", "scale_1", "scale_2"),
        columns("rot_0", "rot_1", "rot_2", "rot_3"),
        columns("opacity")[:, 0],
        columns("f_dc_0", "f_dc_1", "f_dc_2"),
        rest.swapaxes(1, 2),
    )


def read_by_gaussforge(path: Path, kind: str) -> Read:
    """By a converter that has Niantic's own library for .spz; kinds are ply, compressed.ply and spz."""
    found = gaussforge.GaussForge().read(path.read_bytes(), kind)
    assert "error" not in found, found["error"]
    data = found["data"]

    def values(name: str) -> Array:
        return np.frombuffer(data[name], np.float32).astype(float).reshape(data["numPoints"], -1)

    return Read(
        values("positions"),
        values("scales"),
        values("rotations"),
        values("alphas")[:, 0],
        values("colors"),
        values("sh").reshape(-1, 3, 3),
    )


def gaussian(u: Array, v: Array) -> Array:
    """What is left of a splat, as published; u and v are in standard deviations, of the screen's axes."""
    return np.exp(-(u * u + v * v) / 2)


def window(u: Array, v: Array) -> Array:
    """What our players draw instead: a parabola along either that ends at END, with the same integral."""
    along_u, along_v = (np.maximum(1 - (along / END) ** 2, 0) for along in (u, v))
    return 9 * np.pi / (8 * END**2) * along_u * along_v


def draw(
    splats: Read,
    camera: Camera,
    *,
    dilation: float = DILATION,
    antialiased: bool = True,
    profile: Callable[[Array, Array], Array] = gaussian,
) -> Array:
    """Premultiplied sRGB and alpha [H, W, 4]; `antialiased` keeps a splat's sum over the pixels, dilated or not."""
    width, height = camera.screen
    focal = camera.projection[[0, 1], [0, 1]] * np.array([width, height]) / 2
    turn, move = camera.view[:3, :3], camera.view[:3, 3]
    eye = splats.centres @ turn.T + move
    depth = -eye[:, 2]
    middle = np.array([width, height]) / 2 + focal * [1, -1] * eye[:, :2] / depth[:, None]
    slopes = np.zeros((len(depth), 2, 3))  # of the pixel with the place in eye space
    slopes[:, 0, 0], slopes[:, 0, 2] = focal[0] / depth, focal[0] * eye[:, 0] / depth**2
    slopes[:, 1, 1], slopes[:, 1, 2] = -focal[1] / depth, -focal[1] * eye[:, 1] / depth**2
    seen, axes = np.linalg.eigh(slopes @ turn @ splats.covariances() @ (slopes @ turn).swapaxes(1, 2))
    wide = seen + dilation
    share = np.sqrt(np.prod(np.maximum(seen, 0) / wide, axis=1)) if antialiased else np.ones(len(depth))
    opacity = share / (1 + np.exp(-splats.logits))
    away = splats.centres - camera.position
    color = splats.colors(away / np.linalg.norm(away, axis=1, keepdims=True))
    image, left = np.zeros((height, width, 4)), np.ones((height, width))
    reach = 3 * np.sqrt(wide[:, 1])
    for k in np.argsort(depth, kind="stable"):
        low = np.clip(np.floor(middle[k] - reach[k]), 0, camera.screen).astype(int)
        high = np.clip(np.ceil(middle[k] + reach[k]), 0, camera.screen).astype(int)
        if depth[k] < camera.near or (low >= high).any():
            continue
        x, y = np.meshgrid(*(np.arange(a, b) + 0.5 - m for a, b, m in zip(low, high, middle[k], strict=True)))
        (ux, uy), (vx, vy) = axes[k] / np.sqrt(wide[k]) @ axes[k].T
        alpha = np.minimum(opacity[k] * profile(ux * x + uy * y, vx * x + vy * y), 0.99)
        alpha[alpha < 1 / 255] = 0
        box = np.s_[low[1] : high[1], low[0] : high[0]]
        image[box] += (left[box] * alpha)[..., None] * np.append(color[k], 1)
        left[box] *= 1 - alpha
    return image


def decibels(a: Array, b: Array) -> float:
    """Peak signal-to-noise ratio of images in 0..1."""
    return float(-10 * np.log10(np.mean((a - b) ** 2)))
