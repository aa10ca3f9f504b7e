"""Students of several sizes beside their teacher."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
import torch
import train_ranks
from compared_systems import SETTINGS, smooth_recording

from mua.student.settings import Ranks, Sizes, preset
from mua.training.schedule import Schedule

FEW, MORE = (Sizes(Ranks(rank, rank, rank), Ranks(rank, rank, rank), components=4, hidden=16) for rank in (1, 8))


def numbers(row: str) -> list[float]:
    return [float(number) for number in re.findall(r"\d+\.\d+", row)]


def test_more_ranks_cost_more_and_come_nearer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recording = smooth_recording(tmp_path / "hero.work" / "recording")
    quick = replace(SETTINGS, pictures=2, finetune=Schedule(steps=5, batch=4, lr=1e-4))
    monkeypatch.setattr(train_ranks, "preset", lambda _: quick)
    rows = list(train_ranks.measure(recording, "quick", (FEW, MORE), torch.device("cpu")))
    few, more = map(numbers, rows)
    assert all(one > other for one, other in zip(more[:3], few[:3], strict=True))  # both costs, training to first order
    assert more[4] > few[4]  # training, as drawn
    sized = replace(preset("paper"), **vars(MORE))
    assert more[0] == pytest.approx(train_ranks.costs(sized)[0] / 1e9, abs=5e-4)

    best = next(train_ranks.measure(recording, "quick", (MORE,), torch.device("cpu"), until="bases"))
    assert all(one >= other for one, other in zip(numbers(best)[2:], more[2:], strict=True))  # without networks' errors

    monkeypatch.setattr(train_ranks, "measure_sensitivities", None)
    assert list(train_ranks.measure(recording, "quick", (MORE,), torch.device("cpu"))) == rows[1:]


def test_sizes_are_read_as_they_are_written() -> None:
    assert train_ranks.sizes_of("1,2,3/4,5,6/7/8") == Sizes(Ranks(1, 2, 3), Ranks(4, 5, 6), components=7, hidden=8)
