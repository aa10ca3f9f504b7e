"""The UDP port: a stream over the loopback poses as the clip, wrong packets are counted, closing ends the thread."""

import select
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from people import person, retarget
from shared_data import SharedData
from vmc_senders import Program, Sender, humanoid, message, performing

from mua.cli.listening import listening
from mua.errors import InputError
from mua.live.live_pose import EASING, Live
from mua.live.receiver import Address, Receiver
from mua.motion.bvh import read_bvh
from mua.pose.encoding import PoseEncoding

SINGLE = 12 * 4 * float(np.finfo(np.float32).eps)
PATIENCE = 10  # seconds for what takes none


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    with Receiver(Address(0)) as opened:
        yield opened


@pytest.fixture
def program(receiver: Receiver) -> Iterator[Program]:
    with Program(receiver) as sending:
        yield sending


def test_a_recorded_stream_over_the_loopback_poses_as_the_retargeted_clip(
    shared_data: SharedData, receiver: Receiver, program: Program
) -> None:
    target = person(axes=7)
    sender: Sender = performing(read_bvh(shared_data.path("motion/cmu/02_03.bvh")), humanoid())
    clip, _ = retarget(sender.motion, target)
    live = Live(receiver.newest, target, PoseEncoding(joints=(1, 2), rate=30.0))
    program.send(*sender.packets(0))
    live.advance(time.monotonic())
    for frame in range(len(sender.clip)):
        program.send(*sender.packets(frame))
        shown = live.advance(time.monotonic() + EASING).pose.rotations
        same = np.abs(np.sum(shown * clip.rotations[frame], axis=-1))
        assert np.sqrt(2 * np.maximum(1 - same, 0)).max() < SINGLE
    assert receiver.counts.malformed == receiver.counts.ignored == 0


def test_wrong_packets_are_counted_and_the_port_stays_open(receiver: Receiver, program: Program) -> None:
    program.send(b"", b"nonsense", bytes(1000), message("/VMC/Ext/Bone/Pos", "Tail", *[0.0] * 6, 1.0))
    assert receiver.newest(time.monotonic()) is None
    assert (receiver.counts.malformed, receiver.counts.ignored) == (3, 1)
    program.send(message("/VMC/Ext/Blend/Val", "A", 0.5), message("/VMC/Ext/Blend/Apply"))
    newest = receiver.newest(time.monotonic())
    assert newest is not None
    assert newest.expressions == {"A": 0.5}


@pytest.mark.parametrize(
    ("host", "reach"), [("127.0.0.1", "this machine alone"), ("0.0.0.0", "whoever reaches this machine")]
)
def test_says_who_reaches_it(capsys: pytest.CaptureFixture[str], host: str, reach: str) -> None:
    with listening(Address(0, host)) as receiver:
        assert receiver is not None
        assert capsys.readouterr().out == f"listens to VMC on {receiver.address}, from {reach}\n"


def test_listens_on_the_loopback_address_alone_unless_told_otherwise(receiver: Receiver) -> None:
    assert receiver.address.host == "127.0.0.1"
    with Receiver(Address(0, "0.0.0.0")) as everywhere:
        assert str(everywhere.address) == f"0.0.0.0:{everywhere.address.port}"
        with Program(everywhere) as sending:
            sending.send(message("/VMC/Ext/OK", 1))


def test_says_that_a_port_is_taken_or_an_address_is_not_here(receiver: Receiver) -> None:
    taken = receiver.address
    with pytest.raises(InputError, match=f"--listen is {taken}; that port cannot be opened: Address already in use"):
        Receiver(taken)
    with pytest.raises(InputError, match=r"--listen is 192\.0\.2\.1:39539; that port cannot be opened"):
        Receiver(Address(39539, "192.0.2.1"))


def test_a_closed_port_is_free_again_and_nothing_runs_on() -> None:
    before = set(threading.enumerate())
    with Receiver(Address(0)) as first:
        assert set(threading.enumerate()) > before
    assert set(threading.enumerate()) == before
    first.close()
    Receiver(first.address).close()


def test_closing_ends_the_thread_although_a_player_takes_what_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    waiting, closed = select.select, threading.Event()

    def preempted(*given: Any) -> Any:
        closed.wait()
        opened.newest(time.monotonic())  # as a player that draws at this moment
        return waiting(*given)

    monkeypatch.setattr(select, "select", preempted)
    opened = Receiver(Address(0))
    closing = threading.Thread(target=opened.close, daemon=True)
    closing.start()
    closing.join(0.05)  # it waits for the thread
    closed.set()
    closing.join(PATIENCE)
    assert not closing.is_alive()
