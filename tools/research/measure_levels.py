"""Print what a coarser level of detail loses where it is chosen, and how much a camera that walks sees of the switches.

python tools/research/measure_levels.py hero.muaavatar --clip walk_07 --clip turn_02 --strip walk.png: as an eye of a
headset sees it, by the CPU reference. Decibels and FLIP are of the eye's whole image, and of the part that just holds
the figure.
"""

import argparse
import itertools
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import flip_evaluator
import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.camera import Camera, perspective
from mua.avatar.coarser import texel_length
from mua.avatar.decode import Splats
from mua.avatar.level_choice import LARGEST_TEXEL
from mua.avatar.rendering import frame_bounds, render_over, to_bytes
from mua.bench.counts import FOCAL, SCREEN
from mua.player.levels import AUTO, Levels

BACKGROUND = (0.5, 0.5, 0.5)
AZIMUTH = 0.3  # radians
AROUND = 0.06  # metres about the figure's box
STEPS = 120  # images of a walk in one direction
BEYOND = 1.5  # times the farthest switch and less than the nearest: where a walk begins and ends
SHOWN, HEIGHT = 12, 240  # images of a filmstrip, pixels


@dataclass(frozen=True)
class Eye:
    """Before a figure, at its middle's height."""

    middle: Array  # [3] of its box, metres
    half: Array  # [3] of its size, metres

    def camera(self, distance: float) -> Camera:
        """A camera for the part of the eye's image that just holds the figure, at this distance from its middle."""
        c, s = np.cos(AZIMUTH), np.sin(AZIMUTH)
        view = np.eye(4)
        view[:3, :3] = [[c, 0, -s], [0, 1, 0], [s, 0, c]]
        view[:3, 3] = [0, 0, -distance] - view[:3, :3] @ self.middle
        across, up, depth = np.abs(view[:3, :3]) @ self.half + AROUND
        width, height = (2 * int(np.ceil(FOCAL * side / (distance - depth))) for side in (across, up))
        projection = perspective(2 * np.arctan(height / 2 / FOCAL), aspect=width / height)
        return Camera(view, projection, (width, height))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--clip", action="append", help="to measure, one or several; the first if left out")
    parser.add_argument("--strip", type=Path, help="image to write, of a walk past all switches")
    given = parser.parse_args()
    avatar = read(given.file)
    names = given.clip or [avatar.clips[0].name]
    print("| clip | frame | texels | metres | dB, FLIP of the eye's image | dB, FLIP of the figure's part | covered |")
    print("| --- | ---: | --- | ---: | --- | --- | ---: |")
    for name in names:
        for frame in (0, len(avatar.clip(name)) // 2):
            losses(avatar, name, frame)
    walk(avatar, names[0], given.strip)


def losses(avatar: Avatar, clip: str, frame: int) -> None:
    """Print a row for each level, beside the one before it, at the distance where it is chosen."""
    sizes, length = Levels(avatar, AUTO).sizes, texel_length(avatar)
    finer = avatar.decode(clip, frame)
    eye = eye_of(finer)
    for level, size in enumerate(sizes[1:], start=1):
        coarser = avatar.at_level(level).decode(clip, frame)
        distance = length * 2**level * FOCAL / LARGEST_TEXEL + float(eye.half[2])
        camera = eye.camera(distance)
        one, other = (picture(splats, camera) for splats in (finer, coarser))
        share = np.prod(camera.screen) / np.prod(SCREEN)
        error, flip = float(np.mean((one - other) ** 2)), flip_of(other, one)
        whole = f"{decibels(error * share):.1f}, {flip * share:.4f}"
        covered = [np.abs(image - BACKGROUND[0]).max(axis=2) > 1 / 255 for image in (one, other)]
        more = covered[1].sum() / covered[0].sum() - 1
        figures = f"{whole} | {decibels(error):.1f}, {flip:.4f} | {more:+.2%}"
        print(f"| {clip} | {frame} | {size} for {sizes[level - 1]} | {distance:.1f} | {figures} |")
        finer = coarser


def walk(avatar: Avatar, clip: str, strip: Path | None) -> None:
    """Print by how much a still figure's mean colour changes from image to image, with and without a switch."""
    levels, length = Levels(avatar, AUTO), texel_length(avatar)
    poses = avatar.clip(clip)
    posed = cache(lambda level: avatar.at_level(level).decode(clip, 0))
    eye = eye_of(posed(0))
    nearest, farthest = (length * 2**level * FOCAL / LARGEST_TEXEL for level in (1, len(levels.sizes) - 1))
    ways = np.geomspace(BEYOND * farthest, nearest / BEYOND, STEPS)
    seen, before, jumps, shown = [], None, {False: 0.0, True: 0.0}, -1
    for distance in [*ways, *ways[::-1]]:
        camera = eye.camera(float(distance + eye.half[2]))
        level = levels.choose(poses.rotations[0], poses.translations[0], [camera])
        image = picture(posed(level), camera)
        mean = image.mean(axis=(0, 1))
        if before is not None:
            jump = float(np.abs(mean - before).max())
            jumps[level != shown] = max(jumps[level != shown], jump)
        before, shown = mean, level
        seen.append((distance, level, image))
    switches = sum(a[1] != b[1] for a, b in itertools.pairwise(seen))
    print(f"\nFrom {ways[0]:.1f} m to {ways[-1]:.1f} m and back in {len(seen)} images, {switches} switches.")
    print(f"The mean colour of the figure's part changes by up to {jumps[False]:.5f} between two images of one level,")
    print(f"by up to {jumps[True]:.5f} at a switch.")
    if strip is not None:
        chosen = [seen[int(i)] for i in np.linspace(0, len(seen) - 1, SHOWN)]
        Image.fromarray(np.hstack([_scaled(image) for _, _, image in chosen])).save(strip)
        print(f"{strip}: levels {', '.join(str(level) for _, level, _ in chosen)}")


def eye_of(splats: Splats) -> Eye:
    low, high = frame_bounds(splats)
    return Eye((low + high) / 2, (high - low) / 2)


def picture(splats: Splats, camera: Camera) -> Array:
    """[H, W, 3] in 0..1 over grey."""
    return np.clip(render_over(splats, camera, background=BACKGROUND), 0, 1)


def decibels(error: float) -> float:
    return float(-10 * np.log10(max(error, 1e-12)))


def flip_of(image: Array, truth: Array) -> float:
    pictures = (np.ascontiguousarray(p, np.float32) for p in (truth, image))
    return float(flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False, computeMeanError=True)[1])


def _scaled(image: Array) -> Array:
    height, width, _ = image.shape
    size = (max(round(width * HEIGHT / height), 1), HEIGHT)
    return np.asarray(Image.fromarray(to_bytes(image)).resize(size, Image.Resampling.NEAREST))


if __name__ == "__main__":
    main()
