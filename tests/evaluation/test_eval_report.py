"""The tables of mua-eval: what holds for all is said once, no figure is cut, storage is held against itself."""

import io
import math
from dataclasses import replace

import pytest
from rich.console import Console

from mua.evaluation import capture_report, entries, report
from mua.evaluation.capture_scores import FilmedEntry
from mua.evaluation.cost import Cost
from mua.evaluation.entries import Entry, Picture
from mua.evaluation.metrics import Scores
from mua.evaluation.scores import Result, Sample
from mua.recording import WholeFrame
from mua_research.curve import COSTS


def truth(frame: WholeFrame) -> Picture:
    return Picture(frame.texture)


def result(name: str, psnr: float, cost: Cost, *, own_mesh: bool = False) -> Result:
    scores = Scores(psnr, 0.9, 0.9, 0.1, math.nan)
    samples = [Sample("a", 0, held_out, 0, 0.2, scores) for held_out in (False, True)]
    return Result(Entry(name, truth, cost, own_mesh=own_mesh), samples)


def test_storage_is_held_against_the_widest_file_of_the_same_avatar() -> None:
    def stored(kind: str, size: int, parameters: int = 10) -> Cost:
        return Cost(parameters=parameters, flops=1, bytes=size, storage=kind)

    rows = [
        result("small", 40.0, stored("i8", 2_000_000)),
        result("other", 30.0, stored("f16", 5, parameters=11)),
        result("exact", 40.125, stored("f32", 8_000_000)),
        result("small, own mesh", 20.0, stored("i8", 2_000_000), own_mesh=True),
        result("a system", 50.0, Cost(parameters=10, flops=1, bytes=40)),
    ]
    assert report.storage_costs(rows) == [
        ("small", "i8", "2.00", "-0.125", "-0.125"),
        ("exact", "f32", "8.00", "+0.000", "+0.000"),
    ]


def table(rows: list[Result], setting: report.Setting) -> str:
    console = Console(file=io.StringIO(), width=80)
    console.print(report.tables(rows, setting))
    return console.file.getvalue()  # type: ignore[attr-defined]


def row(entry: Entry, failure: str = "") -> Result:
    scores = Scores(48.12, 0.9934, 0.9991, 0.0123, math.nan)
    samples = [] if failure else [Sample("walk", 0, held, 0, 0.08, scores) for held in (False, True)]
    return Result(entry, samples, failure)


def test_costs_are_printed_in_the_units_of_their_headings() -> None:
    costs = Cost(parameters=2_500_000, flops=1_234_000_000, bytes=4_200_000, fps=31.3)
    shown = dict(zip(report.COSTS, report.costs_of(result("a", 40.0, costs)), strict=True))
    assert shown == {"GFLOPs": "1.234", "Param (M)": "2.50", "MB": "4.2", "FPS": "31.3"}
    entry = FilmedEntry("a", lambda clip, frame: pytest.fail("nothing is drawn"), costs)
    assert dict(zip(capture_report.COSTS, capture_report.rows([], [entry])[0][-2:], strict=True)) == {
        "M parameters": "2.500",
        "MFLOP": "1234.00",
    }
    assert {name: cost(entry) for name, cost in COSTS.items()} == {
        "million parameters": 2.5,
        "million operations a frame": 1234.0,
    }


SETTING = report.Setting("rec", "a device", {"training": 1, "held out": 1}, 1, 512, 60.0, None, "tiny", None, 0.08)
MEAN = row(Entry(entries.MEAN, truth, Cost(parameters=10, flops=0, bytes=40)))
FILE = row(Entry("a_file_with_a_name_of_more_than_forty_letters", truth, Cost(10, 10, 10, 31.2, "f16")))


def test_no_figure_is_cut_on_eighty_columns() -> None:
    shown = table([MEAN, FILE], replace(SETTING, lpips="alex"))
    assert "…" not in shown
    assert "LPIPS: alex, times 1000." in " ".join(shown.split())
    assert shown.count("48.12") == 4
    assert max(map(len, shown.splitlines())) <= 80


def test_nothing_is_said_of_what_did_not_happen() -> None:
    of_files = table([MEAN, FILE], replace(SETTING, frames={"training": 1, "held out": 0}))
    for word in ("trained for", "own mesh", "held out", "│ LPIPS", "failed"):
        assert word not in of_files
    assert "FPS" in of_files
    systems = table([MEAN, row(Entry("ours", truth, Cost(10, 10, 40)))], SETTING)
    assert "trained for 60 s" in systems
    assert "FPS" not in systems


def test_what_holds_for_all_rows_is_said_once() -> None:
    failing = row(Entry("linear", None, failure="no [place] left"), failure="no [place] left")
    shown = table([MEAN, FILE, failing], SETTING)
    assert shown.count("no weights given") == 1
    assert shown.count("no [place] left") == 1
