"""An avatar in the world at a frame of a clip: section 6."""

from dataclasses import dataclass

import numpy as np
from oracle import descriptor, expressions, texture
from oracle.file import Array, Record
from oracle.motion import Pose, bind_pose, in_the_world
from oracle.quaternions import apply, compose, conjugate, multiply, normalise, rigid, rotate
from oracle.texels import Texels, levels

C0, C1 = 1 / (2 * np.sqrt(np.pi)), np.sqrt(3 / (4 * np.pi))


@dataclass(frozen=True)
class Splats:
    texels: Texels
    canonical: Array  # v [V, 3], v' of section 12
    joints: Array  # K [J, 8]
    vertices: Array  # [V, 8] dual quaternions
    motions: Array  # Q [N, 8]
    texture: Array  # T [N, 23], that of section 12
    centres: Array  # [N, 3] metres
    rotations: Array  # [N, 4]
    scales: Array  # [N, 3] standard deviations, metres
    opacities: Array  # [N]
    box: Array  # [2, 3] around the avatar, metres

    def colours(self, camera: Array) -> Array:
        """6.6: [N, 3] towards a camera [3], with the channels of 5.4."""
        x, y, z = rotate(conjugate(self.motions[:, :4]), normalise(self.centres - camera)).T[..., None]
        c0, c1, c2, c3 = np.split(self.texture[:, 11:23], 4, axis=-1)
        return np.maximum(0, 0.5 + C0 * c0 + C1 * (-y * c1 + z * c2 - x * c3))


def blend(motions: Array, weights: Array, reference: Array) -> Array:
    """6.2: of motions [N, k, 8], signs against those of the indices reference [N]."""
    real = motions[..., :4]
    signs = np.where(np.einsum("nkx,nx->nk", real, real[np.arange(len(real)), reference]) < 0, -1, 1)
    return normalise(np.einsum("nk,nkx->nx", weights * signs, motions))


def decode(avatar: Record, poses: list[Pose], n: int, level: int = 0) -> Splats:
    """Frame n of poses at the rate of the encoding, at a level of detail."""
    skeleton, template, texels = avatar.skeleton, avatar.template, levels(avatar)[level]
    d = descriptor.describe(avatar, poses, n)
    x = descriptor.bound(avatar.encoding, descriptor.components(avatar.encoding, d))
    v, t = texture.canonical_vertices(avatar.coarse, x), texture.at_texels(avatar, x, texels, level)
    moved = expressions.moved(avatar, poses[n])
    t = expressions.light(t, texels.corners, texels.weights(), expressions.brightened(avatar, poses[n]))
    v, t = v + moved, expressions.bend(t, texels.corners, texels.weights(), template.faces, v, moved)
    turns, places = in_the_world(skeleton, poses[n])
    joints = compose(rigid(turns, places), conjugate(rigid(*in_the_world(skeleton, bind_pose(skeleton)))))  # 6.1
    first = np.zeros(len(template.skin_indices), int)
    vertices = blend(joints[template.skin_indices], template.skin_weights, first)  # 6.3
    weights = texels.weights()
    q = blend(vertices[texels.corners], weights, weights.argmax(axis=1))  # 6.4
    centres = apply(q, np.einsum("nk,nkx->nx", weights, v[texels.corners]) + t[:, 0:3])  # 6.5
    rotations, scales = multiply(q[:, :4], normalise(t[:, 3:7])), np.exp(np.minimum(t[:, 7:10], 10))
    posed = centres, rotations, scales, 1 / (1 + np.exp(-t[:, 10]))
    return Splats(texels, v, joints, vertices, q, t, *posed, avatar.bounds + places[skeleton.root])
