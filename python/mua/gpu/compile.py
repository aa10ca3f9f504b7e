"""HLSL to SPIR-V by a compiler of this machine; compiled code is kept on disk by the content that it came from."""

import hashlib
import os
import re
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

from mua import files
from mua.errors import InputError
from mua.gpu import compilers, sources

ERROR = re.compile(r"\berror(?::|\[| X)", re.IGNORECASE)


def spirv(path: Path, entry: str, *, stage: str = "comp", compiler: str = "glslang") -> bytes:
    """The SPIR-V of one entry point of a shader, from the cache if nothing that it depends on changed.

    Raises InputError if the compiler is absent, the file declares no such kernel, or the code does not compile.
    """
    chosen = find_compiler(compiler)
    texts = sources.with_includes(path)
    defines: tuple[str, ...] = ()
    if stage == "comp":
        declared = sources.kernels(texts.get(path, ""))
        if entry not in declared:
            raise InputError(f"{path}: has no kernel {entry}; it has {', '.join(declared) or 'none'}")
        defines = declared[entry]
    key = _key(chosen, texts, (entry, stage, *defines))
    cached = cache_directory() / f"{key}.spv"
    if cached.is_file():
        return cached.read_bytes()
    code = _compiled(chosen, path, entry, stage, defines)
    with suppress(InputError):  # a home that cannot be written to costs time, not the picture
        files.write_bytes(cached, code)
    return code


def find_compiler(name: str) -> compilers.Compiler:
    """The compiler with this name; InputError that says what brings it if it is not on this machine."""
    found = compilers.find(name)
    if found is None:
        raise InputError(f"the shader compiler {name} is not on this machine; it comes with {compilers.INSTALL[name]}")
    return found


def cache_directory() -> Path:
    """Where compiled shaders are kept: below the user's cache directory."""
    if named := os.environ.get("XDG_CACHE_HOME"):
        base = Path(named)
    elif sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    else:
        base = Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    return base / "mua" / "shaders"


def _key(compiler: compilers.Compiler, texts: dict[Path, str], options: tuple[str, ...]) -> str:
    command = compiler.command(Path("file"), "entry", options[1], Path("output"))[1:]
    digest = hashlib.sha256()
    made = compiler.name, compiler.version, compiler.prelude, compiler.finish.__name__
    for part in (*made, *command, *options, *texts.values()):
        digest.update(len(part).to_bytes(8, "little") + part.encode())
    return digest.hexdigest()


def _compiled(compiler: compilers.Compiler, path: Path, entry: str, stage: str, defines: tuple[str, ...]) -> bytes:
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "code.spv"
        done = run_compiler(compiler, path, entry, stage, output, defines)
        if done.returncode or not output.is_file():
            raise InputError(f"{path}: {entry} does not compile: {_first_error(done.stdout + done.stderr)}")
        return compiler.finish(output.read_bytes())


def run_compiler(
    compiler: compilers.Compiler, path: Path, entry: str, stage: str, output: Path, defines: tuple[str, ...]
) -> subprocess.CompletedProcess[str]:
    """Compile one entry point of a file into `output`, beside which a prelude may be written."""
    if compiler.prelude:
        include = f'#include "{path.resolve().as_posix()}"\n'
        path = output.with_suffix(".hlsl")
        path.write_text(compiler.prelude + include)
    command = compiler.command(path.resolve(), entry, stage, output)
    command += [f"-I{sources.directory().resolve()}", *(f"-D{define}" for define in defines)]
    return subprocess.run(command, cwd=path.parent, capture_output=True, text=True, check=False)


def _first_error(printed: str) -> str:
    lines = [line.strip() for line in printed.splitlines() if line.strip()]
    return next(filter(ERROR.search, lines), lines[-1] if lines else "the compiler said nothing")
