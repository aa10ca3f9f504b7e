"""What a bake ends with: an overall line, a line for each clip, and the file's size."""

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import typer
from rich.console import Console

from mua.baking.distillation import Baked
from mua.baking.report import HELD_OUT, Stored, as_json, closing, markdown, missed, shortfalls, table
from mua.baking.student_errors import Errors, Picture, held_out_errors
from mua.cli.display import UNEXPLAINED, Display, show
from mua.pose.clip import Clip
from mua.recording import RecordedClip, WholeFrame


def errors(
    student: float, frames: int = 2, *, bands: float | None = None, best: float | None = None, outside: float = 0.0
) -> Errors:
    """Of a teacher that is one everywhere; bands, bases and student miss it by so much. The mean is nought."""
    rest = Clip("a", 30.0, np.zeros((1, 1, 4)), np.zeros((1, 1, 3)))
    clip = RecordedClip(rest.name, 30.0, rest.rotations, rest.translations, False, np.zeros(1, np.int64), True)
    frame = WholeFrame(clip, 0, 0, np.ones((4, 3), np.float32), np.ones((5, 23), np.float32))
    misses = {"mean": 1, "bands": bands or student, "best": best or student, "student": student}
    counted = Errors()
    for _ in range(frames):
        pictures = {name: Picture(np.full((5, 23), 1 - v), np.full((4, 3), 1 - v)) for name, v in misses.items()}
        counted.add(frame, {**pictures, "student": replace(pictures["student"], outside=outside)})
    return counted


GROUPS = {"training": errors(0.1), "walk (end)": errors(0.2, frames=1), "dance": errors(0.4, frames=3)}


def printed(groups: dict[str, Errors]) -> list[list[str]]:
    output = io.StringIO()
    console = Console(file=output, width=200)
    console.print(table(groups))
    return [line.replace("│", " ").split("  ") for line in output.getvalue().splitlines() if "│" in line]


def test_the_terminal_has_a_line_for_training_for_all_held_out_and_for_each_clip() -> None:
    names = [next(cell.strip() for cell in row if cell.strip()) for row in printed(GROUPS)]
    assert names == ["training", HELD_OUT, "walk (end)", "dance"]
    lines = ["".join(row) for row in printed(GROUPS)]
    assert "99.0 %" in lines[0]
    assert "96.0 %" in lines[2]


def test_a_single_held_out_clip_is_said_once() -> None:
    assert len(printed({"training": errors(0.1), "dance": errors(0.2)})) == 2


def test_files_hold_all_held_out_clips_together_too() -> None:
    assert f"| {HELD_OUT} (4) | SH |" in markdown(GROUPS, teacher="a formula")
    assert '"held_out": {\n  "frames": 4' in as_json(GROUPS, teacher="a formula", held_out={"walk": 8, "dance": 0})


def test_what_the_student_misses_is_split_by_cause() -> None:
    assert missed(errors(0.3, best=0.2, bands=0.1), "SH") == ("1.0 %", "3.0 %", "5.0 %")  # differences of squares


def test_a_clip_that_is_worse_than_the_mean_is_said_with_its_cause() -> None:
    assert shortfalls(GROUPS) == []
    assert shortfalls({"training": errors(1.0)}) == []  # as good as the mean
    (far,) = shortfalls({**GROUPS, "kick": errors(1.1, outside=0.42)})
    assert far.startswith("kick: the mean texture is nearer to the teacher in offset (-21.0 %), ")
    assert "colour (-21.0 %), mesh (-21.0 %): 42.0 % of its poses lies outside of training" in far
    (near,) = shortfalls({"walk (end)": errors(1.1, outside=0.1), "dance": errors(0.9)})
    assert near.endswith("raise --frames")


@pytest.mark.parametrize(("miss", "status"), [(0.9, 0), (1.1, UNEXPLAINED)])
def test_a_shortfall_ends_the_command_with_a_status_of_its_own(
    miss: float, status: int, capsys: pytest.CaptureFixture[str]
) -> None:
    stored = Stored(clips=1, seconds=1.0, clip_bytes=1, file_bytes=1)
    baked = Baked({"training": errors(0.1), "kick": errors(miss)}, Path("a.muaavatar"), stored, "a formula")
    ended = 0
    try:
        show(Console(file=io.StringIO(), width=200), baked)
    except typer.Exit as end:
        ended = end.exit_code
    assert ended == status
    said = capsys.readouterr().err
    assert said.startswith("warning: kick: ") if status else not said


def test_how_far_outside_is_the_mean_over_frames() -> None:
    groups = {"a": errors(0.1, frames=1, outside=0.4), "b": errors(0.1, frames=3, outside=0.2)}
    held = held_out_errors(groups)
    assert held is not None
    assert held.mean_outside == pytest.approx(0.25)
    assert json.loads(as_json(groups, teacher="a formula", held_out={}))["groups"]["b"]["outside"] == pytest.approx(0.2)


def test_an_attribute_that_does_not_move_is_no_shortfall() -> None:
    """What is left of it is rounding, of which a student explains less than nothing."""
    still = errors(1.1)
    still.squares = {key: square * 1e-12 for key, square in still.squares.items()}
    assert shortfalls({"walk": still}) == []


def test_the_last_lines_say_what_the_file_holds() -> None:
    stored = Stored(clips=21, seconds=508.0, clip_bytes=10_400_000, file_bytes=61_200_000)
    assert closing(stored, Path("a.muaavatar")) == (
        "a.muaavatar: 61.2 MB, of which 10.4 MB are 21 clips (8 min 28 s together)"
    )
    one = Stored(clips=1, seconds=5.3, clip_bytes=42_400, file_bytes=1_800_000)
    assert closing(one, Path("a.muaavatar")) == "a.muaavatar: 1.8 MB, of which 42 kB are 1 clip (5.3 s)"
    none = Stored(clips=0, seconds=0.0, clip_bytes=0, file_bytes=5_000_000)
    assert closing(none, Path("a.muaavatar")) == "a.muaavatar: 5.0 MB, no clip stored for playback"


def test_a_sentence_that_comes_several_times_in_a_stage_is_said_once() -> None:
    file = io.StringIO()
    with Display(Console(file=file)) as shown:
        shown.stage("character")
        for sentence in ("It is large.", "It slides.", "It slides."):
            shown.note(sentence)
    assert file.getvalue().splitlines()[1:3] == ["  It is large.", "  It slides. (2 times)"]


@pytest.mark.parametrize("width", [80, 1000])
def test_no_figure_of_the_table_is_cut(width: int) -> None:
    output = io.StringIO()
    console = Console(file=output, width=width)
    named = {f"a clip with a long name, number {i} [end]": errors(0.1 * i) for i in range(1, 4)}
    console.print(table({"training": errors(0.1), **named}))
    shown = output.getvalue()
    assert "…" not in shown
    for figure in ("99.0 %", "96.0 %", "91.0 %"):
        assert figure in shown
    assert "[end]" in shown.replace("\n", "") or width == 80


def test_an_end_that_follows_another_stages_line_is_named() -> None:
    file = io.StringIO()
    with Display(Console(file=file)) as shown:
        shown.stage("geometry")
        shown.step(0, 2)
        shown.stage("appearance")
        shown.step(2, 2)
        shown.stage("geometry")
        shown.step(2, 2)
        shown.stage("avatar")
    said = [line.strip().split(" ")[0] for line in file.getvalue().splitlines()]
    assert said == ["geometry", "appearance", "appearance:", "geometry:", "avatar", "0.0"]
