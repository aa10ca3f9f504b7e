"""Avatars in view take turns with their decodes: who is decoded when, and how old what is shown may be."""

from collections import Counter
from dataclasses import replace
from typing import cast

import pytest
from turn_scenarios import CLIP, HEADSET, Actor, Frame, play, run, wander

from mua.avatar.decode_turns import ALONE, LONGEST, PARTS, Ask, Decode, Steps, Turns, take_turns

FRAMES = 400


def moving(count: int) -> list[Actor]:
    """Of clips and rigs, of all sizes on screen."""
    return [Actor(i, HEADSET, i % 2 == 1, 3.1 * i, rank=10.0 * i) for i in range(count)]


def made(steps: dict[int, Steps]) -> int:
    """Parts of decodes in a displayed frame."""
    return sum(PARTS * (one.whole is not None) + one.finish + one.parts for one in steps.values())


def ages(actors: list[Actor], *, parts: int = 1) -> list[int]:
    """The longest time between two decodes of each that are shown, in displayed frames."""
    last, longest = dict.fromkeys(range(len(actors)), 0), Counter[int]()
    for frame, _, steps in run(play(actors, FRAMES, parts=parts)):
        for key, one in steps.items():
            if one.show or one.whole:
                longest[key] = max(longest[key], frame.number - last[key])
                last[key] = frame.number
    return [max(longest[key], FRAMES - last[key]) for key in last]


@pytest.mark.parametrize("count", [2, 3, 10])
@pytest.mark.parametrize("parts", [1, 2, 3])
def test_a_displayed_frame_makes_no_more_parts_than_it_may(count: int, parts: int) -> None:
    assert {made(steps) for _, _, steps in run(play(moving(count), FRAMES, parts=parts))} <= set(range(parts + 1))


def test_a_displayed_frame_decodes_one_avatar() -> None:
    for _, _, steps in run(play(moving(10), FRAMES)):
        assert sum(one.parts > 0 for one in steps.values()) == 1


@pytest.mark.parametrize("count", [2, 3, 4, 5, 7, 10, 20])
@pytest.mark.parametrize("parts", [1, 2])
def test_no_decode_is_older_than_is_stated(count: int, parts: int) -> None:
    turn = -(-PARTS // parts)
    assert max(ages(moving(count), parts=parts)) <= max(LONGEST, count * turn) + 2 * turn


@pytest.mark.parametrize("seed", range(8))
def test_sizes_that_change_make_none_wait_longer(seed: int) -> None:
    """Also where ranks are as unfair as can be: those just served are the largest."""
    actors, last = moving(6), dict.fromkeys(range(6), 0)
    for frame, turns, steps in run(play(actors, FRAMES)):
        for key, one in steps.items():
            if one.show:
                assert frame.number - last[key] <= max(LONGEST, 6 * PARTS) + 2 * PARTS
                last[key] = frame.number
        for actor in actors:
            served = turns.avatars[actor.number].served
            actor.rank = float(served if seed % 2 else not served) + (actor.number * seed) % 7


def test_none_has_another_turn_before_all_that_wait_had_one() -> None:
    begun = Counter[int]()
    for _, _, steps in run(play(moving(7), FRAMES)):
        begun.update(key for key, one in steps.items() if one.begin)
        assert max(begun.values()) - min(begun[key] for key in range(7)) <= 1


def test_the_largest_that_moved_most_comes_first() -> None:
    order = [key for _, _, steps in run(play(moving(4), 4 * PARTS)) for key, one in steps.items() if one.begin]
    assert order == [3, 2, 1, 0]


def test_what_was_never_decoded_comes_before_what_is_only_old() -> None:
    actors = moving(3)
    actors[0].seen = False
    order = []
    for frame, _, steps in run(play(actors, 5 * PARTS)):
        order += [key for key, one in steps.items() if one.begin]
        actors[0].seen = frame.number >= 2 * PARTS
    assert order[2:4] == [2, 0]  # the decode of 2 had begun when 0 came into view


def test_one_that_rests_costs_nothing_and_another_takes_its_turns() -> None:
    actors = moving(3)
    actors[1].step = 0
    shown = list(run(play(actors, FRAMES)))
    assert sum(one.parts for _, _, steps in shown for key, one in steps.items() if key == 1) == PARTS  # once
    assert shown[-1][1].avatars[1].shown == Decode(actors[1].due)
    resting = [Actor(i, 0) for i in range(3)]
    assert [made(steps) for _, _, steps in run(play(resting, 20))] == [1] * 3 * PARTS + [0] * (20 - 3 * PARTS)


def test_one_that_starts_to_move_is_not_taken_for_old() -> None:
    actors = moving(3)
    actors[0].step, actors[0].rank = 0, -1.0
    begun = []
    for frame, _, steps in run(play(actors, 100)):
        if frame.number == 60:
            actors[0].step = HEADSET
        begun += [key for key, one in steps.items() if one.begin and frame.number > 60]
    assert begun.index(0) in (1, 2)  # the smallest has its turn in this round or the next


def test_a_clip_is_shown_when_it_is_due_where_there_is_time() -> None:
    """Two avatars of 25 poses a second, and parts enough for both."""
    for frame, turns, _ in run(play([Actor(0, HEADSET), Actor(1, HEADSET, position=0.5)], FRAMES, parts=4)):
        if frame.number > PARTS:
            assert [turns.avatars[key].shown for key in (0, 1)] == [Decode(frame.asks[key].due) for key in (0, 1)]


def test_a_clip_is_never_shown_before_it_is_due() -> None:
    for frame, _, steps in run(play([Actor(i, HEADSET, position=5 * i) for i in range(3)], FRAMES, parts=2)):
        for key, one in steps.items():
            state = frame.asks[key]
            assert not (one.begin and one.begin.moment != state.following)
    shown = [turns.avatars[0].shown for _, turns, _ in run(play([Actor(i, HEADSET) for i in range(3)], FRAMES))]
    dues = [frame.asks[0].due for frame in play([Actor(0, HEADSET)], FRAMES)]
    late = [(cast(int, due) - cast(int, one.moment)) % CLIP for due, one in zip(dues, shown, strict=True) if one]
    assert min(late) == 0
    assert max(late) <= HEADSET * (max(LONGEST, 3 * PARTS) + 2 * PARTS) + 1


def test_another_level_comes_with_the_next_decode_and_at_rest_too() -> None:
    actors = [Actor(i, 0) for i in range(2)]
    for frame, turns, _ in run(play(actors, 60)):
        actors[0].level = int(frame.number > 20)
        if frame.number == 59:
            assert turns.avatars[0].shown == Decode(0, 1)


def frames(*asked: dict[int, Ask]) -> list[Frame]:
    return [Frame(number, 1, (), asks) for number, asks in enumerate(asked)]


def test_one_that_leaves_while_it_is_decoded_leaves_its_turn_to_the_next() -> None:
    big, small = Ask(5, 6, rank=2), Ask(7, 8, rank=1)
    steps = [steps for _, _, steps in run(iter(frames({0: big, 1: small}, {0: big, 1: small}, {1: small, 2: small})))]
    assert [one[0].parts for one in steps[:2]] == [1, 1]
    assert steps[2][1] == Steps(begin=Decode(8), parts=1)


def test_one_that_comes_back_goes_on_with_its_decode_only_where_it_is_still_wanted() -> None:
    def returns(following: int) -> Steps:
        here, other = {0: Ask(5, 6), 1: Ask(1, 1)}, {1: Ask(1, 1), 2: Ask(1, 1)}
        came = {0: Ask(following - 1, following, rank=9), 1: Ask(1, 1)}
        asked = [here, here, *[other] * 2 * PARTS, came]
        return list(run(iter(frames(*asked))))[-1][2][0]

    assert returns(6) == Steps(parts=1)
    assert returns(9) == Steps(begin=Decode(9), parts=1)


def test_one_that_is_destroyed_while_it_is_decoded_is_forgotten() -> None:
    both, rest = {0: Ask(5, 6, rank=2), 1: Ask(7, 8), 2: Ask(7, 8)}, {1: Ask(7, 8), 2: Ask(7, 8)}
    told = [*frames(both), Frame(1, 1, (0,), rest), Frame(2, 1, (), both)]
    (_, _, first), (_, turns, second), (_, _, third) = run(iter(told))
    assert first[0].parts == 1
    assert (0 in turns.avatars, second[1].begin) == (False, Decode(8))
    assert third[0] == Steps()


def test_what_may_not_be_spread_is_decoded_at_once_and_takes_no_turn_away() -> None:
    actors = moving(3)
    actors[2].spread = False
    for frame, turns, steps in run(play(actors, FRAMES)):
        assert turns.avatars[2].shown == Decode(frame.asks[2].due)
        assert made({0: steps[0], 1: steps[1]}) == 1


@pytest.mark.parametrize("step", [HEADSET, 0.5, 1 / 3])
def test_one_avatar_alone_is_on_time_and_no_frame_decodes_all(step: float) -> None:
    counts = []
    for frame, turns, steps in run(play([Actor(0, step)], FRAMES)):
        assert turns.avatars[0].shown == Decode(frame.asks[0].due)
        counts.append(made(steps))
    assert (counts[0], max(counts[1:])) == (PARTS, ALONE)


def test_one_rig_alone_is_one_displayed_frame_late() -> None:
    before = 0
    for frame, turns, steps in run(play([Actor(0, HEADSET, rig=True)], FRAMES)):
        assert turns.avatars[0].shown == Decode(before)
        assert frame.number == 0 or made(steps) <= ALONE
        before = cast(int, frame.asks[0].due)


@pytest.mark.parametrize("seed", range(40))
def test_whatever_happens_none_starves_and_no_frame_makes_too_much(seed: int) -> None:
    waited = Counter[int]()
    for frame, turns, steps in run(wander(seed, FRAMES)):
        spread = [key for key, ask in frame.asks.items() if ask.spread]
        if len(frame.asks) > 1:
            assert made({key: steps[key] for key in spread}) <= frame.parts
        for key in list(waited):
            if key not in spread:
                del waited[key]
        for key in spread:
            rests = turns.avatars[key].shown == Decode(frame.asks[key].following, frame.asks[key].level)
            waited[key] = 0 if steps[key].show or steps[key].whole or rests else waited[key] + 1
            assert waited[key] <= LONGEST + 2 * PARTS * (len(turns.avatars) + 1)


def test_equal_states_decide_alike_and_are_not_changed() -> None:
    asks = {key: Ask(5, 6, rank=key) for key in range(3)}
    before = Turns()
    first, again = take_turns(before, asks, 4), take_turns(before, asks, 4)
    assert first == again
    assert before == Turns()
    assert replace(first[0]) == first[0]
