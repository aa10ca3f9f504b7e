"""Motion as .bvh: joints, offsets and Euler angles, in metres, Y up.

A .bvh has no bind pose: all angles at 0 are its rest. Joints are therefore turned so that this rest is the bind pose;
where they are in the world in each frame stays the same.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ROTATIONS = "Zrotation Xrotation Yrotation"  # applied from left to right, each about the axes so far
POSITIONS = "Xposition Yposition Zposition"
STILL = 1e-6  # metres, by which a joint may move in its parent and still have a fixed offset
TIP = 0.05  # metres, for a joint whose bone has no length


def bvh_text(skeleton: Skeleton, clip: Clip) -> str:
    """The content of a .bvh; joints in the order of the skeleton, but children follow their parents.

    Errors: InputError where the skeleton has several joints without a parent.
    """
    roots = np.flatnonzero(skeleton.parents < 0)
    if len(roots) != 1:
        named = ", ".join(skeleton.names[root] for root in roots)
        raise InputError(f"the skeleton has {len(roots)} joints without a parent ({named}); a .bvh holds one")
    _, bind = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    rotations, positions = _about_the_bind_pose(skeleton, clip)
    offsets = bind - np.where(skeleton.parents[:, None] < 0, 0, bind[skeleton.parents])
    moves = np.abs(positions - offsets).max(axis=(0, 2)) > STILL
    moves[roots] = True
    order: list[int] = []
    lines = ["HIERARCHY", *_hierarchy(skeleton, int(roots[0]), offsets, moves, order), "MOTION"]
    angles = np.degrees(_zxy(rotations))
    columns = [part for j in order for part in ([positions[:, j]] if moves[j] else []) + [angles[:, j]]]
    rows = [" ".join(f"{value:.6f}" for value in row) for row in np.concatenate(columns, axis=1)]
    return "\n".join([*lines, f"Frames: {len(clip)}", f"Frame Time: {1 / clip.rate:.8f}", *rows, ""])


def _about_the_bind_pose(skeleton: Skeleton, clip: Clip) -> tuple[Array, Array]:
    """Local rotations [F, J, 4] and positions [F, J, 3] of joints whose axes are the world's in the bind pose."""
    turned, placed = skeleton.world(clip.rotations, clip.translations)
    bind, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    turned = rotation.multiply(turned, np.broadcast_to(rotation.conjugate(bind), turned.shape))
    child = np.flatnonzero(skeleton.parents >= 0)
    parent = skeleton.parents[child]
    back = rotation.conjugate(turned[:, parent])
    rotations, positions = turned.copy(), placed.copy()
    rotations[:, child] = rotation.multiply(back, turned[:, child])
    positions[:, child] = rotation.rotate(back, placed[:, child] - placed[:, parent])
    return rotations, positions


def _zxy(
    rotations: Array,  # [F, J, 4]
) -> Array:
    """Angles [F, J, 3] about Z, X and Y, in radians, without jumps by whole turns from frame to frame."""
    m = rotation.to_matrix(rotations)
    x = np.arcsin(np.clip(m[..., 2, 1], -1, 1))
    z = np.arctan2(-m[..., 0, 1], m[..., 1, 1])
    y = np.arctan2(-m[..., 2, 0], m[..., 2, 2])
    upright = np.abs(m[..., 2, 1]) > 1 - 1e-12  # Z and Y turn about the same axis
    z = np.where(upright, np.arctan2(m[..., 1, 0], m[..., 0, 0]), z)
    y = np.where(upright, 0, y)
    return np.unwrap(np.stack([z, x, y], axis=-1), axis=0)


def _hierarchy(
    skeleton: Skeleton,
    joint: int,
    offsets: Array,  # [J, 3]
    moves: Array,  # [J] which joints have positions
    order: list[int],  # joints in the order of the file, appended to
) -> list[str]:
    """The lines of a joint and all below it."""
    depth = len(skeleton.ancestors(joint))
    indent = "  " * depth
    name = "_".join(skeleton.names[joint].split())  # a space ends a name in many readers
    order.append(joint)
    channels = f"6 {POSITIONS} {ROTATIONS}" if moves[joint] else f"3 {ROTATIONS}"
    lines = [f"{indent}{'JOINT' if depth else 'ROOT'} {name}", f"{indent}{{"]
    lines += [f"{indent}  OFFSET {_place(offsets[joint])}", f"{indent}  CHANNELS {channels}"]
    children = np.flatnonzero(skeleton.parents == joint)
    for child in children:
        lines += _hierarchy(skeleton, int(child), offsets, moves, order)
    if not len(children):
        tip = offsets[joint] / 2 if depth and np.abs(offsets[joint]).max() > STILL else np.array([0, TIP, 0])
        lines += [f"{indent}  End Site", f"{indent}  {{", f"{indent}    OFFSET {_place(tip)}", f"{indent}  }}"]
    return [*lines, f"{indent}}}"]


def _place(point: Array) -> str:
    return " ".join(f"{value:.6f}" for value in point)
