"""Options of mua-bake are refused in one sentence, before anything is loaded."""

import errno
import inspect
import os
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from commands import Commands, python

import mua
from mua.baking.bake import read_settings
from mua.baking.options import check_inputs, check_output
from mua.baking.settings import BakeSettings
from mua.cli import bake, teach, train
from mua.errors import InputError

HEAVY = {"torch", "warp", "pxr"}


def settings(**changed: Any) -> BakeSettings:
    """The settings of a bake with some options changed."""
    arguments = inspect.signature(mua.bake).parameters.values()
    return read_settings({one.name: one.default for one in arguments} | changed)


def test_one_process_per_core_records_by_default() -> None:
    assert settings(jobs=3).jobs == 3
    assert settings().jobs >= 1


def test_numbers_override_the_preset() -> None:
    student = settings(preset="tiny", seed=3, frames=7, texels=64).student
    assert (student.seed, student.frames, student.texels) == (3, 7, 64)


def test_files_that_are_not_there_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nobody\.glb: there is no such file"):
        check_inputs(tmp_path / "nobody.glb", [])
    with pytest.raises(InputError, match="is a directory, expected a file"):
        check_inputs(tmp_path, [])
    with pytest.raises(InputError, match=r"--motion .*walk\.bvh: there is no such file or directory"):
        check_inputs(None, [tmp_path, tmp_path / "walk.bvh"])


def test_a_file_in_the_place_of_the_work_directory_is_refused(tmp_path: Path) -> None:
    (tmp_path / "work").touch()
    with pytest.raises(InputError, match=r"--work .*: is a file, expected a directory"):
        check_output(tmp_path / "a.muaavatar", tmp_path / "work")


def test_directories_to_make_are_listed_once(tmp_path: Path) -> None:
    new = tmp_path / "new"
    assert check_output(new / "more" / "a.muaavatar", new / "work") == [new]
    assert check_output(tmp_path / "a.muaavatar", tmp_path / "work") == []


@pytest.mark.parametrize("checked", [(), ("--check",)], ids=["bake", "check"])
@pytest.mark.parametrize(("option", "given"), [("--mapping", "--mapping m.json"), ("--feet plant", "--feet plant")])
def test_what_becomes_of_motion_files_is_refused_where_there_are_none(
    command: Commands,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    checked: tuple[str, ...],
    option: str,
    given: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("m.json").write_text('{"hips": "root"}')
    for stage in ("mua.baking.pipeline.bake", "mua.cli.check.check_and_show"):  # which would take minutes
        monkeypatch.setattr(stage, lambda *_: pytest.fail("begun"))
    ended = command("bake", *given.split(), *checked)
    assert ended.sentence == f"error: {option}: works only with --motion, which is not given"


WRONG = [["--preset", "huge"], ["--texels", "100"], ["nobody.glb"], ["--mapping", "none.json"], ["-o", "a.glb"]]
REFUSED = f"""
from mua.cli.bake import run
for arguments in {WRONG}:
    sys.argv[1:] = arguments
    try:
        run()
    except SystemExit:
        print(arguments, {HEAVY} & set(sys.modules) or "")
"""


def test_wrong_options_are_refused_before_torch_warp_or_readers_are_loaded() -> None:
    ended = python(REFUSED)
    assert ended.err.count("error: ") == ended.err.count("\n") == len(WRONG)
    assert ended.out.splitlines() == [f"{arguments} " for arguments in WRONG]


@pytest.mark.parametrize("closed", ["", "work"])
def test_a_work_directory_that_exists_is_asked_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, closed: str
) -> None:
    """It may be the one place where something can be written, or a mount where nothing can."""
    volume = tmp_path / "volume"
    (volume / "work").mkdir(parents=True)
    touch = Path.touch

    def read_only(self: Path) -> None:
        if self.parent == volume / closed:
            raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(self))
        touch(self)

    monkeypatch.setattr(Path, "touch", read_only)
    if not closed:
        assert check_output(tmp_path / "a.muaavatar", volume / "work") == []
        return
    with pytest.raises(InputError, match=r"--work .*work: nothing can be written in .*work \(Read-only file system\)"):
        check_output(tmp_path / "a.muaavatar", volume / "work")


@pytest.mark.parametrize(
    ("function", "command"), [(mua.bake, bake), (mua.train, train), (mua.teach, teach)], ids=["bake", "train", "teach"]
)
def test_every_argument_of_the_function_is_an_option_of_the_command(
    function: Callable[..., object], command: ModuleType
) -> None:
    options = set(inspect.signature(command.main).parameters) - {"check", "json", "more", "verbose"}
    assert options == set(inspect.signature(function).parameters) - {"listener"}
