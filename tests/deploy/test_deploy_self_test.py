"""The player's answers are taken as docs/deploy.md has them, and nothing else is."""

import pytest

from mua.deploy.player import answers
from mua.deploy.self_test import Case, collect
from mua.errors import InputError


def test_collects_cases_up_to_the_result() -> None:
    lines = ["START 2", "PASS splat_sort/one", "FAIL dq_skinning/odd: 1.0: expected 2.0", "FAIL 1/2", "PASS later/on"]
    assert collect(lines) == [Case("splat_sort", "one", None), Case("dq_skinning", "odd", "1.0: expected 2.0")]


@pytest.mark.parametrize(
    "lines",
    [
        ["START 2", "PASS a/b", "PASS 2/2"],
        ["START 2", "PASS a/b", "PASS 1/1"],
        ["START 1", "PASS a/b", "FAIL 1/1"],
        ["PASS a/b", "PASS 1/1"],
    ],
)
def test_notices_lost_lines(lines: list[str]) -> None:
    with pytest.raises(InputError, match="lines were lost"):
        collect(lines)


@pytest.mark.parametrize("text", ["", "PASS", "PASS a", "FAIL a/b", "PASS a/b: well", "DONE", "START many"])
def test_refuses_other_answers(text: str) -> None:
    with pytest.raises(InputError, match="expected one of the answers"):
        collect(["START 1", text])


def test_answers_are_those_of_one_run() -> None:
    lines = [
        "x MUA-SELFTEST 1 START 1",
        "x MUA-SELFTEST 2 START 2",
        "MUA-BENCH 2 END",
        "",
        "MUA-SELFTEST 2 PASS 2/2 \r",
    ]
    assert list(answers(lines, "MUA-SELFTEST", "2")) == ["START 2", "PASS 2/2"]
