"""Fixtures shared by all tests."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if workers := os.environ.get("PYTEST_XDIST_WORKER_COUNT"):  # before torch: each has its share of the cores
    os.environ.setdefault("OMP_NUM_THREADS", str(max(1, (os.cpu_count() or 1) // int(workers))))

import pytest
from shared_data import SharedData

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait

if TYPE_CHECKING:
    from mua.compare.system import TrainingFrames
    from mua.gpu import Device
    from mua.recording import Recording


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
def smooth_recording(tmp_path_factory: pytest.TempPathFactory) -> "Recording":
    """A smooth teacher's frames, in which every compared system finds something to learn."""
    import compared  # here, because few tests need torch

    return compared.smooth_recording(tmp_path_factory.mktemp("smooth"))


@pytest.fixture(scope="session")
def smooth_frames(smooth_recording: "Recording") -> "TrainingFrames":
    """The same, as compared systems are given them."""
    import compared

    return compared.smooth_frames(smooth_recording)


@pytest.fixture(scope="session")
def device() -> Iterator["Device"]:
    """What shaders run on: $MUA_DEVICE as for `open_device`, else the best there is."""
    from mua.gpu import open_device  # here, because few tests need wgpu

    opened = open_device(os.environ.get("MUA_DEVICE"))
    yield opened
    opened.close()
