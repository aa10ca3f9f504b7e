"""Where the shaders are, and which files a shader includes."""

import os
import re
from pathlib import Path

from mua.errors import InputError

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
PRAGMA = re.compile(r"^\s*#pragma\s+kernel\s+(\w+)[ \t]*(.*)$", re.MULTILINE)


def directory() -> Path:
    """The directory of the compute shaders: $MUA_SHADERS, else as packed in the wheel, else of the checkout."""
    if named := os.environ.get("MUA_SHADERS"):
        return Path(named)
    package = Path(__file__).resolve().parents[1]
    packed = package / "shaders"
    return packed if packed.is_dir() else package.parents[1] / "ComputeShaders"


def find(file: str | Path) -> Path:
    """The path of a shader named relative to `directory()` or absolutely."""
    path = directory() / file
    if not path.is_file():
        raise InputError(f"{path}: there is no such shader")
    return path


def read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: a shader is UTF-8 text, but byte {error.start} is not") from error


def with_includes(path: Path) -> dict[Path, str]:
    """The text of a shader and of all that it includes, at any depth; the compiler reports missing files."""
    found: dict[Path, str] = {}
    waiting = [path]
    while waiting:
        file = waiting.pop()
        if file in found or not file.is_file():
            continue
        found[file] = read(file)
        for name in INCLUDE.findall(found[file]):
            beside = file.parent / name
            waiting.append(beside if beside.is_file() else directory() / name)
    return found


def kernels(text: str) -> dict[str, tuple[str, ...]]:
    """The entry points that a compute shader declares by `#pragma kernel`, each with its defines."""
    return {name: tuple(defines.split("//")[0].split()) for name, defines in PRAGMA.findall(text)}
