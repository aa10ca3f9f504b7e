"""Poses of the SMPL-X body model, as capture sets give them, on a template that is rigged to the model's joints."""

import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.motion.amass import NOMINAL
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ROWS = NOMINAL[55]  # joints in the model's order: name, parent, offset
PARTS = (  # of the pose, in the order of the joints; what a file leaves out is not turned
    ("global_orient", 1),
    ("body_pose", 21),
    ("jaw_pose", 1),
    ("leye_pose", 1),
    ("reye_pose", 1),
    ("left_hand_pose", 15),
    ("right_hand_pose", 15),
)
NEEDED = ("global_orient", "body_pose", "transl")
LEAST_SHARED = 15  # joints by which a template is known to be rigged to the model


@dataclass(frozen=True, eq=False)
class SmplxPoses:
    """F poses in the world of a capture set."""

    turns: Array  # [F, 55, 4] local, unit wxyz
    translation: Array  # [F, 3] of the model, metres

    def __len__(self) -> int:
        return len(self.turns)

    @property
    def up(self) -> Array:
        """The axis [3] of the world, with its sign, along which the body stands most of the time."""
        mean = rotation.rotate(self.turns[:, 0], np.array([0.0, 1, 0])).mean(axis=0)
        axis = int(np.abs(mean).argmax())
        return np.asarray(np.sign(mean[axis]) * np.eye(3)[axis])


def read_smplx(path: Path) -> SmplxPoses:
    """Read smpl_params.npz; raises InputError where an array is missing, of another shape or not finite."""
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {key: np.asarray(file[key], float) for key in ("transl", *(k for k, _ in PARTS)) if key in file}
    except (OSError, ValueError, EOFError, TypeError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: cannot be read as an .npz of plain arrays: {error}") from error
    for key in NEEDED:
        if key not in arrays:
            raise InputError(f"{path}: holds no {key}; found {', '.join(arrays) or 'none'}")
    frames = len(arrays["transl"])
    for key, joints in (("transl", 1), *PARTS):
        values = arrays.setdefault(key, np.zeros((frames, 3 * joints)))
        if values.shape != (frames, 3 * joints) or not frames:
            raise InputError(f"{path}: {key}: the shape is {list(values.shape)}, expected [{frames}, {3 * joints}]")
        if not np.isfinite(values).all():
            wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))[0]
            raise InputError(f"{path}: {key}: pose {wrong} is not finite")
    vectors = np.concatenate([arrays[key] for key, _ in PARTS], axis=1).reshape(frames, -1, 3)
    angles = np.linalg.norm(vectors, axis=-1)
    axes = vectors / np.where(angles > 0, angles, 1)[..., None]
    return SmplxPoses(rotation.from_axis_angle(axes, angles), arrays["transl"])


def on_template(
    poses: SmplxPoses,
    skeleton: Skeleton,
    *,
    turn: Array,  # [4] from the world of the poses to ours
    rate: float,
    where: str,  # what a sentence calls the template
) -> Clip:
    """The poses on a template that stands as the model does where all angles are 0, its joints called as the model's.

    Other joints keep their place on their parent. Errors: InputError where too few names are shared.
    """
    names = [name for name, _, _ in ROWS]
    shared = [name for name in names if name in skeleton.names]
    if len(shared) < LEAST_SHARED or "pelvis" not in shared:
        raise InputError(
            f"{where}: {len(shared)} of its joints are called as SMPL-X's (pelvis, left_hip, spine1, ...); "
            "expected a template on the model's joints"
        )
    world = _world(poses, turn)
    bind_turned, bind_at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    rotations = np.tile(skeleton.bind_rotations, (len(poses), 1, 1))
    translations = np.tile(skeleton.bind_translations, (len(poses), 1, 1))
    turned = np.empty((len(poses), len(skeleton.names), 4))
    for joint, (name, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        above = turned[:, parent] if parent >= 0 else np.tile([1.0, 0, 0, 0], (len(poses), 1))
        turned[:, joint] = rotation.multiply(above, rotations[:, joint])
        if name in names:
            turned[:, joint] = rotation.multiply(world[:, names.index(name)], bind_turned[joint])
            rotations[:, joint] = rotation.normalize(rotation.multiply(rotation.conjugate(above), turned[:, joint]))
        if name == "pelvis":
            at = rotation.rotate(turn, poses.translation + bind_at[joint])
            base = np.zeros(3) if parent < 0 else bind_at[parent]  # what is above the pelvis stands still
            translations[:, joint] = rotation.rotate(rotation.conjugate(above), at - base)
    return Clip("poses", rate, rotations, translations)


def _world(poses: SmplxPoses, turn: Array) -> Array:
    """Rotations [F, 55, 4] in our world of the model's joints since its rest pose."""
    names = [name for name, _, _ in ROWS]
    found = np.empty_like(poses.turns)
    for joint, (_, parent, _) in enumerate(ROWS):
        above = found[:, names.index(parent)] if parent else np.broadcast_to(turn, (len(poses), 4))
        found[:, joint] = rotation.multiply(above, poses.turns[:, joint])
    return found
