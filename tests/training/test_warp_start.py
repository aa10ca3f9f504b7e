"""Starting Warp hides its complaint about a missing GPU, and nothing else."""

import subprocess
import sys

CODE = """
import os
from mua.training.warp_start import NO_GPU, _without
with _without(NO_GPU):
    os.write(2, b"Warp CUDA warning: " + NO_GPU + b". More.\\nanother matter\\n")
os.write(2, b"and after it\\n")
"""


def stderr(code: str) -> str:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stderr


def test_leaves_out_the_line_about_the_gpu_alone() -> None:
    assert stderr(CODE) == "another matter\nand after it\n"


def test_the_teacher_starts_without_a_word() -> None:
    assert stderr("import mua.teachers.simulated.simulation, warp; warp.zeros(1, device='cpu')") == ""
