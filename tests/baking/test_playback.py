"""Which clips an avatar's file holds: what the user gave, however it was recorded."""

from dataclasses import replace

import numpy as np
import pytest

from mua.baking.playback import choose, held_out, held_out_sentence, range_clips, typical_frame, whole_clips
from mua.errors import InputError
from mua.pose.clip import Clip, Stretches
from mua.recording import RecordedClip


def clip(name: str, frames: int, *, start: int = 0) -> Clip:
    """A root that moves a metre a frame."""
    places = np.zeros((frames, 2, 3))
    places[:, 0, 0] = np.arange(start, start + frames)
    return Clip(name, 30.0, np.tile([1.0, 0, 0, 0], (frames, 2, 1)), places)


def recorded(name: str, frames: int, *, held: bool = False, start: int = 0) -> RecordedClip:
    own = clip(name, frames, start=start)
    return RecordedClip(name, own.rate, own.rotations, own.translations, held, np.array([0]), True)


CUT = [
    recorded("walk", 8),
    recorded("short", 3),
    recorded("walk (end)", 2, held=True, start=8),
    recorded("dance", 5, held=True),
]


def test_held_out_ends_are_joined_to_their_clips() -> None:
    walk, short, dance = whole_clips(CUT)
    assert [(c.name, len(c)) for c in (walk, short, dance)] == [("walk", 10), ("short", 3), ("dance", 5)]
    np.testing.assert_array_equal(walk.translations[:, 0, 0], np.arange(10))
    assert type(short) is Clip


def test_a_held_out_piece_is_not_what_a_player_begins_with() -> None:
    clips = [
        recorded("piece", 18, held=True),
        recorded("walk", 8),
        recorded("turn", 2, held=True),
        recorded("dance", 5),
    ]
    assert [c.name for c in whole_clips(clips)] == ["walk", "dance", "piece", "turn"]


def test_a_rest_pose_is_not_what_a_player_begins_with() -> None:
    """Many files hold a T-pose as their first clip."""
    pose = recorded("T-pose", 4)
    still = replace(pose, translations=np.zeros_like(pose.translations))
    assert [c.name for c in whole_clips([still, *CUT])] == ["walk", "short", "T-pose", "dance"]
    assert [c.name for c in whole_clips([pose, *CUT])] == ["T-pose", "walk", "short", "dance"]


@pytest.mark.parametrize(
    "clips",
    [
        [recorded("walk", 8), recorded("walk (end)", 2)],  # trained on: a clip of that name
        [recorded("walk", 8, held=True), recorded("walk (end)", 2, held=True)],
        [recorded("walk (end)", 2, held=True)],
    ],
)
def test_a_clip_that_is_only_named_like_an_end_stays_one(clips: list[RecordedClip]) -> None:
    assert [c.name for c in whole_clips(clips)] == [c.name for c in clips]


def test_says_from_which_frame_on_what_is_held_out() -> None:
    assert held_out(CUT) == {"walk": 8, "dance": 0}
    assert held_out_sentence(held_out(CUT)) == "held out of training: walk from frame 8, dance"
    assert held_out_sentence({}) == "no clip was held out of training"


@pytest.mark.parametrize(
    ("wanted", "chosen"),
    [
        (["all"], ["a", "b", "2"]),
        (["none"], []),
        (["1"], ["a"]),
        (["99"], ["a", "b", "2"]),
        (["2"], ["2"]),  # a name comes before a number
        (["b", "a", "b"], ["b", "a"]),
    ],
)
def test_clips_are_chosen_by_name_by_number_or_by_a_word(wanted: list[str], chosen: list[str]) -> None:
    assert [c.name for c in choose([clip("a", 1), clip("b", 1), clip("2", 1)], wanted)] == chosen


@pytest.mark.parametrize("wanted", [["c"], ["a", "all"]])
def test_a_clip_that_is_not_there_is_named(wanted: list[str]) -> None:
    with pytest.raises(InputError, match=rf"--clips {wanted[-1]}: there is no such clip; expected a"):
        choose([clip("a", 1)], wanted)


def test_the_typical_frame_is_the_one_nearest_to_the_mean_pose() -> None:
    angles = np.radians([0, 80, 30, 35, 90])
    rotations = np.tile([1.0, 0, 0, 0], (5, 2, 1))
    rotations[:, 1] = np.stack([np.cos(angles / 2), np.sin(angles / 2), 0 * angles, 0 * angles], axis=1)
    rotations[2] *= -1  # the same rotation
    rotations[:, 0] = np.random.default_rng(0).standard_normal((5, 4))  # where the character faces counts for nothing
    bend = Clip("bend", 30.0, rotations, np.zeros((5, 2, 3)))
    assert typical_frame([bend], root=0)[1] == 3


def test_clips_joined_keep_what_each_stretches() -> None:
    matrices = np.random.default_rng(0).standard_normal((10, 1, 3, 3))
    walk = replace(clip("walk", 10), stretches=Stretches(np.array([1]), matrices))
    joined = walk.cut(slice(7)).then(replace(walk.cut(slice(7, None)), name="end"))
    assert joined.name == "walk"
    assert joined.stretches is not None
    np.testing.assert_array_equal(joined.stretches.matrices, matrices)
    np.testing.assert_array_equal(joined.translations, walk.translations)


def test_the_range_of_motion_is_not_played_beside_other_clips() -> None:
    ranged = [recorded("range of motion: walk", 6), recorded("range of motion: any pose", 6)]
    assert [c.name for c in whole_clips([*CUT, *ranged])] == [c.name for c in whole_clips(CUT)]
    assert [c.name for c in range_clips([*CUT, *ranged], whole_clips(CUT))] == [c.name for c in ranged]


def test_the_range_of_motion_is_played_where_there_is_nothing_else() -> None:
    ranged = [recorded("range of motion: walk", 6), recorded("range of motion: walk (end)", 2, held=True, start=6)]
    (walk,) = whole_clips(ranged)
    assert (walk.name, len(walk)) == ("range of motion: walk", 8)
    assert range_clips(ranged, [walk]) == []
