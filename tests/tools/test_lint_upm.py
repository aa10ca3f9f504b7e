"""The linter over whole packages; `make check` runs it over those of this checkout."""

import subprocess
import sys
from pathlib import Path

import gen_meta
import lint_upm
from upm_files import put


def test_finds_nothing_in_packages_that_are_right(packages: list[Path]) -> None:
    assert lint_upm.faults(packages) == []


def test_prints_a_line_for_each_fault(packages: list[Path]) -> None:
    (packages[0] / "README.md").unlink()
    (packages[0] / "Editor.meta").unlink()
    command = [sys.executable, lint_upm.__file__, *map(str, packages)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.splitlines() == [
        "com.mua.test/Editor: no .meta file, so that Unity ignores it in an installed package",
        "com.mua.test/README.md.meta: a .meta file without its asset",
        "com.mua.test/README.md: not there, expected a page beside package.json",
    ]


def test_folded_kernels_keep_their_guids(packages: list[Path]) -> None:
    """tools/pack_upm.py folds them below ComputeShaders, with the .meta files of com.mua.kernels."""
    folder = packages[0] / "ComputeShaders"
    put(folder / "x.compute", "")
    gen_meta.write(packages[0])
    put(folder / "x.compute.meta", gen_meta.meta("com.mua.kernels", "x.compute", folder=False))
    assert lint_upm.faults(packages) == []
    put(folder / "x.compute.meta", gen_meta.meta("com.mua.test", "ComputeShaders/x.compute", folder=False))
    assert [line.split(": guid")[0] for line in lint_upm.faults(packages)] == [
        "com.mua.test/ComputeShaders/x.compute.meta"
    ]
