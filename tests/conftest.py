"""Fixtures shared by all tests."""

import gc
import os
import sys
from collections.abc import Generator, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if workers := os.environ.get("PYTEST_XDIST_WORKER_COUNT"):  # before torch: each has its share of the cores
    os.environ.setdefault("OMP_NUM_THREADS", str(max(1, (os.cpu_count() or 1) // int(workers))))

import numpy as np
import pytest
from commands import Commands, Ended
from shared_data import SharedData
from synthetic_avatar import synthetic_avatar, with_expressions

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.asset import write
from mua.pose.clip import Clip

if TYPE_CHECKING:
    import socket

    from trainings import Training

    from mua.capture import Capture
    from mua.gpu import Device
    from mua.recording import Recording
    from mua_research.system import TrainingFrames


RARELY = (20_000, 20, 20)  # objects between collections of garbage, and how many of each kind between larger ones


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Spare the garbage collector what lives as long as the run: modules and tests, a million objects."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()
        gc.set_threshold(*RARELY)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Say how to run the same order again."""
    seed = config.getoption("randomly_seed", None)
    if isinstance(seed, int):
        terminalreporter.write_line(f"random order; the same again: pytest --randomly-seed={seed}")


@pytest.fixture(scope="session")
def shared_data() -> SharedData:
    return SharedData()


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording that nothing disturbed; tests leave it as it is."""
    from recordings import write  # here, because few tests need torch

    directory = tmp_path_factory.mktemp("recordings") / "undisturbed"
    write(directory)
    return directory


@pytest.fixture(scope="session")
def small_capture(tmp_path_factory: pytest.TempPathFactory) -> "Capture":
    """A capture of the procedural character by four cameras; tests leave it as it is."""
    from captures import make_capture  # here, because few tests need one

    return make_capture(tmp_path_factory.mktemp("captures") / "figure")


@pytest.fixture
def avatar_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The synthetic avatar, a.muaavatar."""
    path = tmp_path_factory.mktemp("avatar") / "a.muaavatar"
    write(path, synthetic_avatar())
    return path


@pytest.fixture(scope="session")
def avatar_files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ...]:
    """Two avatars, the second with one clip more and a face, and a broken one."""
    directory, avatar = tmp_path_factory.mktemp("avatars"), synthetic_avatar(1)
    clip = avatar.clips[0]
    longer = Clip("twice", clip.rate, np.tile(clip.rotations, (2, 1, 1)), np.tile(clip.translations, (2, 1, 1)))
    write(directory / "first.muaavatar", synthetic_avatar(0))
    write(directory / "second.muaavatar", replace(with_expressions(avatar), clips=(clip, longer)))
    (directory / "broken.muaavatar").write_bytes(b"not an avatar")
    return tuple(directory / f"{name}.muaavatar" for name in ("first", "second", "broken"))


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Commands:
    """Runs commands in this process."""
    return Commands(monkeypatch, capsys)


@pytest.fixture
def mua_train(command: Commands, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> "Training":
    """mua-train with a small preset: of a recording, with options, to a.muaavatar if no other output is given."""
    import trainings  # here, because few tests need torch

    trainings.be_small(monkeypatch)

    def train(recording: Path, *more: object, output: Path = tmp_path / "a.muaavatar") -> Ended:
        return command("train", *trainings.arguments(recording, output), *more)

    return train


@pytest.fixture(scope="session", autouse=True)
def _kept_atlases() -> Iterator[None]:
    """Characters that were read before are read with the atlas that was built for them then."""
    from atlases import keep_atlases  # after mua.cli

    with pytest.MonkeyPatch.context() as patch:
        keep_atlases(patch)
        yield


@pytest.fixture(scope="session")
def _fork_server() -> Iterator["socket.socket"]:
    from forked_workers import fork_server  # here, because few tests need torch

    with fork_server() as server:
        yield server


@pytest.fixture
def forked(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    """Processes that record are forked on Linux, for tests that do not look at how they are started."""
    from forked_workers import fork_workers  # here, because few tests need torch

    if sys.platform == "linux":
        fork_workers(monkeypatch, request.getfixturevalue("_fork_server"))


@pytest.fixture
def first_try(monkeypatch: pytest.MonkeyPatch) -> None:
    """Charts may lie anywhere: the first layout is taken, on a grid of half as many cells a side."""
    from mua.atlas import chart_packing, packing_grid  # here, because few tests need it

    monkeypatch.setattr(chart_packing, "TRIES", chart_packing.TRIES[:1])
    half = packing_grid.GRID // 2
    for module in (chart_packing, packing_grid):
        monkeypatch.setattr(module, "GRID", half)


@pytest.fixture
def untimed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that are compared are not timed, for tests that look at nothing of the kind."""
    from mua.evaluation import entries  # here, because few tests need torch

    monkeypatch.setattr(entries, "frames_per_second", lambda *_, **__: 30.0)


@pytest.fixture(scope="session")
def trained(written: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The avatar that mua-train makes of `written`, its working files beside it; tests leave them as they are."""
    import trainings

    from mua.cli import train

    output = tmp_path_factory.mktemp("trained") / "new" / "a.muaavatar"
    with pytest.MonkeyPatch.context() as monkeypatch:
        trainings.be_small(monkeypatch)
        monkeypatch.setattr("sys.argv", ["mua-train", *trainings.arguments(written, output)])
        with pytest.raises(SystemExit) as ended:
            train.run()
    assert ended.value.code in trainings.FINISHED
    return output


@pytest.fixture(scope="session")
def smooth_recording(tmp_path_factory: pytest.TempPathFactory) -> "Recording":
    """A smooth teacher's frames, which every compared system can fit."""
    import compared_systems  # here, because few tests need torch

    return compared_systems.smooth_recording(tmp_path_factory.mktemp("smooth"))


@pytest.fixture(scope="session")
def smooth_frames(smooth_recording: "Recording") -> "TrainingFrames":
    """The same, as compared systems are given them."""
    import compared_systems

    return compared_systems.smooth_frames(smooth_recording)


@pytest.fixture(scope="session")
def device() -> Iterator["Device"]:
    """The device for shaders: $MUA_DEVICE as for `open_device`, else the best one."""
    from mua.gpu import open_device  # here, because few tests need wgpu

    opened = open_device(os.environ.get("MUA_DEVICE"))
    yield opened
    opened.close()
