"""Real inputs that lie beside a checkout."""

from pathlib import Path

import pytest

SHARED_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


class SharedData:
    """A test that needs a file that is absent skips and names it."""

    def path(self, name: str) -> Path:
        found = SHARED_DATA / name
        if not found.exists():
            pytest.skip(f"needs shared/data/{name} beside the checkout")
        return found
