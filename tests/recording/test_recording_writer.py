"""Recordings written: the state after a kill, refused frames and directories."""

import errno
import os
import random
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from recordings import RATE, Dying, Killed, add, content, frames, opened, write
from synthetic_avatar import synthetic_rig

from mua.arrays import Array
from mua.errors import InputError
from mua.pose.skeleton import Pose
from mua.recording import Recording, TeacherWriter


def test_full_images_are_taken_at_the_valid_texels(tmp_path: Path) -> None:
    texels = synthetic_rig().texels
    (first,) = frames(1)
    image = np.full((texels.size, texels.size, 23), np.nan, dtype=np.float32)
    image.reshape(-1, 23)[texels.texels] = first.texture
    with opened(tmp_path) as writer:
        add(writer, replace(first, texture=image))
    np.testing.assert_array_equal(Recording(tmp_path).mean_texture(), first.texture)


def test_a_buffer_that_the_caller_fills_anew_holds_each_frame(tmp_path: Path) -> None:
    two = frames(2)
    mesh, texture = np.zeros_like(two[0].mesh), np.zeros_like(two[0].texture)
    with opened(tmp_path / "reused") as writer:
        writer.start_clip("walk")
        for frame in two:
            mesh[:], texture[:] = frame.mesh, frame.texture
            writer.add(frame.pose, mesh, texture)
    with opened(tmp_path / "own") as writer:
        add(writer, *two)
    assert content(tmp_path / "reused") == content(tmp_path / "own")


def test_death_at_any_step_of_a_write_loses_and_doubles_nothing(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Die before the k-th of the calls that change the disk; then go on."""
    of_path = [(Path, name) for name in ("rename", "unlink", "write_bytes", "replace")]
    with monkeypatch.context() as patch:
        dying = Dying(patch, (np, "save"), (np, "savez"), (os, "fsync"), *of_path)
        for step in range(1, 10_000, 11):  # some of the steps of every shard; all would take minutes
            directory = tmp_path / str(step)
            dying.budget = step
            try:
                write(directory)
            except Killed:
                if (directory / "recording.json").exists():
                    Recording(directory)
                dying.budget = 0
                write(directory)
                assert content(directory) == content(written)
                shutil.rmtree(directory)
            else:
                break
    assert step > 50


@pytest.mark.long
def test_kill_9_at_random_moments_loses_and_doubles_nothing(written: Path, tmp_path: Path) -> None:
    program = "import sys, recordings as t; print('ready', flush=True); t.write(t.Path(sys.argv[1]))"
    paths = os.pathsep.join([str(Path(__file__).parents[1] / "fixtures"), *sys.path])
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


def test_interleaved_clips_stay_contiguous_after_a_kill(tmp_path: Path) -> None:
    """A clip that a killed run left is complete once another is started."""
    with suppress(Killed), opened(tmp_path, shard_frames=2) as killed:
        add(killed, *frames(3))
        raise Killed
    with opened(tmp_path) as writer:
        writer.start_clip("turn")
        with pytest.raises(InputError, match="clip 'walk' is complete"):
            writer.start_clip("walk")
    assert [(c.name, len(c), c.complete) for c in Recording(tmp_path).clips] == [("walk", 2, True)]


def test_a_second_writer_is_refused_and_leaves_the_first_ones_frames(tmp_path: Path) -> None:
    with opened(tmp_path, whole_every=1) as first:
        add(first, *frames(3))
        with pytest.raises(InputError, match=rf"process {os.getpid()} is using it; wait until that has ended"):
            opened(tmp_path)
    assert [frame.index for frame in Recording(tmp_path).whole_frames()] == [0, 1, 2]
    opened(tmp_path)


def test_every_file_of_a_shard_is_on_the_disk_before_the_shard_has_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The name is synced after them, so that a loss of power leaves a shard whole or not at all."""
    fsync, rename = os.fsync, Path.rename
    synced: set[int] = set()  # by inode, which a rename keeps
    shards = 0

    def syncing(descriptor: int) -> None:
        synced.add(os.fstat(descriptor).st_ino)
        fsync(descriptor)

    def renaming(self: Path, target: Path) -> Path:
        nonlocal shards
        if target.parent.name == "shards":
            shards += 1
            assert {path.stat().st_ino for path in (self, *self.iterdir())} <= synced
            synced.discard(target.parent.stat().st_ino)
        return rename(self, target)

    monkeypatch.setattr(os, "fsync", syncing)
    monkeypatch.setattr(Path, "rename", renaming)
    write(tmp_path / "r")
    assert shards == 7
    assert (tmp_path / "r" / "shards").stat().st_ino in synced


def test_a_writer_that_need_not_be_durable_waits_for_no_shard(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with opened(tmp_path, durable=False) as writer:
        add(writer, *frames(1))  # the reference is synced in any case
        monkeypatch.setattr(os, "fsync", lambda descriptor: pytest.fail("a shard was synced"))
        add(writer, *frames(3)[1:])
    assert Recording(tmp_path).count() == 3


def test_a_shard_that_finds_no_room_is_not_left_half_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither where a frame kept whole finds none, which is written at once, nor where the rest does."""
    write_bytes = Path.write_bytes

    def full(self: Path, content: bytes) -> int:
        if self.name == refused:
            write_bytes(self, b"half")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return write_bytes(self, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    for refused in ("whole_00000.npy", "d2.npy", "index.json"):
        with pytest.raises(InputError, match=r"cannot be written \(No space left on device\); earlier shards are kept"):
            write(tmp_path / refused)
        assert list((tmp_path / refused / "shards").iterdir()) == []


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
        (lambda f: replace(f, pose=Pose(f.pose.rotations[:2], f.pose.translations)), r"rotations has shape \[2, 4\]"),
        (lambda f: replace(f, pose=Pose(f.pose.rotations * 2, f.pose.translations)), "of joint 0 has length 2"),
        (lambda f: replace(f, pose=Pose(f.pose.rotations, nan_at(f.pose.translations, 0))), "pose translations is nan"),
        (lambda f: replace(f, mesh=None), "mesh is missing, expected both or neither"),
        (lambda f: replace(f, mesh=torch.tensor(f.mesh, requires_grad=True)), r"mesh is .* tensor\.detach\(\)\.cpu"),
        (
            lambda f: replace(f, texture=torch.tensor(f.texture, requires_grad=True)),
            r"texture is .* tensor\.detach\(\)",
        ),
        (
            lambda f: replace(f, pose=Pose(f.pose.rotations[:, :3], f.pose.translations)),
            r"rotations has shape \[3, 3\], expected \[3, 4\], unit quaternions wxyz; from_axis_angle",
        ),
    ],
)
def test_refuses_a_bad_frame_and_goes_on(tmp_path: Path, change, message: str) -> None:  # type: ignore[no-untyped-def]
    good, second = frames(2)
    bad = change(second)
    with opened(tmp_path) as writer:
        add(writer, good)
        with pytest.raises(InputError, match=f"clip 'walk', frame 1: .*{message}"):
            writer.add(bad.pose, bad.mesh, bad.texture)
        writer.add(second.pose, second.mesh, second.texture)
    assert Recording(tmp_path).count() == 2


def test_refuses_a_first_frame_that_is_not_finite(tmp_path: Path) -> None:
    (frame,) = frames(1)
    with opened(tmp_path) as writer, pytest.raises(InputError, match="is nan"):
        add(writer, replace(frame, texture=nan_at(frame.texture, 3, 3)))
    assert not (tmp_path / "reference.npz").exists()


@pytest.mark.parametrize("rate", [0, -30, 0.5, 1001, float("nan")])
def test_refuses_a_rate_that_no_file_can_hold(tmp_path: Path, rate: float) -> None:
    with pytest.raises(InputError, match=r"rate is .*, expected 1 to 1000 frames per second"):
        opened(tmp_path / "r", rate=rate)
    assert not (tmp_path / "r").exists()


def test_refuses_a_frame_before_a_clip(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="start_clip comes before"):
        opened(tmp_path).add(synthetic_rig().skeleton.bind_pose)


def test_refuses_a_directory_of_another_rig_rate_or_wavelet(written: Path) -> None:
    rig = synthetic_rig()
    other = replace(rig, skin_weights=rig.skin_weights[::-1])
    with pytest.raises(InputError, match=r"rig is .* record into another directory"):
        TeacherWriter(written, other, rate=RATE)
    with pytest.raises(InputError, match=r"rate is 24\.0, expected 30\.0"):
        opened(written, rate=30)
    with pytest.raises(InputError, match=r"wavelet is 'spline3', expected 'bior2\.2'"):
        opened(written, wavelet="bior2.2")


def test_refuses_a_texture_size_that_four_levels_do_not_halve(tmp_path: Path) -> None:
    rig = synthetic_rig()
    with pytest.raises(InputError, match="texture size 40, expected a multiple of 16"):
        TeacherWriter(tmp_path, replace(rig, texels=replace(rig.texels, size=40)), rate=RATE)
