"""mua-inspect prints what a file holds and refuses a broken one in a sentence."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from synthetic_avatar import synthetic_avatar

from mua.asset import write


def inspect(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", "from mua.cli.inspect import run; run()", *arguments]
    environment = {"COLUMNS": "160", "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


@pytest.fixture
def avatar_file(tmp_path: Path) -> Path:
    path = tmp_path / "a.muaavatar"
    write(path, synthetic_avatar())
    return path


def test_shows_skeleton_texels_ranks_costs_and_clips(avatar_file: Path) -> None:
    shown = inspect(str(avatar_file))
    assert shown.returncode == 0
    for text in ("3 joints, root root", "of 32 x 32", "4 3 2", "M parameters", "GFLOPs", "wave", "bior4.4"):
        assert text in shown.stdout


def test_verify_accepts_a_sound_file(avatar_file: Path) -> None:
    verified = inspect("--verify", str(avatar_file))
    assert (verified.returncode, "sound" in verified.stdout) == (0, True)


def test_verify_refuses_a_damaged_file_in_one_sentence(avatar_file: Path) -> None:
    content = bytearray(avatar_file.read_bytes())
    content[-9] ^= 1
    avatar_file.write_bytes(content)
    refused = inspect("--verify", str(avatar_file))
    assert refused.returncode == 1
    assert refused.stderr.startswith(f"error: {avatar_file}: ")
    assert refused.stderr.count("\n") == 1
