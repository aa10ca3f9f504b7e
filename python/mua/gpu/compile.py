"""HLSL to SPIR-V: what comes compiled with the package, else by a compiler of this machine.

What is compiled here is kept on disk by the content that it came from.
"""

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
from mua.gpu import compiled, compilers, sources

ERROR = re.compile(r"\berror(?::|\[| X)", re.IGNORECASE)


def spirv(path: Path, entry: str, *, stage: str = "comp", compiler: str = "glslang") -> bytes:
    """The SPIR-V of one entry point of a shader: as it comes with the package, from the cache, or compiled.

    Raises InputError if a compiler is needed and absent, the file declares no such kernel, or it does not compile.
    """
    texts, options = made_from(path, entry, stage)
    if compiler == compiled.COMPILER and (code := compiled.find(path, texts.values(), options)) is not None:
        return code
    try:
        chosen = find_compiler(compiler)
    except InputError as error:
        raise InputError(f"{path}: {entry} as it stands here does not come compiled, and {error}") from error
    key = _key(chosen, texts, options)
    cached = cache_directory() / f"{key}.spv"
    if cached.is_file():
        return cached.read_bytes()
    code = compile_entry(chosen, path, options)
    with suppress(InputError):  # a home that cannot be written to costs time, not the picture
        files.write_bytes(cached, code)
    return code


def made_from(path: Path, entry: str, stage: str) -> tuple[dict[Path, str], tuple[str, ...]]:
    """The texts of a shader and its includes, and (entry, stage, *defines).

    Raises InputError if the file declares no such kernel.
    """
    texts = sources.with_includes(path)
    if stage != "comp":
        return texts, (entry, stage)
    declared = sources.kernels(texts.get(path, ""))
    if entry not in declared:
        raise InputError(f"{path}: has no kernel {entry}; it has {', '.join(declared) or 'none'}")
    return texts, (entry, stage, *declared[entry])


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


def compile_entry(
    compiler: compilers.Compiler,
    path: Path,
    options: tuple[str, ...],  # (entry, stage, *defines)
) -> bytes:
    """Compile one entry point, whatever is kept of it elsewhere; raises InputError where it does not compile."""
    entry, stage, *defines = options
    with tempfile.TemporaryDirectory() as scratch:
        output = Path(scratch) / "code.spv"
        done = run_compiler(compiler, path, entry, stage, output, tuple(defines))
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
