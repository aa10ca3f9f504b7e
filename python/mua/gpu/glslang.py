"""The compiler of shaders that were changed since they were compiled: glslang's command line."""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from mua.errors import InputError
from mua.gpu import sources

INSTALL = "glslangValidator: Debian package glslang-tools, on Windows and macOS the Vulkan SDK"
ERROR = re.compile(r"\berror(?::|\[| X)", re.IGNORECASE)
FRAGMENT_GROUP = 1  # descriptor set of what a fragment entry reads; all other stages read from set 0


def find() -> str | None:
    """The program on this machine."""
    return shutil.which("glslangValidator") or shutil.which("glslang")


def command(program: str, path: Path, entry: str, stage: str, output: Path) -> list[str]:
    """The command that compiles one entry point into `output`, without includes and defines."""
    # --amb numbers the bindings; each stage starts from 0, so the fragment's go to a set of their own
    group = ["--resource-set-binding", "frag", str(FRAGMENT_GROUP)] if stage == "frag" else []
    options = ["-D", "-V", "--target-env", "vulkan1.1", "-S", stage, "--amb", *group]
    return [program, *options, "-e", entry, "--source-entrypoint", entry, "-o", str(output), str(path)]


def compile(
    path: Path,
    options: tuple[str, ...],  # (entry, stage, *defines)
) -> bytes:
    """The SPIR-V of one entry point; raises InputError where there is no compiler or it refuses."""
    entry, stage, *defines = options
    program = find()
    if program is None:
        raise InputError(
            f"{path}: {entry} as it stands here does not come compiled, and the shader compiler glslang is not on this "
            f"machine; it comes with {INSTALL}"
        )
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "code.spv"
        asked = command(program, path.resolve(), entry, stage, output) + shared_options(defines)
        done = subprocess.run(asked, cwd=path.parent, capture_output=True, text=True, check=False)
        return result(path, entry, output, done)


def shared_options(defines: list[str]) -> list[str]:
    """Includes and defines, in the syntax that all compilers share."""
    return [f"-I{sources.directory().resolve()}", *(f"-D{define}" for define in defines)]


def result(path: Path, entry: str, output: Path, done: subprocess.CompletedProcess[str]) -> bytes:
    """The SPIR-V that a compiler wrote to `output`; raises InputError with its first error where it refused."""
    if done.returncode or not output.is_file():
        lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        message = next(filter(ERROR.search, lines), lines[-1] if lines else "the compiler printed nothing")
        raise InputError(f"{path}: {entry} does not compile: {message}")
    return output.read_bytes()
