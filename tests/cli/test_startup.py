"""Commands answer before they load what takes seconds, and all have --version and --quiet."""

import importlib.metadata
import runpy
import sys
from pathlib import Path

import pytest
from commands import Ended, python

import mua
from mua.files import inputs
from mua.recording import layout

INSTALLED = importlib.metadata.distribution("mua").entry_points.select(group="console_scripts")
COMMANDS = sorted(command.name.removeprefix("mua-") for command in INSTALLED)
# What takes long to load, or is not there unless its extra was asked for.
SLOW = (
    "torch",
    "trimesh",
    "warp",
    "wgpu",
    "pxr",
    "scipy",
    "matplotlib",
    "moderngl",
    "meshoptimizer",
    "xatlas",
    "adbutils",
)
RUN = """
sys.argv[0] = "mua-{name}"
try:
    from mua.cli.{name} import run
    run()
finally:
    loaded = sorted(set({slow}) & set(sys.modules))
    if loaded:
        print("loaded:", loaded)
"""


ACTIONS = {"capture": ("check",)}  # commands that do several things


def started(name: str, *arguments: str | Path) -> Ended:
    """A command in a process of its own; it prints what it loaded of all that is slow to load."""
    return python(RUN.format(name=name, slow=SLOW), *ACTIONS.get(name, ()), *arguments)


def refused(ended: Ended) -> str:
    """The sentence of a command that printed nothing else and loaded nothing slow."""
    assert ended.out == ""
    return ended.sentence.removeprefix("error: ")


@pytest.mark.parametrize("name", COMMANDS)
def test_a_wrong_name_is_refused_before_anything_is_loaded(name: str, tmp_path: Path) -> None:
    absent = tmp_path / "absent.muaavatar"
    kind = "directory" if name in ("capture", "eval", "teach", "train") else "file"
    assert refused(started(name, absent)) == f"{absent}: there is no such {kind}"


@pytest.mark.parametrize("name", ["bench", "deploy", "export", "inspect", "pack", "share", "view"])
def test_a_directory_in_place_of_a_file_is_told_likewise(name: str, tmp_path: Path) -> None:
    assert refused(started(name, tmp_path)) == f"{tmp_path}: is a directory, expected a file"


@pytest.mark.parametrize("name", ["eval", "train"])
def test_what_is_no_recording_is_told_likewise(name: str, tmp_path: Path) -> None:
    assert refused(started(name, tmp_path)) == f"{tmp_path}: not a recording, it holds no {layout.HEADER}"
    file = tmp_path / "file"
    file.touch()
    assert refused(started(name, file)) == f"{file}: is a file, expected the directory of a recording"
    assert inputs.HEADER == layout.HEADER


@pytest.mark.parametrize("name", ["bake", "export", "view"])
def test_absent_motion_is_told_likewise(name: str, tmp_path: Path, avatar_file: Path) -> None:
    absent = tmp_path / "walks"
    sentence = refused(started(name, avatar_file, "--motion", absent))
    assert sentence == f"--motion {absent}: there is no such file or directory"


@pytest.mark.parametrize("name", COMMANDS)
def test_says_its_version_without_its_arguments(name: str) -> None:
    assert started(name, "--version").out == f"mua-{name} {mua.__version__}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_runs_as_a_module(name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.delitem(sys.modules, f"mua.cli.{name}", raising=False)  # runpy warns of one that is imported
    monkeypatch.setattr(sys, "argv", [f"mua-{name}", "--version"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module(f"mua.cli.{name}", run_name="__main__")
    assert not ended.value.code
    assert mua.__version__ in capsys.readouterr().out


def test_the_version_is_that_of_the_installation() -> None:
    assert importlib.metadata.version("mua") == mua.__version__


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_the_common_options_and_loads_nothing(name: str) -> None:
    ended = started(name, "--help")
    assert ended.status == 0
    assert "--version" in ended.out
    assert "--quiet" in ended.out
    assert "loaded:" not in ended.out


def test_quiet_prints_nothing_but_errors(avatar_file: Path, tmp_path: Path) -> None:
    assert "metres" in started("inspect", avatar_file).out
    assert started("inspect", "--quiet", avatar_file) == Ended(0, "", "")
    assert refused(started("inspect", "--quiet", tmp_path / "absent"))


@pytest.mark.parametrize(
    ("modules", "absent"),
    [
        ("mua", SLOW),
        ("mua.cli.view, mua.player.window", ("torch", "imgui_bundle", "glfw")),
        ("mua.cli.bake, mua.cli.check", ("torch",)),
    ],
)
def test_importing_does_not_load_what_may_not_be_needed(modules: str, absent: tuple[str, ...]) -> None:
    assert python(f"import {modules}; print(sorted(set({absent}) & set(sys.modules)))") == Ended(0, "[]\n", "")
