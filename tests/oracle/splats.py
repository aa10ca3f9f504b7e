"""Sections 6 and 7 of schemas/README.md: splats in the world, their colours, and in which order a camera draws them."""

from dataclasses import dataclass

import numpy as np
from oracle.file import Array, Tree
from oracle.motion import Pose, bind_pose, bounded, components, descriptor, window, world
from oracle.texture import at_texels, canonical, halved, image, one_sided, places
from oracle.turning import TINY, apply, dual_product, product, rigid, rotate, star, unit

GEOMETRY = 11  # channels, of 5.4
C0, C1 = 0.28209479177387814, 0.4886025119029199


@dataclass(frozen=True)
class Splats:
    canonical: Array  # v [V, 3]
    joints: Array  # K [J, 8]
    vertices: Array  # [V, 8]
    texture: Array  # T [N, 23]
    dual: Array  # Q [N, 8]
    centres: Array  # [N, 3]
    rotations: Array  # [N, 4]
    scales: Array  # [N, 3]
    opacities: Array  # [N]
    root: Array  # P[root]

    def colours(self, camera: Array) -> Array:
        """6.6: [N, 3]"""
        x, y, z = rotate(star(self.dual[:, :4]), unit(self.centres - camera)).T[..., None]
        c0, c1, c2, c3 = np.moveaxis(self.texture[:, GEOMETRY:].reshape(-1, 4, 3), 1, 0)
        return np.maximum(0, 0.5 + C0 * c0 + C1 * (-y * c1 + z * c2 - x * c3))


def joints(skeleton: Tree, pose: Pose) -> Array:
    """6.1: K [J, 8]"""
    return dual_product(rigid(*world(skeleton, pose)), star(rigid(*world(skeleton, bind_pose(skeleton)))))


def blend(q: Array, w: Array, reference: Array) -> Array:
    """6.2: of q [N, K, 8] with weights w [N, K], signs against reference [N, 8]."""
    s = np.where(np.sum(q[..., :4] * reference[:, None, :4], axis=-1) < 0, -1.0, 1.0)
    total = np.sum((w * s)[..., None] * q, axis=1)
    return np.asarray(total / np.maximum(np.linalg.norm(total[:, :4], axis=1, keepdims=True), TINY))


def corner_weights(avatar: Tree) -> Array:
    """6.4: [N, 3]"""
    b = places(avatar)
    return np.column_stack([b, np.maximum(1 - b[:, 0] - b[:, 1], 0)])


def decode(avatar: Tree, poses: list[Pose], n: int) -> Splats:
    """Frame n of poses at the rate of the encoding."""
    skeleton, template, texels = avatar["skeleton"], avatar["template"], avatar["texels"]
    x = bounded(avatar, components(avatar, descriptor(avatar, window(avatar, poses, n))))
    v, K, T = canonical(avatar["coarse"], x), joints(skeleton, poses[n]), _texture(avatar, x)
    posed = blend(K[template["skin_indices"]], template["skin_weights"], K[template["skin_indices"][:, 0]])  # 6.3
    f, b = template["faces"][texels["triangles"]], corner_weights(avatar)
    Q = blend(posed[f], b, posed[f[np.arange(len(f)), b.argmax(axis=1)]])
    return Splats(
        canonical=v,
        joints=K,
        vertices=posed,
        texture=T,
        dual=Q,
        centres=apply(Q, np.einsum("nk,nki->ni", b, v[f]) + T[:, :3]),  # 6.5
        rotations=product(Q[:, :4], unit(T[:, 3:7])),
        scales=np.exp(np.minimum(T[:, 7:10], 10)),
        opacities=1 / (1 + np.exp(-T[:, 10])),
        root=world(skeleton, poses[n])[1][skeleton["root"]],
    )


def _texture(avatar: Tree, x: Array) -> Array:
    """5.4: T [N, 23]"""
    parts = []
    for branch in (avatar["geometry"], avatar["appearance"]):
        A = image(avatar, branch, x)
        for _ in range(avatar.get("level", 0)):
            A = halved(A)
        parts.append(at_texels(avatar, branch, A))
    return np.concatenate(parts).T


def behind(avatar: Tree, splats: Splats, view: Array) -> Array:
    """7.2: [N] whether an eye sees a one-sided texel from behind."""
    v = splats.canonical[avatar["template"]["faces"][avatar["texels"]["triangles"]]]
    n = rotate(splats.dual[:, :4], np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]))
    away = splats.centres + view[:3, :3].T @ view[:3, 3]
    most = 0.25 * np.linalg.norm(n, axis=1) * np.linalg.norm(away, axis=1)
    return one_sided(avatar["texels"]) & (np.sum(n * away, axis=1) > most)


def keys(avatar: Tree, splats: Splats, view: Array, near: float) -> Array:
    """7.3, of one avatar and one eye, which motion may take beyond what the file holds."""
    low, high = avatar["bounds"] + splats.root
    corners = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)])
    s = np.linalg.norm(high - low) / 2
    depth, of_box = (-(points @ view[2, :3] + view[2, 3]) for points in (splats.centres, corners))
    farthest, nearest = of_box.max() + s, max(of_box.min() - s, near)
    return np.floor(65534 * np.clip((farthest - depth) / (farthest - nearest), 0, 1) + 0.5)
