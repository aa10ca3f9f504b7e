"""Fixtures shared by all tests."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait

if TYPE_CHECKING:
    from mua.gpu import Device

SHARED_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


class SharedData:
    """Real inputs that lie beside a checkout; a test that needs an absent one skips and names it."""

    def path(self, name: str) -> Path:
        found = SHARED_DATA / name
        if not found.exists():
            pytest.skip(f"needs shared/data/{name} beside the checkout")
        return found


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
def device() -> Iterator["Device"]:
    """What shaders run on: $MUA_DEVICE as for `open_device`, else the best there is."""
    from mua.gpu import open_device  # here, because few tests need wgpu

    opened = open_device(os.environ.get("MUA_DEVICE"))
    yield opened
    opened.close()
