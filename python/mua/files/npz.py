"""Reading .npz files that may be missing or damaged."""

import zipfile
from collections.abc import Collection
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.errors import InputError


def read_npz(path: Path, names: Collection[str], *, optional: Collection[str] = ()) -> dict[str, Array]:
    """The arrays `names` of a file, and those of `optional` that it has.

    Raises InputError where it is missing, damaged or lacks one of `names`.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: stored[name] for name in (*names, *(name for name in optional if name in stored))}
    except FileNotFoundError as error:
        raise InputError(f"{path}: is missing") from error
    except KeyError as error:
        raise InputError(f"{path}: lacks the array {error.args[0]}") from error
    except (OSError, ValueError, EOFError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: is damaged or cut short, expected a .npz file") from error
