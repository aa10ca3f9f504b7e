"""A frame holds as many parts and splats as its milliseconds allow, and what was too much is not tried all the time."""

from collections.abc import Callable
from itertools import pairwise

import pytest

from mua.avatar.decode_turns import PARTS
from mua.avatar.frame_budget import MILLISECONDS, PATIENCE, WINDOW, FrameBudget, measure


def settle(
    time: Callable[[FrameBudget], float], windows: int, *, exact: bool = True, finest: int = 900_000
) -> list[FrameBudget]:
    """What is decided after each window, where a frame takes `time`."""
    budget, decided = FrameBudget(), []
    for _ in range(windows):
        for _ in range(WINDOW):
            shown = min(finest, budget.splats or finest)
            budget = measure(budget, time(budget), avatars=3, exact=exact, splats=(shown, finest))
        decided.append(budget)
    return decided


def by_work(plain: float, part: float, finest: int = 900_000) -> Callable[[FrameBudget], float]:
    return lambda budget: plain * min(1, (budget.splats or finest) / finest) + part * budget.parts


def test_a_device_with_room_decodes_all_avatars_in_a_frame_after_two_seconds() -> None:
    decided = settle(by_work(1, 0.1), 5)
    assert decided[-1].parts == 3 * PARTS
    assert decided[-1].splats is None


def test_a_frame_that_just_fits_stays_as_it_is() -> None:
    assert {(one.parts, one.splats) for one in settle(by_work(12.5, 0.9), 100)} == {(1, None)}


def test_a_frame_that_takes_too_long_shows_fewer_splats_until_it_fits_and_stays() -> None:
    decided = settle(by_work(26, 0.9), 100)
    assert {(one.parts, one.splats) for one in decided[5:]} == {(1, decided[-1].splats)}
    assert by_work(26, 0.9)(decided[-1]) <= MILLISECONDS


def test_parts_are_given_up_before_splats() -> None:
    budget = FrameBudget(parts=4)
    for _ in range(WINDOW):
        budget = measure(budget, 20, splats=(900_000, 900_000))
    assert (budget.parts, budget.splats) == (2, None)


def test_splats_come_back_where_there_is_room_again() -> None:
    budget = FrameBudget(splats=300_000)
    for _ in range(8 * WINDOW):
        budget = measure(budget, 5, splats=(300_000, 900_000))
    assert budget.splats is None


def test_a_single_long_frame_changes_nothing() -> None:
    budget = FrameBudget(parts=2)
    for i in range(WINDOW):
        budget = measure(budget, 50 if i == 7 else 12.5)
    assert budget.parts == 2


@pytest.mark.parametrize("exact", [True, False])
def test_what_was_too_much_is_tried_ever_more_rarely(exact: bool) -> None:
    """Where one more step takes the frame from much room to too long."""
    decided = settle(lambda budget: 10 if budget.parts == 1 else 30, 400, exact=exact)
    tried = [i for i, one in enumerate(decided) if one.parts == 2]
    gaps = [after - before for before, after in pairwise(tried)]
    assert gaps == sorted(gaps)
    assert gaps[-1] >= PATIENCE


def test_frames_of_a_display_that_waits_for_none_have_room_as_far_as_is_known() -> None:
    """60 Hz, whose frames never take less."""
    assert settle(lambda _: 16.7, 5, exact=False)[-1].parts == 3 * PARTS
    assert settle(lambda _: 33.3, 5, exact=False)[-1].splats is not None


def test_no_limit_of_splats_is_set_where_none_may_be() -> None:
    budget = FrameBudget()
    for _ in range(10 * WINDOW):
        budget = measure(budget, 40)
    assert (budget.parts, budget.splats) == (1, None)
