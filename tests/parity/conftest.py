"""The device that the shaders are held against their references on."""

import os
from collections.abc import Iterator

import pytest

from mua.gpu import Device, open_device


@pytest.fixture(scope="session")
def device() -> Iterator[Device]:
    """$MUA_DEVICE as for `open_device`, else the best there is."""
    opened = open_device(os.environ.get("MUA_DEVICE"))
    yield opened
    opened.close()
