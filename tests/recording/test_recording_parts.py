"""Parts recorded by several processes become the recording of one; a kill leaves the parts or the whole."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
import torch
from recordings import RATE, Dying, FormulaTeacher, Killed, clip, content, frames, opened, plan
from synthetic_avatar import synthetic_rig
from together import errors, start

from mua.channels import CHANNELS
from mua.errors import InputError
from mua.recording import PlannedClip, Recording, TeacherWriter, damage, parts, record
from mua.recording.layout import SUM
from mua.recording.parts import divide, first_texture, join_parts, part_directory, record_share, share


def record_parts(directory: Path, processes: int) -> None:
    for rank in range(processes):
        teacher = FormulaTeacher(synthetic_rig())
        planned = plan(teacher.rig)
        record_share(teacher, planned, directory, rank=rank, count=processes, rate=RATE, shard_frames=4)


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
    """The recording by one process, with the defaults of `TeacherWriter`."""
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


def test_any_number_of_processes_makes_the_same_files(whole: Recording, tmp_path: Path) -> None:
    for processes in (1, 2, 5):
        record_parts(tmp_path / f"{processes}", processes)
        join_parts(tmp_path / f"{processes}", plan(synthetic_rig()))
    assert_same(Recording(tmp_path / "1"), whole)
    assert content(tmp_path / "1") == content(tmp_path / "2") == content(tmp_path / "5")
    damage.check(tmp_path / "5", plan(synthetic_rig()), rate=RATE, whole=True)  # else the next run would record it anew


def arrays(directory: Path) -> dict[int, int]:
    """Bytes by file of all arrays but running sums."""
    found = [path.stat() for path in directory.rglob("shards/*/*.npy") if path.name != SUM]
    return {stat.st_ino: stat.st_size for stat in found}


def test_joining_needs_no_room_for_a_second_copy(tmp_path: Path) -> None:
    record_parts(tmp_path / "r", 2)
    recorded = arrays(tmp_path)
    join_parts(tmp_path / "r", plan(synthetic_rig()))
    assert recorded
    assert arrays(tmp_path / "r") == recorded


def test_parts_are_joined_where_a_file_system_has_no_links(
    whole: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: Path) -> None:
        raise OSError

    record_parts(tmp_path / "r", 2)
    monkeypatch.setattr(os, "link", refuse)
    join_parts(tmp_path / "r", plan(synthetic_rig()))
    assert_same(Recording(tmp_path / "r"), whole)


def test_a_writer_goes_on_with_what_was_joined(tmp_path: Path) -> None:
    directory, rig = tmp_path / "joined", synthetic_rig()
    record_parts(directory, 2)
    join_parts(directory, plan(rig))
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


def test_death_at_any_step_of_joining_leaves_the_parts_or_the_whole(
    whole: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    record_parts(tmp_path / "parts" / "joined", 2)
    of_path = [(Path, name) for name in ("rename", "write_bytes", "mkdir")]
    dying = Dying(monkeypatch, (os, "link"), (np, "save"), (shutil, "copyfile"), (shutil, "rmtree"), *of_path)
    for step in range(1, 10_000, 13):
        directory = tmp_path / f"{step}" / "joined"
        dying.budget = 0
        shutil.copytree(tmp_path / "parts", directory.parent)
        dying.budget = step
        try:
            join_parts(directory, plan(synthetic_rig()))
        except Killed:
            dying.budget = 0
            join_parts(directory, plan(synthetic_rig()))
            assert_same(Recording(directory), whole)
        else:
            break
    assert step > 50


def test_refuses_a_part_that_is_missing_unfinished_or_of_another_teacher(tmp_path: Path) -> None:
    directory, planned = tmp_path / "joined", plan(synthetic_rig())
    record_parts(directory, 2)
    first, second = (part_directory(directory, part, 3) for part in range(2))
    kept = content(first)
    shutil.move(second, tmp_path / "aside")
    with pytest.raises(InputError, match=r"joined.part-2-of-3: not a recording"):
        join_parts(directory, planned)
    teacher = FormulaTeacher(synthetic_rig())
    with TeacherWriter(second, teacher.rig, rate=RATE) as writer:
        writer.refer_to(teacher.frame(planned[0].clip, 0).texture)
    with pytest.raises(InputError, match=r"part-2-of-3: clip 'turn' is unfinished"):
        join_parts(directory, planned)
    shutil.rmtree(second)
    with TeacherWriter(second, teacher.rig, rate=RATE) as writer:
        record(teacher, planned[1:2], writer)
    with pytest.raises(InputError, match=r"part-2-of-3: comes from another teacher than .*part-1-of-3"):
        join_parts(directory, planned)
    assert content(first) == kept
    assert not directory.exists()


def test_refuses_another_reference(tmp_path: Path) -> None:
    first, _, third = frames(3)
    with opened(tmp_path) as writer:
        writer.refer_to(first.texture)
        with pytest.raises(InputError, match=r"reference.npz: is another texture"):
            writer.refer_to(third.texture)


def test_the_texture_that_all_parts_refer_to_comes_after_its_run_up() -> None:
    rig = synthetic_rig()
    whole = clip(rig, "walk", 10)
    end = PlannedClip(whole.cut(slice(4, None)), held_out=True, wanted=frozenset({1}), run_up=whole.cut(slice(4)))
    teacher = FormulaTeacher(rig)
    np.testing.assert_array_equal(first_texture(teacher, [end]), teacher.frame(whole, 5).texture)


def planned(lengths: list[int]) -> list[PlannedClip]:
    rig = synthetic_rig()
    clips = [clip(rig, str(number), max(length, 1)).cut(slice(length)) for number, length in enumerate(lengths)]
    return [PlannedClip(one, held_out=False, wanted=frozenset()) for one in clips]


def names(lengths: list[int]) -> list[list[str]]:
    return [[p.clip.name for p in part] for part in divide(planned(lengths))]


def test_every_clip_is_a_part_while_there_are_few() -> None:
    assert names([10, 0, 30]) == [["0"], ["1"], ["2"]]
    with pytest.raises(InputError, match="plan: holds no clip"):
        divide([])


def test_of_many_clips_consecutive_ones_make_parts_of_about_one_length(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "MOST_PARTS", 2)
    assert names([10, 10, 10, 10]) == [["0", "1"], ["2", "3"]]
    assert names([30, 10, 10, 10]) == [["0"], ["1", "2", "3"]]
    assert names([5, 0, 0]) == [["0", "1", "2"]]  # an empty part is none


def test_each_process_takes_the_longest_part_that_is_left_when_it_has_the_least_to_do() -> None:
    divided = divide(planned([5, 40, 20, 15]))
    assert share(divided, 0, 2) == [1]
    assert share(divided, 1, 2) == [2, 3, 0]
    assert [share(divided, rank, 9) for rank in range(5)] == [[1], [2], [3], [0], []]
