"""Print what f16, i8 and packed storage cost: bytes, and the error of each attribute beside the same avatar in f32.

mua-bake --storage f32 -o hero.muaavatar ...; python tools/research/measure_storage.py hero.muaavatar
"""

import argparse
import itertools
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.tensors import Storage
from mua.asset.write import encode
from mua.avatar.decode import decode_clip_frame
from mua.baking.evaluate import UNITS
from mua.channels import ATTRIBUTES

FRAMES = 3  # frames of each clip
STORAGES: tuple[Storage, ...] = ("f32", "f16", "i8", "packed")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, help="an avatar baked with --storage f32")
    avatar = read(parser.parse_args().file)
    exact = textures(avatar, avatar)
    print("| storage | MB | " + " | ".join(f"{name}, {UNITS[name][0]}" for name in ATTRIBUTES) + " |")
    print("|" + " --- |" * (2 + len(ATTRIBUTES)))
    for storage in STORAGES:
        content = encode(avatar, storage=storage)
        error = textures(decode_tree(parse_checked(content)), avatar) - exact
        cells = [spread(error[..., channels], UNITS[name][1]) for name, channels in ATTRIBUTES.items()]
        print(f"| {storage} | {len(content) / 1e6:.2f} | " + " | ".join(cells) + " |")


def textures(avatar: Avatar, source: Avatar) -> Array:
    """Textures [F, N, 23] of frames of all clips of `source`."""
    frames = itertools.product(source.clips, np.linspace(0, 1, FRAMES))
    return np.stack([decode_clip_frame(avatar, c, frame=int(t * (len(c) - 1))).texture for c, t in frames])


def spread(error: Array, scale: float) -> str:
    """RMS and largest error of vectors [..., c] in a person's unit."""
    lengths = scale * np.linalg.norm(error, axis=-1)
    return f"{np.sqrt(np.mean(lengths**2)):.2g} (max {lengths.max():.2g})"


if __name__ == "__main__":
    main()
