"""Print the processor time of each kernel of a frame alone and of its drawing, on a device that is a processor.

python tools/research/bench_processor.py hero.muaavatar --distance 1.0; without a file, of random numbers in the paper's
shapes. Mesa's lavapipe computes in this process: its processor time counts no other program's, as a clock would do.
"""

import argparse
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from mua.asset.write import write
from mua.avatar.camera import Camera
from mua.bench.counts import DISTANCES, eye_before, fragments
from mua.bench.random_avatar import random_avatar
from mua.bench.work import by_kernel
from mua.gpu import Buffer, Commands, Device, open_device
from mua.gpu.kernel import Kernel
from mua.motion.facing import front_of
from mua.player.buffers import AvatarBuffers
from mua.player.draw import IMAGE_FORMAT, SortedSplats, SplatRenderer, draw_image
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.student.settings import preset

VISIBLE_WORD = 4  # word of the arguments that splat_sort writes


class Recorded:
    """Dispatches of a frame in order, each to be submitted alone."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self.all = device.commands()
        self.each: list[tuple[str, Commands]] = []

    def dispatch(
        self, kernel: Kernel, groups: tuple[int, int, int], buffers: Mapping[str, Buffer], **constants: Any
    ) -> None:
        alone = self._device.commands()
        for commands in (alone, self.all):
            commands.dispatch(kernel, groups, buffers, **constants)
        self.each.append((kernel.name, alone))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, nargs="?")
    parser.add_argument("--distance", type=float, action="append", help="metres; 2.2, 1.0 and 0.6 if left out")
    parser.add_argument("--repeat", type=int, default=9, help="the median counts")
    given = parser.parse_args()
    device = open_device()
    with TemporaryDirectory() as folder:
        path = given.file or Path(folder) / "random.muaavatar"
        if given.file is None:
            write(path, random_avatar(preset("paper")))
        frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, path))])
    (avatar,) = frame.avatars
    clip, skeleton = avatar.avatar.avatar.clips[0], avatar.avatar.avatar.rig.skeleton
    window = avatar.avatar.avatar.encoding.frames(0)
    before = device.commands()
    avatar.decode(before, clip.rotations[window], clip.translations[window])
    azimuth = front_of(skeleton, clip.rotations[0], clip.translations[0])
    cameras = {way: eye_before(avatar.bounds, azimuth, way) for way in given.distance or DISTANCES}
    recorded: Any = Recorded(device)
    avatar.decode(recorded, clip.rotations[window], clip.translations[window])
    frame.sort(recorded, [next(iter(cameras.values()))])
    kernels(device, frame, recorded, given.repeat)
    for distance, camera in cameras.items():
        drawing(device, frame, clip, window, camera, f"{distance} m", given.repeat)


def _through(commands: Commands, frame: SplatFrame[AvatarFrame]) -> None:
    """Submit commands and wait until they are done."""
    commands.submit()
    frame.arguments.read()


def kernels(device: Device, frame: SplatFrame[AvatarFrame], recorded: Recorded, repeat: int) -> None:
    """Print a row for each kernel."""
    spent = defaultdict(list)
    for _ in range(repeat):
        once: defaultdict[str, float] = defaultdict(float)
        for name, commands in recorded.each:
            once[name] += processor(partial(_through, commands, frame))
            once[name] -= processor(frame.arguments.read)
        for name, seconds in once.items():
            spent[name].append(1e3 * seconds)
    share = frame.arguments.read()[VISIBLE_WORD] / frame.splat_count
    print("| kernel | dispatches | ms | MB | MFLOP |\n| --- | ---: | ---: | ---: | ---: |")
    for name, work in by_kernel(recorded.all.bound, share=share).items():
        times = sum(kernel == name for kernel, _ in recorded.each)
        print(
            f"| `{name}` | {times} | {np.median(spent[name]):.1f} | {work.bytes / 1e6:.2f} | {work.flops / 1e6:.1f} |"
        )
    print(f"| all | {len(recorded.each)} | {sum(map(np.median, spent.values())):.0f} | | |\n")


def drawing(
    device: Device, frame: SplatFrame[AvatarFrame], clip: Any, window: list[int], camera: Camera, name: str, repeat: int
) -> None:
    """Print what drawing the frame before a camera takes beyond an empty image."""
    commands = device.commands()
    frame.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
    frame.sort(commands, [camera])
    commands.submit()
    renderer = SplatRenderer(device, IMAGE_FORMAT)
    nothing = device.buffer(np.zeros(len(frame.arguments.read()), np.uint32), name="arguments", indirect=True)
    empty = SortedSplats(frame.sorted.splats, frame.sorted.order, nothing)
    taken = [
        processor(lambda: draw_image(device, renderer, frame.sorted, [camera]))
        - processor(lambda: draw_image(device, renderer, empty, [camera]))
        for _ in range(repeat)
    ]
    counted = fragments(device, frame.sorted, camera).sum(dtype=float) / 1e6
    print(f"drawing from {name}: {1e3 * np.median(taken):.0f} ms, {counted:.2f} million fragments")


def processor(run: Callable[[], Any]) -> float:
    """Seconds of this process."""
    start = time.process_time()
    run()
    return time.process_time() - start


if __name__ == "__main__":
    main()
