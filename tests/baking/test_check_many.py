"""mua-bake --check of several characters: a line each, worst first, and an exit status that scripts can use."""

import json
from pathlib import Path

import pytest
from column_files import column_file
from commands import Commands

from mua.baking import check as checks
from mua.fidelity.compare import Fidelity

pytestmark = pytest.mark.usefixtures("first_try")


@pytest.fixture
def characters(tmp_path: Path) -> Path:
    """A directory with a file that is sound, one that is none, and a note beside them."""
    directory = tmp_path / "characters"
    directory.mkdir()
    column_file(directory).rename(directory / "sound.glb")
    (directory / "broken.glb").write_text("no such thing")
    (directory / "readme.txt").write_text("about them")
    return directory


def test_a_directory_is_a_line_for_each_character_worst_first(
    characters: Path, tmp_path: Path, command: Commands
) -> None:
    output, figures = tmp_path / "out" / "a.muaavatar", tmp_path / "all.json"
    ended = command("bake", characters, "--check", "--texels", 64, "-o", output, "--json", figures)
    lines = [line for line in ended.out.splitlines() if line.split(" ")[0] in ("refused", "look", "good")]
    assert [line.split()[1] for line in lines] == [f"{characters / 'broken.glb'}:", f"{characters / 'sound.glb'}:"]
    assert lines[0].startswith("refused ")
    assert "overlap" in lines[1]
    assert ended.status == 1
    assert [path.name for path in output.parent.iterdir()] == ["sound.glb_check.png"]
    broken, sound = json.loads(figures.read_text())
    assert broken.keys() == {"character", "refused"}
    assert sound["fidelity"]["iou"] > 0.9


@pytest.mark.parametrize(("warnings", "status"), [((), 0), (("its head is missing",), 3)])
def test_the_status_says_whether_anything_looks_wrong(
    warnings: tuple[str, ...],
    status: int,
    characters: Path,
    tmp_path: Path,
    command: Commands,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def compared(*_: object, **__: object) -> tuple[Fidelity | None, tuple[str, ...]]:
        return None, warnings

    monkeypatch.setattr(checks, "fidelity_of", compared)
    sound, other = characters / "sound.glb", column_file(tmp_path)
    ended = command("bake", sound, other, "--check", "--texels", 64, "-o", tmp_path / "a.muaavatar")
    assert ended.status == status
    assert f"2 characters: {0 if warnings else 2} good, {2 if warnings else 0} to look at, 0 refused" in ended.out
    assert command("bake", sound, "--check", "--texels", 64, "-o", tmp_path / "a.muaavatar").status == status


def test_several_characters_are_not_baked(characters: Path, tmp_path: Path, command: Commands) -> None:
    sound = characters / "sound.glb"
    assert (
        f"{sound}: one character is baked at a time; only --check takes several"
        in command("bake", sound, sound).sentence
    )
    walk, run = tmp_path / "walk.bvh", tmp_path / "run.bvh"
    assert (
        f"{run}: one character is baked at a time; only --check takes several; each motion file needs a --motion of"
        in (command("bake", sound, "--motion", walk, run).sentence)
    )


def test_a_directory_without_characters_and_a_name_that_is_wrong_are_refused(tmp_path: Path, command: Commands) -> None:
    assert f"{tmp_path}: expected files that end in .glb" in command("bake", tmp_path, "--check").sentence
    absent = tmp_path / "absent.glb"
    assert f"{absent}: there is no such file" in command("bake", absent, column_file(tmp_path), "--check").sentence
