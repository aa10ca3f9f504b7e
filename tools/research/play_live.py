"""Plays a motion file to an avatar as a VMC stream over the loopback, and prints memory, losses and time as it goes on.

A process sends 60 frames a second, each split over packets as programs send them, with 52 expressions; another one
listens and poses the avatar for every picture of a display of 60 Hz, its descriptor's window included.
"""

import argparse
import socket
import sys
import time
from collections import deque
from multiprocessing import get_context
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "python"), str(ROOT / "tests" / "fixtures")]

import numpy as np  # noqa: E402
from vmc_senders import Sender, humanoid, performing  # noqa: E402

from mua.asset.read import read  # noqa: E402
from mua.live.live_pose import Live  # noqa: E402
from mua.live.receiver import LOOPBACK, Address, Receiver  # noqa: E402
from mua.motion.read import read_motion  # noqa: E402

RATE = 60.0  # frames and pictures a second
SHAPES = 52  # expressions, as ARKit has


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("avatar", type=Path)
    parser.add_argument("motion", type=Path)
    parser.add_argument("--seconds", type=float, default=600.0)
    asked = parser.parse_args()
    avatar = read(asked.avatar)
    with Receiver(Address(0)) as receiver:
        live = Live(receiver.newest, avatar.rig.skeleton, avatar.encoding)
        given = (asked.motion, receiver.address.port, asked.seconds)
        program = get_context("spawn").Process(target=send, args=given)
        program.start()
        _display(receiver, live, asked.seconds)
        program.join()
        print(receiver.figures)


def _display(receiver: Receiver, live: Live, seconds: float) -> None:
    """Ask for the pose of every picture, and print a line a minute."""
    while receiver.newest(time.monotonic()) is None:
        time.sleep(0.01)
    begun, pictures = time.monotonic(), 0
    spent: deque[float] = deque(maxlen=round(60 * RATE))
    while (now := time.monotonic()) < begun + seconds:
        if pictures % round(60 * RATE) == round(RATE):  # a second after the full minute: all is allocated
            print(f"{now - begun:4.0f} s: {_resident():.1f} MB resident, {receiver.figures}", flush=True)
        live.advance(now)
        live.window()
        done = time.monotonic()
        receiver.latency.drawn(live.arrived, done)
        spent.append(done - now)
        pictures += 1
        time.sleep(max(begun + pictures / RATE - done, 0))
    print(f"{seconds:4.0f} s: {_resident():.1f} MB resident; {np.median(spent) * 1e3:.1f} ms for the pose of a picture")


def send(motion: Path, port: int, seconds: float) -> None:
    """Send a motion over and over, forwards and backwards, so that it never leaps."""
    source = read_motion(motion)[0]
    moving = performing(source, humanoid(), rate=RATE)
    random = np.random.default_rng(0)
    face = [{f"shape {shape}": float(random.random()) for shape in range(SHAPES)} for _ in moving.clip.rotations]
    frames = [Sender(moving.figure, moving.clip, face).packets(frame) for frame in range(len(moving.clip))]
    frames += frames[::-1]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
        begun = time.monotonic()
        for number in range(round((seconds + 2) * RATE)):
            for packet in frames[number % len(frames)]:
                program.sendto(packet, (LOOPBACK, port))
            time.sleep(max(begun + (number + 1) / RATE - time.monotonic(), 0))
        packets = sum(len(frames[number % len(frames)]) for number in range(round((seconds + 2) * RATE)))
        print(f"sent {packets:,} packets of {round((seconds + 2) * RATE):,} frames")


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


if __name__ == "__main__":
    main()
