"""mua-train on damaged recordings, in places where it cannot write, on full disks, and killed at any moment."""

import errno
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import time
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from recordings import write
from trainings import FINISHED, STAGE_NAMES, Training, one_by_one, process

from mua.arrays import Array
from mua.training.checkpoint import Checkpoints

EARLIER = b"an earlier result"


def change(path: Path, how: Callable[[Array], None]) -> None:
    """Rewrite a .npy file with its array changed in place, and its checksum, as another writer might have."""
    array = np.load(path)
    how(array)
    np.save(path, array)
    index = path.with_name("index.json")
    stored = json.loads(index.read_text())
    stored["crc32"][path.name] = zlib.crc32(path.read_bytes())
    index.write_text(json.dumps(stored))


def put(value: float, *at: int) -> Callable[[Array], None]:
    def change_one(array: Array) -> None:
        array[at + (0,) * (array.ndim - len(at))] = value

    return change_one


def saying(name: str, **fields: object) -> Callable[[Path], None]:
    """Fields of a JSON file have other values."""

    def change_fields(recording: Path) -> None:
        path = recording / name
        path.write_text(json.dumps(json.loads(path.read_text()) | fields))

    return change_fields


def with_another_rig(recording: Path) -> None:
    rig = dict(np.load(recording / "rig.npz"))
    rig["vertices"] = rig["vertices"] + 1
    np.savez(recording / "rig.npz", **rig)


def with_nan(name: str, *at: int, value: float = np.nan) -> Callable[[Path], None]:
    return lambda recording: change(recording / "shards" / name, put(value, *at))


def with_a_bit_flipped(name: str) -> Callable[[Path], None]:
    def flip(recording: Path) -> None:
        path = recording / "shards" / name
        content = bytearray(path.read_bytes())
        content[-9] ^= 1
        path.write_bytes(content)

    return flip


DAMAGES = {
    "missing shard": (lambda recording: shutil.rmtree(recording / "shards/00001"), "shard 00001 is missing"),
    "shard of another rig": (
        saying("shards/00001/index.json", rig="0" * 64),
        "00001/index.json: holds frames of another",
    ),
    "another rig": (with_another_rig, "rig.npz: is not the rig"),
    "odd texture size": (saying("recording.json", texels=40), "texels is 40, expected a multiple of 16"),
    "nan in a mesh": (with_nan("00000/meshes.npy", 1), "00000/meshes.npy: frame 2 of 'walk'"),
    "nan in LL": (with_nan("00001/ll.npy", 0), "00001/ll.npy: frame 8 of 'walk'"),
    "nan in D2's last channel": (with_nan("00001/d2.npy", 3, 2, 22), "00001/d2.npy: frame 14 of 'walk'"),
    "infinity in D3": (with_nan("00000/d3.npy", 3, value=np.inf), "00000/d3.npy: frame 6 of 'walk'"),
    "nan in a pose": (with_nan("00000/rotations.npy", 2), "00000/rotations.npy: a pose"),
    "nan in the sum": (with_nan("00006/sum.npy"), "00006/sum.npy: the sum"),
    **{
        f"a bit of {name}": (with_a_bit_flipped(f"{name}.npy"), f"{name}.npy: is damaged: its checksum differs")
        for name in (
            *("00000/rotations", "00001/translations", "00000/meshes", "00000/whole_00000"),
            *("00001/ll", "00001/d3", "00000/d2", "00006/sum"),
        )
    },
    "nan in a whole frame": (with_nan("00000/whole_00000.npy"), "whole_00000.npy: frame 0 of 'walk'"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_rejects_a_damaged_recording(written: Path, tmp_path: Path, mua_train: Training, damage: str) -> None:
    how, message = DAMAGES[damage]
    recording, output = Path(shutil.copytree(written, tmp_path / "recording")), tmp_path / "a.muaavatar"
    how(recording)
    output.write_bytes(EARLIER)
    assert message in mua_train(recording).sentence
    assert not list(tmp_path.rglob("*.part*"))
    if "whole" not in damage:  # a frame kept whole is read to measure the finished avatar
        assert output.read_bytes() == EARLIER


def a_file(directory: Path) -> Path:
    (directory / "file").write_bytes(EARLIER)
    return directory / "file" / "a.muaavatar"


def a_directory(directory: Path) -> Path:
    (directory / "a.muaavatar").mkdir()
    return directory / "a.muaavatar"


def read_only(directory: Path) -> Path:
    (directory / "closed").mkdir(mode=0o500)
    return directory / "closed" / "a.muaavatar"


def refuse(path: Path) -> None:
    raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))


PLACES = {
    "below a file": (a_file, "cannot be written ({parent} is no directory)"),
    "a directory": (a_directory, "is a directory, expected a file to write"),
    "read-only": (read_only, "cannot be written (Permission denied)"),
}


@pytest.mark.parametrize("place", PLACES)
def test_an_output_that_cannot_be_is_named_before_any_training(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mua_train: Training, place: str
) -> None:
    where, expected = PLACES[place]
    output = where(tmp_path)
    if where is read_only and os.geteuid() == 0:  # root may write anywhere: the system's answer to other users
        monkeypatch.setattr(Path, "touch", refuse)
    ended = mua_train(written, output=output)
    assert f"{output}: {expected.format(parent=output.parent)}" in ended.sentence
    assert not set(ended.out.splitlines()) & set(STAGE_NAMES)


@contextmanager
def disk_of(size: int) -> Iterator[None]:
    """Within the block the system refuses whatever lies beyond the first `size` bytes of any file."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.parametrize("stage", ["coarse mesh", "geometry bases", "geometry fine-tuning"])
def test_a_checkpoint_that_finds_no_room_costs_nothing_trained_before(
    written: Path, trained: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mua_train: Training, stage: str
) -> None:
    room = (trained.with_suffix(".work") / f"student/{stage}.pt").stat().st_size - 1
    save = Checkpoints.save

    def save_on_small_disk(self: Checkpoints, name: str, state: dict[str, Any]) -> None:
        with disk_of(room) if name == stage else nullcontext():
            save(self, name, state)

    monkeypatch.setattr("mua.student.branches.together", one_by_one)  # so that it is known which one finds no room
    with monkeypatch.context() as small:
        small.setattr(Checkpoints, "save", save_on_small_disk)
        ended = mua_train(written)
    assert f"{stage}.pt: cannot be written (File too large)" in ended.sentence
    begun = [name for name in dict.fromkeys(ended.out.splitlines()) if name in STAGE_NAMES]
    assert begun[-1] == stage
    assert {path.stem for path in tmp_path.rglob("*.pt")} & set(STAGE_NAMES) == set(begun[:-1])
    repeated = set(mua_train(written).out.splitlines()) & set(STAGE_NAMES)
    assert repeated == set(STAGE_NAMES) - set(begun[:-1])
    assert (tmp_path / "a.muaavatar").read_bytes() == trained.read_bytes()


def test_an_avatar_that_finds_no_room_leaves_the_earlier_one_and_all_that_was_trained(
    written: Path, trained: Path, tmp_path: Path, mua_train: Training
) -> None:
    output = tmp_path / "a.muaavatar"
    shutil.copytree(trained.with_suffix(".work"), tmp_path / "a.work")
    output.write_bytes(EARLIER)
    with disk_of(trained.stat().st_size - 1):
        message = mua_train(written).sentence
    assert f"{output}: cannot be written (File too large); the previous file" in message
    assert output.read_bytes() == EARLIER
    assert not list(tmp_path.rglob("*.part*"))
    assert not set(mua_train(written).out.splitlines()) & set(STAGE_NAMES)
    assert output.read_bytes() == trained.read_bytes()


def test_a_full_disk_while_recording_is_reported(written: Path, tmp_path: Path) -> None:
    with (
        disk_of((written / "shards/00006/sum.npy").stat().st_size - 1),
        pytest.raises(ValueError, match=r"\.npy: cannot be written .*; earlier shards are kept"),
    ):
        write(tmp_path / "recording")


def test_a_gpu_that_is_too_small_is_reported(
    written: Path, monkeypatch: pytest.MonkeyPatch, mua_train: Training
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise torch.cuda.OutOfMemoryError("CUDA out of memory. Tried to allocate 2.00 GiB. GPU 0 has ...")

    monkeypatch.setattr("mua.student.distil.train", fail)
    assert "its memory is too small (CUDA out of memory); what was" in mua_train(written).sentence


@pytest.mark.long
def test_killed_at_any_moment_it_ends_in_the_same_bytes(written: Path, trained: Path, tmp_path: Path) -> None:
    """kill -9, three times at a random moment after a stage was announced; then a run that nothing disturbs."""
    moment = random.Random(7)
    output = tmp_path / "a.muaavatar"
    for stage in ("coarse mesh", "geometry coefficients", "avatar"):
        killed = subprocess.Popen(process(written, output), stdout=subprocess.PIPE, text=True)
        assert killed.stdout is not None
        for line in killed.stdout:
            if line.strip() == stage:
                time.sleep(moment.uniform(0, 0.05))
                break
        killed.send_signal(signal.SIGKILL)
        killed.communicate()
        assert killed.returncode == -signal.SIGKILL  # it had not ended by itself
    subprocess.run(process(written, output), check=True, stdout=subprocess.DEVNULL)
    assert output.read_bytes() == trained.read_bytes()
    assert not list(tmp_path.rglob("*.part*"))


@pytest.mark.parametrize("left", ["a.work/student/.coarse mesh.{}.part.pt", ".a.{}.part.muaavatar"])
def test_removes_what_a_killed_run_left(
    written: Path, trained: Path, tmp_path: Path, mua_train: Training, left: str
) -> None:
    with subprocess.Popen(["true"]) as killed:
        left = left.format(killed.pid)
    shutil.copytree(trained.with_suffix(".work"), tmp_path / "a.work")
    (tmp_path / left).write_bytes(b"half")
    assert mua_train(written).status in FINISHED
    assert not (tmp_path / left).exists()
