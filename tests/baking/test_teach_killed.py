"""kill -9 at ten moments of one training of a teacher; it goes on each time and ends in the same bytes."""

import random
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import pytest
from captures import make_capture
from watched_teacher import STAGES, STEPS

PROGRAM = Path(__file__).parents[1] / "fixtures" / "watched_teacher.py"
FILES = ("teacher.json", "rig.npz", "weights.pt")
Moment = tuple[int, int]  # stage, step
# Every second one while it waits after a step, the others while it keeps the step or takes the next one.
MOMENTS: Sequence[tuple[Moment, bool]] = (
    *(((0, 1), False), ((0, 4), True), ((1, 1), True), ((1, 3), False), ((1, 6), True)),
    *(((2, 2), True), ((2, 5), False), ((3, 1), True), ((3, 4), False), ((3, 5), True)),
)
LONGEST = 0.05  # seconds after a step's report, in which a checkpoint is written and the next step taken


def run(capture: Path, output: Path, *, until: Moment | None = None, delay: float | None = None) -> int:
    """Train up to a moment and kill the process there, `delay` seconds after it went on; returns how it ended."""
    command = [sys.executable, str(PROGRAM), str(capture), str(output)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        for line in process.stdout:
            stage, step = line.split("|")
            reached = until is not None and (STAGES.index(stage), int(step)) >= until
            if reached and delay is None:
                process.send_signal(signal.SIGKILL)
                break
            print("on", file=process.stdin, flush=True)
            if reached:
                assert delay is not None
                time.sleep(delay)
                process.send_signal(signal.SIGKILL)
                break
    return process.returncode


@pytest.mark.long
def test_killed_at_ten_moments_it_ends_in_the_same_bytes(tmp_path: Path) -> None:
    capture, delays = make_capture(tmp_path / "capture").folder, random.Random(0)
    assert run(capture, tmp_path / "whole") == 0
    for moment, at_work in MOMENTS:
        delay = delays.uniform(0, LONGEST) if at_work else None
        ended = run(capture, tmp_path / "killed", until=moment, delay=delay)
        assert ended == -signal.SIGKILL, f"{STAGES[moment[0]]}, step {moment[1]} of {STEPS}: had ended by itself"
        assert not (tmp_path / "killed" / "teacher.json").exists()
    assert run(capture, tmp_path / "killed") == 0
    for name in FILES:
        assert (tmp_path / "killed" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name
    kept = {path.name for path in (tmp_path / "killed" / "work").iterdir() if path.is_file()}
    assert kept == {path.name for path in (tmp_path / "whole" / "work").iterdir() if path.is_file()}
