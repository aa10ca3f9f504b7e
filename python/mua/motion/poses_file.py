"""Poses of one skeleton as they stand in an .npz: for motion that is exact on a character and in its world.

Arrays: names [J], parents [J] (-1: none), root, bind_rotations [J, 4], bind_translations [J, 3], rotations [F, J, 4],
translations [F, J, 3] (local, unit wxyz, metres, Y up) and rate (frames per second). With a face also
expression_names [E] and expressions [F, E], weights from 0 to 1.
"""

import io
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mua.arguments import finite_array, unit_quaternions
from mua.arrays import Array
from mua.errors import InputError
from mua.files.write import write_bytes
from mua.limits import LARGEST_RATE, LEAST_RATE
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

KEYS = ("names", "parents", "root", "bind_rotations", "bind_translations", "rotations", "translations", "rate")
WEIGHTS = "expressions"
FACE_KEYS = ("expression_names", WEIGHTS)
DAMAGE = (OSError, ValueError, EOFError, AttributeError, TypeError, zipfile.BadZipFile, zlib.error)


def write_poses(path: Path, skeleton: Skeleton, clip: Clip, *, expressions: Sequence[str] = ()) -> None:
    """Write a clip with its skeleton and the names of the expressions it has weights of, all of it or nothing."""
    content = io.BytesIO()
    face: dict[str, Any] = {}
    if clip.expressions is not None:
        face = {"expression_names": np.array(expressions), WEIGHTS: clip.expressions}
    np.savez(
        content,
        names=np.array(skeleton.names),
        parents=skeleton.parents,
        root=skeleton.root,
        bind_rotations=skeleton.bind_rotations,
        bind_translations=skeleton.bind_translations,
        rotations=clip.rotations,
        translations=clip.translations,
        rate=clip.rate,
        **face,
    )
    write_bytes(path, content.getvalue())


def holds_poses(path: Path) -> bool:
    """Whether an .npz has the arrays of this format."""
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            return set(KEYS) <= set(file)
    except DAMAGE:
        return False


def read_poses(path: Path) -> SourceMotion:
    """Read what `write_poses` wrote; the clip is called as the file. Errors: InputError that names the array."""
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {key: file[key] for key in KEYS}
            face = {key: file[key] for key in FACE_KEYS if key in file}
    except (*DAMAGE, KeyError) as error:
        raise InputError(f"{path}: cannot be read as poses: {error}") from error
    names = tuple(str(name) for name in arrays["names"].ravel())
    joints = len(names)
    skeleton = Skeleton(
        names=names,
        parents=_joints(path, arrays, "parents", (joints,), least=-1),
        bind_rotations=unit_quaternions(arrays["bind_rotations"], f"{path}: bind_rotations", (joints, 4)),
        bind_translations=finite_array(arrays["bind_translations"], f"{path}: bind_translations", (joints, 3)),
        root=int(_joints(path, arrays, "root", (), least=0)),
    )
    if (skeleton.parents >= np.arange(joints)).any():
        raise InputError(f"{path}: parents: a joint comes before its parent, expected it after")
    rotations = unit_quaternions(arrays["rotations"], f"{path}: rotations", (None, joints, 4))
    translations = finite_array(arrays["translations"], f"{path}: translations", (len(rotations), joints, 3))
    rate = float(finite_array(arrays["rate"], f"{path}: rate", ()))
    if not len(rotations) or not LEAST_RATE <= rate <= LARGEST_RATE:
        raise InputError(
            f"{path}: has {len(rotations)} poses at {rate:g} frames per second; expected at least one, "
            f"at {LEAST_RATE:g} to {LARGEST_RATE:g}"
        )
    expressions, weights = _face(path, face, len(rotations))
    clip = Clip(path.stem, rate, rotations, translations, expressions=weights)
    return SourceMotion(skeleton, clip, expressions=expressions)


def _face(path: Path, arrays: dict[str, Array], frames: int) -> tuple[tuple[str, ...], Array | None]:
    """Names and weights [F, E] of expressions; none without them."""
    if not arrays:
        return (), None
    if len(arrays) < len(FACE_KEYS):
        raise InputError(f"{path}: has {next(iter(arrays))} alone, expected {' and '.join(FACE_KEYS)}")
    names = tuple(str(name) for name in arrays["expression_names"].ravel())
    weights = finite_array(arrays[WEIGHTS], f"{path}: {WEIGHTS}", (frames, len(names)))
    return names, np.clip(weights, 0, 1)


def _joints(path: Path, arrays: dict[str, Array], key: str, shape: tuple[int, ...], *, least: int) -> Array:
    """Numbers of joints."""
    found, count = finite_array(arrays[key], f"{path}: {key}", shape), len(arrays["names"])
    if (found != np.rint(found)).any() or (found < least).any() or (found >= count).any():
        raise InputError(f"{path}: {key}: expected whole numbers of {least} to {count - 1}")
    return found.astype(np.int32)
