"""FBX files that are damaged, and readers that crash: one sentence each."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fbx_files import figure, picture

from mua.characters.fbx import process
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion

READ_EACH = """
import os, sys
from pathlib import Path
from mua.characters.fbx.scene import read_scenes
from mua.errors import InputError

for name in sys.argv[1:]:
    child = os.fork()
    if not child:
        try:
            read_scenes(Path(name), "animation")
        except InputError as error:
            os._exit(0 if str(error).startswith(name) else 3)
        except BaseException as error:
            print(name, repr(error), flush=True)
            os._exit(4)
        os._exit(0)
    _, status = os.waitpid(child, 0)
    if os.WIFEXITED(status) and os.WEXITSTATUS(status):
        print(name, "status", os.WEXITSTATUS(status), flush=True)
"""


def whole(tmp_path: Path, *, binary: bool) -> bytes:
    fbx, bones, body = figure()
    fbx.texture(fbx.material(body), "a.png", picture((9, 9, 9, 255)))
    fbx.animate(fbx.stack("bend", 5), bones[1], "Lcl Rotation", np.arange(15.0).reshape(5, 3))
    return fbx.save(tmp_path / "whole.fbx", binary=binary).read_bytes()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="os.fork is only on Linux and macOS")
@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
def test_damaged_files_are_read_or_refused_in_a_sentence(tmp_path: Path, binary: bool) -> None:
    content = whole(tmp_path, binary=binary)
    rng = np.random.default_rng(7)
    damaged = [content[:end] for end in np.linspace(1, len(content) - 1, 40).astype(int)]
    for _ in range(60):
        flipped = np.frombuffer(content, np.uint8).copy()
        flipped[rng.integers(30, len(content), 4)] ^= rng.integers(1, 256, 4).astype(np.uint8)
        damaged.append(flipped.tobytes())
    paths = [tmp_path / f"{number}.fbx" for number in range(len(damaged))]
    for path, part in zip(paths, damaged, strict=True):
        path.write_bytes(part)
    ended = subprocess.run([sys.executable, "-c", READ_EACH, *map(str, paths)], capture_output=True, text=True)
    assert (ended.returncode, ended.stdout) == (0, "")


def test_a_file_cut_short_is_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "hero.fbx"
    path.write_bytes(whole(tmp_path, binary=True)[:2000])
    for read in (read_surfaces, read_motion):
        with pytest.raises(InputError, match=r"hero\.fbx: the FBX file cannot be read, it is broken or cut short"):
            read(path)


def test_a_reader_that_crashes_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "hero.fbx"
    path.write_bytes(whole(tmp_path, binary=True))
    crash = tmp_path / "crash"
    crash.write_text("#!/bin/sh\nkill -SEGV $$\n")
    crash.chmod(0o755)
    monkeypatch.setattr(process.sys, "executable", str(crash))
    with pytest.raises(InputError, match=r"hero\.fbx: .* its reader ended early, with status -11"):
        read_surfaces(path)


def test_a_reader_that_does_not_end_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "hero.fbx"
    path.write_bytes(whole(tmp_path, binary=True))
    monkeypatch.setattr(process, "SECONDS", 0.01)
    with pytest.raises(InputError, match=r"hero\.fbx: reading the FBX file takes longer than"):
        read_surfaces(path)


def test_other_content_under_the_suffix_is_called_what_it_is(tmp_path: Path) -> None:
    path = tmp_path / "hero.fbx"
    path.write_bytes(b"<html><body>404</body></html>")
    with pytest.raises(InputError, match="is an HTML page, not an FBX file"):
        read_surfaces(path)
