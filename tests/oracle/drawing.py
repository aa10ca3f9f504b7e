"""How a camera sees splats: section 7."""

from dataclasses import dataclass

import numpy as np
from oracle.file import Array
from oracle.quaternions import rotate
from oracle.splats import Splats

REACH = 2.015  # h of 7.2


@dataclass(frozen=True)
class Camera:
    view: Array  # [4, 4] world to eye
    projection: Array  # [4, 4]
    near: float  # metres
    screen: tuple[int, int]  # width, height

    def eye(self) -> Array:
        """Its place in the world [3]."""
        return np.linalg.inv(self.view)[:3, 3]

    def depths(self, points: Array) -> Array:
        """7.3"""
        return -(points @ self.view[2, :3] + self.view[2, 3])


def ellipses(splats: Splats, camera: Camera) -> tuple[Array, Array, Array]:
    """7.1: centres [N, 2], squared deviations [N, 2] and their axes [N, 2, 2], the columns; pixels."""
    focal, shift, half = np.diag(camera.projection)[:2], camera.projection[:2, 2], np.array(camera.screen) / 2
    e = splats.centres @ camera.view[:3, :3].T + camera.view[:3, 3]
    z = np.maximum(-e[:, 2:], camera.near)
    ndc = focal * e[:, :2] / z - shift
    slope = (np.clip(ndc, -1.3, 1.3) + shift) / focal
    rows = camera.view[:2, :3] + slope[..., None] * camera.view[2, :3]
    jacobian = (half * focal * [1, -1] / z)[..., None] * rows
    matrix = np.stack([rotate(splats.rotations, axis) for axis in np.eye(3)], axis=-1)
    spread = jacobian @ (matrix * splats.scales[:, None, :])
    values, axes = np.linalg.eigh(spread @ spread.swapaxes(1, 2))
    return (1 + ndc * [1, -1]) * half, np.maximum(values, 1e-4), axes


def behind(splats: Splats, camera: Camera) -> Array:
    """7.2: which one-sided texels [N] the eye sees from behind."""
    a, b, c = splats.canonical[splats.texels.corners].swapaxes(0, 1)
    n, ray = rotate(splats.motions[:, :4], np.cross(b - a, c - a)), splats.centres - camera.eye()
    most = 0.25 * np.linalg.norm(n, axis=-1) * np.linalg.norm(ray, axis=-1)
    return splats.texels.one_sided & (np.sum(n * ray, axis=-1) > most)


def keys(splats: Splats, camera: Camera) -> Array:
    """7.3: [N], of one avatar and one eye."""
    box, s = splats.box, np.linalg.norm(splats.box[1] - splats.box[0]) / 2
    corners = camera.depths(np.stack(np.meshgrid(*box.T), axis=-1).reshape(-1, 3))
    farthest, nearest = corners.max() + s, max(corners.min() - s, camera.near)
    share = (farthest - camera.depths(splats.centres)) / max(farthest - nearest, 1e-30)
    return np.floor(65534 * np.clip(share, 0, 1) + 0.5)


def draw(splats: Splats, camera: Camera, image: Array) -> Array:
    """7.2 and 7.3: splats over an image [height, width, 3]."""
    centres, variances, axes = ellipses(splats, camera)
    colours, opacities = splats.colours(camera.eye()), splats.opacities
    pixels = np.stack(np.meshgrid(*(np.arange(side) + 0.5 for side in camera.screen)), axis=-1)
    shown = (opacities >= 1 / 255) & (camera.depths(splats.centres) > camera.near) & ~behind(splats, camera)
    for n in np.argsort(keys(splats, camera), kind="stable"):
        if shown[n]:
            wide = np.sqrt(variances[n] + 5 / (12 * REACH**2))
            share = 9 * np.pi / (8 * REACH**2) * np.sqrt(variances[n].prod()) / wide.prod()
            uv = (pixels - centres[n]) @ (axes[n] / (REACH * wide)) @ axes[n].T
            alpha = opacities[n] * share * np.maximum(1 - uv**2, 0).prod(axis=-1, keepdims=True)
            image = colours[n] * alpha + image * (1 - alpha)
    return image
