"""Read AMASS `.npz` motion: axis-angle poses of the SMPL family of body models, Z up, brought to Y up.

The body model itself is not needed: retargeting asks a skeleton for names and rest directions only. NOMINAL holds rough
offsets of an average adult in the models' rest pose (arms level, legs straight, facing +Z), rounded to centimetres.
"""

import zipfile
import zlib
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.motion.source import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

# Joint, parent and offset in centimetres; sided joints are given for the left (+X) and mirrored. In the models' order.
_BODY = (
    ("pelvis", "", (0, -22, 3)),
    ("left_hip", "pelvis", (6, -9, -1)),
    ("right_hip", "pelvis", (6, -9, -1)),
    ("spine1", "pelvis", (0, 11, -3)),
    ("left_knee", "left_hip", (4, -38, 0)),
    ("right_knee", "right_hip", (4, -38, 0)),
    ("spine2", "spine1", (0, 13, 0)),
    ("left_ankle", "left_knee", (-1, -41, -4)),
    ("right_ankle", "right_knee", (-1, -41, -4)),
    ("spine3", "spine2", (0, 6, 2)),
    ("left_foot", "left_ankle", (4, -6, 12)),
    ("right_foot", "right_ankle", (4, -6, 12)),
    ("neck", "spine3", (0, 21, -4)),
    ("left_collar", "spine3", (8, 11, -3)),
    ("right_collar", "spine3", (8, 11, -3)),
    ("head", "neck", (0, 8, 5)),
    ("left_shoulder", "left_collar", (11, 4, -1)),
    ("right_shoulder", "right_collar", (11, 4, -1)),
    ("left_elbow", "left_shoulder", (26, 0, 0)),
    ("right_elbow", "right_shoulder", (26, 0, 0)),
    ("left_wrist", "left_elbow", (25, 0, 0)),
    ("right_wrist", "right_elbow", (25, 0, 0)),
)
_HANDS = (("left_hand", "left_wrist", (8, 0, 0)), ("right_hand", "right_wrist", (8, 0, 0)))
_FACE = (("jaw", "head", (0, -2, 2)), ("left_eye_smplhf", "head", (3, 4, 7)), ("right_eye_smplhf", "head", (3, 4, 7)))
_FINGERS = tuple(
    (f"{side}_{finger}{i}", f"{side}_wrist" if i == 1 else f"{side}_{finger}{i - 1}", root if i == 1 else step)
    for side in ("left", "right")
    for finger, root, step in (
        ("index", (10, 0, 2), (3, 0, 0)),
        ("middle", (11, 0, 0), (3, 0, 0)),
        ("pinky", (8, 0, -4), (2, 0, 0)),
        ("ring", (10, 0, -2), (3, 0, 0)),
        ("thumb", (3, -1, 3), (2, 0, 2)),
    )
    for i in (1, 2, 3)
)
# By the number of joints in `poses`: SMPL, SMPL-H, SMPL-X.
NOMINAL = {24: _BODY + _HANDS, 52: _BODY + _FINGERS, 55: _BODY + _FACE + _FINGERS}

RATE_KEYS = ("mocap_framerate", "mocap_frame_rate")
Z_UP_TO_Y_UP = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0, 0])  # a quarter turn about X


def read_amass(path: Path) -> SourceMotion:
    """Read poses [F, 3 J] (radians), trans [F, 3] (metres) and the frame rate of an AMASS file.

    J is 24 (SMPL), 52 (SMPL-H) or 55 (SMPL-X). Pickled content is never loaded.
    Errors: InputError for an unreadable file, a missing key, another J, no frames, numbers that are not finite.
    """
    poses, translation, rate = _load(path)
    skeleton = nominal_skeleton(poses.shape[1] // 3)
    vectors = poses.reshape(len(poses), -1, 3)
    angles = np.linalg.norm(vectors, axis=-1)
    axes = vectors / np.where(angles > 0, angles, 1)[..., None]
    rotations = rotation.from_axis_angle(axes, angles)
    rotations[:, 0] = rotation.multiply(Z_UP_TO_Y_UP, rotations[:, 0])
    pelvis = rotation.rotate(Z_UP_TO_Y_UP, translation + skeleton.bind_translations[0])
    return SourceMotion(skeleton, Clip(path.stem, rate, rotations, skeleton.with_root(pelvis)))


def nominal_skeleton(joints: int) -> Skeleton:
    """The rest skeleton of the model with that many joints: facts in names and parents, rough in its offsets."""
    rows = NOMINAL[joints]
    names = tuple(name for name, _, _ in rows)
    mirror = np.array([[-1 if name.startswith("right") else 1, 1, 1] for name in names])
    return Skeleton(
        names=names,
        parents=np.array([names.index(parent) if parent else -1 for _, parent, _ in rows], dtype=np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (joints, 1)),
        bind_translations=np.array([offset for _, _, offset in rows]) * mirror * 0.01,
        root=0,
    )


def _load(path: Path) -> tuple[Array, Array, float]:
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {key: file[key] for key in ("poses", "trans", *RATE_KEYS) if key in file}
    except (OSError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: cannot be read as an .npz of plain arrays: {error}") from error
    rate_key = next((key for key in RATE_KEYS if key in arrays), RATE_KEYS[0])
    for key in ("poses", "trans", rate_key):
        if key not in arrays:
            raise InputError(
                f"{path}: expected the array {key!r} of an AMASS motion, found {', '.join(arrays) or 'none'}"
            )
        if not np.issubdtype(arrays[key].dtype, np.number) or not np.isfinite(arrays[key]).all():
            raise InputError(f"{path}: {key}: expected finite numbers, found others")
    poses, translation, rate = (arrays[key].astype(float) for key in ("poses", "trans", rate_key))
    widths = {3 * joints for joints in NOMINAL}
    if poses.ndim != 2 or poses.shape[1] not in widths or len(poses) < 1:
        raise InputError(
            f"{path}: poses: expected shape [1 or more, one of {sorted(widths)}], found {list(poses.shape)}"
        )
    if translation.shape != (len(poses), 3):
        raise InputError(f"{path}: trans: expected shape {[len(poses), 3]}, found {list(translation.shape)}")
    if rate.size != 1 or rate.item() <= 0:
        raise InputError(f"{path}: {rate_key}: expected one number above 0, found {rate.tolist()}")
    return poses, translation, float(rate.item())
