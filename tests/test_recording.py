"""Recordings: what comes back, what a kill leaves, what is refused."""

import json
import os
import random
import shutil
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Container, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pywt
import torch
from synthetic_avatar import synthetic_rig

from mua.arrays import Array
from mua.errors import InputError
from mua.motion.clip import Clip
from mua.recording import PlannedClip, Recording, TeacherWriter, record
from mua.rig.rig import Rig
from mua.rig.skeleton import Pose
from mua.teachers.teacher import TeacherFrame
from mua.texture.channels import ATTRIBUTES, GEOMETRY
from mua.texture.fill import Fill

RATE = 24.0
HALF = 2.0**-11  # relative rounding error of half precision
SUBNORMAL = 2.0**-25  # its absolute error next to zero
SINGLE = float(np.finfo(np.float32).eps)
TRANSFORM = 4 * 2 * 10 * SINGLE  # four levels, two axes, ten taps


class FormulaTeacher:
    """A teacher whose every number follows from clip and frame, so that any run yields the same."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.computed: list[tuple[str, int]] = []
        rng = np.random.default_rng(5)
        valid, vertices = len(rig.texels.texels), len(rig.mesh.vertices)
        self._base = rng.standard_normal((valid, 23)).astype(np.float32)
        self._base[:, ATTRIBUTES["scale"]] -= 6
        self._change = 0.1 * rng.standard_normal((valid, 23)).astype(np.float32)
        self._sway = 0.1 * rng.standard_normal((vertices, 3)).astype(np.float32)

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        for index in range(len(clip)):
            yield self.frame(clip, index) if index in wanted else clip.pose(index)

    def frame(self, clip: Clip, index: int) -> TeacherFrame:
        self.computed.append((clip.name, index))
        phase = np.float32(np.sin(index + len(clip.name)))
        texture = self._base + phase * self._change
        if index % 2:
            texture[::3, ATTRIBUTES["rotation"]] *= -1
        mesh = self.rig.mesh.vertices.astype(np.float32) + phase * self._sway
        return TeacherFrame(clip.pose(index), mesh, texture)


def clip(rig: Rig, name: str, frames: int) -> Clip:
    rng = np.random.default_rng(frames)
    rotations = rng.standard_normal((frames, len(rig.skeleton.names), 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    return Clip(name, RATE, rotations, rng.standard_normal((frames, 3)))


def plan(rig: Rig) -> list[PlannedClip]:
    return [
        PlannedClip(clip(rig, "walk", 23), held_out=False, wanted=frozenset(range(0, 23, 2))),
        PlannedClip(clip(rig, "turn", 5), held_out=True, wanted=frozenset({1, 4}), whole=frozenset({4})),
        PlannedClip(clip(rig, "reach", 11), held_out=False, wanted=frozenset(range(11)), whole=frozenset({2, 3})),
    ]


def write(directory: Path, *, whole_every: int = 5) -> FormulaTeacher:
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)
    with TeacherWriter(directory, rig, rate=RATE, shard_frames=4, whole_every=whole_every) as writer:
        record(teacher, plan(rig), writer)
    return teacher


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("recordings") / "undisturbed"
    write(directory)
    return directory


def aligned(texture: Array, reference: Array) -> Array:
    texture = texture.copy()
    for texel in range(len(texture)):
        if texture[texel, 3:7] @ reference[texel, 3:7] < 0:
            texture[texel, 3:7] *= -1
    return texture


def truth(*, held_out: bool) -> list[TeacherFrame]:
    """The recorded frames in order, rotations aligned to the first of all."""
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)
    reference = teacher.frame(plan(rig)[0].clip, 0).texture
    frames = [
        teacher.frame(planned.clip, index)
        for planned in plan(rig)
        for index in sorted(planned.wanted)
        if planned.held_out == held_out
    ]
    return [replace(frame, texture=aligned(frame.texture, reference)) for frame in frames]


def content(directory: Path) -> dict[str, bytes]:
    return {str(p.relative_to(directory)): p.read_bytes() for p in sorted(directory.rglob("*")) if p.is_file()}


def test_clips_and_poses_come_back_exactly(written: Path) -> None:
    recording = Recording(written)
    assert recording.rate == RATE
    assert recording.wavelet == "bior4.4"
    for stored, planned in zip(recording.clips, plan(synthetic_rig()), strict=True):
        assert (stored.name, stored.held_out, stored.complete) == (planned.clip.name, planned.held_out, True)
        assert stored.recorded.tolist() == sorted(planned.wanted)
        np.testing.assert_array_equal(stored.rotations, planned.clip.rotations)
        np.testing.assert_array_equal(stored.translation, planned.clip.translation)


def test_rig_comes_back_exactly(written: Path) -> None:
    stored, rig = Recording(written).rig, synthetic_rig()
    assert (stored.skeleton.names, stored.skeleton.root) == (rig.skeleton.names, rig.skeleton.root)
    np.testing.assert_array_equal(stored.mesh.vertices, rig.mesh.vertices)
    np.testing.assert_array_equal(stored.skin_weights, rig.skin_weights)
    np.testing.assert_array_equal(stored.texels.barycentrics, rig.texels.barycentrics)
    assert stored.texels.size == rig.texels.size


def pywt_subbands(fill: Fill, texture: Array) -> list[Array]:
    """LL [C, n, n], D3 and D2 [3, C, ., .] of a filled texture, in double precision."""
    image = fill(torch.from_numpy(texture)).numpy().astype(np.float64)
    bands = []
    for _ in range(4):
        image, details = pywt.dwt2(image, "bior4.4", "periodization")
        bands.append(np.stack(details))
    return [image, bands[3], bands[2]]


@pytest.mark.parametrize("held_out", [False, True])
def test_subbands_are_within_half_precision_of_the_difference(written: Path, held_out: bool) -> None:
    recording = Recording(written)
    frames, reference = truth(held_out=held_out), truth(held_out=False)[0].texture
    rows = list(range(recording.count(held_out)))[::-1]
    assert len(rows) == len(frames)
    stored = {part: recording.subbands(slice(*part), rows, held_out=held_out) for part in ((0, 11), (11, 23), (4, 5))}
    fill = Fill(recording.rig.texels)
    for at, row in enumerate(rows):
        expected = pywt_subbands(fill, frames[row].texture)
        changes = pywt_subbands(fill, frames[row].texture - reference)
        for (start, stop), bands in stored.items():
            for band, whole, change in zip(bands, expected, changes, strict=True):
                assert band.dtype == torch.float32
                error = np.abs(band[at].numpy() - whole[..., start:stop, :, :])
                bound = HALF * np.abs(change[..., start:stop, :, :]) + SUBNORMAL + TRANSFORM * np.abs(whole).max()
                assert (error <= bound).all()


def test_meshes_come_back_exactly(written: Path) -> None:
    recording = Recording(written)
    expected = np.stack([frame.mesh for frame in truth(held_out=False)])
    np.testing.assert_array_equal(recording.meshes(torch.arange(recording.count())), expected)
    np.testing.assert_array_equal(recording.meshes([3, 1, 3]), expected[[3, 1, 3]])
    assert recording.meshes([]).shape == (0, *expected.shape[1:])
    assert recording.subbands(GEOMETRY, []).d2.shape == (0, 3, 11, 4, 4)


def test_means_are_over_training_frames_only(written: Path) -> None:
    recording, frames = Recording(written), truth(held_out=False)
    mean = np.mean([frame.texture for frame in frames], axis=0, dtype=np.float64)
    largest = max(float(np.abs(frame.texture).max()) for frame in frames)
    np.testing.assert_allclose(recording.mean_texture(), mean, rtol=0, atol=SINGLE * 2 * largest)
    mesh = np.mean([frame.mesh for frame in frames], axis=0, dtype=np.float64)
    np.testing.assert_allclose(recording.mean_mesh(), mesh, rtol=1e-14, atol=1e-14)


def test_whole_frames_are_those_planned_or_every_nth(written: Path) -> None:
    recording = Recording(written)
    kept = [(frame.clip.name, frame.index) for frame in recording.whole_frames()]
    assert kept == [("walk", 0), ("walk", 10), ("walk", 20), ("turn", 4), ("reach", 2), ("reach", 3)]
    assert recording.whole_count == len(kept)
    assert [frame.clip.name for frame in recording.whole_frames(held_out=True)] == ["turn"]
    teacher = FormulaTeacher(recording.rig)
    reference = truth(held_out=False)[0].texture
    for frame in recording.whole_frames():
        original = teacher.frame(frame.clip, frame.index)
        expected = aligned(original.texture, reference)
        bound = HALF * np.abs(expected - reference) + SUBNORMAL + 2 * SINGLE * np.abs(expected)
        assert (np.abs(frame.texture - expected) <= bound).all()
        np.testing.assert_array_equal(frame.mesh, original.mesh)


def test_full_images_are_taken_at_the_valid_texels(tmp_path: Path) -> None:
    rig = synthetic_rig()
    size = rig.texels.size
    first = FormulaTeacher(rig).frame(clip(rig, "walk", 1), 0)
    image = np.full((size * size, 23), np.nan, dtype=np.float32)
    image[rig.texels.texels] = first.texture
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        writer.start_clip("walk")
        writer.add(first.pose, first.mesh, image.reshape(size, size, 23))
    np.testing.assert_array_equal(Recording(tmp_path).mean_texture(), first.texture)


def test_fingerprint_changes_with_content_only(written: Path, tmp_path: Path) -> None:
    write(tmp_path / "again")
    assert Recording(tmp_path / "again").fingerprint() == Recording(written).fingerprint()
    assert content(tmp_path / "again") == content(written)
    write(tmp_path / "other", whole_every=3)
    assert Recording(tmp_path / "other").fingerprint() != Recording(written).fingerprint()


def test_complete_recording_is_not_touched_again(written: Path, tmp_path: Path) -> None:
    directory = tmp_path / "copy"
    shutil.copytree(written, directory)
    assert write(directory).computed == []
    assert content(directory) == content(written)


class Killed(BaseException):
    """Stands for the death of the process."""


def test_death_at_any_step_of_a_write_loses_and_doubles_nothing(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Die before the k-th of the calls that change the disk; then go on."""
    budget = [0]

    def dying(call):  # type: ignore[no-untyped-def]
        def step(*args, **kwargs):  # type: ignore[no-untyped-def]
            budget[0] -= 1
            if budget[0] == 0:
                raise Killed
            return call(*args, **kwargs)

        return step

    with monkeypatch.context() as patch:
        patch.setattr(np, "save", dying(np.save))
        patch.setattr(np, "savez", dying(np.savez))
        patch.setattr(os, "fsync", dying(os.fsync))
        for method in ("rename", "unlink", "write_bytes", "replace"):
            patch.setattr(Path, method, dying(getattr(Path, method)))
        for step in range(1, 10_000, 11):  # some of the steps of every shard; all would take minutes
            directory = tmp_path / str(step)
            budget[0] = step
            try:
                write(directory)
            except Killed:
                if (directory / "recording.json").exists():
                    Recording(directory)
                budget[0] = 0
                write(directory)
                assert content(directory) == content(written)
                shutil.rmtree(directory)
            else:
                break
    assert step > 50


def test_kill_9_at_random_moments_loses_and_doubles_nothing(written: Path, tmp_path: Path) -> None:
    program = "import sys, test_recording as t; print('ready', flush=True); t.write(t.Path(sys.argv[1]))"
    paths = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    rng = random.Random(3)
    kills = 0
    for attempt in range(20):
        child = subprocess.Popen(
            [sys.executable, "-c", program, str(tmp_path / "killed")],
            env={**os.environ, "PYTHONPATH": paths},
            stdout=subprocess.PIPE,
        )
        with child:
            assert child.stdout is not None
            child.stdout.readline()
            if attempt < 3:
                time.sleep(rng.uniform(0.02, 0.3))
                child.kill()
        if child.returncode == 0:
            break
        kills += 1
    assert kills > 0
    assert content(tmp_path / "killed") == content(written)


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


def test_memory_does_not_grow_with_the_number_of_frames(tmp_path: Path) -> None:
    rig = synthetic_rig()
    teacher = FormulaTeacher(rig)

    def peak(frames: int) -> int:
        planned = [PlannedClip(clip(rig, "walk", frames), held_out=False, wanted=frozenset(range(frames)))]
        with TeacherWriter(tmp_path / str(frames), rig, rate=RATE, shard_frames=4, whole_every=1) as writer:
            tracemalloc.start()
            record(teacher, planned, writer)
            allocated = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
        return allocated

    peak(4)  # fills caches
    texture = teacher.frame(clip(rig, "walk", 1), 0).texture.nbytes
    assert peak(96) < peak(16) + texture  # of the 80 frames more not even one is held


def test_interleaved_clips_stay_contiguous_after_a_kill(tmp_path: Path) -> None:
    """A clip that a killed run left is complete once another is started."""
    rig = synthetic_rig()
    teacher, walk = FormulaTeacher(rig), clip(rig, "walk", 3)
    killed = TeacherWriter(tmp_path, rig, rate=RATE, shard_frames=2)
    killed.start_clip("walk")
    for frame in (teacher.frame(walk, index) for index in range(3)):
        killed.add(frame.pose, frame.mesh, frame.texture)
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        writer.start_clip("turn")
        with pytest.raises(InputError, match="clip 'walk' is complete"):
            writer.start_clip("walk")
    assert [(c.name, len(c), c.complete) for c in Recording(tmp_path).clips] == [("walk", 2, True)]


def test_recording_without_frames_opens_but_has_no_mean(tmp_path: Path) -> None:
    rig = synthetic_rig()
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        writer.start_clip("walk")
        writer.add(rig.skeleton.bind_pose)
    recording = Recording(tmp_path)
    assert (recording.count(), len(recording.clips[0])) == (0, 1)
    with pytest.raises(InputError, match="holds no training frame"):
        recording.mean_texture()


def nan_at(array: Array, *where: int) -> Array:
    array = array.copy()
    array[where] = np.nan
    return array


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: replace(f, mesh=f.mesh[1:]), r"mesh has shape \[11, 3\], expected \[12, 3\]"),
        (lambda f: replace(f, mesh=nan_at(f.mesh, 2, 1)), r"mesh is nan at \[2, 1\]"),
        (
            lambda f: replace(f, texture=f.texture[:-1]),
            r"texture has shape .* expected \[\d+, 23\] at the valid",
        ),
        (lambda f: replace(f, texture=np.zeros((32, 32, 26))), r"\[32, 32, 26\].*the 3 of the base position"),
        (
            lambda f: replace(f, texture=nan_at(f.texture, 0, 4)),
            r"channel 4 \(rotation\) at row \d+, column \d+ is",
        ),
        (lambda f: replace(f, texture=f.texture + np.inf), r"channel 0 \(offset\) .* is inf"),
        (lambda f: replace(f, texture=f.texture * 1e6), "differs by .* from the reference frame's"),
        (lambda f: replace(f, pose=Pose(f.pose.rotations[:2], f.pose.translation)), r"rotations has shape \[2, 4\]"),
        (lambda f: replace(f, pose=Pose(f.pose.rotations * 2, f.pose.translation)), "of joint 0 has length 2"),
        (lambda f: replace(f, pose=Pose(f.pose.rotations, nan_at(f.pose.translation, 0))), "pose translation is nan"),
        (lambda f: replace(f, mesh=None), "mesh is missing, expected both or neither"),
    ],
)
def test_refuses_a_bad_frame_and_goes_on(tmp_path: Path, change, message: str) -> None:  # type: ignore[no-untyped-def]
    rig = synthetic_rig()
    teacher, walk = FormulaTeacher(rig), clip(rig, "walk", 2)
    good, second = teacher.frame(walk, 0), teacher.frame(walk, 1)
    bad = change(second)
    with TeacherWriter(tmp_path, rig, rate=RATE) as writer:
        writer.start_clip("walk")
        writer.add(good.pose, good.mesh, good.texture)
        with pytest.raises(InputError, match=f"clip 'walk', frame 1: .*{message}"):
            writer.add(bad.pose, bad.mesh, bad.texture)
        writer.add(second.pose, second.mesh, second.texture)
    assert Recording(tmp_path).count() == 2


def test_refuses_a_first_frame_that_is_not_finite(tmp_path: Path) -> None:
    rig = synthetic_rig()
    frame = FormulaTeacher(rig).frame(clip(rig, "walk", 1), 0)
    writer = TeacherWriter(tmp_path, rig, rate=RATE)
    writer.start_clip("walk")
    with pytest.raises(InputError, match="is nan"):
        writer.add(frame.pose, frame.mesh, nan_at(frame.texture, 3, 3))
    assert not (tmp_path / "reference.npz").exists()


def test_refuses_a_frame_before_a_clip(tmp_path: Path) -> None:
    rig = synthetic_rig()
    with pytest.raises(InputError, match="start_clip comes before"):
        TeacherWriter(tmp_path, rig, rate=RATE).add(rig.skeleton.bind_pose)


def test_refuses_a_directory_of_another_rig_rate_or_wavelet(written: Path) -> None:
    rig = synthetic_rig()
    other = replace(rig, skin_weights=rig.skin_weights[::-1])
    with pytest.raises(InputError, match=r"rig is .* record into another directory"):
        TeacherWriter(written, other, rate=RATE)
    with pytest.raises(InputError, match=r"rate is 24\.0, expected 30\.0"):
        TeacherWriter(written, rig, rate=30)
    with pytest.raises(InputError, match=r"wavelet is 'bior4\.4', expected 'bior2\.2'"):
        TeacherWriter(written, rig, rate=RATE, wavelet="bior2.2")


def test_refuses_a_texture_size_that_four_levels_do_not_halve(tmp_path: Path) -> None:
    rig = synthetic_rig()
    with pytest.raises(InputError, match="texture size 40, expected a multiple of 16"):
        TeacherWriter(tmp_path, replace(rig, texels=replace(rig.texels, size=40)), rate=RATE)


def test_refuses_another_plan(written: Path, tmp_path: Path) -> None:
    shutil.copytree(written, tmp_path / "copy")
    rig = synthetic_rig()
    changed = [replace(plan(rig)[0], wanted=frozenset({0, 1}))]
    with (
        TeacherWriter(tmp_path / "copy", rig, rate=RATE) as writer,
        pytest.raises(InputError, match="clip 'walk' holds other frames than are wanted now"),
    ):
        record(FormulaTeacher(rig), changed, writer)
    slow = [PlannedClip(replace(clip(rig, "slow", 3), rate=12.0), held_out=False, wanted=frozenset({0}))]
    with (
        TeacherWriter(tmp_path / "copy", rig, rate=RATE) as writer,
        pytest.raises(InputError, match=r"clip 'slow': rate is 12\.0 .* expected 24\.0"),
    ):
        record(FormulaTeacher(rig), slow, writer)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("recording.json", "holds no recording.json"),
        ("rig.npz", r"rig\.npz"),
        ("reference.npz", r"reference\.npz: is missing"),
        ("shards/00001/index.json", r"00001/index\.json: is missing"),
        ("shards/00001/d2.npy", r"00001/d2\.npy is missing"),
        ("shards/00000/whole_00000.npy", r"00000/whole_00000\.npy is missing"),
        ("shards/00006/sum.npy", r"sum\.npy is missing"),
    ],
)
def test_names_a_missing_file(written: Path, tmp_path: Path, name: str, message: str) -> None:
    shutil.copytree(written, tmp_path / "copy")
    (tmp_path / "copy" / name).unlink()
    with pytest.raises(InputError, match=message):
        Recording(tmp_path / "copy")


def test_names_a_missing_shard(written: Path, tmp_path: Path) -> None:
    shutil.copytree(written, tmp_path / "copy")
    shutil.rmtree(tmp_path / "copy/shards/00001")
    with pytest.raises(InputError, match="shard 00001 is missing"):
        Recording(tmp_path / "copy")
    with pytest.raises(InputError, match="shard 00001 is missing"):
        TeacherWriter(tmp_path / "copy", synthetic_rig(), rate=RATE)


@pytest.mark.parametrize(
    "name", ["recording.json", "rig.npz", "reference.npz", "shards/00001/index.json", "shards/00001/ll.npy"]
)
def test_names_a_file_cut_short(written: Path, tmp_path: Path, name: str) -> None:
    shutil.copytree(written, tmp_path / "copy")
    path = tmp_path / "copy" / name
    whole = path.read_bytes()
    for kept in (0, 1, len(whole) // 3, len(whole) - 2):
        path.write_bytes(whole[:kept])
        with pytest.raises(InputError, match=path.name):
            Recording(tmp_path / "copy")


def test_refuses_a_newer_version(written: Path, tmp_path: Path) -> None:
    shutil.copytree(written, tmp_path / "copy")
    header = json.loads((written / "recording.json").read_text())
    (tmp_path / "copy/recording.json").write_text(json.dumps(header | {"version": 2}))
    with pytest.raises(InputError, match="version is 2, this program reads 1"):
        Recording(tmp_path / "copy")
