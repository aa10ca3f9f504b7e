"""Commands answer before they load what takes seconds, and all have --version and --quiet."""

import importlib.metadata
import subprocess
import sys
from pathlib import Path

import pytest
from synthetic_avatar import synthetic_avatar

import mua
from mua import inputs
from mua.asset import write
from mua.recording import layout

COMMANDS = ("bake", "bench", "deploy", "eval", "inspect", "train", "view")
# What takes long to load, or is not there unless its extra was asked for.
SLOW = ("torch", "warp", "wgpu", "pxr", "scipy", "matplotlib", "moderngl", "meshoptimizer", "xatlas", "adbutils")
RUN = """
import sys
sys.argv = ["mua-{name}", *sys.argv[1:]]
try:
    from mua.cli.{name} import run
    run()
finally:
    loaded = sorted(set({slow}) & set(sys.modules))
    if loaded:
        print("loaded:", loaded)
"""


def started(name: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own; it prints what it loaded of all that is slow to load."""
    code = RUN.format(name=name, slow=SLOW)
    line = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(line, capture_output=True, text=True, check=False)


@pytest.fixture
def avatar_file(tmp_path: Path) -> Path:
    path = tmp_path / "a.muaavatar"
    write(path, synthetic_avatar())
    return path


@pytest.mark.parametrize("name", COMMANDS)
def test_a_wrong_name_is_told_before_anything_is_loaded(name: str, tmp_path: Path) -> None:
    absent = tmp_path / "absent.muaavatar"
    ended = started(name, absent)
    kind = "directory" if name in ("eval", "train") else "file"
    assert ended.stderr == f"error: {absent}: there is no such {kind}\n"
    assert (ended.returncode, ended.stdout) == (1, "")


@pytest.mark.parametrize("name", ["bench", "deploy", "inspect", "view"])
def test_a_directory_in_place_of_a_file_is_told_likewise(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder.muaavatar"
    folder.mkdir()
    ended = started(name, folder)
    assert ended.stderr == f"error: {folder}: is a directory, expected a file\n"
    assert ended.stdout == ""


@pytest.mark.parametrize("name", ["eval", "train"])
def test_what_is_no_recording_is_told_likewise(name: str, tmp_path: Path) -> None:
    assert started(name, tmp_path).stderr == f"error: {tmp_path}: not a recording, it holds no {layout.HEADER}\n"
    file = tmp_path / "file"
    file.touch()
    ended = started(name, file)
    assert ended.stderr == f"error: {file}: is a file, expected the directory of a recording\n"
    assert ended.stdout == ""
    assert inputs.HEADER == layout.HEADER


@pytest.mark.parametrize("name", ["bake", "view"])
def test_absent_motion_is_told_likewise(name: str, tmp_path: Path, avatar_file: Path) -> None:
    absent = tmp_path / "walks"
    ended = started(name, avatar_file, "--motion", absent)
    assert ended.stderr == f"error: --motion {absent}: there is no such file or directory\n"
    assert ended.stdout == ""


@pytest.mark.parametrize("name", COMMANDS)
def test_says_its_version_without_its_arguments(name: str) -> None:
    assert started(name, "--version").stdout == f"mua-{name} {mua.__version__}\n"


def test_the_version_is_that_of_the_installation() -> None:
    assert importlib.metadata.version("mua") == mua.__version__


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_the_common_options_and_loads_nothing(name: str) -> None:
    ended = started(name, "--help")
    assert ended.returncode == 0
    assert "--version" in ended.stdout
    assert "--quiet" in ended.stdout
    assert "loaded:" not in ended.stdout


def test_quiet_prints_nothing_where_all_is_well(avatar_file: Path) -> None:
    assert "metres" in started("inspect", avatar_file).stdout
    quiet = started("inspect", "--quiet", avatar_file)
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")


def test_quiet_still_prints_errors(tmp_path: Path) -> None:
    quiet = started("inspect", "--quiet", tmp_path / "absent")
    assert (quiet.returncode, quiet.stderr.count("\n")) == (1, 1)


def test_importing_the_package_loads_nothing_slow() -> None:
    code = f"import sys, mua; sys.exit(bool(set({SLOW}) & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
