"""A budget gives the largest student of the measured frontier that keeps it."""

import json
from dataclasses import astuple, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from recordings import add, frames, opened
from synthetic_avatar import synthetic_rig
from trainings import FINISHED, SMALL, Training

from mua.asset import read
from mua.asset.count import flops
from mua.asset.tensors import Storage
from mua.asset.write import encode
from mua.bench.random_avatar import random_avatar
from mua.errors import InputError
from mua.recording import Recording
from mua.student.budget import FRONTIER, cost, within_budget
from mua.student.distil import body_of
from mua.student.settings import Budget, Settings, Sizes, preset
from mua.student.shapes import Body

PERSON = Body(descriptor=1299, inputs=981, vertices=5508, texels=300_000)
ROUNDING = 100 * float(np.finfo(np.float32).eps)  # of least squares on bases that hold all of a small recording
BYTES = 0.01  # share by which the estimate of a file may differ from what is written


def chosen(*, mflop: float | None = None, mb: float | None = None) -> Settings:
    return within_budget(replace(preset("paper"), budget=Budget(mflop, mb)), PERSON, "f16")


def test_each_size_costs_more_than_the_one_before_it() -> None:
    costs = [cost(replace(preset("paper"), **vars(sizes)), PERSON, "f16") for sizes in FRONTIER]
    for less, more in pairwise(costs):
        assert (less.mflop or 0) < (more.mflop or 0)
        assert (less.mb or 0) < (more.mb or 0)


def test_no_size_holds_less_than_a_smaller_one() -> None:
    def numbers(sizes: Sizes) -> list[int]:
        return [*astuple(sizes.geometry), *astuple(sizes.appearance), sizes.components, sizes.hidden]

    assert all(np.less_equal(numbers(less), numbers(more)).all() for less, more in pairwise(FRONTIER))


def test_the_choice_keeps_both_budgets_and_grows_with_them() -> None:
    before = Budget(0, 0)
    for mflop, mb in ((330, 40), (380, 40), (380, 60), (500, 60), (2000, 400)):
        settings = chosen(mflop=mflop, mb=mb)
        spent = cost(settings, PERSON, "f16")
        assert (spent.mflop or 0) <= mflop
        assert (spent.mb or 0) <= mb
        assert (spent.mflop or 0) >= (before.mflop or 0)
        before = spent
    assert vars(FRONTIER[-1]).items() <= vars(settings).items()


def test_without_a_budget_the_sizes_are_the_presets() -> None:
    assert chosen() == preset("paper")


@pytest.mark.parametrize("storage", ["f16", "f32"])
def test_the_cost_is_that_of_the_written_file(storage: Storage) -> None:
    settings = replace(preset("tiny"), texels=64)
    avatar = random_avatar(settings)
    rig = replace(avatar.rig, expressions=None)
    avatar, inputs = replace(avatar, rig=rig, clips=()), len(avatar.components.margins)
    body = Body(avatar.encoding.width, inputs, len(rig.mesh.vertices), len(rig.texels.texels))
    spent = cost(settings, body, storage)
    assert spent.mflop == sum(flops(avatar).values()) / 1e6
    assert spent.mb == pytest.approx(len(encode(avatar, storage=storage)) / 1e6, rel=BYTES)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [({"mflop": 100}, "--budget-mflop 100: the smallest student takes"), ({"mb": 3}, "--budget-mb 3: the smallest")],
)
def test_refuses_a_budget_that_no_student_keeps(given: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        chosen(**given)


def test_a_larger_budget_costs_more_and_its_bases_miss_less(written: Path, tmp_path: Path, mua_train: Training) -> None:
    spent, missed = [], []
    for mflop in (1.2, 2.0):
        ended = mua_train(written, "--budget-mflop", str(mflop))
        assert ended.status in FINISHED
        assert "The budget gives the student ranks of" in ended.out
        spent.append(sum(flops(read(tmp_path / "a.muaavatar")).values()) / 1e6)
        assert spent[-1] <= mflop
        training = json.loads((tmp_path / "a_errors.json").read_text())["groups"]["training"]
        missed.append([training["rms"][attribute]["best"] for attribute in ("offset", "SH")])
    assert spent[0] < spent[1]
    assert np.all(np.array(missed[1]) <= np.array(missed[0]) * (1 + ROUNDING))


def test_a_budget_counts_the_taps_of_the_recordings_wavelet(tmp_path: Path) -> None:
    spent = []
    for wavelet in ("bior2.2", "bior4.4"):
        with opened(tmp_path / wavelet, wavelet=wavelet) as writer:
            add(writer, *frames(2))
        settings = replace(SMALL, texels=synthetic_rig().texels.size)
        spent.append(cost(settings, body_of(Recording(tmp_path / wavelet), settings), "f16"))
    assert (spent[0].mflop or 0) < (spent[1].mflop or 0)
    assert spent[0].mb == spent[1].mb
