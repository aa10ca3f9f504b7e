"""The HLSL compilers of this machine: those whose SPIR-V the runner takes, and FXC, which Unity compiles with."""

import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import slang_output

from mua.errors import InputError
from mua.gpu import compile, glslang

SLANG_STAGES = {"comp": "compute", "vert": "vertex", "frag": "fragment"}
PROFILES = {"comp": "cs", "vert": "vs", "frag": "ps"}
UNKNOWN_PRAGMA = "15601"  # slangc's warning about `#pragma kernel`
INSTALL = {
    "glslang": glslang.INSTALL,
    "slang": "slangc: PyPI package slangtorch, or the Vulkan SDK",
    "dxc": "dxc: the Vulkan SDK, or a command in $MUA_DXC",
    "fxc": "fxc: the Windows SDK, or a command in $MUA_FXC",
}


@dataclass(frozen=True)
class Compiler:
    """One HLSL compiler.

    `command` is called with (file, entry, stage, output), runs in the file's directory, and lacks -I and -D, which are
    alike. A `prelude` is to stand before the file's own text; `finish` is for the SPIR-V that comes out.
    """

    name: str
    version: str
    command: Callable[[Path, str, str, Path], list[str]]
    prelude: str = ""
    finish: Callable[[bytes], bytes] = bytes


@cache
def find(name: str) -> Compiler | None:
    """The compiler with this name, None if it is not on this machine; KeyError if there is none like it."""
    return FINDERS[name]()


def run_compiler(
    compiler: Compiler, path: Path, entry: str, stage: str, output: Path, defines: tuple[str, ...]
) -> subprocess.CompletedProcess[str]:
    """Compile one entry point of a file into `output`, beside which a prelude may be written."""
    if compiler.prelude:
        include = f'#include "{path.resolve().as_posix()}"\n'
        path = output.with_suffix(".hlsl")
        path.write_text(compiler.prelude + include)
    command = compiler.command(path.resolve(), entry, stage, output) + glslang.shared_options(list(defines))
    return subprocess.run(command, cwd=path.parent, capture_output=True, text=True, check=False)


def spirv(compiler: Compiler, path: Path, entry: str, stage: str = "comp") -> bytes:
    """The SPIR-V of one entry point; raises InputError where it does not compile."""
    _, (_, _, *defines) = compile.made_from(path, entry, stage)
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "code.spv"
        done = run_compiler(compiler, path, entry, stage, output, tuple(defines))
        return compiler.finish(glslang.result(path, entry, output, done))


def _glslang() -> Compiler | None:
    program = glslang.find()
    if program is None:
        return None
    return Compiler("glslang", _version([program, "--version"]), partial(glslang.command, program))


def _fxc() -> Compiler | None:
    """FXC, which makes no SPIR-V: $MUA_FXC or `fxc` on the PATH."""
    program = _program("MUA_FXC", "fxc")
    if program is None:
        return None

    def command(path: Path, entry: str, stage: str, output: Path) -> list[str]:
        # by name alone: to FXC a path that begins with a slash is an option
        return [*program, "-nologo", "-T", f"{PROFILES[stage]}_5_0", "-E", entry, "-Fo", str(output), path.name]

    return Compiler("fxc", "", command)


def run_slangc(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """slangc in a folder; raises InputError where it is not on this machine."""
    program = _slangc()
    if program is None:
        raise InputError(f"the shader compiler slangc is not on this machine; {INSTALL['slang']}")
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, check=False)


def _slangc() -> str | None:
    return shutil.which("slangc") or shutil.which("slangc", path=_wheel("slangtorch", "bin"))


def _slang() -> Compiler | None:
    program = _slangc()
    if program is None:
        return None

    def command(path: Path, entry: str, stage: str, output: Path) -> list[str]:
        # anything but -O0 asks for spirv-opt, which the wheel lacks
        options = ["-target", "spirv", "-O0", "-fvk-use-entrypoint-name", "-warnings-disable", UNKNOWN_PRAGMA]
        names = ["-stage", SLANG_STAGES[stage], "-entry", entry, "-o", str(output)]
        return [program, "-lang", "hlsl", str(path), *options, *names]

    version = _version([program, "-v"])
    return Compiler("slang", version, command, slang_output.PRELUDE, slang_output.without_lone_switches)


def _dxc() -> Compiler | None:
    """$MUA_DXC or `dxc` on the PATH."""
    program = _program("MUA_DXC", "dxc")
    if program is None:
        return None

    def command(path: Path, entry: str, stage: str, output: Path) -> list[str]:
        options = ["-spirv", "-fspv-target-env=vulkan1.1", "-Wall", "-T", f"{PROFILES[stage]}_6_0"]
        return [*program, *options, "-E", entry, "-Fo", str(output), str(path)]

    return Compiler("dxc", _version([*program, "--version"]), command)


SPIRV: dict[str, Callable[[], Compiler | None]] = {"glslang": _glslang, "slang": _slang, "dxc": _dxc}
FINDERS = {**SPIRV, "fxc": _fxc}


def _program(variable: str, name: str) -> list[str] | None:
    """The command in an environment variable, else the program on the PATH."""
    if named := os.environ.get(variable):
        return shlex.split(named, posix=os.name == "posix")
    found = shutil.which(name)
    return [found] if found else None


def _wheel(package: str, folder: str) -> str | None:
    """A folder of an installed package, found without importing it."""
    found = importlib.util.find_spec(package)
    path = Path(found.origin).parent / folder if found and found.origin else None
    return str(path) if path and path.is_dir() else None


def _version(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    printed = done.stdout + done.stderr
    found = re.search(r"\d+:?[\d.]+\d", printed)
    return found.group() if found else printed.strip()
