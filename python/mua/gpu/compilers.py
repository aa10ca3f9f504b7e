"""The HLSL compilers that the runner can use, found on this machine."""

import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

FRAGMENT_GROUP = 1  # descriptor set of what a fragment entry reads; all other stages read from set 0


@dataclass(frozen=True)
class Compiler:
    """One HLSL compiler; `command` is called with (file, entry, stage, output) and lacks -I and -D, which are alike."""

    name: str
    executable: str
    version: str
    command: Callable[[Path, str, str, Path], list[str]]


def glslang(executable: str) -> Compiler:
    def command(path: Path, entry: str, stage: str, output: Path) -> list[str]:
        # --amb numbers the bindings; each stage starts from 0, so the fragment's go to a set of their own
        group = ["--resource-set-binding", "frag", str(FRAGMENT_GROUP)] if stage == "frag" else []
        options = ["-D", "-V", "--target-env", "vulkan1.1", "-S", stage, "--amb", *group]
        return [executable, *options, "-e", entry, "--source-entrypoint", entry, "-o", str(output), str(path)]

    return Compiler("glslang", executable, _version(executable), command)


@cache
def find() -> tuple[Compiler, ...]:
    """The compilers on this machine's PATH."""
    executable = shutil.which("glslangValidator") or shutil.which("glslang")
    return (glslang(executable),) if executable else ()


def _version(executable: str) -> str:
    printed = subprocess.run([executable, "--version"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"\d+:?[\d.]+\d", printed)
    return found.group() if found else printed.strip()
