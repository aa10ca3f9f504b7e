"""Write the table of kernels in ComputeShaders/README.md from the shaders; --check says whether it is up to date."""

from pathlib import Path

import generated
import shader_source
from shader_source import Shader

ROOT = Path(__file__).resolve().parents[1]
KERNELS = ROOT / "ComputeShaders"
README = KERNELS / "README.md"
REFERENCES = ROOT / "python" / "mua" / "kernels" / "README.md"  # lists the kernels in frame order
HEAD = "| entry point | threads |"


def frame_order() -> list[Path]:
    """The compute shaders in the order in which a frame dispatches them."""
    rows = [line for line in REFERENCES.read_text().splitlines() if line.startswith("| `")]
    files = [KERNELS / f"{row.split('`')[1]}.compute" for row in rows]
    return [path for path in files if path.is_file()]


def row(shader: Shader, entry: str) -> str:
    """One row of the table."""
    access = {buffer.name: shader.accesses(entry, buffer.name) for buffer in shader.used(entry)}
    threads = [str(n) for n in shader.threads(entry)]
    while threads[-1] == "1":
        threads.pop()
    stem = shader.path.stem
    cells = [
        f"`{entry}`",
        " x ".join(threads),
        ", ".join(f"`{name}`" for name, (reads, _) in access.items() if reads),
        ", ".join(f"`{name}`" for name, (_, writes) in access.items() if writes),
        f"[{stem}](../python/mua/kernels/{stem}.py)",
        f"[test](../tests/parity/test_{stem}.py)",
    ]
    return f"| {' | '.join(cells)} |"


def generate() -> str:
    """The README with its table anew."""
    lines = README.read_text().splitlines()
    start = next(n for n, line in enumerate(lines) if line.startswith(HEAD)) + 2
    end = next(n for n, line in enumerate(lines[start:], start) if not line.startswith("|"))
    shaders = [shader_source.read(path, KERNELS) for path in frame_order()]
    rows = [row(shader, entry) for shader in shaders for entry in shader.kernels]
    return "\n".join([*lines[:start], *rows, *lines[end:], ""])


if __name__ == "__main__":
    generated.run("gen_kernel_table.py", __doc__, {README: generate()})
