"""Commands answer before they load what takes seconds, and all have --version and --quiet."""

import importlib.metadata
import io
import json
import runpy
import signal
import sys
from pathlib import Path

import pytest
from commands import Ended, python

import mua
from mua.cli.failure import run_command
from mua.files import inputs
from mua.recording import layout

COMMANDS = (
    "bake",
    "bench",
    "capture",
    "deploy",
    "eval",
    "export",
    "inspect",
    "pack",
    "share",
    "teach",
    "train",
    "view",
)
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
import contextlib, io, json
answers = []
for line in json.loads(sys.argv[1]):
    sys.argv[:] = ["mua-{name}", *line]
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        try:
            from mua.cli.{name} import run
            run()
        except SystemExit as ended:
            status = ended.code or 0
        loaded = sorted(set({slow}) & set(sys.modules))
        if loaded:
            print("loaded:", loaded)
    answers.append((status, out.getvalue(), err.getvalue()))
print(json.dumps(answers))
"""


ACTIONS = {"capture": ("check",)}  # of commands that do several things


def started(name: str, *lines: tuple[str | Path, ...]) -> list[Ended]:
    """A command with each of some lines of arguments, in a process of its own; it prints what it loaded of SLOW."""
    given = json.dumps([[*ACTIONS.get(name, ()), *map(str, line)] for line in lines])
    ended = python(RUN.format(name=name, slow=SLOW), given)
    assert (ended.status, ended.err) == (0, "")
    return [Ended(*answer) for answer in json.loads(ended.out)]


def refused(ended: Ended) -> str:
    """The sentence of a command that printed nothing else and loaded nothing slow."""
    assert ended.out == ""
    return ended.sentence.removeprefix("error: ")


def wrong_names(name: str, folder: Path, avatar: Path) -> dict[tuple[str | Path, ...], str]:
    """Arguments of a command that name what is not there or is something else, and its sentences."""
    absent, file, empty = folder / "absent.muaavatar", folder / "file", folder / "empty"
    file.touch()
    empty.mkdir()
    kind = "directory" if name in ("capture", "eval", "teach", "train") else "file"
    wrong: dict[tuple[str | Path, ...], str] = {(absent,): f"{absent}: there is no such {kind}"}
    if name in ("bench", "deploy", "export", "inspect", "pack", "share", "view"):
        wrong[empty,] = f"{empty}: is a directory, expected a file"
    if name in ("eval", "train"):
        wrong[empty,] = f"{empty}: not a recording, it holds no {layout.HEADER}"
        wrong[file,] = f"{file}: is a file, expected the directory of a recording"
    if name in ("bake", "export", "view"):
        wrong[avatar, "--motion", absent] = f"--motion {absent}: there is no such file or directory"
    return wrong


@pytest.mark.parametrize("name", COMMANDS)
def test_wrong_names_version_and_help_are_answered_before_anything_is_loaded(
    name: str, tmp_path: Path, avatar_file: Path
) -> None:
    wrong = wrong_names(name, tmp_path, avatar_file)
    version, shown, *ended = started(name, ("--version",), ("--help",), *wrong)
    assert [refused(one) for one in ended] == list(wrong.values())
    assert version == Ended(0, f"mua-{name} {mua.__version__}\n", "")
    assert shown.status == 0
    assert "--version" in shown.out
    assert "--quiet" in shown.out
    assert "loaded:" not in shown.out
    assert inputs.HEADER == layout.HEADER


@pytest.mark.parametrize("name", COMMANDS)
def test_runs_as_a_module(name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.delitem(sys.modules, f"mua.cli.{name}", raising=False)  # runpy warns of one that is imported
    monkeypatch.setattr(sys, "argv", [f"mua-{name}", "--version"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module(f"mua.cli.{name}", run_name="__main__")
    assert not ended.value.code
    assert mua.__version__ in capsys.readouterr().out


def test_a_name_that_the_console_cannot_show_ends_no_command(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(shown, "ascii", write_through=True))
    monkeypatch.setattr(sys, "argv", ["mua-inspect"])
    with pytest.raises(SystemExit) as ended:
        run_command(lambda: print("Größe"))
    assert not ended.value.code
    assert shown.getvalue() == b"Gr\\xf6\\xdfe\n"


def test_the_version_is_that_of_the_installation() -> None:
    assert importlib.metadata.version("mua") == mua.__version__


def test_quiet_prints_nothing_but_errors(avatar_file: Path, tmp_path: Path) -> None:
    absent = tmp_path / "absent"
    shown, quiet, wrong = started("inspect", (avatar_file,), ("--quiet", avatar_file), ("--quiet", absent))
    assert "metres" in shown.out
    assert quiet == Ended(0, "", "")
    assert refused(wrong)


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


def test_ctrl_c_before_a_command_is_loaded_ends_it_in_silence() -> None:
    assert python("import mua.cli; raise KeyboardInterrupt") == Ended(-signal.SIGINT, "", "")
