"""Characters of this folder have small atlases: to fill larger ones takes longer than all else that tests do."""

from collections.abc import Iterator

import pytest


@pytest.fixture(autouse=True, scope="module")
def _small_atlases() -> Iterator[None]:
    from mua.baking import sources

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sources, "ATLAS", 256)
        yield
