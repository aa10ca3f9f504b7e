"""What every section makes of one frame of the worked sample: PYTHONPATH=tests python -m oracle.sample.

A line is the section, a name, the sides, the sum of all magnitudes and the first four numbers. Section 12 is of the
same avatar with expressions.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from oracle import descriptor, drawing, expressions, motion, splats, surface, texture
from oracle.file import Record, load

SAMPLE = Path(__file__).resolve().parents[1] / "golden" / "packed.muaavatar"
SPOKEN = SAMPLE.with_name("expressions.muaavatar")
FRAME = 3  # a frame of the first clip at the rate of the encoding
VIEW = np.array([[1, 0, 0, -0.5], [0, 1, 0, -1], [0, 0, 1, -3], [0, 0, 0, 1]])  # from (0.5, 1, 3) along -Z
PROJECTION = np.array([[3, 0, 0.1, 0], [0, 4, -0.2, 0], [0, 0, -1, -0.2], [0, 0, -1, 0]])
CAMERA = drawing.Camera(VIEW, PROJECTION, near=0.1, screen=(64, 48))


def lines(avatar: Record, spoken: Record) -> Iterator[str]:
    for section, name, value in (*numbers(avatar), *of_expressions(spoken)):
        array = np.atleast_1d(np.asarray(value, np.float64))
        sides, first = " x ".join(map(str, array.shape)), " ".join(f"{number:g}" for number in array.flat[:4])
        yield f"{section:4} {name:34} {sides:14} {np.abs(array).sum():g} | {first}"


def numbers(avatar: Record) -> Iterator[tuple[str, str, Any]]:
    skeleton, geometry, clip = avatar.skeleton, avatar.geometry, avatar.clips[0]
    yield "1.1", "clips[0].rotations", clip.rotations
    yield "1.5", "geometry.ll_basis", geometry.ll_basis
    yield "1.5", "coarse.basis", avatar.coarse.basis
    yield "2.1", "l0", motion.bind_pose(skeleton).rotations
    yield "2.2", "l of stored frame 1", motion.stored_pose(skeleton, clip, 1).rotations
    yield "2.2", "t of stored frame 1", motion.stored_pose(skeleton, clip, 1).translations
    poses = motion.poses(avatar, clip)
    yield "2.3", "frames", len(poses)
    yield "2.3", f"l of frame {FRAME}", poses[FRAME].rotations
    yield "2.4", f"W of frame {FRAME}", motion.in_the_world(skeleton, poses[FRAME])[0]
    yield "2.4", f"P of frame {FRAME}", motion.in_the_world(skeleton, poses[FRAME])[1]
    d = descriptor.describe(avatar, poses, FRAME)
    z = descriptor.components(avatar.encoding, d)
    x = descriptor.bound(avatar.encoding, z)
    yield "3.4", f"d of frame {FRAME}", d
    yield "3.5", f"z of frame {FRAME}", z
    yield "3.6", f"x of frame {FRAME}", x
    yield "3.7", f"outside of frame {FRAME}", descriptor.outside(z, x)
    found = splats.decode(avatar, poses, FRAME)
    yield "4.1", "y of geometry", texture.network(geometry.mlp, x)
    yield "4.2", "v", found.canonical
    yield "4.3", "alpha of geometry", texture.coefficients(geometry, x)[0]
    yield "5.1", "LL of geometry", texture.subbands(geometry, x)[0]
    yield "5.1", "D_0 of geometry", texture.subbands(geometry, x)[1][0]
    yield "5.2", "A_levels of geometry", texture.image(avatar.wavelet, geometry, x)
    yield "5.3", "T", found.texture
    yield "5.5", "b_0, b_1", found.texels.barycentrics
    yield "5.6", "one-sided", found.texels.one_sided
    yield "6.1", "K", found.joints
    yield "6.3", "vertices' dual quaternions", found.vertices
    yield "6.4", "Q", found.motions
    yield from (("6.5", name, getattr(found, name)) for name in ("centres", "rotations", "scales", "opacities"))
    yield "6.6", f"colours from {CAMERA.eye().tolist()}", found.colours(CAMERA.eye())
    yield "7.1", "pixel", drawing.ellipses(found, CAMERA)[0]
    yield "7.2", "seen from behind", drawing.behind(found, CAMERA)
    yield "7.3", f"keys, near = {CAMERA.near}", drawing.keys(found, CAMERA)
    yield "7.3", "image", drawing.draw(found, CAMERA, np.zeros((48, 64, 3)))
    yield "8.2", "surface triangles", surface.triangles(avatar)
    for number in range(1, 1 + len(avatar.texels.levels)):
        found = splats.decode(avatar, poses, FRAME, number)
        yield "9.1", f"texels of level {number}", found.texels.texels
        yield "9.2", f"triangles of level {number}", found.texels.triangles
        yield "9.3", f"geometry.static_offset of level {number}", found.texels.static_offset[:11]
        yield "9.4", f"T of level {number}", found.texture


def of_expressions(avatar: Record) -> Iterator[tuple[str, str, Any]]:
    pose = motion.poses(avatar, avatar.clips[0])[FRAME]
    assert pose.weights is not None
    yield "12", f"w of frame {FRAME}", pose.weights
    yield "12.6", f"w' of frame {FRAME}", expressions.shown(avatar.expressions, pose.weights)
    yield "12.1", "m", expressions.moved(avatar, pose)
    yield "12.1", "s", expressions.brightened(avatar, pose)
    bent = expressions.vertices(avatar.template.faces, avatar.coarse.mean, expressions.moved(avatar, pose))
    yield "12.3", "vertices that bend", sorted(bent)
    yield "12.3", "g on the mean mesh", [bent[i][1] for i in sorted(bent)]
    yield "12.3", "P on the mean mesh", [bent[i][2] for i in sorted(bent)]
    for number in range(1 + len(avatar.texels.levels)):
        found = splats.decode(avatar, motion.poses(avatar, avatar.clips[0]), FRAME, number)
        yield "12.5", f"T of level {number}", found.texture
        yield "12.4", f"centres of level {number}", found.centres


if __name__ == "__main__":
    sys.stdout.write("".join(f"{line}\n" for line in lines(load(SAMPLE), load(SPOKEN))))
