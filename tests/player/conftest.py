"""A window of the interactive player."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from driven_window import Driven

from mua.gpu import Device


@pytest.fixture
def window(device: Device, avatar_files: tuple[Path, ...]) -> Iterator[Driven]:
    driven = Driven(device, avatar_files)
    yield driven
    driven.canvas.close()
