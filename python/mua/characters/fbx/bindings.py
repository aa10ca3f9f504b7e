"""What ufbx holds, as Python and numpy values; only in a process of its own (`process.py`).

ufbx 0.0.5 gives up a reference too many to what it hands out: to members of enumerations, to arrays whose buffer is
released, to parts of an object that goes. Everything asked of it is therefore held until the process ends, which it
does without taking anything apart.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import ufbx

from mua.arrays import Array
from mua.errors import InputError

Y_UP = ufbx.CoordinateAxes(
    ufbx.CoordinateAxis.POSITIVE_X, ufbx.CoordinateAxis.POSITIVE_Y, ufbx.CoordinateAxis.POSITIVE_Z
)
ENUMS = (ufbx.SkinningMethod, ufbx.WrapMode)  # that are read here
READS = 100_000  # of members of these: more than a file has skins and textures

_held: list[object] = [[member for kind in ENUMS for member in kind] * READS]


def load(path: Path) -> Any:
    """The scene of a file, its root turned to Y up and scaled to metres; a scale that stays with its node gets a node.

    Raises InputError with what ufbx says of a broken file.
    """
    content = path.read_bytes()
    _held.append(content)
    try:
        scene = ufbx.load_memory(
            content,
            filename=str(path),
            file_format=ufbx.FileFormat.FBX,
            target_axes=Y_UP,
            target_unit_meters=1.0,
            space_conversion=ufbx.SpaceConversion.TRANSFORM_ROOT,
            inherit_mode_handling=ufbx.InheritModeHandling.HELPER_NODES,
        )
    except (ufbx.UfbxError, ValueError, MemoryError) as broken:
        said = str(broken) or type(broken).__name__
        raise InputError(f"{path}: the FBX file cannot be read, it is broken or cut short (ufbx: {said})") from broken
    _held.append(scene)
    return scene


def get(thing: Any, path: str) -> Any:
    """An attribute, or with dots an attribute of an attribute."""
    for name in path.split("."):
        thing = getattr(thing, name)
        _held.append(thing)
    return thing


def items(thing: Any, path: str) -> Iterator[Any]:
    """The elements of a list of objects."""
    found = get(thing, path)
    for index in range(len(found)):
        _held.append(found[index])
        yield _held[-1]


def array(thing: Any, path: str) -> Array:
    """A list of vectors or numbers as an array, copied."""
    found = get(thing, path)
    if not len(found):
        return np.zeros((0, 0))
    try:
        _held.append(memoryview(found))
    except TypeError:  # lists of indices have no buffer
        return np.fromiter(found, int, len(found))
    return np.array(_held[-1])


def matrix(thing: Any, path: str) -> Array:
    """A matrix [4, 4] that acts on column vectors."""
    full = np.eye(4)
    full[:3] = np.array(get(thing, path), float).T
    return full
