"""What every section of schemas/README.md makes of one frame of the sample: PYTHONPATH=tests python -m oracle.sample.

A line is the section, a name, the sides, the sum of all magnitudes and the first four numbers.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from oracle import level, motion, splats, surface, texture
from oracle.file import Array, Tree, load

SAMPLE = Path(__file__).resolve().parents[1] / "golden" / "packed.muaavatar"
FRAME = 3  # a frame of the first clip at the rate of the encoding
CAMERA = np.array([0.5, 1.0, 3.0])  # looks along -Z
NEAR = 0.1


def lines(avatar: Tree) -> Iterator[str]:
    for section, name, values in _numbers(avatar):
        held = np.asarray(values, dtype=float)
        sides = " x ".join(map(str, held.shape)) or "1"
        shown = " ".join(f"{value:.6g}" for value in held.ravel()[:4])
        yield f"{section:4} {name:34} {sides:14} {np.abs(held).sum():.6g} | {shown}"


def _numbers(avatar: Tree) -> Iterator[tuple[str, str, Array | float]]:
    clip, geometry = avatar["clips"][0], avatar["geometry"]
    yield "1.1", "clips[0].rotations", clip["rotations"]
    yield "1.5", "geometry.ll_basis", geometry["ll_basis"]
    yield "2.1", "l0", motion.bind_pose(avatar["skeleton"])[0]
    yield "2.2", "l of stored frame 1", motion.stored_frame(avatar["skeleton"], clip, 1)[0]
    yield "2.2", "t of stored frame 1", motion.stored_frame(avatar["skeleton"], clip, 1)[1]
    poses = motion.frames(avatar, clip)
    yield "2.3", "frames", float(len(poses))
    yield from ((section, f"{name} of frame {FRAME}", value) for section, name, value in _posed(avatar, poses))
    x = motion.bounded(
        avatar, motion.components(avatar, motion.descriptor(avatar, motion.window(avatar, poses, FRAME)))
    )
    yield from _textured(avatar, x)
    yield from _drawn(avatar, splats.decode(avatar, poses, FRAME))
    yield "8.2", "surface triangles", np.array(surface.triangles(avatar))
    for number in range(1, len(avatar["texels"]["levels"]) + 1):
        avatar = level.coarser(avatar)
        yield "9.1", f"texels of level {number}", avatar["texels"]["texels"]
        yield "9.2", f"triangles of level {number}", avatar["texels"]["triangles"]
        yield "9.3", f"geometry.static_offset of level {number}", avatar["geometry"]["static_offset"]
        yield "9.4", f"T of level {number}", splats.decode(avatar, poses, FRAME).texture


def _posed(avatar: Tree, poses: list[motion.Pose]) -> Iterator[tuple[str, str, Array | float]]:
    yield "2.3", "l", poses[FRAME][0]
    yield "2.4", "W", motion.world(avatar["skeleton"], poses[FRAME])[0]
    yield "2.4", "P", motion.world(avatar["skeleton"], poses[FRAME])[1]
    d = motion.descriptor(avatar, motion.window(avatar, poses, FRAME))
    z = motion.components(avatar, d)
    yield from (("3.4", "d", d), ("3.5", "z", z), ("3.6", "x", motion.bounded(avatar, z)))
    yield "3.7", "outside", motion.outside(z, motion.bounded(avatar, z))


def _textured(avatar: Tree, x: Array) -> Iterator[tuple[str, str, Array]]:
    geometry = avatar["geometry"]
    alphas, A = texture.coefficients(geometry, x), texture.image(avatar, geometry, x)
    yield "4.1", "y of geometry", texture.network(geometry["mlp"], x)
    yield "4.2", "v", texture.canonical(avatar["coarse"], x)
    yield "4.3", "alpha of geometry", alphas[0]
    yield "5.1", "LL of geometry", texture.low(geometry, alphas[0])
    yield "5.1", "D_0 of geometry", texture.detail(geometry["details"][0], alphas[1])
    yield "5.2", "A_levels of geometry", A
    yield "5.3", "T of geometry", texture.at_texels(avatar, geometry, A)
    yield "5.5", "b_0, b_1", texture.places(avatar)
    yield "5.6", "one-sided", texture.one_sided(avatar["texels"])


def _drawn(avatar: Tree, found: splats.Splats) -> Iterator[tuple[str, str, Array]]:
    view = np.eye(4)
    view[:3, 3] = -CAMERA
    yield "6.1", "K", found.joints
    yield "6.3", "vertices' dual quaternions", found.vertices
    yield "6.4", "Q", found.dual
    for name in ("centres", "rotations", "scales", "opacities"):
        yield "6.5", name, getattr(found, name)
    yield "6.6", f"colours from {CAMERA.tolist()}", found.colours(CAMERA)
    yield "7.2", "seen from behind", splats.behind(avatar, found, view)
    yield "7.3", f"keys, near = {NEAR}", splats.keys(avatar, found, view, NEAR)


if __name__ == "__main__":
    sys.stdout.write("".join(f"{line}\n" for line in lines(load(SAMPLE))))
