"""Both eyes of a recorded draw of splats, drawn into the layers of one target by one pass.

By slangc, which knows a view's index, with the stand-in of Unity's include; or as Unity itself compiles the shader.
"""

import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import shader_compilers
from drawn import rows
from engine_shaders import GAMMA, STEREO, VULKAN, Engine
from layers import Bound, LayeredDevice, Stage
from replay import Drawn, value
from shader_programs import VARIANTS, Program

from mua.arrays import Array
from mua.gpu import constants, glslang
from mua.gpu.reflect import Constant, reflect

FLOATS = tuple(f"half{count} float{count}" for count in ("", 2, 3, 4))  # slangc's halves have 16 bits
STAND_IN_WORDS = ("UNITY_COLORSPACE_GAMMA", "VIEW SV_ViewID", *FLOATS)
SPLAT_WORDS = 8
LEADING = 1000  # splats, more than the device takes at a time
THIN = 0x2E662E66  # two halves of 0.1 pixels
BLOCK = re.compile(r"layout\(set = (\d+), binding = (\d+), std\d+\)[ \w]*\b(uniform|buffer) (\w+) \{")
MEMBER = re.compile(r"^(?:hlslcc_mtx4x4)?(\w+): offset (\d+),.* index (\d+), binding -1", re.MULTILINE)
SIZE = re.compile(r"^(\w+): offset -1, .* size (\d+), index (\d+), binding \d+", re.MULTILINE)

Compiled = tuple[tuple[Stage, Stage], list[Bound]]


def values(drawn: Drawn) -> dict[str, Any]:
    """What the package and the engine set for the vertices."""
    matrices = Constant("view_projection", 0, "float", (2, 4, 4), (64, 4, 16), used=True)
    screen = Constant("screen", 0, "float", (4,), (4,), used=True)
    counts = (Constant(name, 0, "uint", (), (), used=True) for name in ("eye_count", "corners"))
    set_by_package = {c.name: value("draw", c, *drawn.constants[c.name]) for c in (matrices, screen, *counts)}
    return {**set_by_package, "unity_StereoMatrixP": rows(turned=False)["unity_StereoMatrixP"]}


def by_stand_in(program: Program, stereo: str, drawn: Drawn, folder: Path) -> Compiled:
    """Compiled with the macros of `stand_ins/shader`."""
    path, slang = program.write(folder, *VARIANTS[stereo], *STAND_IN_WORDS), shader_compilers.find("slang")
    assert slang is not None, shader_compilers.INSTALL["slang"]
    entries = ((program.vertex, "vert"), (program.fragment, "frag"))
    stages = tuple(Stage(shader_compilers.spirv(slang, path, entry, stage), entry) for entry, stage in entries)
    interface = reflect(stages[0].code)
    assert interface.constants_binding is not None
    named = {constant.name: constant for constant in interface.constants}
    block = constants.pack(str(program), named, constants.block_size(interface.constants), values(drawn))
    bound = [Bound(0, slot.binding, False, drawn.buffers[slot.name].tobytes()) for slot in interface.buffers]
    return (stages[0], stages[1]), [*bound, Bound(0, interface.constants_binding, True, block)]


def by_engine(engine: Engine, program: Program, stereo: str, drawn: Drawn, folder: Path) -> Compiled:
    """Compiled as Unity does it."""
    path, defines = engine.write(program, folder), (*VULKAN, *STEREO[stereo], *GAMMA)
    vertex = engine.glsl(path, program.vertex, "vert", defines)
    code, reflected = _assembled(vertex, "vert", folder)
    fragment, _ = _assembled(engine.glsl(path, program.fragment, "frag", defines), "frag", folder)
    return (Stage(code, "main"), Stage(fragment, "main")), _bound(vertex, reflected, drawn)


def _assembled(glsl: str, stage: str, folder: Path) -> tuple[bytes, str]:
    """SPIR-V and what glslang tells of its blocks."""
    source, output = folder / f"translated.{stage}", folder / f"translated.{stage}.spv"
    source.write_text(glsl)
    program = glslang.find()
    assert program is not None, glslang.INSTALL
    options = ["-V", "--target-env", "vulkan1.1", "-l", "-q", str(source), "-o", str(output)]
    done = subprocess.run([program, *options], capture_output=True, text=True, check=True)
    return output.read_bytes(), done.stdout


def _bound(glsl: str, reflected: str, drawn: Drawn) -> list[Bound]:
    blocks = {name: (int(index), int(size)) for name, size, index in SIZE.findall(reflected)}
    offsets = {(int(index), name): int(offset) for name, offset, index in MEMBER.findall(reflected)}
    found = []
    for group, binding, kind, name in BLOCK.findall(glsl):
        if name not in blocks:
            continue  # nothing reads it
        if kind == "buffer":
            content = drawn.buffers[name].tobytes()
        else:
            index, size = blocks[name]
            content = _block(size, {member: at for (of, member), at in offsets.items() if of == index}, drawn)
        found.append(Bound(int(group), int(binding), kind == "uniform", content))
    return found


def _block(size: int, offsets: dict[str, int], drawn: Drawn) -> bytes:
    """A constant buffer; matrices lie column by column."""
    block = bytearray(-(-size // 16) * 16)
    for name, given in values(drawn).items():
        if name in offsets:
            content = np.swapaxes(given, -1, -2) if np.ndim(given) > 1 else np.asarray(given)
            data = content.astype(np.uint32 if content.dtype.kind in "iu" else np.float32).tobytes()
            block[offsets[name] : offsets[name] + len(data)] = data
    return bytes(block)


def led(drawn: Drawn) -> Drawn:
    """The same draw after clear splats amid the others.

    Mesa 22 notes a new view with the first triangles that it need not clip. Those that it clips before go into the
    layer of the view before.
    """
    splats = drawn.buffers["splats"].reshape(-1, SPLAT_WORDS)
    clear = np.zeros(SPLAT_WORDS, np.uint32)
    clear[:3] = np.median(splats[:, :3].view(np.float32), axis=0).astype(np.float32).view(np.uint32)
    clear[5:] = THIN
    order = np.concatenate([np.full(LEADING, len(splats), np.uint32), drawn.buffers["order"]])
    changed = {"splats": np.append(splats, clear), "order": order}
    if "visible_arguments" in drawn.buffers:
        changed["visible_arguments"] = drawn.buffers["visible_arguments"].copy()
        changed["visible_arguments"][0] += drawn.corners * LEADING
    vertices, instances = drawn.arguments
    return replace(
        drawn, buffers={**drawn.buffers, **changed}, arguments=(vertices + drawn.corners * LEADING, instances)
    )


def picture(device: LayeredDevice, compiled: Compiled, drawn: Drawn, stereo: str, screen: tuple[int, int]) -> Array:
    """[2, H, W, 4] of both eyes. Where the eyes are instances, the engine doubles those of direct draws alone."""
    stages, bound = compiled
    multiview = stereo == "multiview"
    vertices, instances = drawn.arguments
    if not (multiview or drawn.indirect):
        instances *= 2
    return device.draw(stages, bound, screen=screen, vertices=vertices, instances=instances, multiview=multiview)
