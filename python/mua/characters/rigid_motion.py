"""A scene's matrices over time as rotations and positions of joints that do not stretch."""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind, rotations_of
from mua.scene import Motion


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """Joints of one motion in the world, and how far they stretch."""

    rotations: Array  # [F, J, 3, 3]
    positions: Array  # [F, J, 3] metres
    stretches: Array  # [F, J, 3, 3] what is left of the deformation: the surface's stretch about each joint, bind axes

    @property
    def scales(self) -> Array:
        """Largest deviation [F, J] of a scale from that of the rest pose, relative."""
        return np.asarray(np.abs(self.stretches - np.eye(3)).max(axis=(-1, -2)))


def rigid_motion(motion: Motion, bind: Bind) -> RigidMotion:
    """The rotation that each joint gives to the surface, on top of its bind rotation, and where it stands."""
    worlds = motion.worlds[:, bind.nodes]
    deformation = worlds @ np.linalg.inv(bind.matrices)
    turned = rotations_of(deformation)
    residual = np.swapaxes(turned, -1, -2) @ deformation[..., :3, :3] @ np.linalg.inv(bind.stretch)
    return RigidMotion(turned @ rotations_of(bind.matrices), worlds[..., :3, 3], residual)


def local_rotations(world: Array, parents: Array) -> Array:
    """Rotations [..., J, 3, 3] relative to the parent joint, of world ones."""
    local = world.copy()
    child = np.flatnonzero(parents >= 0)
    local[..., child, :, :] = np.swapaxes(world[..., parents[child], :, :], -1, -2) @ world[..., child, :, :]
    return local


def local_offsets(world: Array, positions: Array, parents: Array) -> Array:
    """Positions [..., J, 3] in the parent joint's axes, of world rotations [..., J, 3, 3] and positions [..., J, 3]."""
    offsets = positions.copy()
    child = np.flatnonzero(parents >= 0)
    apart = positions[..., child, :] - positions[..., parents[child], :]
    offsets[..., child, :] = np.einsum("...ji,...j->...i", world[..., parents[child], :, :], apart)
    return offsets
