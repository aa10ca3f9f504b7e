"""What a recording keeps, and what it takes for damage: sums, sizes of shards, bytes that changed, clips that lack."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recordings import RATE, frames, opened, plan
from synthetic_avatar import synthetic_rig

from mua.channels import GEOMETRY
from mua.errors import InputError
from mua.recording import Recording, writer
from mua.recording.damage import check


def test_poses_alone_fill_shards_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Long motion of which hardly any frame is recorded is on the disk before it ends."""
    monkeypatch.setattr(writer, "POSES_PER_SHARD", 3)
    with opened(tmp_path) as own:
        own.start_clip("walk")
        for frame in frames(7):
            own.add(frame.pose)
        assert [len(clip) for clip in Recording(tmp_path).clips] == [6]


def test_the_sum_of_all_frames_is_kept_once(written: Path) -> None:
    """It is as large as a texture."""
    assert [path.parent.name for path in written.glob("shards/*/sum.npy")] == ["00006"]


def test_a_byte_that_changed_is_found_when_it_is_read(written: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copytree(written, tmp_path / "copy"))
    values = np.load(copy / "shards/00001/ll.npy")
    np.save(copy / "shards/00001/ll.npy", np.nextafter(values, np.inf, dtype=values.dtype))
    recording = Recording(copy)
    recording.meshes(range(recording.count()))
    with pytest.raises(InputError, match=r"00001/ll\.npy"):
        recording.subbands(GEOMETRY, range(recording.count()))


def test_frames_kept_whole_say_which_of_the_recorded_frames_they_are(written: Path) -> None:
    recording, found = Recording(written), []
    for frame in recording.whole_frames():
        (mesh,) = recording.meshes([frame.row], held_out=frame.clip.held_out)
        np.testing.assert_array_equal(frame.mesh, mesh)
        found.append(frame.row)
    assert found == [0, 5, 10, 1, 14, 15]


def test_a_clip_that_was_never_begun_is_missed_only_in_a_whole_recording(written: Path) -> None:
    walk, *others = plan(synthetic_rig())
    planned = [walk, *others, replace(walk, clip=replace(walk.clip, name="run"))]
    check(written, planned, rate=RATE, whole=False)
    with pytest.raises(InputError, match="clip 'run' holds other frames"):
        check(written, planned, rate=RATE, whole=True)
