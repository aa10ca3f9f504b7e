"""The live pose of an avatar: its window, what it does while a sender begins, is late and stops."""

from itertools import pairwise

import numpy as np
import pytest
from people import person, retarget, walk
from vmc_senders import Sender, frames_of, humanoid, performing

from mua.arrays import Array
from mua.live.live_pose import EASING, Live
from mua.live.retargeting import Posing
from mua.live.vmc import GONE, Frame
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.encoding import PoseEncoding
from mua.pose.skeleton import Pose

ENCODING = PoseEncoding(joints=(1, 2), rate=30.0)
SINGLE = 12 * 4 * float(np.finfo(np.float32).eps)
EASED = 2.5 * 1.5 / EASING / 60  # radians that easing from one pose to another of 2.5 radians takes between pictures
BEGINS = 100.0  # seconds


@pytest.fixture(scope="module")
def sender() -> Sender:
    body = person()
    moving = performing(SourceMotion(body, walk(body, 90)), humanoid())
    return Sender(moving.figure, moving.clip, [{"A": 0.8} for _ in range(90)])


class Stream:
    """Frames 60 times a second from BEGINS on, of a clip whose own rate is 30."""

    def __init__(self, sender: Sender, *, rate: float = 60.0) -> None:
        self.rate, found = rate, frames_of(sender)
        self.frames = [
            Frame(BEGINS + index / rate, frame.rotations, frame.positions, frame.known, frame.expressions)
            for index, frame in enumerate(found)
        ]

    def newest(self, now: float) -> Frame | None:
        come = [frame for frame in self.frames if frame.time <= now]
        return come[-1] if come else None


def turned(a: Pose, b: Pose) -> float:
    """The largest angle by which a joint differs, radians."""
    return float(2 * np.arccos(np.clip(np.abs(np.sum(a.rotations * b.rotations, axis=-1)), 0, 1)).max())


def same(a: Array, b: Array) -> bool:
    return bool(np.sqrt(2 * np.maximum(1 - np.abs(np.sum(a * b, axis=-1)), 0)).max() < SINGLE)


@pytest.mark.parametrize("rate", [30.0, 60.0, 90.0])
def test_the_window_is_that_of_the_clip_at_the_avatars_rate(sender: Sender, rate: float) -> None:
    target, stream = person(axes=1), Stream(sender, rate=rate)
    played = Clip("played", rate, sender.clip.rotations, sender.clip.translations)
    clip, _ = retarget(SourceMotion(sender.figure, played), target, rate=rate)
    live = Live(stream.newest, target, ENCODING)
    for index, frame in enumerate(stream.frames):
        live.advance(frame.time + 0.001)
        if index > EASING * rate + 2 * rate / 30 + 2:
            rotations, translations = live.window()
            ages = [index - round(age * rate / 30) for age in range(3)]
            assert same(rotations, clip.rotations[ages])
            assert translations.shape == (3, len(target.names), 3)
            assert same(live.now.pose.rotations, clip.rotations[index])


def test_stands_at_ease_until_a_sender_begins_and_when_it_has_stopped(sender: Sender) -> None:
    target, stream = person(), Stream(sender)
    live = Live(stream.newest, target, ENCODING)
    last = stream.frames[-1].time
    for time in np.arange(BEGINS - 2, last + GONE + EASING + 0.5, 1 / 60):
        live.advance(time)
        if time < BEGINS:
            assert turned(live.now.pose, live.at_ease.pose) < 1e-6
            assert live.arrived is None
        elif BEGINS + EASING < time < last + GONE - 0.01:
            assert live.now.expressions == pytest.approx({"A": 0.8})
    assert live.now.expressions == {}
    assert live.arrived is None
    arm = target.names.index("LeftArm"), target.names.index("LeftHand")
    at = target.world(live.now.pose.rotations, live.now.pose.translations)[1]
    assert at[arm[0], 1] - at[arm[1], 1] > 0.4  # arms hang
    gone = Posing(target).pose(stream.frames[-1]).translations[target.root] - live.now.pose.translations[target.root]
    np.testing.assert_allclose(gone[[0, 2]], 0, atol=0.02)  # where it was


def test_nothing_jumps_while_a_sender_begins_stops_and_begins_again(sender: Sender) -> None:
    stream = Stream(sender)
    again = [
        Frame(frame.time + 4, frame.rotations, frame.positions, frame.known, frame.expressions)
        for frame in stream.frames[45:]
    ]
    stream.frames += again
    live, poses, posing = Live(stream.newest, person(), ENCODING), [], Posing(person())
    posed = [posing.pose(frame) for frame in stream.frames[:90]]
    for time in np.arange(BEGINS - 0.5, again[-1].time + GONE + EASING + 0.2, 1 / 60):
        poses.append(live.advance(time))
    turns = [turned(a.pose, b.pose) for a, b in pairwise(poses)]
    steps = [np.abs(a.pose.translations - b.pose.translations).max() for a, b in pairwise(poses)]
    weights = [pose.expressions.get("A", 0.0) for pose in poses]
    walked = [turned(a, b) for a, b in pairwise(posed)]
    assert max(turns) < max(walked) + EASED
    assert max(steps) < 0.1
    assert np.abs(np.diff(weights)).max() < 0.05
    assert max(weights) == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("names", "weights"),
    [(("happy", "aa"), [0, 0.8]), (("jawOpen",), [0.56]), (("A", "sad"), [0.8, 0]), ((), None)],
)
def test_expressions_are_those_of_the_avatar_whatever_the_sender_calls_them(
    sender: Sender, names: tuple[str, ...], weights: list[float] | None
) -> None:
    stream = Stream(sender)
    live = Live(stream.newest, person(), ENCODING, expressions=names)
    for time in np.arange(BEGINS, BEGINS + 2 * EASING, 1 / 60):
        shown = live.advance(time).pose.expressions
    if weights is None:
        assert shown is None
    else:
        assert shown is not None
        np.testing.assert_allclose(shown, np.array(weights), atol=1e-6)
        after = stream.frames[-1].time + GONE
        for time in np.arange(after, after + 2 * EASING, 1 / 60):
            shown = live.advance(time).pose.expressions
        np.testing.assert_array_equal(shown, 0)


def test_lost_packets_hold_the_last_pose(sender: Sender) -> None:
    stream = Stream(sender)
    stream.frames = stream.frames[:60]
    live = Live(stream.newest, person(), ENCODING)
    for frame in stream.frames:
        live.advance(frame.time)
    held, moment, window = live.now, live.moment, live.window()
    for late in np.arange(0.01, GONE - 0.01, 0.02):
        live.advance(stream.frames[-1].time + late)
        assert live.now is held
        assert live.moment == moment
    for now, before in zip(live.window(), window, strict=True):
        np.testing.assert_array_equal(now, before)


def test_another_pose_is_another_moment(sender: Sender) -> None:
    stream = Stream(sender)
    live, moments = Live(stream.newest, person(), ENCODING), []
    for time in np.arange(BEGINS + EASING + 0.1, BEGINS + 1.4, 1 / 240):  # four pictures of each frame
        live.advance(time)
        moments.append(live.moment)
    settled = moments[int(240 * (EASING + 0.05)) :]
    assert set(np.diff(settled)) == {0, 1}
    assert len(set(settled)) == pytest.approx(len(settled) / 4, abs=2)


def test_goes_on_without_a_jump_after_nobody_has_looked_for_a_while(sender: Sender) -> None:
    """As after a pause, or while a clip was shown."""
    stream = Stream(sender, rate=10.0)  # nine seconds
    live = Live(stream.newest, person(), ENCODING)
    for time in np.arange(BEGINS, BEGINS + 2, 1 / 60):
        before = live.advance(time)
    assert turned(before.pose, live.advance(BEGINS + 7).pose) < EASED
