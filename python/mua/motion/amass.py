"""Read `.npz` motion of the SMPL family of body models, axis angles as AMASS and its relatives store them, in Y up.

AMASS has Z up. Relatives (BEAT2, results of pose estimators) have Y up or, seen by a camera, Y down; none says so, but
the trunk of a person who stands does.

A face comes as coefficients of SMPL-X's expressions, which a character of that model has as pairs of expressions.

The body model itself is not needed: retargeting asks a skeleton for names and rest directions only. NOMINAL holds rough
offsets of an average adult in the models' rest pose (arms level, legs straight, facing +Z), rounded to centimetres.
"""

import zipfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arguments import finite_array
from mua.arrays import Array
from mua.errors import InputError
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.signed_expressions import UNIT, as_weights
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
# By the number of joints in `poses`: the body alone, SMPL, SMPL-H, SMPL-X.
NOMINAL = {22: _BODY, 24: _BODY + _HANDS, 52: _BODY + _FINGERS, 55: _BODY + _FACE + _FINGERS}

POSE_KEYS = ("poses", "smpl_poses", "fullpose", "pose_world")  # of AMASS, AIST++, SMPL-X, WHAM
SPLIT_KEYS = (("root_orient", "global_orient"), ("pose_body", "body_pose"))  # where the pose comes in parts
HAND_KEYS = (("left_hand_pose",), ("right_hand_pose",))
HANDS_KEY = "pose_hand"  # both hands in one array
TRANSLATION_KEYS = ("trans_world", "trans", "transl", "smpl_trans", "root_trans")
FACE_KEYS = ("expressions", "expression", "face_expr")  # of BEAT2, of pose estimators, of Motion-X
SCALE_KEY = "smpl_scaling"  # of AIST++: units of its smpl_trans in a metre
OF_AMASS = ("dmpls", "mocap_time_length", "markers_latent")  # only files of AMASS itself have these: Z is up
RATE_KEYS = ("mocap_framerate", "mocap_frame_rate", "fps", "framerate", "frame_rate")
SPLIT_BODY = (63, 69)  # numbers of a body without its root: SMPL-H and SMPL-X, SMPL
HAND = 45  # numbers of a hand; hands in principal components have fewer and are left out
POSITIONS = ("joints", "positions", "keypoints3d", "motion", "data", "arr_0")
USUAL_RATE = 30.0

Z_UP_TO_Y_UP = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0, 0])  # a quarter turn about X
Y_DOWN_TO_Y_UP = np.array([0.0, 1, 0, 0])  # half a turn about X
IDENTITY = np.array([1.0, 0, 0, 0])
MOST_TURNED = 4 * np.pi  # radians of a component: beyond it they are degrees
STANDS = 0.7  # of a unit along an axis: cosine of how far a trunk may lean that stands along it


def read_amass(path: Path) -> SourceMotion:
    """Read axis angles [F, 3 J] or [F, J, 3] (radians) or matrices [F, J, 3, 3], places [F, 3] (metres) and the rate.

    J is 22 (a body), 24 (SMPL), 52 (SMPL-H) or 55 (SMPL-X); `root_orient` and `pose_body`, or `global_orient` and
    `body_pose`, do as well. `expressions`, `expression` or `face_expr` [F, K] are the face's. Pickled
    content is never loaded.
    Errors: InputError for an unreadable file, a missing key, another J, no frames, numbers that are not finite.
    """
    arrays = _load(path)
    poses = _poses(path, arrays)
    translation = _translation(path, arrays, len(poses))
    rate, notes = _rate(path, arrays)
    skeleton = nominal_skeleton(poses.shape[1] // 3)
    vectors = poses.reshape(len(poses), -1, 3)
    angles = np.linalg.norm(vectors, axis=-1)
    axes = vectors / np.where(angles > 0, angles, 1)[..., None]
    rotations = rotation.from_axis_angle(axes, angles)
    up, turn = ("", Z_UP_TO_Y_UP) if arrays.keys() & set(OF_AMASS) else _up(rotations[:, 0])
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    pelvis = rotation.rotate(turn, translation + skeleton.bind_translations[0])
    names, weights, of_face = _face(path, arrays, len(poses))
    notes += of_face
    if up:
        notes += (f"{path.name}: {up}, unlike in AMASS; judged by how the body stands.",)
    clip = Clip(path.stem, rate, rotations, skeleton.with_root(pelvis), expressions=weights)
    return SourceMotion(skeleton, clip, notes, expressions=names)


def _up(roots: Array) -> tuple[str, Array]:
    """The up axis and the turn [4] from it to Y up, by the rotations [F, 4] of pelvises."""
    along = np.median(rotation.rotate(roots, np.array([0.0, 1, 0])), axis=0)[1]
    if along > STANDS:
        return "Y is up", IDENTITY
    return ("Y is down", Y_DOWN_TO_Y_UP) if along < -STANDS else ("", Z_UP_TO_Y_UP)


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


def _load(path: Path) -> dict[str, Array]:
    """The arrays that matter, each of finite numbers."""
    known = (*POSE_KEYS, *(key for keys in (*SPLIT_KEYS, *HAND_KEYS) for key in keys), HANDS_KEY)
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            held = list(file)
            arrays = {
                key: file[key] for key in (*known, *TRANSLATION_KEYS, SCALE_KEY, *RATE_KEYS, *FACE_KEYS) if key in held
            }
            of_amass = dict.fromkeys((key for key in OF_AMASS if key in held), np.zeros(0))
            shapes = {key: file[key].shape for key in POSITIONS if key in held}
    except (OSError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: cannot be read as an .npz of plain arrays: {error}") from error
    for key, array in arrays.items():
        if not np.issubdtype(array.dtype, np.number) or np.iscomplexobj(array) or not np.isfinite(array).all():
            raise InputError(f"{path}: {key}: expected finite numbers, found others")
    if not any(key in arrays for key in (*POSE_KEYS, *SPLIT_KEYS[1])):
        for key, shape in shapes.items():
            if len(shape) >= 3 and shape[-1] == 3:
                raise InputError(
                    f"{path}: {key} holds places of joints {list(shape)}, not rotations, which a character needs; "
                    "fit a body model to them (such as SMPL by SMPLify) and give its poses"
                )
        raise InputError(
            f"{path}: expected the array 'poses' of an AMASS motion (or 'global_orient' and 'body_pose'), found "
            f"{', '.join(held) or 'none'}"
        )
    return {key: _vectors(array.astype(float)) for key, array in arrays.items()} | of_amass


def _vectors(array: Array) -> Array:
    """Axis angles [..., 3] of rotation matrices [F, J, 3, 3], which some pose estimators write; others as they are."""
    if array.ndim != 4 or array.shape[2:] != (3, 3):
        return array
    quaternions = rotation.from_matrix(array)
    sines = np.linalg.norm(quaternions[..., 1:], axis=-1, keepdims=True)
    return quaternions[..., 1:] * 2 * np.arctan2(sines, quaternions[..., :1]) / np.maximum(sines, np.finfo(float).tiny)


def _first(arrays: Mapping[str, Array], keys: Sequence[str]) -> str | None:
    return next((key for key in keys if key in arrays), None)


def _poses(path: Path, arrays: Mapping[str, Array]) -> Array:
    """Axis angles [F, 3 J] of a whole body, put together where the file has them in parts."""
    key = _first(arrays, POSE_KEYS)
    poses = _flat(arrays[key]) if key else _joined(path, arrays)
    widths = {3 * joints for joints in NOMINAL}
    if poses.ndim != 2 or poses.shape[1] not in widths or len(poses) < 1:
        raise InputError(
            f"{path}: {key or 'body_pose'}: expected shape [1 or more, one of {sorted(widths)}], "
            f"found {list(arrays[key].shape if key else poses.shape)}"
        )
    if (largest := np.abs(poses).max()) > MOST_TURNED:
        raise InputError(f"{path}: {key or 'body_pose'}: holds {largest:.4g}, expected axis angles in radians")
    return poses


def _flat(array: Array) -> Array:
    """[F, J, 3] as [F, 3 J]."""
    return array.reshape(len(array), -1) if array.ndim == 3 and array.shape[-1] == 3 else array


def _joined(path: Path, arrays: Mapping[str, Array]) -> Array:
    root, body = (_first(arrays, keys) for keys in SPLIT_KEYS)
    if root is None or body is None:
        raise InputError(f"{path}: expected 'global_orient' beside 'body_pose', found {', '.join(arrays)}")
    parts = [_flat(arrays[root]).reshape(len(arrays[root]), -1), _flat(arrays[body])]
    if parts[0].shape[1] != 3 or parts[1].ndim != 2 or parts[1].shape[1] not in SPLIT_BODY:
        raise InputError(
            f"{path}: {root}, {body}: expected shapes [frames, 3] and [frames, {SPLIT_BODY[0]} or {SPLIT_BODY[1]}], "
            f"found {list(arrays[root].shape)} and {list(arrays[body].shape)}"
        )
    hands = [_flat(arrays[key]) for keys in ((HANDS_KEY,), *HAND_KEYS) if (key := _first(arrays, keys))]
    if sum(hand.shape[-1] for hand in hands) == 2 * HAND and parts[1].shape[1] == SPLIT_BODY[0]:
        parts += hands
    if len({len(part) for part in parts}) != 1:
        raise InputError(
            f"{path}: {root}, {body}: expected as many frames in every part, found "
            + ", ".join(str(len(part)) for part in parts)
        )
    return np.concatenate(parts, axis=1)


def _translation(path: Path, arrays: Mapping[str, Array], frames: int) -> Array:
    key = _first(arrays, TRANSLATION_KEYS)
    if key is None:
        raise InputError(
            f"{path}: expected the array 'trans' of an AMASS motion, found {', '.join(arrays)}; zeros {[frames, 3]} "
            "let the person stay in place"
        )
    if arrays[key].shape != (frames, 3):
        raise InputError(f"{path}: {key}: expected shape {[frames, 3]}, found {list(arrays[key].shape)}")
    scale = arrays[SCALE_KEY] if key == "smpl_trans" and SCALE_KEY in arrays else np.ones(1)
    if scale.size != 1 or scale.item() <= 0:
        raise InputError(f"{path}: {SCALE_KEY}: expected one number above 0, found {scale.tolist()}")
    return arrays[key] / scale.item()


def _rate(path: Path, arrays: Mapping[str, Array]) -> tuple[float, tuple[str, ...]]:
    """Frames per second, and a note where the file states none."""
    key = _first(arrays, RATE_KEYS)
    if key is None:
        return USUAL_RATE, (f"{path.name}: states no frame rate; {USUAL_RATE:g} frames per second are taken.",)
    if arrays[key].size != 1 or arrays[key].item() <= 0:
        raise InputError(f"{path}: {key}: expected one number above 0, found {arrays[key].tolist()}")
    return float(arrays[key].item()), ()


def _face(
    path: Path, arrays: Mapping[str, Array], frames: int
) -> tuple[tuple[str, ...], Array | None, tuple[str, ...]]:
    """The expressions that coefficients move, their weights [F, S], and a note where these are held to 1."""
    key = _first(arrays, FACE_KEYS)
    if key is None:
        return (), None, ()
    coefficients = finite_array(arrays[key], f"{path}: {key}", (frames, None))
    pairs = [as_weights(f"Exp{number:03}", column) for number, column in enumerate(coefficients.T)]
    moving = {name: weights for pair in pairs for name, weights in pair.items() if weights.any()}
    if not moving:
        return (), None, ()
    beyond = np.mean(np.abs(coefficients) > UNIT)
    note = f"{path.name}: {key}: {100 * beyond:.2g} % of the coefficients are beyond {UNIT:g} and are held to that."
    return tuple(moving), np.stack([*moving.values()], axis=1), (note,) if beyond else ()
