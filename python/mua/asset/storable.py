"""Whether a file can store an avatar's numbers and names: checked before anything is written."""

from collections.abc import Iterable, Iterator
from dataclasses import fields, is_dataclass

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import CONTROL
from mua.errors import InputError
from mua.limits import LARGEST


def require_storable(avatar: Avatar) -> None:
    """Raises InputError that names the field of the first number or name that no player could read."""
    clips = [clip.name for clip in avatar.clips]
    require_names("the avatar", [avatar.name], avatar.rig.skeleton.names, clips, avatar.expressions)
    if avatar.wavelet.coarser:
        raise InputError(f"the avatar is at level {avatar.wavelet.coarser}; expected level 0, from which others follow")
    for field, values in _reals(avatar, ""):
        held = np.abs(values) <= LARGEST  # false for nan as well
        if not held.all():
            raise InputError(f"{field}: the value {_worst(values[~held]):.6g} cannot be stored, {_remedy()}")


def require_names(
    owner: str, own: Iterable[str], joints: Iterable[str], clips: Iterable[str], expressions: Iterable[str] = ()
) -> None:
    """Raises InputError for a name that every reader of the file would refuse."""
    kinds = (("its name", own), ("the joint", joints), ("the clip", clips), ("the expression", expressions))
    for kind, names in kinds:
        for name in names:
            if control := CONTROL.search(name):
                found = f"has the control character U+{ord(control[0]):04X} in its name"
                raise InputError(f"{owner}: {kind} {name!r} {found}; rename it")


def _remedy() -> str:
    return (
        f"expected finite numbers up to {LARGEST:.0f}; mua-train --check RECORDING says which channels of a recording "
        "are far from what a splat holds, another --seed trains it anew"
    )


def _worst(values: Array) -> float:
    """The one that says most: what is no number, else the largest."""
    lost = values[~np.isfinite(values)]
    return float(lost[0] if len(lost) else values[np.abs(values).argmax()])


def _reals(value: object, name: str) -> Iterator[tuple[str, Array]]:
    """The names and contents of all arrays of reals within a dataclass."""
    if isinstance(value, np.ndarray) and np.issubdtype(value.dtype, np.floating):
        yield name, value
    elif isinstance(value, tuple):
        for number, one in enumerate(value):
            yield from _reals(one, f"{name}[{number}]")
    elif is_dataclass(value):
        for part in fields(value):
            yield from _reals(getattr(value, part.name), f"{name}.{part.name}".lstrip("."))
