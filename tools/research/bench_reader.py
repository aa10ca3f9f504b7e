"""Print how fast the C# reader of unity-package opens a file under mono, and the memory that it takes.

python tools/research/bench_reader.py [--megabytes 50] [FILE]
"""

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "unity")]

from csharp import PROGRAMS, RUNTIME, CSharp  # noqa: E402 with the tests' modules on the path
from synthetic_avatar import synthetic_avatar  # noqa: E402

from mua.asset.write import write  # noqa: E402

RUNS = 6


def write_large(path: Path, megabytes: float) -> None:
    """The tests' avatar with so many principal components of its mesh that its file is as large as asked."""
    avatar = synthetic_avatar()
    vertices = avatar.coarse.mean.shape
    hidden, last = avatar.coarse.mlp[:-1], avatar.coarse.mlp[-1]
    rank = int(megabytes * 2**20 / 4 / (np.prod(vertices) + last.weight.shape[1] + 1))
    rng = np.random.default_rng(0)
    grown = replace(
        last, weight=rng.normal(size=(rank, last.weight.shape[1])), bias=rng.normal(size=rank).astype(np.float32)
    )
    basis = rng.normal(size=(rank, *vertices))
    write(path, replace(avatar, coarse=replace(avatar.coarse, mlp=(*hidden, grown), basis=basis)), storage="f32")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", nargs="?", type=Path, help="none: random numbers")
    parser.add_argument("--megabytes", type=float, default=50)
    arguments = parser.parse_args()
    csharp = CSharp()
    program = csharp.build([RUNTIME / "Format", PROGRAMS / "FormatProgram.cs"])
    with tempfile.TemporaryDirectory() as folder:
        path = arguments.file or Path(folder) / "large.muaavatar"
        if arguments.file is None:
            write_large(path, arguments.megabytes)
        for line in csharp.run(program, "time", path, RUNS).splitlines():
            size, milliseconds, allocated = line.split()
            print(f"{int(size) / 2**20:.1f} MiB: {milliseconds} ms, {int(allocated) / 2**10:.0f} KiB beside the file")


if __name__ == "__main__":
    main()
