"""mua-inspect prints what a file holds and refuses a broken one in a sentence."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import Commands, Ended, process
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.asset import write
from mua.asset.read import load, read
from mua.asset.summary import summary

Inspect = Callable[..., Ended]  # the command with its arguments, on a terminal of so many columns


@pytest.fixture
def inspect(command: Commands, monkeypatch: pytest.MonkeyPatch) -> Inspect:
    def run(*arguments: object, columns: int = 160) -> Ended:
        monkeypatch.setenv("COLUMNS", str(columns))
        return command("inspect", *arguments)

    return run


def test_shows_skeleton_texels_ranks_costs_and_clips(avatar_file: Path, inspect: Inspect) -> None:
    shown = inspect(avatar_file)
    assert shown.status == 0
    for text in ("3 joints, root root", "of 32 x 32", "4 3 2", "M parameters", "GFLOPs", "wave", "bior4.4"):
        assert text in shown.out


def test_verify_accepts_a_sound_file(avatar_file: Path, inspect: Inspect) -> None:
    verified = inspect("--verify", avatar_file)
    assert (verified.status, "sound" in verified.out) == (0, True)


def test_verify_refuses_a_damaged_file_in_one_sentence(avatar_file: Path, inspect: Inspect) -> None:
    content = bytearray(avatar_file.read_bytes())
    content[-9] ^= 1
    avatar_file.write_bytes(content)
    assert inspect("--verify", avatar_file).sentence.startswith(f"error: {avatar_file}: ")


def test_the_root_is_the_one_that_the_skeleton_says(avatar_file: Path) -> None:
    avatar = read(avatar_file)
    rig = replace(avatar.rig, skeleton=replace(avatar.rig.skeleton, root=1))
    assert summary(avatar_file, load(avatar_file), replace(avatar, rig=rig))["skeleton"]["root"] == "middle"


def test_is_printed_whole_into_a_pipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    path = tmp_path / ("long_" * 20 + ".muaavatar")
    notes = "a sentence of a teacher [simulated] " * 12
    write(path, replace(synthetic_avatar(), notes=notes.strip()))
    shown = process("inspect", path).out
    assert notes.strip() in shown
    assert str(path) in shown
    assert "…" not in shown


def test_json_holds_all_that_the_tables_show_and_the_names_that_the_guide_lists(
    avatar_file: Path, inspect: Inspect
) -> None:
    held = json.loads(inspect("--json", avatar_file).out)
    guide = (Path(__file__).parents[2] / "docs" / "inspect.md").read_text()
    table = "".join(line for line in guide.splitlines() if line.startswith("| `"))
    for name, value in held.items():
        assert f"`{name}`" in table or f"`{name}." in table, name
        for inner in value if isinstance(value, dict) else value[0] if name == "clips" else ():
            assert f"{inner}`" in table, inner
    assert held["skeleton"] == {"joints": ["root", "middle", "tip"], "root": "root"}
    assert held["clips"] == [{"name": "wave", "frames": 7, "rate": 24.0, "seconds": 7 / 24}]
    assert (held["bytes"], held["file"]) == (avatar_file.stat().st_size, str(avatar_file))
    assert held["ranks"] == {"geometry": [4, 3, 2], "appearance": [4, 3, 2]}
    shown = inspect(avatar_file).out
    for number in (*held["bytes_by_part"].values(), *held["parameters"].values()):
        assert f"{number:,}" in shown


def test_expressions_are_named(tmp_path: Path, inspect: Inspect) -> None:
    path = tmp_path / "face.muaavatar"
    write(path, with_expressions(synthetic_avatar()))
    held = json.loads(inspect("--json", path).out)
    assert held["expressions"] == ["jawOpen", "eyeBlinkLeft", "nothing", "Mund auf"]
    assert held["bytes_by_part"]["expressions"] == 4 * (5 + 7) + 2 * 4 * 7 + 5 * 4  # entries, offsets and gains, shapes
    assert held["ruled_expressions"] == []
    assert "4: jawOpen, eyeBlinkLeft, nothing, Mund auf" in inspect(path).out
    made = with_expressions(synthetic_avatar())
    assert made.rig.expressions
    own = replace(made.rig.expressions, rules=np.array([3, 0, 64, 0], np.int32))
    write(path, replace(made, rig=replace(made.rig, expressions=own)))
    assert json.loads(inspect("--json", path).out)["ruled_expressions"] == ["jawOpen", "nothing"]
    assert "jawOpen, nothing" in inspect(path).out


def test_a_packed_file_shows_what_it_holds_packed_and_unpacked(tmp_path: Path, inspect: Inspect) -> None:
    path = tmp_path / "packed.muaavatar"
    write(path, synthetic_avatar(), storage="packed")
    held = json.loads(inspect("--json", path).out)
    assert (held["format"], held["storage"]) == ("1.2", "packed")
    assert all(held["bytes_by_part"][part] <= size for part, size in held["unpacked_bytes_by_part"].items())
    assert sum(held["bytes_by_part"].values()) < held["bytes"] < sum(held["unpacked_bytes_by_part"].values())
    shown = inspect(path).out
    assert "unpacked" in shown
    assert f"{held['unpacked_bytes_by_part']['geometry']:,}" in shown


def test_a_plain_file_shows_its_bytes_once(avatar_file: Path, inspect: Inspect) -> None:
    held = json.loads(inspect("--json", avatar_file).out)
    assert held["bytes_by_part"] == held["unpacked_bytes_by_part"]
    assert "unpacked" not in inspect(avatar_file).out


def test_json_and_verify_are_one_or_the_other(avatar_file: Path, inspect: Inspect) -> None:
    refused = inspect("--json", "--verify", avatar_file)
    assert refused.sentence.startswith("error: --json and --verify are both given")
    assert refused.out == ""


def test_a_file_without_clips_says_so(tmp_path: Path, inspect: Inspect) -> None:
    path = tmp_path / "still.muaavatar"
    write(path, replace(synthetic_avatar(), clips=()))
    assert "It holds no clips." in inspect(path).out
    assert json.loads(inspect("--json", path).out)["clips"] == []
