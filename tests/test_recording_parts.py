"""Parts recorded by several processes become the recording of one; a kill leaves the parts or the whole."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
import torch
from recordings import RATE, FormulaTeacher, clip, content, plan
from synthetic_avatar import synthetic_rig
from together import errors, start

from mua.errors import InputError
from mua.motion.clip import Clip
from mua.recording import PlannedClip, Recording, TeacherWriter, record
from mua.recording.parts import divide, join_parts, part_directory, record_part
from mua.texture.channels import CHANNELS


def record_parts(directory: Path, parts: int) -> None:
    for part in range(parts):
        teacher = FormulaTeacher(synthetic_rig())
        planned = plan(teacher.rig)
        record_part(teacher, planned, directory, part=part, parts=parts, rate=RATE, shard_frames=4)


def assert_same(joined: Recording, whole: Recording) -> None:
    assert [(c.name, c.held_out, c.complete) for c in joined.clips] == [
        (c.name, c.held_out, c.complete) for c in whole.clips
    ]
    for mine, theirs in zip(joined.clips, whole.clips, strict=True):
        np.testing.assert_array_equal(mine.recorded, theirs.recorded)
        np.testing.assert_array_equal(mine.rotations, theirs.rotations)
    for held_out in (False, True):
        rows = range(whole.count(held_out))
        assert joined.count(held_out) == len(rows)
        np.testing.assert_array_equal(joined.meshes(rows, held_out=held_out), whole.meshes(rows, held_out=held_out))
        bands = (recording.subbands(slice(0, CHANNELS), rows, held_out=held_out) for recording in (joined, whole))
        assert all(torch.equal(a, b) for a, b in zip(*bands, strict=True))
    # One sum in double precision or several added: of numbers below 10 and under 100 frames.
    np.testing.assert_allclose(joined.mean_texture(), whole.mean_texture(), atol=1e-13)
    for kept, frame in zip(joined.whole_frames(), whole.whole_frames(), strict=True):
        assert (kept.clip.name, kept.index) == (frame.clip.name, frame.index)
        np.testing.assert_array_equal(kept.texture, frame.texture)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """What one process records, with the defaults of `TeacherWriter`."""
    directory = tmp_path_factory.mktemp("whole")
    teacher = FormulaTeacher(synthetic_rig())
    with TeacherWriter(directory, teacher.rig, rate=RATE) as writer:
        record(teacher, plan(teacher.rig), writer)
    return Recording(directory)


def test_two_processes_record_what_one_does(whole: Recording, tmp_path: Path) -> None:
    assert errors(start("record", tmp_path), "record", tmp_path) == ["", ""]
    assert_same(Recording(tmp_path / "recording"), whole)
    assert not list(tmp_path.glob("*.part*"))
    assert not list(tmp_path.glob(".*.part*"))


@pytest.mark.parametrize("parts", [1, 3, 5])
def test_any_number_of_parts_makes_the_recording(whole: Recording, tmp_path: Path, parts: int) -> None:
    record_parts(tmp_path / "joined", parts)
    join_parts(tmp_path / "joined", plan(synthetic_rig()), parts=parts)
    assert_same(Recording(tmp_path / "joined"), whole)


def test_a_writer_goes_on_with_what_was_joined(tmp_path: Path) -> None:
    directory, rig = tmp_path / "joined", synthetic_rig()
    record_parts(directory, 2)
    join_parts(directory, plan(rig), parts=2)
    mean, frames = Recording(directory).mean_texture(), Recording(directory).count()
    teacher = FormulaTeacher(rig)
    more = PlannedClip(clip(rig, "jump", 3), held_out=False, wanted=frozenset({0}))
    with TeacherWriter(directory, rig, rate=RATE) as writer:
        record(teacher, [*plan(rig), more], writer)
    assert teacher.computed == [("jump", 0)]
    assert Recording(directory).count() == frames + 1
    moved = Recording(directory).mean_texture() * (frames + 1) - mean * frames
    last = next(f for f in Recording(directory).whole_frames() if f.clip.name == "jump")
    np.testing.assert_allclose(moved, last.texture, atol=2e-3)  # whole frames are half precision


class Killed(BaseException):
    """Stands for the death of the process."""


def test_death_at_any_step_of_joining_leaves_the_parts_or_the_whole(
    whole: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record_parts(tmp_path / "parts" / "joined", 2)
    budget = [0]

    def dying(call):  # type: ignore[no-untyped-def]
        def step(*args, **kwargs):  # type: ignore[no-untyped-def]
            budget[0] -= 1
            if budget[0] == 0:
                raise Killed
            return call(*args, **kwargs)

        return step

    monkeypatch.setattr(os, "link", dying(os.link))
    monkeypatch.setattr(np, "save", dying(np.save))
    monkeypatch.setattr(shutil, "copyfile", dying(shutil.copyfile))
    monkeypatch.setattr(shutil, "rmtree", dying(shutil.rmtree))
    for method in ("rename", "write_bytes", "mkdir"):
        monkeypatch.setattr(Path, method, dying(getattr(Path, method)))
    for step in range(1, 10_000, 13):
        directory = tmp_path / f"{step}" / "joined"
        budget[0] = 0
        shutil.copytree(tmp_path / "parts", directory.parent)
        budget[0] = step
        try:
            join_parts(directory, plan(synthetic_rig()), parts=2)
        except Killed:
            budget[0] = 0
            join_parts(directory, plan(synthetic_rig()), parts=2)
            assert_same(Recording(directory), whole)
        else:
            break
    assert step > 50


def test_refuses_a_part_that_is_missing_unfinished_or_of_another_teacher(tmp_path: Path) -> None:
    directory, planned = tmp_path / "joined", plan(synthetic_rig())
    record_parts(directory, 2)
    first, second = (part_directory(directory, part, 2) for part in range(2))
    kept = content(first)
    shutil.move(second, tmp_path / "aside")
    with pytest.raises(InputError, match=r"joined.part-2-of-2: not a recording"):
        join_parts(directory, planned, parts=2)
    teacher = FormulaTeacher(synthetic_rig())
    with TeacherWriter(second, teacher.rig, rate=RATE) as writer:
        writer.refer_to(teacher.frame(planned[0].clip, 0).texture)
    with pytest.raises(InputError, match=r"part-2-of-2: clip 'turn' is unfinished"):
        join_parts(directory, planned, parts=2)
    shutil.rmtree(second)
    with TeacherWriter(second, teacher.rig, rate=RATE) as writer:
        record(teacher, planned[1:], writer)
    with pytest.raises(InputError, match=r"part-2-of-2: is of another teacher than .*part-1-of-2"):
        join_parts(directory, planned, parts=2)
    assert content(first) == kept
    assert not directory.exists()


def test_refuses_another_reference(tmp_path: Path) -> None:
    teacher, walk = FormulaTeacher(synthetic_rig()), plan(synthetic_rig())[0].clip
    with TeacherWriter(tmp_path, teacher.rig, rate=RATE) as writer:
        writer.refer_to(teacher.frame(walk, 0).texture)
        with pytest.raises(InputError, match=r"reference.npz: is another texture"):
            writer.refer_to(teacher.frame(walk, 2).texture)


def test_clips_stay_in_order_and_are_shared_by_their_length() -> None:
    rig = synthetic_rig()

    def names(lengths: list[int], parts: int) -> list[list[str]]:
        clips = [clip(rig, str(number), max(length, 1)) for number, length in enumerate(lengths)]
        cut = [c.cut(slice(n)) for c, n in zip(clips, lengths, strict=True)]
        return [[p.clip.name for p in part] for part in divide([planned(c) for c in cut], parts)]

    def planned(one: Clip) -> PlannedClip:
        return PlannedClip(one, held_out=False, wanted=frozenset())

    assert names([10, 10, 10, 10], 2) == [["0", "1"], ["2", "3"]]
    assert names([30, 10, 10, 10], 2) == [["0"], ["1", "2", "3"]]
    assert names([5], 3) == [[], ["0"], []]
    assert names([5, 0], 2) == [[], ["0", "1"]]  # the middle of the one, and what follows it
    assert names([], 2) == [[], []]
