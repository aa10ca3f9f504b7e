"""Texels on posed triangles, their splats by the reference, and through SplatProject on a device."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from dispatch import run
from packed_splats import unpacked

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera
from mua.avatar.decode import Splats, box_of
from mua.gpu import Device
from mua.kernels.dq_skinning import blend_texels, skin_splats
from mua.kernels.inverse_dwt import pack_channels, unpack_channels
from mua.kernels.splat_project import LARGEST_BARYCENTRIC, pack_texels

FILE = "splat_project.compute"
GROUP = 256  # threads
UNWRITTEN = 0xFFFFFFFF
FACES = np.array([[0, 1, 2], [2, 3, 4], [5, 3, 1]], np.int32)


@dataclass(frozen=True, eq=False)
class Texels:
    """What SplatProject is given of an avatar, all of it as buffers hold it."""

    vertex_dq: Array  # [V, 8] float32
    mesh: Array  # [V, 3] float32
    faces: Array  # [F, 3]
    triangles: Array  # [N]
    barycentrics: Array  # [N, 2] multiples of 1/65535
    texture: Array  # [N, 23] half floats
    one_sided: Array  # [N] bool

    def __len__(self) -> int:
        return len(self.triangles)

    @property
    def buffers(self) -> dict[str, Array]:
        return {
            "mesh": self.mesh,
            "faces": self.faces.astype(np.uint32),
            "texels": pack_texels(self.triangles, self.barycentrics, self.one_sided),
            "texel_channels": pack_channels(self.texture),
            "vertex_dq": self.vertex_dq,
        }

    @cached_property
    def splats(self) -> Splats:
        """By the reference, in float64."""
        third = np.maximum(1 - self.barycentrics.sum(axis=1, keepdims=True), 0)
        on_mesh = self.faces, self.triangles, np.concatenate([self.barycentrics, third], axis=1)
        texture = self.texture.astype(float)
        texel_dq = blend_texels(self.vertex_dq.astype(float), *on_mesh)
        centres, rotations, scales, opacities = skin_splats(texel_dq, self.mesh.astype(float), *on_mesh, texture)
        a, b, c = (self.mesh[self.faces[self.triangles, corner]].astype(float) for corner in range(3))
        normals = rotation.rotate(texel_dq[:, :4], np.cross(b - a, c - a)) * self.one_sided[:, None]
        return Splats(
            canonical=self.mesh,
            mesh=self.mesh,
            texture=texture,
            centres=centres,
            rotations=rotations,
            scales=scales,
            opacities=opacities,
            sh=texture[:, 11:],
            texel_dq=texel_dq,
            bounds=box_of(centres),
            normals=normals,
        )

    def kept(self, chosen: Array) -> "Texels":
        """Only some of the texels."""
        parts = self.triangles[chosen], self.barycentrics[chosen], self.texture[chosen], self.one_sided[chosen]
        return Texels(self.vertex_dq, self.mesh, self.faces, *parts)


def on_steps(barycentrics: Array) -> Array:
    """The first two of barycentrics [N, 3], as a texel's word holds them."""
    return np.asarray(np.rint(barycentrics[:, :2] * LARGEST_BARYCENTRIC) / LARGEST_BARYCENTRIC)


def held(texture: Array) -> Array:
    """Channels [N, 23] as half floats hold them."""
    return unpack_channels(pack_channels(texture))


def texels_of(frame: Splats) -> Texels:
    """Texels that pose to a frame's splats, but for the rounding of half floats: each on a vertex of its own."""
    count = len(frame.centres)
    turn = frame.texel_dq[:, :4]
    back = rotation.conjugate(turn)
    logits = np.log(frame.opacities) - np.log1p(-frame.opacities)
    own = rotation.multiply(back, frame.rotations)
    channels = [np.zeros((count, 3)), own, np.log(frame.scales), logits[:, None], frame.sh]
    return Texels(
        np.concatenate([turn, np.zeros((count, 4))], axis=1).astype(np.float32),
        rotation.rotate(back, frame.centres).astype(np.float32),
        np.arange(count)[:, None].repeat(3, axis=1),
        np.arange(count),
        np.tile([1.0, 0], (count, 1)),
        held(np.concatenate(channels, axis=1)),
        np.zeros(count, bool),
    )


@dataclass(frozen=True, eq=False)
class Scene:
    """Texels before one or two eyes."""

    texels: Texels
    cameras: tuple[Camera, ...]
    bounds: Array  # [2, 3]

    @property
    def constants(self) -> dict[str, int | float | Array]:
        eyes = [self.cameras[0], self.cameras[-1]]
        return {
            "view": np.stack([c.view for c in eyes]),
            "projection": np.stack([c.projection for c in eyes]),
            "bounds_low": np.append(self.bounds[0], 1),
            "bounds_high": np.append(self.bounds[1], 0),
            "screen": np.array(self.cameras[0].screen),
            "near": NEAR,
            "eyes": len(self.cameras),
            "texel_count": len(self.texels),
        }


@dataclass(frozen=True, eq=False)
class Projected:
    """What the kernel leaves for the sort and the draw."""

    splats: Array  # [M] of PACKED
    keys: Array  # [M] uint16

    @property
    def words(self) -> Array:
        return self.splats.view("<u4").reshape(-1, 8)


def project_on(device: Device, scene: Scene, *, first_splat: int = 0) -> Projected:
    """All that is written, and what stands before the first splat."""
    count = len(scene.texels)
    slots = first_splat + count + count % 2
    buffers = {
        **scene.texels.buffers,
        "splats": np.full((slots, 8), UNWRITTEN, np.uint32),
        "keys": np.full(slots // 2, UNWRITTEN - 1, np.uint32),
    }
    groups = (-(-count // GROUP), 1, 1)
    found = run(device, FILE, "SplatProject", groups, buffers, **scene.constants, first_splat=first_splat)
    return Projected(unpacked(found["splats"]), found["keys"].view(np.uint16))
