"""Measurements that leave training clips out take whole clips, by their names."""

from pathlib import Path

import pytest
import recordings
import typer
from left_out import left_out

from mua.recording import Recording


def test_the_frames_of_named_clips_are_left_out(tmp_path: Path) -> None:
    recordings.write(tmp_path)
    recording = Recording(tmp_path)
    first, second = [clip.name for clip in recording.clips if not clip.held_out]
    assert left_out(recording, [second]).tolist() == [False] * 12 + [True] * 11
    assert left_out(recording, [first, second]).all()
    with pytest.raises(typer.BadParameter, match=rf"'jump' is no training clip, expected some of {first}, {second}"):
        left_out(recording, [first, "jump"])
