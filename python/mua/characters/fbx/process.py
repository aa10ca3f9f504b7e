"""FBX is read in a process of its own: where ufbx, which is C, crashes on a broken file, the user reads a sentence."""

import os
import pickle
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, TypeAlias

from mua.errors import InputError
from mua.scene import Scene

Wanted: TypeAlias = Literal["skinned", "animation"]
SECONDS = 600  # after which a file is given up: one of a million triangles takes a few


def scenes_of(path: Path, wanted: Wanted) -> list[Scene]:
    """The scenes that `scene.py` reads of a file: with its meshes, and for `animation` also without.

    It takes about 0.4 s to start, once for each file. Raises InputError where the file is broken.
    """
    if find_spec("ufbx") is None:
        raise ModuleNotFoundError("No module named 'ufbx'", name="ufbx")
    command = [sys.executable, "-m", "mua.characters.fbx", wanted, os.fspath(path)]
    try:
        ended = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=SECONDS)
    except subprocess.TimeoutExpired as late:
        raise InputError(f"{path}: reading the FBX file takes longer than {SECONDS} s, expected seconds") from late
    except OSError as error:
        raise InputError(f"{path}: a process to read it cannot be started ({error.strerror})") from error
    try:
        answer = pickle.loads(ended.stdout)
    except Exception as lost:
        raise InputError(f"{path}: the FBX file is broken: its reader ended early, {_ending(ended)}") from lost
    if isinstance(answer, str):
        raise InputError(answer)
    return list(answer)


def _ending(ended: "subprocess.CompletedProcess[bytes]") -> str:
    """How a process ended, in words: the signal or its last line of output."""
    lines = ended.stderr.decode(errors="replace").strip().splitlines()
    if ended.returncode < 0 or not lines:
        return f"with status {ended.returncode}"
    return f"with {lines[-1]}"


def hand_back() -> None:
    """Read the file that the arguments name and write its scenes, or a sentence on why there are none, to stdout."""
    from mua.characters.fbx.scene import read_scenes  # with ufbx

    wanted, path = sys.argv[1:]
    try:
        answer: object = read_scenes(Path(path), wanted)
    except InputError as error:
        answer = str(error)
    pickle.dump(answer, sys.stdout.buffer, protocol=5)
    sys.stdout.buffer.flush()
    os._exit(0)  # without the end of an interpreter, in which ufbx may crash
