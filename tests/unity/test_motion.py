"""Descriptor, forward kinematics, skinning and clip sampling in C# give the numbers of the Python reference."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, RUNTIME, CSharp
from synthetic_avatar import synthetic_avatar, with_expressions

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.avatar.model import Layer, Mlp
from mua.pose.clip import Clip
from mua.pose.components import read_components
from mua.pose.descriptor import describe
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton

BOUND = 2048 * np.finfo(float).eps  # some hundred operations, each rounded once, on numbers up to ten
ROUNDING = float(np.finfo(np.float32).eps)  # what the kernels read is rounded to float32 in the end
PLACE = rotation.dual_from_rigid(np.array([0.8, 0, 0.6, 0]), np.array([1, -2, 0.5]))
COMPONENTS = 9
SECONDS = (0.0, 0.04, 0.2, 0.5, 1.0, 12.345, 1e6, -0.01, -3.3)


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    file = csharp.build([RUNTIME / "Format"], library=True)
    motion = csharp.build([RUNTIME / "Motion"], library=True, references=[file])  # apart, as Unity compiles them
    return csharp.build([PROGRAMS / "MotionProgram.cs"], references=[file, motion])


def avatar_of(
    *,
    remove_heading: bool,
    window: int,
    rate: float,
    clips: Sequence[tuple[float, int]],
    reach: float = 1,
    roam: float = 1,
) -> Avatar:
    """The synthetic avatar on a skeleton whose root joint has a turned parent, with clips of (rate, frames).

    Training showed components up to `reach`; joints roam so many metres.
    """
    avatar = synthetic_avatar()
    rng = np.random.default_rng(window)
    skeleton = replace(
        avatar.rig.skeleton,
        bind_rotations=rotation.normalize(rng.normal(size=(3, 4))),
        bind_translations=rng.normal(size=(3, 3)),
        root=1,
    )
    encoding = PoseEncoding(joints=(0, 2), rate=rate, window=window, remove_heading=remove_heading, translated=(2,))
    return replace(
        avatar,
        rig=replace(avatar.rig, skeleton=skeleton),
        encoding=encoding,
        components=random_components(rng, encoding.width, reach),
        coarse=replace(avatar.coarse, mlp=widened(avatar.coarse.mlp, COMPONENTS)),
        geometry=replace(avatar.geometry, mlp=widened(avatar.geometry.mlp, COMPONENTS)),
        appearance=replace(avatar.appearance, mlp=widened(avatar.appearance.mlp, COMPONENTS)),
        clips=tuple(random_clip(skeleton, rng, r, frames, roam) for r, frames in clips),
    )


def random_components(rng: np.random.Generator, width: int, reach: float) -> Components:
    """Some of which training showed but one value, some that may not go beyond it, and one that reads nothing."""
    directions = rng.normal(size=(COMPONENTS, width)) / np.sqrt(width)
    directions[2] = 0
    ranges = reach * np.sort(rng.uniform(-1, 1, (2, COMPONENTS)), axis=0)
    ranges[:, :3] = ranges[:, 3:6].mean(axis=0)
    margins = rng.uniform(0, 0.5, COMPONENTS)
    margins[::4] = 0
    normalization = Normalization(rng.normal(size=width), rng.uniform(0.5, 2, width))
    return Components(normalization, directions, ranges, margins)


def widened(mlp: Mlp, width: int) -> Mlp:
    return (Layer(np.zeros((len(mlp[0].bias), width), np.float32), mlp[0].bias), *mlp[1:])


def random_clip(skeleton: Skeleton, rng: np.random.Generator, rate: float, frames: int, roam: float) -> Clip:
    rotations = rotation.normalize(rng.normal(size=(frames, len(skeleton.names), 4)))
    if frames > 2:
        rotations[2] = rotations[1]  # a slerp between equals
        rotations[1] *= -1
    return Clip(f"{rate} Hz", rate, rotations, roam * rng.normal(size=(frames, len(skeleton.names), 3)))


def upside_down() -> Avatar:
    """A root that is turned over, which leaves no heading, or next to none: what is smaller than rounding is none."""
    avatar = avatar_of(remove_heading=True, window=2, rate=24, clips=[(24, 5)])
    turns = [[0, 1, 0, 0], [1e-6, 1, 0, -2e-6], [0, 0, 1, 0], [1e-10, 1, 0, 1e-10], [-3e-7, 0.6, 1e-6, 0.8]]
    clip = avatar.clips[0]
    clip.rotations[:, 0] = [1, 0, 0, 0]
    clip.rotations[:, 1] = rotation.normalize(np.array(turns))
    skeleton = replace(avatar.rig.skeleton, bind_rotations=np.tile([1.0, 0, 0, 0], (3, 1)))
    return replace(avatar, rig=replace(avatar.rig, skeleton=skeleton))


CASES = {
    "own rate": (avatar_of(remove_heading=True, window=3, rate=24, clips=[(24, 5), (24, 1)]), "f32"),
    "other rates": (avatar_of(remove_heading=True, window=3, rate=24, clips=[(30, 11), (23.976, 9), (120, 41)]), "f32"),
    "ends that rounding moves": (avatar_of(remove_heading=True, window=3, rate=100, clips=[(25, 30), (50, 59)]), "f32"),
    "turned over": (upside_down(), "f32"),
    "halves": (avatar_of(remove_heading=True, window=2, rate=24, clips=[(24, 6), (60, 13)]), "f16"),
    "no heading": (avatar_of(remove_heading=False, window=3, rate=30, clips=[(24, 7)]), "f32"),
    "one frame": (avatar_of(remove_heading=True, window=1, rate=30, clips=[(30, 4)]), "f32"),
    "within training": (avatar_of(remove_heading=True, window=3, rate=24, clips=[(24, 9)], reach=1e3), "f32"),
    "far outside of training": (
        avatar_of(remove_heading=True, window=3, rate=24, clips=[(24, 60)], reach=0.1, roam=50),
        "f32",
    ),
    "a face": (
        with_expressions(avatar_of(remove_heading=True, window=2, rate=24, clips=[(24, 5), (30, 11), (7, 4)])),
        "f16",
    ),
    "longest window": (avatar_of(remove_heading=True, window=16, rate=24, clips=[(24, 20)]), "f32"),
}


@pytest.mark.parametrize(("avatar", "storage"), CASES.values(), ids=CASES)
def test_numbers_are_those_of_the_reference(
    csharp: CSharp, program: Path, tmp_path: Path, avatar: Avatar, storage: Storage
) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, avatar, storage=storage)
    avatar = read(path)
    found = play(csharp, program, path)
    clips = [resample(clip, avatar.encoding.rate) for clip in avatar.clips]
    assert found.pop("frames") == [len(clip) for clip in clips]
    assert found.pop("at") == [int(s * clip.rate % len(clip)) for clip in clips for s in SECONDS]
    assert found.pop("allocated") == [0] * len(clips)
    expected = [expected_numbers(avatar, clip) for clip in clips]
    assert found.keys() == expected[0].keys()
    for name, values in found.items():
        wanted = np.concatenate([numbers[name] for numbers in expected]).reshape(len(values), -1)
        rounded = ROUNDING if np.asarray(values).dtype == np.float32 else 0
        np.testing.assert_allclose(values, wanted, rtol=rounded, atol=BOUND, err_msg=name)


def test_a_time_that_rounding_places_before_its_frame_is_within_it(
    csharp: CSharp, program: Path, tmp_path: Path
) -> None:
    path, frames = tmp_path / "a.muaavatar", range(300)
    write(path, CASES["no heading"][0])
    rate, count = 30, 8
    assert any(int(frame / rate * rate) != frame for frame in frames)
    assert play(csharp, program, path, [frame / rate for frame in frames])["at"] == [n % count for n in frames]


def play(csharp: CSharp, program: Path, path: Path, seconds: Sequence[float] = SECONDS) -> dict[str, list]:
    """What the program prints, by name: integers, or arrays."""
    found: dict[str, list] = defaultdict(list)
    for line in csharp.run(program, path, *seconds).splitlines():
        name, value = line.split(" ")
        if name in ("frames", "at", "allocated"):
            found[name].append(int(value))
        else:
            kind = "<f4" if name in ("components", "expressions", "skinning") else "<f8"
            found[name].append(np.frombuffer(bytes.fromhex(value), kind))
    return found


def expected_numbers(avatar: Avatar, clip: Clip) -> dict[str, Array]:
    """[F, ...] of every frame of a clip."""
    skeleton, encoding = avatar.rig.skeleton, avatar.encoding
    windows = np.array([encoding.frames(frame) for frame in range(len(clip))])
    turned, placed = skeleton.world(clip.rotations, clip.translations)
    descriptors = describe(skeleton, encoding, clip.rotations, clip.translations)
    components, outside = read_components(avatar.components, descriptors)
    return {
        "expressions": np.zeros((len(clip), 0)) if clip.expressions is None else clip.expressions,
        "rotations": clip.rotations[windows],
        "translations": clip.translations[windows],
        "components": components,
        "outside": outside,
        "turned": turned,
        "placed": placed,
        "skinning": rotation.dual_multiply(PLACE, skeleton.skinning(clip.rotations, clip.translations)),
        "root": placed[:, skeleton.root],
    }
