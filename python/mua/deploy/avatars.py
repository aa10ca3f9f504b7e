"""Avatars on their way to the headset: checked here, and complete or absent there."""

import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from mua.asset.read import read
from mua.deploy.headset import Headset
from mua.deploy.player import PACKAGE
from mua.errors import InputError

SUFFIX = ".muaavatar"
PART = ".part"
FOLDER = f"/sdcard/Android/data/{PACKAGE}/files/avatars"


@dataclass(frozen=True)
class Checked:
    """A sound file and the name that the player knows it by."""

    path: Path
    name: str


def check(paths: list[Path]) -> list[Checked]:
    """Files that the player will be able to read.

    Errors: InputError naming the file that is unsound, has another suffix or a name that the player cannot be given.
    """
    checked: list[Checked] = []
    for path in paths:
        if path.suffix != SUFFIX:
            raise InputError(f"{path}: the suffix is {path.suffix!r}, expected {SUFFIX!r}")
        if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9._-]*", path.stem):
            raise InputError(f"{path}: the name is {path.stem!r}, expected letters, digits, '.', '_' and '-' only")
        if path.stem in (held.name for held in checked):
            raise InputError(f"{path}: another avatar of this call has the name {path.stem!r} too")
        read(path)
        checked.append(Checked(path, path.stem))
    return checked


def push(headset: Headset, avatar: Checked) -> int:
    """Send one avatar and return its bytes; under its own name there is only ever a complete file.

    Errors: InputError if it does not arrive whole; what had arrived is deleted.
    """
    content = avatar.path.read_bytes()
    target = f"{FOLDER}/{avatar.name}{SUFFIX}"
    partial = target + PART
    headset.run("mkdir", "-p", FOLDER)
    try:
        headset.send(content, partial)
        _require_size(headset, partial, len(content))
        headset.run("mv", "-f", partial, target)
        _require_size(headset, target, len(content))
    except BaseException:
        with suppress(InputError):  # report the first failure, not that of deleting
            headset.run("rm", "-f", partial)
        raise
    return len(content)


def _require_size(headset: Headset, path: str, size: int) -> None:
    if (found := headset.size(path)) != size:
        raise InputError(f"{headset.serial}: {path} has {found or 0} bytes, expected {size}: is its storage full?")
