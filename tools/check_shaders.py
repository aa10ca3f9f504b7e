"""Compile every shader with every HLSL compiler of this machine and hold the kernels to their rules.

Prints a table of entry points by compilers, then what is wrong; any warning counts. Exits 1 if there is anything.
"""

import re
import sys
import tempfile
from pathlib import Path

import checkout  # noqa: F401
import shader_compilers
import shader_rules
import shader_source
from rich.box import SIMPLE
from rich.console import Console
from rich.progress import track
from rich.table import Table
from shader_compilers import Compiler
from shader_source import Shader

from mua.gpu import sources

ROOT = Path(__file__).resolve().parents[1]
KERNELS = ROOT / "ComputeShaders"
DRAWS = ROOT / "python" / "mua" / "player" / "shaders"
STAGES = {"Vert": "vert", "Frag": "frag"}
DRAW_ENTRY = re.compile(r"\w+(Vert|Frag)")
MESSAGE = re.compile(r"\b(?:warning|error)(?::|\[| X)", re.IGNORECASE)
UNKNOWN_PRAGMA = re.compile(r"X3568|unknown pragma")  # `#pragma kernel` is Unity's


def kernel_shaders() -> list[Shader]:
    """The compute shaders, by name."""
    return [shader_source.read(path, KERNELS) for path in sorted(KERNELS.glob("*.compute"))]


def draw_shaders() -> list[tuple[Shader, list[str]]]:
    """The desktop player's shaders that draw, each with its vertex and fragment entry points."""
    shaders = [shader_source.read(path, KERNELS) for path in sorted(DRAWS.glob("*.hlsl"))]
    return [(shader, [name for name in shader.functions if DRAW_ENTRY.fullmatch(name)]) for shader in shaders]


def rule_faults() -> list[str]:
    """Every rule that the shaders of this checkout break."""
    kernels, draws = kernel_shaders(), draw_shaders()
    faults = [fault for shader in kernels for fault in shader_rules.kernel_faults(shader)]
    for path in [*sorted(KERNELS.glob("*.hlsl")), *(shader.path for shader, _ in draws)]:
        faults += shader_rules.file_faults(path)
    return faults + shader_rules.package_faults(kernels, draws, ROOT)


def entry_points() -> list[tuple[Path, str, str]]:
    """File, entry point and stage of all that is compiled for a device."""
    entries = [(shader.path, entry, "comp") for shader in kernel_shaders() for entry in shader.kernels]
    for shader, names in draw_shaders():
        entries += [(shader.path, name, STAGES[name[-4:]]) for name in names]
    return entries


def messages(compiler: Compiler, path: Path, entry: str, stage: str) -> list[str]:
    """The warnings and errors of compiling one entry point; none if it is accepted without one."""
    defines = sources.kernels(sources.read(path)).get(entry, ())
    with tempfile.TemporaryDirectory() as scratch:
        done = shader_compilers.run_compiler(compiler, path, entry, stage, Path(scratch) / "code", defines)
    lines = [line.strip() for line in (done.stdout + done.stderr).splitlines()]
    found = [line for line in lines if MESSAGE.search(line) and not UNKNOWN_PRAGMA.search(line)]
    return found if found or done.returncode == 0 else [f"status {done.returncode}", *lines[:1]]


def compile_all(found: list[Compiler], console: Console) -> dict[tuple[str, str, str], list[str]]:
    """The messages of each compiler by file, entry point and compiler."""
    return {
        (path.name, entry, compiler.name): messages(compiler, path, entry, stage)
        for path, entry, stage in track(entry_points(), "compiling", console=console, transient=True)
        for compiler in found
    }


def table(results: dict[tuple[str, str, str], list[str]], found: list[Compiler]) -> Table:
    shown = Table("file", "entry point", *(f"{compiler.name}\n{compiler.version}" for compiler in found), box=SIMPLE)
    for file, entry in dict.fromkeys((file, entry) for file, entry, _ in results):
        messages = [results[file, entry, compiler.name] for compiler in found]
        shown.add_row(file, entry, *("ok" if not lines else f"[red]{len(lines)} messages" for lines in messages))
    return shown


def main() -> None:
    console = Console()
    candidates = {name: shader_compilers.find(name) for name in shader_compilers.FINDERS}
    found = [compiler for compiler in candidates.values() if compiler is not None]
    results = compile_all(found, console)
    console.print(table(results, found))
    for name, compiler in candidates.items():
        if compiler is None:
            console.print(
                f"{name} is not on this machine; it comes with {shader_compilers.INSTALL[name]}", highlight=False
            )
    faults = [
        f"{file}: {entry}: {name}: {line}" for (file, entry, name), lines in results.items() for line in lines
    ] + rule_faults()
    for fault in faults:
        console.print(fault, style="red", highlight=False, markup=False, soft_wrap=True)
    sys.exit(1 if faults or not found else 0)


if __name__ == "__main__":
    main()
