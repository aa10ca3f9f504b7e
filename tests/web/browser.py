"""A headless browser with WebGPU on the CPU, for tests: pages that are opened, used and looked at.

It needs Debian's `chromium-headless-shell` (or `chromium`), Node and the packages of tests/web/package.json.
"""

import json
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mua.share.site import Site

HERE = Path(__file__).parent
PROGRAMS = ("chromium-headless-shell", "chromium", "google-chrome")
DESKTOP, TABLET, PHONE = (1280, 800), (820, 1180), (390, 844)  # CSS pixels
Serve = Callable[[Site], str]  # a site for as long as a test runs, and its address


def lacking() -> str | None:
    """What would have to be installed first; None where nothing is missing."""
    if not any(map(shutil.which, PROGRAMS)):
        return "needs a browser: apt-get install chromium-headless-shell"
    if shutil.which("node") is None:
        return "needs Node 18 or later"
    if not (HERE / "node_modules" / "puppeteer-core").is_dir():
        return "needs the packages of tests/web/package.json: npm ci --prefix tests/web"
    return None


class Browser:
    """A browser process."""

    def __init__(self) -> None:
        program = next(filter(None, map(shutil.which, PROGRAMS)))
        line = ["node", str(HERE / "drive.mjs"), program]
        self._process = subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, op: str, **given: object) -> Any:
        """Carry out one operation of drive.mjs."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"op": op, **given}) + "\n")
        self._process.stdin.flush()
        answer = json.loads(self._process.stdout.readline())
        assert "error" not in answer, answer["error"]
        return answer["value"]

    @contextmanager
    def page(
        self,
        url: str | None = None,
        *,
        size: tuple[int, int] = DESKTOP,  # CSS pixels
        before: str = "",  # a script that runs before those of the page
        touch: bool = False,
        **media: str,  # features, as prefers_color_scheme="dark"
    ) -> Iterator["Page"]:
        """A new page with a profile of its own, at an address if one is given; closed with the block."""
        features = {name.replace("_", "-"): value for name, value in media.items()}
        width, height = size
        number = self.ask("open", width=width, height=height, before=before, touch=touch, media=features)
        page = Page(self, number)
        try:
            if url is not None:
                page.do("goto", url=url)
            yield page
        finally:
            page.do("close")

    def close(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()
        assert self._process.stdout is not None
        self._process.stdout.close()


class Page:
    """A page of it."""

    def __init__(self, browser: Browser, number: int) -> None:
        self._browser, self._number = browser, number

    def do(self, op: str, **given: object) -> Any:
        """An operation of drive.mjs on this page."""
        return self._browser.ask(op, on=self._number, **given)

    def evaluate(self, code: str) -> Any:
        """The value of an expression, of which a promise is awaited."""
        return self.do("evaluate", code=code)

    def wait(self, code: str) -> None:
        """Until an expression is true."""
        self.do("wait", code=code)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.do("press", key=key)

    def screenshot(self, path: Path) -> Path:
        self.do("screenshot", path=str(path))
        return path

    @property
    def reported(self) -> dict[str, list[str]]:
        """What the page wrote to its console, what it raised and what it asked for: console, errors, requests."""
        return dict(self.do("reported"))
