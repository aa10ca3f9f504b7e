"""For those who have a template and a texel map: theirs become the rig of a recording (docs/recording.md).

What is expected of you are plain arrays, as UMA's and ASH's programs hold them: a mesh in millimetres with UVs whose v
points up, dense skin weights, the bones' transforms in the world, and for each texel [u, v] a face and barycentrics.
"""

import numpy as np

import mua
from mua import rotation
from mua.avatar.decode import pose_splats
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.rig import Rig
from mua.rig.texel_map import TexelMap
from mua.texture import sh

MILLIMETRES = 1000.0  # of a metre; 100 where yours are centimetres
INFLUENCES = 8  # joints of a vertex at most


def mesh_of(vertices: np.ndarray, faces: np.ndarray, uv: np.ndarray, uv_faces: np.ndarray) -> Mesh:
    """The template: [V, 3] millimetres, [F, 3], [T, 2] v up, [F, 3]; faces counter-clockwise seen from outside."""
    down = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
    return Mesh(vertices / MILLIMETRES, faces.astype(np.int32), down, uv_faces.astype(np.int32))


def skin_of(weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The largest weights of each vertex, of [V, J]; they sum to 1."""
    wide = np.pad(weights, ((0, 0), (0, max(INFLUENCES - weights.shape[1], 0))))
    order = np.argsort(-wide, axis=1, kind="stable")[:, :INFLUENCES]
    kept = np.take_along_axis(wide, order, axis=1)
    joints = np.where(kept > 0, order, 0).astype(np.int32)
    return joints, (kept / kept.sum(axis=1, keepdims=True)).astype(np.float32)


def texels_of(face: np.ndarray, barycentrics: np.ndarray) -> tuple[TexelMap, np.ndarray]:
    """A map [R, R] of faces, -1 where there is none, and [R, R, 3], both indexed [u, v] with v up.

    Also which of your texels each of ours is: `yours[order]` is in our order, where `yours` [N, ...] is in that of
    `np.where(face >= 0)`.
    """
    size = len(face)
    u, v = np.where(face >= 0)
    own = (size - 1 - v) * size + u  # rows from the top
    order = np.argsort(own)
    u, v = u[order], v[order]
    return TexelMap(size, own[order].astype(np.int32), face[u, v].astype(np.int32), _unit(barycentrics[u, v]), 0), order


def skeleton_of(names: list[str], parents: np.ndarray, world: np.ndarray) -> Skeleton:
    """Bones in the pose of the template: parents [J] first, -1 for none, and [J, 4, 4] in the world, millimetres."""
    bind = pose_of(parents, world)
    return Skeleton(tuple(names), parents.astype(np.int32), bind.rotations, bind.translations, root=0)


def pose_of(parents: np.ndarray, world: np.ndarray) -> mua.Pose:
    """A frame: the bones' transforms in the world [J, 4, 4], millimetres, become those relative to the parent."""
    above = np.where((parents >= 0)[:, None, None], world[parents], np.eye(4))
    local = np.linalg.inv(above) @ world
    return mua.Pose(rotation.from_matrix(local[:, :3, :3]), local[:, :3, 3] / MILLIMETRES)


def canonical(
    rig: Rig,
    mesh: np.ndarray,  # [V, 3] canonical vertices, metres
    pose: mua.Pose,
    texture: np.ndarray,  # [N, 23] whose rotations and colours are in posed space
) -> np.ndarray:
    """The texture with rotations and colours turned back by what turns each texel; positions are canonical already."""
    turn = rotation.conjugate(pose_splats(rig, mesh, texture=texture, pose=pose).texel_dq[:, :4])
    back = texture.copy()
    back[:, 3:7] = rotation.multiply(turn, texture[:, 3:7])
    back[:, 11:23] = sh.rotate(texture[:, 11:23], turn)
    return back


def _unit(barycentrics: np.ndarray) -> np.ndarray:
    inside = np.clip(barycentrics, 0, 1)
    return (inside / inside.sum(axis=1, keepdims=True)).astype(np.float32)
