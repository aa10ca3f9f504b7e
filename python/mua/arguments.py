"""Checks the arguments of public functions, and refuses bad ones with a sentence."""

import operator
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from mua.arrays import Array
from mua.errors import InputError

UNIT_BOUND = 2e-3  # a unit quaternion rounded to f16 leaves 1 by at most 4 x 2^-11
T = TypeVar("T")
PathLike: TypeAlias = str | os.PathLike[str]


def as_path(path: PathLike, name: str) -> Path:
    """The path that argument `name` gives; raises InputError for anything but a str or os.PathLike."""
    if isinstance(path, str | os.PathLike) and isinstance(text := os.fspath(path), str) and text and "\0" not in text:
        return Path(text)
    raise InputError(f"{name} is {describe(path)}; expected a path, as a str or an os.PathLike")


def as_paths(paths: PathLike | Sequence[PathLike], name: str) -> tuple[Path, ...]:
    """One path or several."""
    one = isinstance(paths, str | os.PathLike) or not isinstance(paths, Sequence)
    return tuple(as_path(path, name) for path in ([paths] if one else paths))  # type: ignore[arg-type, union-attr]


def as_names(names: str | Sequence[str], name: str) -> tuple[str, ...]:
    """One name or several; raises InputError for anything but strings."""
    given = (names,) if isinstance(names, str) else names
    if not isinstance(given, Sequence) or not all(isinstance(one, str) for one in given):
        raise InputError(f"{name} is {describe(names)}; expected a name or a list of names")
    return tuple(given)


def one_of(value: T, name: str, choices: Iterable[T]) -> T:
    """One of the choices; raises InputError that lists them for anything else."""
    listed = tuple(choices)
    if value not in listed:
        raise InputError(f"{name} is {describe(value)}; expected {' or '.join(map(str, listed))}")
    return value


def whole_number(value: Any, name: str) -> int:
    """An integer of Python or numpy; raises InputError for anything else, also for True and False."""
    try:
        if not isinstance(value, bool | np.bool_):
            return operator.index(value)
    except TypeError:
        pass
    raise InputError(f"{name} is {describe(value)}; expected a whole number")


def float_type(dtype: npt.DTypeLike, name: str) -> np.dtype[Any]:
    """float32 or float64; raises InputError for any other element type."""
    try:
        found = np.dtype(dtype)
    except (TypeError, ValueError):
        found = np.dtype(object)
    if found not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise InputError(f"{name} is {describe(dtype)}; expected float32 or float64")
    return found


def finite_array(values: Any, name: str, shape: tuple[int | None, ...]) -> Array:
    """Finite real numbers of `shape` (None: any length) as float64; raises InputError for anything else."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of several lengths
        raise InputError(f"{name}: not an array, expected the shape {_written(shape)}") from None
    if array.dtype.kind not in "iuf":
        raise InputError(f"{name}: has elements of type {array.dtype}, expected real numbers")
    if array.ndim != len(shape) or any(n not in (None, m) for n, m in zip(shape, array.shape, strict=True)):
        raise InputError(f"{name}: the shape is {_written(array.shape)}, expected {_written(shape)}")
    if not np.isfinite(array).all():
        raise InputError(f"{name}: a value is not finite")
    return array.astype(np.float64, copy=False)


def unit_quaternions(values: Any, name: str, shape: tuple[int | None, ...]) -> Array:
    """Quaternions of `shape` as float64, brought to length 1 where they are of another; raises InputError for zeros."""
    quaternions = finite_array(values, name, shape)
    lengths = np.linalg.norm(quaternions, axis=-1, keepdims=True)
    if not lengths.all():
        raise InputError(f"{name}: a quaternion is 0 0 0 0, expected a rotation")
    return np.where(np.abs(lengths - 1) > UNIT_BOUND, quaternions / lengths, quaternions)


def describe(value: object) -> str:
    """A value for a sentence, with its type where the value does not show it."""
    shown = repr(value)
    shown = shown if len(shown) <= 60 and "\n" not in shown else "a value"
    return shown if isinstance(value, str | None) else f"{shown} ({type(value).__name__})"


def _written(shape: tuple[int | None, ...]) -> str:
    return f"[{', '.join('any' if n is None else str(n) for n in shape)}]"


def amount(count: int, noun: str) -> str:
    """How many of what, as in a sentence: 1 clip, 2,000 frames."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"


def listed(words: Sequence[str]) -> str:
    """Join words as in a sentence: a, b or c."""
    return " or ".join(part for part in (", ".join(words[:-1]), words[-1]) if part)
