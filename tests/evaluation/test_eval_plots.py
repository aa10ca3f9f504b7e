"""The contact sheet of a comparison: each system's error where it is, on one scale."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mua.arrays import Array
from mua.evaluation import plots
from mua.evaluation.entries import Entry, Picture
from mua.evaluation.metrics import Scores
from mua.evaluation.scores import Result, Sample
from mua.fidelity import strips

CELL = plots.CELL
DARK, BRIGHT = 16, 180  # the ends of the map's colours, in 255ths
SIDE = 240


def figure() -> Array:
    """A grey square that fills the middle of a black image."""
    picture = np.zeros((SIDE, SIDE, 3), np.float32)
    picture[40:200, 40:200] = 0.5
    return picture


def result(name: str, picture: Array, *, failure: str = "") -> Any:
    return Result(SimpleNamespace(name=name, picture=lambda _: Picture(picture)), failure=failure)  # type: ignore[arg-type]


@pytest.fixture
def strip() -> Array:
    """Teacher, one that is the same, one whose upper left quarter is red, one that failed."""
    wrong = figure()
    wrong[40:120, 40:120] = [1, 0, 0]
    frame = SimpleNamespace(texture=figure(), index=3, clip=SimpleNamespace(name="walk", held_out=True))
    studio = SimpleNamespace(draw=lambda _, texture, mesh=None: [texture])
    results = [result("same", figure()), result("red", wrong), result("none", figure(), failure="diverged")]
    return plots._strip(studio, frame, results)  # type: ignore[arg-type]


def column(strip: Array, index: int) -> Array:
    return strip[:, (CELL + 2) * index : (CELL + 2) * index + CELL]


def test_a_column_for_the_teacher_and_each_system_that_did_not_fail(strip: Array) -> None:
    assert strip.shape == (2 * strips.CAPTION + 3 * CELL, 3 * (CELL + 2), 3)
    assert strip.dtype == np.uint8


def test_the_map_is_bright_where_a_system_errs_and_dark_elsewhere(strip: Array) -> None:
    assert column(strip, 1)[-CELL:].max() < DARK
    wrong = column(strip, 2)[-CELL:].max(axis=2)
    half = CELL // 2
    assert np.median(wrong[20 : half - 20, 20 : half - 20]) > BRIGHT
    assert wrong[half + 40 :, half + 40 :].max() < DARK
    assert column(strip, 0)[-CELL:].min() == 255  # the teacher has none


def test_the_square_below_shows_the_place_of_the_greatest_error(strip: Array) -> None:
    top = 2 * strips.CAPTION + CELL
    closer = column(strip, 2)[top : top + CELL]
    np.testing.assert_array_equal(np.unique(closer.reshape(-1, 3), axis=0), [[255, 0, 0]])
    same = column(strip, 1)[top : top + CELL]
    assert np.ptp(same.reshape(-1, 3), axis=0).max() <= 1  # grey all over


def test_pictures_are_cut_to_the_figure_and_a_margin(strip: Array) -> None:
    rows, columns = plots._figure_box([figure(), np.zeros_like(figure())])
    assert (rows, columns) == (slice(31, 209), slice(31, 209))
    assert plots._figure_box([np.zeros((20, 30, 3))]) == (slice(0, 20), slice(0, 30))


def test_sheets_show_the_worst_and_the_median_frame() -> None:
    clips = [SimpleNamespace(name=name, held_out=held_out) for name, held_out in (("walk", False), ("turn", True))]
    frames: list[Any] = [SimpleNamespace(clip=clip, index=index) for clip in clips for index in (1, 3, 5)]
    quality = {1: 50.0, 3: 20.0, 5: 30.0}
    samples = [
        Sample(f.clip.name, f.index, f.clip.held_out, 0, 0.2, Scores(quality[f.index], 1, 1, 0, math.nan))
        for f in frames
    ]
    picked = plots.sheet_frames(frames, [Result(Entry("x", None), samples)], held_out=True)
    assert [(f.clip.name, f.index) for f in picked] == [("turn", 3), ("turn", 5)]
