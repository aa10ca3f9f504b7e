"""The programs of docs/examples run as they stand."""

import subprocess
import sys
from pathlib import Path

import numpy as np
from examples import EXAMPLES, load_example
from PIL import Image

from mua.asset.read import read
from mua.recording import Recording


def test_a_teacher_of_ones_own_is_recorded_trained_and_seen(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / "own_teacher.py"), str(tmp_path)], check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "no mistake in units or conventions was found" in done.stdout
    assert (tmp_path / "figure_check.png").is_file()
    assert [clip.name for clip in read(tmp_path / "figure.muaavatar").clips] == ["wave", "bow", "both"]
    picture = np.asarray(Image.open(tmp_path / "figure.png").convert("RGB"))
    assert 0.05 < np.mean(picture.min(axis=2) < 200) < 0.6  # a figure on white
    errors = (tmp_path / "figure_errors.md").read_text()
    assert "held out" in errors


def test_the_example_goes_on_where_it_was_killed(tmp_path: Path) -> None:
    example = load_example("own_teacher")
    example.FRAMES = {"wave": 3, "both": 2}
    example.record(tmp_path)
    example.FRAMES["bow"] = 2
    again = Recording(example.record(tmp_path))
    assert [clip.recorded.tolist() for clip in again.clips] == [[0], [0], [0]]
    assert {clip.name: len(clip) for clip in again.clips} == {"wave": 3, "both": 2, "bow": 2}
