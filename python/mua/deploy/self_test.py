"""Every kernel on golden buffers, run by the player on the headset and read from its log."""

import re
from collections.abc import Iterable
from contextlib import closing
from dataclasses import dataclass

from mua.deploy.headset import Headset
from mua.deploy.player import answers, follow, new_run
from mua.deploy.steady import awake
from mua.errors import InputError

MARK = "MUA-SELFTEST"
START = re.compile(r"START (\d+)")
CASE = re.compile(r"(PASS|FAIL) ([A-Za-z]\w*)/([A-Za-z]\S*?)(?:: (.*))?")
END = re.compile(r"(PASS|FAIL) (\d+)/(\d+)")


@dataclass(frozen=True)
class Case:
    """One kernel on one set of buffers; `what` says how it failed."""

    kernel: str
    name: str
    what: str | None


def self_test(headset: Headset) -> list[Case]:
    """All cases in the order in which they ran, failed ones among them.

    Errors: InputError if the player crashes, falls silent or contradicts itself.
    """
    run = new_run()
    with awake(headset), closing(follow(headset, run, "-muaSelfTest")) as lines:
        return collect(answers(lines, MARK, run))


def collect(answers: Iterable[str]) -> list[Case]:
    """The cases of one run from its answers, up to the last.

    Errors: InputError if an answer is not in the grammar or the figures do not agree.
    """
    announced, cases = None, list[Case]()
    for text in answers:
        if begun := START.fullmatch(text):
            announced = int(begun[1])
        elif ended := END.fullmatch(text):
            _require_agreement(ended, announced, cases)
            return cases
        elif (case := CASE.fullmatch(text)) and (case[1] == "FAIL") == (case[4] is not None):
            cases.append(Case(case[2], case[3], case[4]))
        else:
            raise InputError(f"the player answered {text!r}, expected one of the answers of docs/deploy.md")
    raise InputError("the player's answers ended before its result")


def _require_agreement(ended: re.Match[str], announced: int | None, cases: list[Case]) -> None:
    passed, total = int(ended[2]), int(ended[3])
    heard = sum(case.what is None for case in cases)
    if (heard, len(cases), announced) != (passed, total, total) or (ended[1] == "PASS") != (passed == total):
        raise InputError(
            f"the player's result is {ended[0]}, but its log has {heard} passed of {len(cases)} cases and announced "
            f"{announced}: lines were lost, run it again"
        )
