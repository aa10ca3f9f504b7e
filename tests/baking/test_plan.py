"""Which frames of a character's clips are recorded, and which are kept to test on."""

import numpy as np
import pytest

from mua.baking.plan import WHOLE_FRAMES, HeldOut, plan, split
from mua.errors import InputError
from mua.pose.clip import Clip


def clip(name: str, frames: int, rate: float = 24.0) -> Clip:
    """Two joints whose place tells the frame."""
    translations = np.zeros((frames, 2, 3))
    translations[:, 0, 0] = np.arange(frames)
    return Clip(name, rate, np.tile([1.0, 0, 0, 0], (frames, 2, 1)), translations)


def frames_of(one: Clip) -> list[int]:
    return one.translations[:, 0, 0].astype(int).tolist()


def test_the_last_fifth_of_each_clip_is_held_out_behind_two_seconds_of_run_up() -> None:
    training, held = split([clip("walk", 100, rate=12.0), clip("nod", 9), clip("turn", 10), clip("jump", 50)], [])
    assert [len(one) for one in training] == [80, 9, 8, 40]
    assert [(one.clip.name, frames_of(one.clip)) for one in held] == [
        ("walk (end)", list(range(80, 100))),
        ("turn (end)", [8, 9]),
        ("jump (end)", list(range(40, 50))),
    ]
    runs = [frames_of(one.run_up) for one in plan([], held, frames=8) if one.run_up is not None]
    assert runs == [list(range(56, 80)), list(range(8)), list(range(40))]


def test_a_clip_whose_end_another_is_called_after_stays_whole() -> None:
    training, held = split([clip("walk", 20), clip("walk (end)", 20)], [])
    assert ([len(one) for one in training], [one.clip.name for one in held]) == ([20, 16], ["walk (end) (end)"])


def test_clips_that_are_named_are_held_out_whole() -> None:
    training, held = split([clip("walk", 20), clip("turn", 20)], ["turn"])
    assert [one.name for one in training] == ["walk"]
    assert [(len(one.clip), one.run_up) for one in held] == [(20, None)]
    with pytest.raises(InputError, match="--hold-out jump: there is no such clip; expected walk"):
        split([clip("walk", 20)], ["jump"])
    with pytest.raises(InputError, match="--hold-out walk: leaves no clip to train on"):
        split([clip("walk", 20)], ["walk"])


def test_frames_lie_in_the_middle_of_equal_shares_of_all_clips() -> None:
    planned = plan([clip("walk", 8), clip("turn", 4)], [], frames=3)
    assert [sorted(one.wanted) for one in planned] == [[2, 6], [2]]
    assert [one.whole == one.wanted for one in planned] == [True, True]


def test_every_frame_is_taken_where_more_are_asked_for() -> None:
    (planned,) = plan([clip("walk", 7)], [], frames=1000)
    assert planned.wanted == frozenset(range(7))


def test_of_many_frames_some_are_kept_whole() -> None:
    (planned,) = plan([clip("walk", 1000)], [], frames=600)
    assert planned.whole is not None
    assert (len(planned.wanted), len(planned.whole), planned.whole < planned.wanted) == (600, WHOLE_FRAMES, True)
    assert np.ptp(np.diff(sorted(planned.whole))) <= 2
    assert max(planned.whole) > 980


@pytest.mark.parametrize(("frames", "recorded"), [(1, [0, 0, 1]), (8, [0, 1, 1]), (40, [3, 3, 4]), (4000, [40, 40, 7])])
def test_held_out_clips_share_a_quarter_of_the_frames_up_to_so_many_each(frames: int, recorded: list[int]) -> None:
    held = [HeldOut(clip(name, count)) for name, count in (("walk", 100), ("turn", 200), ("nod", 7))]
    planned = plan([clip("run", 5000)], held, frames=frames)[1:]
    assert [len(one.wanted) for one in planned] == recorded
    assert all(one.held_out and one.whole == one.wanted for one in planned)
