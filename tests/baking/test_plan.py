"""Which frames of a character's clips are recorded, and which are kept to test on."""

import numpy as np
import pytest

from mua.baking.plan import HELD_MOST, RUN_UP, WHOLE_FRAMES, HeldOut, describe_plan, plan, split, usual_poses
from mua.errors import InputError
from mua.pose.clip import RANGE_OF_MOTION, Clip


def clip(name: str, frames: int, rate: float = 24.0) -> Clip:
    """Two joints whose place tells the frame."""
    translations = np.zeros((frames, 2, 3))
    translations[:, 0, 0] = np.arange(frames)
    return Clip(name, rate, np.tile([1.0, 0, 0, 0], (frames, 2, 1)), translations)


def frames_of(one: Clip) -> list[int]:
    return one.translations[:, 0, 0].astype(int).tolist()


def test_the_last_fifth_of_each_clip_is_held_out_behind_two_seconds_of_run_up() -> None:
    training, held = split([clip("walk", 100), clip("nod", 9), clip("turn", 10, rate=1.0)], [])
    assert [len(one) for one in training] == [80, 9, 8]
    assert [(one.clip.name, frames_of(one.clip)) for one in held] == [
        ("walk (end)", list(range(80, 100))),
        ("turn (end)", [8, 9]),
    ]
    runs = [frames_of(one.run_up) for one in held if one.run_up is not None]
    assert runs == [list(range(80 - int(24 * RUN_UP), 80)), [6, 7]]


def test_a_clip_whose_end_another_is_called_after_stays_whole() -> None:
    training, held = split([clip("walk", 20), clip("walk (end)", 20)], [])
    assert ([len(one) for one in training], [one.clip.name for one in held]) == ([20, 16], ["walk (end) (end)"])


def test_clips_that_are_named_are_held_out_whole() -> None:
    training, held = split([clip("walk", 20), clip("turn", 20)], ["turn"])
    assert ([one.name for one in training], [len(one.clip) for one in held]) == (["walk"], [20])
    with pytest.raises(InputError, match="--hold-out jump: there is no such clip; expected walk"):
        split([clip("walk", 20)], ["jump"])
    with pytest.raises(InputError, match="--hold-out walk: leaves no clip to train on"):
        split([clip("walk", 20)], ["walk"])


def test_frames_lie_in_the_middle_of_equal_shares_of_all_clips() -> None:
    planned = plan([clip("walk", 8), clip("turn", 4)], [], frames=3)
    assert [sorted(one.wanted) for one in planned] == [[2, 6], [2]]
    assert [one.whole == one.wanted for one in planned] == [True, True]


def test_every_frame_is_recorded_where_more_are_asked_for() -> None:
    (planned,) = plan([clip("a", 7)], [], frames=1000)
    assert planned.wanted == frozenset(range(7))


def test_of_many_frames_some_are_kept_whole() -> None:
    (planned,) = plan([clip("walk", 1000)], [], frames=600)
    assert planned.whole is not None
    assert (len(planned.wanted), len(planned.whole), planned.whole < planned.wanted) == (600, WHOLE_FRAMES, True)
    assert np.ptp(np.diff(sorted(planned.whole))) <= 2
    assert max(planned.whole) > 980


@pytest.mark.parametrize(("frames", "recorded"), [(1, [0, 0, 1]), (8, [0, 1, 1]), (40, [3, 3, 4]), (4000, [40, 40, 7])])
def test_held_out_clips_share_a_quarter_of_the_frames_up_to_so_many_each(frames: int, recorded: list[int]) -> None:
    held = [HeldOut(clip("b", 100)), HeldOut(clip("c", 200)), HeldOut(clip("d", 7))]
    training, *kept = plan([clip("a", 5000)], held, frames=frames)
    assert ([len(one.wanted) for one in kept], len(training.wanted)) == (recorded, frames)
    assert all(one.held_out and one.whole == one.wanted and one.run_up is None for one in kept)


def test_all_held_out_clips_together_get_no_more_than_what_their_errors_need() -> None:
    held = [HeldOut(clip(f"end {number}", 50)) for number in range(21)]
    _, *kept = plan([clip("a", 5000)], held, frames=1500)
    counts = [len(one.wanted) for one in kept]
    assert (sum(counts), min(counts), max(counts)) == (HELD_MOST, 9, 10)


def test_how_many_frames_are_recorded_is_said_with_the_reason() -> None:
    training, held = split([clip("walk", 100), clip("nod", 50)], [])
    asked = plan(training, held, frames=60)
    said = describe_plan(asked, [], asked=60)
    spread = "60 of 120 training frames, spread evenly over 2 clips (the preset or --frames asks for 60)"
    assert said == f"Recorded are {spread} and 15 held-out frames to measure errors on."
    few = plan(training, [], frames=240)
    beside = plan([clip("range", 300)], [], frames=135)
    assert describe_plan(few, beside, asked=240) == (
        "Recorded are all 120 training frames of 2 clips (the preset or --frames asks for 240) and 135 frames of the "
        "built-in range of motion (--motion-range none leaves them out)."
    )


def test_usual_poses_are_spread_over_what_is_trained_on_alone() -> None:
    planned = plan([clip("walk", 80), clip(RANGE_OF_MOTION, 80)], [HeldOut(clip("turn", 80))], frames=1000)
    assert [int(pose.translations[0, 0]) for pose in usual_poses(planned)] == [10, 30, 50, 70]
    assert usual_poses(planned[1:]) == []
