"""AvatarRenderer in the stand-ins' player loop: program and avatars of its stories, and how one is reported."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp, by_name
from synthetic_avatar import synthetic_avatar, with_surface

from mua.asset import write
from mua.avatar.model import Layer

KERNELS = ROOT / "ComputeShaders"
WIDE = 1500  # a layer that needs more than one frame's chunk
SECOND = 72  # frames of the program's player loop
RATE = 24  # frames a second of the synthetic avatars
TURNED, TRANSLATED = 1e-6, 1e-5  # float32 of a few transforms on top of each other
Reports = dict[str, list[str]]
Story = Callable[..., Reports]


def build_program(csharp: CSharp) -> Path:
    """programs/Component*.cs with the package's runtime and its Timeline track."""
    programs = sorted(PROGRAMS.glob("Component*.cs"))
    return csharp.runtime(
        RUNTIME / "Timeline", PROGRAMS / "shared", *programs, name="ComponentProgram", references=[csharp.timeline()]
    )


def write_avatars(folder: Path) -> None:
    """Two avatars, one that takes several frames to upload, and one that is damaged."""
    avatar = with_surface(synthetic_avatar(1))
    write(folder / "first.muaavatar", avatar, storage="f16")
    write(folder / "second.muaavatar", synthetic_avatar(2), storage="i8")
    first, *_, last = avatar.coarse.mlp
    outputs, inputs = len(last.bias), first.weight.shape[1]
    zeros = [np.zeros(shape, np.float32) for shape in ((WIDE, inputs), (WIDE, WIDE), (outputs, WIDE))]
    mlp = tuple(Layer(weight, np.zeros(len(weight), np.float32)) for weight in zeros)
    write(folder / "wide.muaavatar", replace(avatar, coarse=replace(avatar.coarse, mlp=mlp)), storage="f32")
    content = bytearray((folder / "first.muaavatar").read_bytes())
    content[len(content) // 2] ^= 0xFF
    (folder / "damaged.muaavatar").write_bytes(content)


def tell(csharp: CSharp, program: Path, folder: Path, name: str, *files: str) -> Reports:
    """What a story says, by key; all that it made is given back at its end."""
    printed = csharp.run(program, KERNELS, name, *(folder / f"{file}.muaavatar" for file in files))
    reported = {"log": [], **by_name(printed)}
    assert (reported["alive"], reported["requests"], reported["world"]) == (["0"], ["0"], ["0"]), reported
    return reported


def counts(seed: int) -> list[int]:
    """Splats of the levels of a synthetic avatar."""
    return [len(synthetic_avatar(seed).at_level(level).rig.texels.texels) for level in range(3)]
