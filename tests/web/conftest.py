"""The browser of these tests. Those that use it are marked `web`, run by `make test-web`, and skip without it."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from servers import answering
from web.browser import Browser, Page, Serve, lacking

from mua.share.server import address, serving
from mua.share.site import Site, player_files

HERE = Path(__file__).parent
PLAIN = b'<!doctype html><script type="module" src="element.js"></script><mua-avatar></mua-avatar>'


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.is_relative_to(HERE) and "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.web)


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    if missing := lacking():
        pytest.skip(missing)
    opened = Browser()
    yield opened
    opened.close()


@pytest.fixture
def serve() -> Iterator[Serve]:
    """Serves a site for as long as the test runs, and gives its address."""
    with ExitStack() as stack:

        def begin(site: Site) -> str:
            server = stack.enter_context(serving(site))
            stack.enter_context(answering(server))
            return address(server)

        yield begin


@pytest.fixture
def page(browser: Browser, serve: Serve) -> Iterator[Page]:
    """A page with an empty element; at the end nothing was raised in it."""
    with browser.page(serve({**player_files(), "index.html": PLAIN}), size=(160, 200)) as opened:
        opened.wait("Boolean(customElements.get('mua-avatar'))")
        yield opened
        assert opened.reported["errors"] == []
