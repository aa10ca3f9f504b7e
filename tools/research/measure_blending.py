"""Print how far splats blended as light, as in a Unity project of linear colour space, are from blended sRGB values.

python tools/research/measure_blending.py hero.muaavatar: frames of all clips over white and over black; dB of the 8-bit
images over the pixels that any splat covers. An avatar is fitted by blending sRGB values, as a project in gamma space
does.
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.asset.read import read
from mua.avatar.camera import orbit
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_premultiplied, to_bytes

FRAMES = 2  # frames of each clip
SCREEN = (480, 720)
BACKGROUNDS = {"white": 1.0, "black": 0.0}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    avatar = read(parser.parse_args().file)
    print("| clip | frame | background | dB | mean difference of 255 | 99 % below |")
    print("| --- | --- | --- | --- | --- | --- |")
    for clip, part in itertools.product(avatar.clips, np.linspace(0, 1, FRAMES)):
        index = int(part * (len(clip) - 1))
        frame = decode_clip_frame(avatar, clip, frame=index)
        camera = orbit(frame_bounds(frame), screen=SCREEN, azimuth=0.4)
        blended, light = (render_premultiplied(frame, camera, encode=encode) for encode in (np.asarray, linear))
        for name, value in BACKGROUNDS.items():
            shown = over(blended, value), srgb(over(light, linear(np.array(value))))
            difference = np.subtract(*(to_bytes(image).astype(float)[blended[..., 3] > 0] for image in shown))
            decibels = 20 * np.log10(255 / np.sqrt(np.mean(difference**2)))
            sizes = np.abs(difference)
            row = (clip.name, index, name, f"{decibels:.1f}", f"{sizes.mean():.2f}", f"{np.percentile(sizes, 99):.0f}")
            print("| " + " | ".join(map(str, row)) + " |")


def over(image: Array, background: Array | float) -> Array:
    return np.asarray(image[..., :3] + (1 - image[..., 3:]) * background)


def linear(value: Array) -> Array:
    """Light of sRGB (IEC 61966-2-1)."""
    return np.where(value <= 0.04045, value / 12.92, ((np.maximum(value, 0) + 0.055) / 1.055) ** 2.4)


def srgb(light: Array) -> Array:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 0) ** (1 / 2.4) - 0.055)


if __name__ == "__main__":
    main()
