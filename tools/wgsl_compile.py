"""One entry point of a shader as WGSL by slangc, and what it binds, by name."""

import json
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import shader_compilers
from shader_compilers import SLANG_STAGES, UNKNOWN_PRAGMA
from wgsl_small import small
from wgsl_source import with_atomics

from mua.gpu import compile, glslang
from mua.gpu.reflect import BufferSlot, Constant, Interface

SCALARS = {"uint32": "uint", "int32": "int", "float32": "float"}
COLUMN, COMPONENT = 16, 4  # bytes between the columns of a matrix, and between the numbers of one
LONE_INTERPOLATION = re.compile(r"@interpolate\(\w+\) +(?!@location)")  # on a struct that is no input: naga refuses it
OPTIONS = ["-target", "wgsl", "-O0", "-matrix-layout-column-major", "-warnings-disable", UNKNOWN_PRAGMA]


@dataclass(frozen=True)
class Shader:
    """One entry point for browsers; a fragment's resources lie in group 1, all others in group 0."""

    entry: str
    stage: str
    code: str
    interface: Interface


def translate(path: Path, entry: str, stage: str) -> Shader:
    """Compile one entry point.

    Raises InputError where slangc is absent or refuses.
    """
    texts, (_, _, *defines) = compile.made_from(path, entry, stage)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for source, text in texts.items():
            (folder / source.name).write_text(with_atomics(text))
        output, reflected = folder / "code.wgsl", folder / "code.json"
        files = ["-o", str(output), "-reflection-json", str(reflected)]
        names = ["-lang", "hlsl", path.name, "-stage", SLANG_STAGES[stage], "-entry", entry]
        given = [*names, *OPTIONS, *files, *(f"-D{define}" for define in defines)]
        done = shader_compilers.run_slangc(given, folder)
        code = glslang.result(path, entry, output, done).decode()
        code = LONE_INTERPOLATION.sub("", code)
        return Shader(entry, stage, small(_grouped(code, stage)), _interface(json.loads(reflected.read_text()), code))


def _grouped(code: str, stage: str) -> str:
    return code.replace("@group(0)", f"@group({glslang.FRAGMENT_GROUP})") if stage == "frag" else code


def _interface(reflected: dict[str, Any], code: str) -> Interface:
    point = reflected["entryPoints"][0]
    used = {bound["name"] for bound in point.get("bindings", []) if bound["binding"].get("used")}
    buffers: list[BufferSlot] = []
    constants: tuple[Constant, ...] = ()
    binding = None
    for parameter in reflected["parameters"]:
        if parameter["name"] not in used:
            continue
        index, kind = parameter["binding"]["index"], parameter["type"]
        if kind["kind"] == "constantBuffer":
            binding, constants = index, _constants(kind["elementType"]["fields"], code)
        else:
            buffers.append(_buffer(parameter["name"], index, kind))
    threads = tuple(point.get("threadGroupSize", (1, 1, 1)))
    return Interface(tuple(sorted(buffers, key=lambda slot: slot.binding)), constants, binding, threads)


def _buffer(name: str, binding: int, kind: dict[str, Any]) -> BufferSlot:
    element = kind["resultType"]
    stride = next(size["value"] for size in element["sizes"] if size["kind"] == "uniform")
    return BufferSlot(name, binding, kind.get("access") != "readWrite", _scalar(element), stride)


def _constants(fields: list[dict[str, Any]], code: str) -> tuple[Constant, ...]:
    found = []
    for field in fields:
        shape, strides = _axes(field["type"])
        used = re.search(rf"\bConstants_0\.{field['name']}_\d", code) is not None
        offset = field["binding"]["offset"]
        found.append(Constant(field["name"], offset, _scalar(field["type"]), tuple(shape), tuple(strides), used))
    return tuple(found)


def _axes(of: dict[str, Any]) -> tuple[list[int], list[int]]:
    """Length and bytes between neighbours of each axis, rows before columns."""
    if of["kind"] == "array":
        shape, strides = _axes(of["elementType"])
        return [of["elementCount"], *shape], [of["uniformStride"], *strides]
    if of["kind"] == "matrix":
        return [of["rowCount"], of["columnCount"]], [COMPONENT, COLUMN]
    if of["kind"] == "vector":
        return [of["elementCount"]], [COMPONENT]
    return [], []


def _scalar(of: dict[str, Any]) -> str:
    """The scalar under an array, a matrix, a vector or an atomic."""
    while "scalarType" not in of:
        of = of["elementType"] if "elementType" in of else of["fields"][0]["type"]
    return SCALARS[of["scalarType"]]
