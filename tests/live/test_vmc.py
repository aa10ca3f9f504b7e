"""Frames of a VMC stream: when one is complete, what it holds, and that nobody can spoil it."""

import tracemalloc
from typing import Any

import numpy as np
import pytest
from people import walk
from vmc_senders import Sender, bundle, frames_of, humanoid, message, performing

from mua.live.bones import BONES
from mua.live.vmc import GONE, LONGEST_NAME, MOST_EXPRESSIONS, QUIET, Assembler, Frame
from mua.motion.source_motion import SourceMotion

SINGLE = 4 * float(np.finfo(np.float32).eps)  # OSC's numbers, a division by the length
UNTURNED = (0.0, 0.0, 0.0, 1.0)


def bone(name: str, *, at: tuple[float, ...] = (0.0, 0.1, 0.0), turn: tuple[float, ...] = UNTURNED) -> tuple[Any, ...]:
    return ("/VMC/Ext/Bone/Pos", name, *at, *turn)


def fed(*packets: bytes, time: float = 0.0) -> Assembler:
    assembler = Assembler()
    for packet in packets:
        assembler.feed(packet, time)
    return assembler


def whole(assembler: Assembler) -> Frame:
    assert assembler.newest is not None
    return assembler.newest


@pytest.fixture(scope="module")
def sender() -> Sender:
    from people import person

    body = person()
    moving = performing(SourceMotion(body, walk(body, 20)), humanoid())
    return Sender(moving.figure, moving.clip, [{"A": frame / 20, "Joy": 1 - frame / 20} for frame in range(20)])


def test_frames_are_what_was_sent(sender: Sender) -> None:
    joints = [BONES.index(name) for name in sender.figure.names]
    for index, frame in enumerate(frames_of(sender)):
        np.testing.assert_allclose(frame.positions[joints], sender.clip.translations[index], atol=10 * SINGLE)
        same = np.abs(np.sum(frame.rotations[joints] * sender.clip.rotations[index], axis=1))
        np.testing.assert_allclose(same, 1, atol=SINGLE)
        assert frame.expressions == pytest.approx(sender.face[index])
        assert set(np.flatnonzero(frame.known)) == set(joints)


@pytest.mark.parametrize("parts", [1, 7, 1000])
def test_it_does_not_matter_how_frames_are_split_over_packets(sender: Sender, parts: int) -> None:
    assembler = fed(*[packet for frame in range(3) for packet in sender.packets(frame, parts=parts)])
    assert assembler.counts.frames == 3
    assert (assembler.counts.malformed, assembler.counts.ignored) == (0, 0)
    np.testing.assert_array_equal(whole(assembler).rotations, frames_of(sender)[2].rotations)


@pytest.mark.parametrize(
    "end", [("/VMC/Ext/Blend/Apply",), ("/VMC/Ext/OK", 1), ("/VMC/Ext/T", 0.5), bone("Head", turn=(0.0, 0.0, 1.0, 0.0))]
)
def test_a_frame_is_complete_where_the_next_one_begins(end: tuple[Any, ...]) -> None:
    assembler = fed(message(*bone("Head")))
    assert assembler.newest is None
    assembler.feed(message(*end), 0.0)
    np.testing.assert_array_equal(whole(assembler).rotations[BONES.index("Head")], [1, 0, 0, 0])


@pytest.mark.parametrize("part", [bone("Head"), ("/VMC/Ext/Blend/Val", "A", 0.5)])
def test_a_frame_that_nothing_ends_is_complete_when_nothing_more_comes(part: tuple[Any, ...]) -> None:
    assembler = fed(message(*part), time=5.0)
    assembler.settle(5.0 + QUIET / 2)
    assert assembler.newest is None
    assembler.settle(5.0 + 1.5 * QUIET)
    assert whole(assembler).time == 5.0


def test_the_root_may_come_in_every_packet_of_a_frame() -> None:
    root = ("/VMC/Ext/Root/Pos", "root", 0.0, 0.0, 0.0, *UNTURNED)
    assembler = fed(bundle(root, bone("Hips")), bundle(root, bone("Head")), bundle(("/VMC/Ext/OK", 1)))
    assert assembler.counts.frames == 1


def test_what_a_frame_lacks_stays_as_it_was_until_the_sender_has_stopped() -> None:
    assembler = Assembler()
    assembler.feed(bundle(bone("Head"), ("/VMC/Ext/Blend/Val", "A", 0.5), ("/VMC/Ext/Blend/Apply",)), 0.0)
    assembler.feed(bundle(bone("Neck"), ("/VMC/Ext/Blend/Val", "I", 0.25), ("/VMC/Ext/OK", 1)), GONE)
    assert whole(assembler).expressions == {"A": 0.5, "I": 0.25}
    assert set(np.flatnonzero(whole(assembler).known)) == {BONES.index("Head"), BONES.index("Neck")}
    assembler.feed(bundle(bone("Spine"), ("/VMC/Ext/OK", 1)), 2 * GONE + 0.01)
    assert whole(assembler).expressions == {}
    assert list(np.flatnonzero(whole(assembler).known)) == [BONES.index("Spine")]


def test_positions_and_turns_are_in_our_axes() -> None:
    """Unity's X points to the right of a figure that faces Z, and a turn about Y goes from Z to X: to its right."""
    half = np.sqrt(0.5)
    head = whole(
        fed(bundle(bone("Head", at=(0.5, 0.25, 0.125), turn=(0.0, 2 * half, 0.0, 2 * half)), ("/VMC/Ext/OK", 1)))
    )
    np.testing.assert_array_equal(head.positions[BONES.index("Head")], [-0.5, 0.25, 0.125])
    np.testing.assert_allclose(head.rotations[BONES.index("Head")], [half, 0, -half, 0], atol=SINGLE)


@pytest.mark.parametrize(
    "wrong",
    [
        bone("Tail"),
        bone("Head" * 50),
        bone("Head", at=(float("nan"), 0.0, 0.0)),
        bone("Head", at=(0.0, 1e30, 0.0)),
        bone("Head", turn=(0.0, 0.0, 0.0, 0.0)),
        bone("Head", turn=(0.0, float("inf"), 0.0, 1.0)),
        bone("Head", turn=(0.0, float("nan"), 0.0, 1.0)),
        bone("Head")[:-1],
        ("/VMC/Ext/Bone/Pos",),
        ("/VMC/Ext/Bone/Pos", 3, 0.0, 0.0, 0.0, *UNTURNED),
        ("/VMC/Ext/Bone/Pos", "Head", "0", 0.0, 0.0, *UNTURNED),
        ("/VMC/Ext/Blend/Val", "A"),
        ("/VMC/Ext/Blend/Val", "A", float("nan")),
        ("/VMC/Ext/Blend/Val", "A", "0.5"),
        ("/VMC/Ext/Blend/Val", 0.5, 0.5),
        ("/VMC/Ext/Blend/Val", "", 0.5),
        ("/VMC/Ext/Blend/Val", "A" * (LONGEST_NAME + 1), 0.5),
    ],
    ids=repr,
)
def test_values_that_mean_nothing_are_ignored_and_counted(wrong: tuple[Any, ...]) -> None:
    sound = bundle(bone("Head", turn=(1.0, 0.0, 0.0, 0.0)), ("/VMC/Ext/Blend/Val", "A", 0.5), ("/VMC/Ext/OK", 1))
    assembler = fed(sound, message(*wrong), message("/VMC/Ext/OK", 1))
    assert (assembler.counts.ignored, assembler.counts.malformed, assembler.counts.frames) == (1, 0, 1)
    assert whole(assembler).expressions == {"A": 0.5}


def test_weights_are_kept_within_0_and_1() -> None:
    given = [("/VMC/Ext/Blend/Val", name, weight) for name, weight in (("A", -3.0), ("I", 1e9), ("U", 1))]
    assert whole(fed(bundle(*given, ("/VMC/Ext/Blend/Apply",)))).expressions == {"A": 0, "I": 1, "U": 1}


def test_messages_that_are_no_part_of_a_pose_do_nothing() -> None:
    assembler = fed(message("/VMC/Ext/Cam", "Camera", *[0.0] * 7, 60.0), message("/VMC/Ext/Key", 1, "A", 65))
    assert (assembler.counts.packets, assembler.counts.ignored, assembler.newest) == (2, 0, None)


def damaged(sound: bytes, random: np.random.Generator) -> bytes:
    packet = bytearray(sound)
    for bit in random.integers(8 * len(packet), size=random.integers(1, 9)):
        packet[bit // 8] ^= 1 << int(bit % 8)
    return bytes(packet[: random.integers(len(packet) + 1)] if random.random() < 0.2 else packet)


def test_ten_thousand_wrong_packets_among_the_right_ones_change_nothing(sender: Sender) -> None:
    """Each frame after them is that of a stream without them; a name that a flipped bit has made may have a weight."""
    random, assembler = np.random.default_rng(9), Assembler()
    expected = frames_of(sender)
    packets = [sender.packets(frame, parts=1000)[0] for frame in range(20)]
    for frame, packet in enumerate(packets):
        for _ in range(250):
            assembler.feed(random.bytes(int(random.integers(1, 400))), frame / 60)
            assembler.feed(damaged(packets[random.integers(20)], random), frame / 60)
        assembler.feed(message("/VMC/Ext/OK", 1), frame / 60)
        assembler.feed(packet, frame / 60)
        joints = expected[frame].known
        np.testing.assert_array_equal(whole(assembler).rotations[joints], expected[frame].rotations[joints])
        np.testing.assert_array_equal(whole(assembler).positions[joints], expected[frame].positions[joints])
        assert expected[frame].expressions.items() <= whole(assembler).expressions.items()
        assert len(whole(assembler).expressions) <= MOST_EXPRESSIONS
    counts = assembler.counts
    assert counts.packets == 10_000 + 40
    assert counts.malformed > 5_000
    assert counts.ignored > 0


def test_packets_of_random_bytes_change_nothing_at_all(sender: Sender) -> None:
    random, assembler = np.random.default_rng(10), fed(*sender.packets(0))
    before = whole(assembler)
    for _ in range(2000):
        assembler.feed(b"/VMC/Ext/Bone/Pos\0\0\0,s" + random.bytes(int(random.integers(200))), 0.0)
    assembler.settle(1.0)
    assert whole(assembler) is before
    assert assembler.counts.malformed + assembler.counts.ignored >= 2000


def test_memory_does_not_grow_with_what_comes() -> None:
    """Minutes of frames, and names without end."""
    assembler, packet = Assembler(), bundle(bone("Head"), bone("Hips"), ("/VMC/Ext/OK", 1))

    def play(seconds: range) -> int:
        for second in seconds:
            for frame in range(60):
                assembler.feed(packet, second + frame / 60)
                assembler.feed(message("/VMC/Ext/Blend/Val", f"name {second} {frame}", 0.5), second + frame / 60)
        return tracemalloc.get_traced_memory()[0]

    tracemalloc.start()
    try:
        first, last = play(range(20)), play(range(20, 60))
    finally:
        tracemalloc.stop()
    assert len(whole(assembler).expressions) == MOST_EXPRESSIONS
    assert last - first < 10_000  # bytes: counts that are larger numbers
    assert assembler.counts.frames > 3000
