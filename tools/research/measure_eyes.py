"""Print how far an image would be off if a splat had one colour for both eyes in place of one for each.

python tools/research/measure_eyes.py hero.muaavatar --clip walk_07 --frame 0 --frame 20: the left eye's image by the
device at hand, from the front and from aside, at the height of face and chest. Order and ellipses are the same.
"""

import argparse
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit, stereo
from mua.bench.counts import FOCAL
from mua.gpu import Device, open_device
from mua.motion.facing import front_of
from mua.player.buffers import AvatarBuffers
from mua.player.draw import EXACT_FORMAT, SortedSplats, SplatRenderer, draw_image
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.resample import resample

SCREEN = (840, 880)  # pixels, half of an eye's along a side
APART = 0.063  # metres between the eyes
DISTANCES = (1.0, 0.6, 0.4)  # metres from the surface
TURNS = (0.0, 0.6)  # radians from the front
HEIGHTS = (0.85, 0.7)  # of the figure: face and chest
DEEP = 0.12  # metres from a figure's axis to its surface
NO_TINT = np.uint32(64 << 11 | 64 << 18 | 64 << 25)  # mua.kernels.splat_project.pack_colors
OPACITY = np.uint32(0x7FF)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--clip", help="the first if left out")
    parser.add_argument("--frame", type=int, action="append", help="0 if left out")
    given = parser.parse_args()
    device = open_device()
    frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, given.file))])
    avatar = frame.avatars[0].avatar.avatar
    clip = resample(avatar.clip(given.clip) if given.clip else avatar.clips[0], avatar.encoding.rate)
    print("| metres | largest, 1/255 | mean where it is covered, 1/255 |\n| ---: | ---: | --- |")
    for distance in DISTANCES:
        errors = []
        for index in given.frame or [0]:
            window = np.clip(avatar.encoding.frames(index), 0, len(clip) - 1)
            front = front_of(avatar.rig.skeleton, clip.rotations[index], clip.translations[index])
            for turn in TURNS:
                for height in HEIGHTS:
                    commands = device.commands()
                    frame.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
                    eyes = stereo(before(frame.avatars[0].bounds, front + turn, height, distance + DEEP), APART)
                    frame.sort(commands, eyes)
                    commands.submit()
                    errors.append(differences(device, frame.sorted, eyes[0]))
        largest, means = max(error.max() for error in errors), [error.mean() for error in errors]
        print(f"| {distance} | {255 * largest:.1f} | {255 * min(means):.1f} to {255 * max(means):.1f} |", flush=True)


def before(bounds: Array, azimuth: float, height: float, distance: float) -> Camera:
    """A camera at a height of the box."""
    camera = orbit(bounds, screen=SCREEN, azimuth=azimuth)
    view, projection, middle = camera.view.copy(), camera.projection.copy(), bounds.mean(axis=0)
    middle[1] = bounds[0, 1] + height * np.ptp(bounds[:, 1])
    view[:3, 3] = [0, 0, -distance] - view[:3, :3] @ middle
    projection[0, 0], projection[1, 1] = (FOCAL / side for side in SCREEN)
    return Camera(view, projection, SCREEN)


def differences(device: Device, splats: SortedSplats, eye: Camera) -> Array:
    """Largest of the channels at each covered pixel [P], between the eye's own colours and the mean of both eyes'."""
    words = splats.splats.read().reshape(-1, 8).copy()
    words[:, 4] = words[:, 4] & OPACITY | NO_TINT
    same = SortedSplats(device.buffer(words, name="splats"), splats.order, splats.arguments)
    renderer = SplatRenderer(device, EXACT_FORMAT)
    own, one = (draw_image(device, renderer, drawn, [eye]) for drawn in (splats, same))
    return np.asarray(np.abs(own - one)[own[..., 3] > 0.5].max(axis=-1))


if __name__ == "__main__":
    main()
