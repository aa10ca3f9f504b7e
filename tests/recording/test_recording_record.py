"""Recording a plan: resuming, memory and errors."""

import gc
import shutil
import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recordings import RATE, FormulaTeacher, clip, content, opened, plan, write
from synthetic_avatar import synthetic_rig

from mua.errors import InputError
from mua.recording import PlannedClip, Recording, TeacherWriter, record


def test_complete_recording_is_not_touched_again(written: Path, tmp_path: Path) -> None:
    directory = tmp_path / "copy"
    shutil.copytree(written, directory)
    assert write(directory).computed == []
    assert content(directory) == content(written)


def test_resuming_asks_the_teacher_only_for_what_is_missing(tmp_path: Path) -> None:
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)
    walk = clip(rig, "walk", 10)
    planned = [PlannedClip(walk, held_out=False, wanted=frozenset(range(10)))]
    heard: list[int] = []

    class Stop(Exception):
        pass

    def stop_at_six(done: int) -> None:
        if done == 6:
            raise Stop

    with pytest.raises(Stop), TeacherWriter(tmp_path, rig, rate=RATE, shard_frames=4) as writer:
        record(teacher, planned, writer, progress=stop_at_six)
    with TeacherWriter(tmp_path, rig, rate=RATE, shard_frames=4) as writer:
        assert writer.next_frame("walk") == 4
        assert writer.recorded("walk") == (0, 1, 2, 3)
        assert not writer.is_complete("walk")
        teacher.computed.clear()
        record(teacher, planned, writer, progress=heard.append)
    assert teacher.computed == [("walk", index) for index in range(4, 10)]
    assert heard == [4, 5, 6, 7, 8, 9, 10]
    assert Recording(tmp_path).count() == 10


def test_a_teacher_plays_a_clip_no_further_than_to_the_last_frame_that_is_wanted(tmp_path: Path) -> None:
    rig = synthetic_rig()
    played: list[tuple[str, int]] = []

    class Listened(FormulaTeacher):
        def frames(self, clip, wanted):  # type: ignore[no-untyped-def]
            for index, frame in enumerate(super().frames(clip, wanted)):
                played.append((clip.name, index))
                yield frame

    planned = [
        PlannedClip(clip(rig, "walk", 10), held_out=False, wanted=frozenset({1, 3})),
        PlannedClip(clip(rig, "still", 7), held_out=True, wanted=frozenset()),
    ]
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        record(Listened(rig), planned, writer)
    assert played == [("walk", index) for index in range(4)]
    assert [len(own) for own in Recording(tmp_path).clips] == [10, 7]
    np.testing.assert_array_equal(Recording(tmp_path).clips[0].rotations, planned[0].clip.rotations)


def test_a_run_up_is_played_and_not_recorded(tmp_path: Path) -> None:
    rig = synthetic_rig()
    whole = clip(rig, "walk", 10)
    run_up, end = whole.cut(slice(4)), replace(whole.cut(slice(4, None)), name="end")

    class Counting(FormulaTeacher):
        """Moves its mesh further with every frame that it plays."""

        def frames(self, clip, wanted):  # type: ignore[no-untyped-def]
            for index, frame in enumerate(super().frames(clip, wanted)):
                moved = rig.mesh.vertices.astype(np.float32) + np.float32(index / 1024)
                yield replace(frame, mesh=moved) if index in wanted else frame

    teacher = Counting(rig)
    planned = [PlannedClip(end, held_out=False, wanted=frozenset({0, 3}), run_up=run_up)]
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        record(teacher, planned, writer)
    assert teacher.computed == [("end", 4), ("end", 7)]
    recording = Recording(tmp_path)
    (recorded,) = recording.clips
    np.testing.assert_array_equal(recorded.translations, end.translations)
    assert recorded.recorded.tolist() == [0, 3]
    moved = recording.meshes([0, 1]) - rig.mesh.vertices
    np.testing.assert_allclose(moved.mean(axis=(1, 2)) * 1024, [4, 7], rtol=1e-3)  # single precision


def test_memory_does_not_grow_with_the_number_of_frames(tmp_path: Path) -> None:
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)

    def collect(_: int) -> None:  # so that it does not matter when rubbish is collected
        gc.collect()

    def peak(frames: int) -> int:
        planned = [PlannedClip(clip(rig, "walk", frames), held_out=False, wanted=frozenset(range(frames)))]
        with TeacherWriter(tmp_path / str(frames), rig, rate=RATE, shard_frames=4, whole_every=1) as writer:
            gc.freeze()  # for good, so that what other tests left is not traversed, nor by later collections
            tracemalloc.start()
            record(teacher, planned, writer, progress=collect)
            allocated = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
        return allocated

    peak(4)  # fills caches
    texture = teacher.frame(clip(rig, "walk", 1), 0).texture.nbytes
    assert peak(96) < peak(16) + texture  # none of the 80 additional frames is held in memory


def test_refuses_another_plan(written: Path, tmp_path: Path) -> None:
    shutil.copytree(written, tmp_path / "copy")
    rig = synthetic_rig()
    changed = replace(plan(rig)[0], wanted=frozenset({0, 1}))
    slow = PlannedClip(replace(clip(rig, "slow", 3), rate=12.0), held_out=False, wanted=frozenset({0}))
    for planned, message in (
        (changed, "clip 'walk' holds other frames than are wanted now"),
        (slow, r"clip 'slow': rate is 12\.0 .* expected 24\.0"),
    ):
        with opened(tmp_path / "copy") as writer, pytest.raises(InputError, match=message):
            record(FormulaTeacher(rig), [planned], writer)
