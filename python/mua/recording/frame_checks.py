"""What a recording takes of a frame: numbers of the right shape, finite, in order, within half precision."""

import numpy as np

from mua.arguments import describe
from mua.arrays import Array
from mua.channels import ATTRIBUTES, CHANNELS
from mua.errors import InputError
from mua.pose.skeleton import Pose
from mua.recording.layout import Header

ROTATIONS = ", unit quaternions wxyz; from_axis_angle and from_matrix of mua.rotation make them"
UNIT_LENGTH_ERROR = 1e-3  # tolerance of a joint quaternion's length: rounding of the source, not another convention
TENSOR = "; a tensor goes in as tensor.detach().cpu().numpy()"
HALF_MAX = float(np.finfo(np.float16).max)


def checked_pose(pose: Pose, joints: int) -> tuple[Array, Array]:
    if not isinstance(pose, Pose):
        raise InputError(f"pose is {describe(pose)}; expected a mua.Pose")
    rotations = checked_array("pose rotations", pose.rotations, (joints, 4), np.float64)
    translations = checked_array("pose translations", pose.translations, (joints, 3), np.float64)
    lengths = np.linalg.norm(rotations, axis=1)
    joint = int(np.argmax(np.abs(lengths - 1)))
    if abs(lengths[joint] - 1) > UNIT_LENGTH_ERROR:
        raise InputError(f"pose rotation of joint {joint} has length {lengths[joint]:.4g}, expected 1")
    return rotations, translations


def check_order(frame: int, expected: int) -> None:
    if frame < expected:
        raise InputError(f"frame={frame} was added already, expected frame={expected}: frames come in order, each once")
    if frame > expected:
        remedy = "a frame that the teacher does not evaluate is added with its pose alone"
        raise InputError(f"frame={frame} comes after frame {expected - 1}, expected frame={expected}: {remedy}")


def checked_array(name: str, value: Array, shape: tuple[int, ...], dtype: type[np.floating]) -> Array:
    """A copy of the given type; raises InputError for another shape or a value that is not finite."""
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError(array.dtype)
        array = array.astype(dtype)
    except (TypeError, ValueError, RuntimeError):
        raise InputError(f"{name} is no array of numbers, expected one of the shape {list(shape)}{TENSOR}") from None
    if array.shape != shape:
        hint = ROTATIONS if shape[-1] == 4 else ""
        raise InputError(f"{name} has shape {list(array.shape)}, expected {list(shape)}{hint}")
    if not np.isfinite(array).all():
        where = np.argwhere(~np.isfinite(array))[0].tolist()
        raise InputError(f"{name} is {array[tuple(where)]} at {where}, expected finite numbers")
    return array


def check_range(
    difference: Array,  # [N, 23] from the reference
    texels: Array,  # [N] row * size + col
    size: int,
) -> None:
    """Raise InputError for the first value that is not finite, or too far from the reference for half precision."""
    if difference.max(initial=0) <= HALF_MAX and difference.min(initial=0) >= -HALF_MAX:  # also false for nan
        return
    texel, channel = np.argwhere(~(np.abs(difference) <= HALF_MAX))[0]
    row, column = divmod(int(texels[texel]), size)
    name = next(name for name, where in ATTRIBUTES.items() if where.start <= channel < where.stop)
    value = difference[texel, channel]
    problem = f"is {value}" if not np.isfinite(value) else f"differs by {value:.3g} from the reference frame's"
    raise InputError(
        f"texture channel {channel} ({name}) at row {row}, column {column} {problem}, "
        f"expected a finite number no further than {HALF_MAX:.0f} from it"
    )


def valid_texture(
    texture: Array,  # [N, 23] or [H, W, 23]
    header: Header,
    texels: Array,  # [N] row * size + col
) -> Array:
    """The values [N, 23] float32 at the valid texels; raises InputError for any other shape."""
    try:
        texture = np.asarray(texture)
    except (TypeError, ValueError, RuntimeError):
        raise InputError(f"texture is no array that numpy reads{TENSOR}") from None
    if texture.dtype.kind not in "iuf":
        raise InputError(f"texture has elements of type {texture.dtype}, expected real numbers")
    if texture.shape == (header.valid_texels, CHANNELS):
        return np.asarray(texture, dtype=np.float32)
    if texture.shape == (header.texels, header.texels, CHANNELS):
        return texture.reshape(-1, CHANNELS)[texels].astype(np.float32, copy=False)
    expected = f"[{header.valid_texels}, 23] at the valid texels or [{header.texels}, {header.texels}, 23]"
    channels = "offset 3, quaternion 4 (wxyz), log scale 3, opacity logit 1, SH 12 (coefficient-major)"
    if texture.ndim and texture.shape[-1] == CHANNELS + 3:
        channels += "; the 3 of the base position follow from the mesh and are left out"
    raise InputError(f"texture has shape {list(texture.shape)}, expected {expected} with the channels {channels}")
