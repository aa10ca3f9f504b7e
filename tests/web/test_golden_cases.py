"""The kernels meet the golden cases in a browser's own WGSL compiler, dispatched by the player's own modules."""

import base64
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from web.browser import Browser, Page

from mua.share.server import address, serving
from mua.share.site import player_files

sys.path.append(str(Path(__file__).parents[1] / "parity"))
from golden import FOLDER, Golden, read_golden
from servers import answering
from test_golden import assert_met

ALL = read_golden()
SCRIPT = Path(__file__).with_name("golden.js")


@pytest.fixture(scope="module")
def page(browser: Browser) -> Iterator[Page]:
    cases = {f"golden/{path.name}": path for path in FOLDER.glob("*.*")}
    page_file = b'<!doctype html><script type="module" src="golden.js"></script>'
    with (
        serving({**player_files(), **cases, "golden.js": SCRIPT, "index.html": page_file}) as server,
        answering(server),
        browser.page(address(server)) as opened,
    ):
        opened.wait("globalThis.replay !== undefined")
        yield opened


@pytest.mark.parametrize("golden", ALL, ids=str)
def test_the_browser_meets_the_golden_case(page: Page, golden: Golden) -> None:
    stem = Path(golden.kernel).stem
    number = [other.case for other in ALL if other.kernel == golden.kernel].index(golden.case)
    found = page.evaluate(f'replay("{stem}", {number})')
    assert page.reported["console"] == []
    words = {name: np.frombuffer(base64.b64decode(text), "<u4") for name, text in found.items()}
    assert_met(golden, words)
