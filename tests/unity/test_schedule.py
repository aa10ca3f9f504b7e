"""The schedule of decodes and the budget of a frame in C# decide as in Python."""

from pathlib import Path

import pytest
from csharp import PROGRAMS, CSharp
from turn_scenarios import decided, run, timed, wander, written


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.runtime(PROGRAMS / "ScheduleProgram.cs")


@pytest.mark.parametrize("seed", range(12))
def test_avatars_take_turns_as_in_python(csharp: CSharp, program: Path, tmp_path: Path, seed: int) -> None:
    told = list(run(wander(seed, 400)))
    (tmp_path / "frames.txt").write_text("".join(written(frame) + "\n" for frame, _, _ in told))
    printed = csharp.run(program, "turns", tmp_path / "frames.txt").splitlines()
    assert printed == [decided(steps) for _, _, steps in told]


@pytest.mark.parametrize("seed", range(6))
def test_a_frame_may_hold_what_it_may_in_python(csharp: CSharp, program: Path, tmp_path: Path, seed: int) -> None:
    lines, decisions = timed(seed, 6000)
    (tmp_path / "times.txt").write_text("".join(line + "\n" for line in lines))
    assert csharp.run(program, "budget", tmp_path / "times.txt").splitlines() == decisions
