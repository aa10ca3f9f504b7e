"""A file whose connection breaks: the rest is asked for by range, and what cannot be had is a sentence."""

import gzip
from collections.abc import Iterator
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Event

import pytest
from servers import answering
from synthetic_avatar import synthetic_avatar
from web.browser import Page
from web.pages import ELEMENT, SENTENCE

from mua.asset.write import encode

LOADED = f"{ELEMENT}.firstPicture > 0 && {ELEMENT}.avatars[0]?.whole"
TIMEOUT = 60  # seconds, after which a server no longer waits for a test that failed
BREAK = 10_000  # bytes after which the first answer breaks off


@dataclass(frozen=True)
class Answer:
    """What is sent after the connection has broken."""

    status: int
    length: int  # that is claimed; negative where none is
    body: bytes
    etag: str = "one"
    headers: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Breaking:
    """A server whose first answer breaks off, and what it was asked for."""

    address: str
    asked: list[str | None]  # the range of each request
    answers: list[Answer]  # to the requests after the first
    first: list[Answer]  # to the first one, where it is not the beginning of the file
    arrived: Event  # of what was sent before the connection breaks


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(synthetic_avatar())


@pytest.fixture
def breaking(content: bytes) -> Iterator[Breaking]:
    asked: list[str | None] = []
    answers: list[Answer] = []
    firsts: list[Answer] = []
    arrived = Event()

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            first = firsts[0] if firsts else Answer(200, len(content), content[:BREAK])
            answer = answers[min(len(asked) - 1, len(answers) - 1)] if asked else first
            asked.append(self.headers.get("Range"))
            self.send_response(answer.status)
            if answer.length >= 0:
                self.send_header("Content-Length", str(answer.length))
            self.send_header("ETag", answer.etag)
            self.send_header("Access-Control-Allow-Origin", "*")
            self.send_header("Access-Control-Expose-Headers", "ETag, Content-Range")
            for name, value in answer.headers:
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(answer.body)
            self.wfile.flush()
            arrived.wait(TIMEOUT)  # a browser forgets what it has not handed on when the connection breaks

        def log_message(self, format: str, *arguments: object) -> None:
            """Say nothing."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server, answering(server):
        yield Breaking(f"http://127.0.0.1:{server.server_port}/a.muaavatar", asked, answers, firsts, arrived)
        arrived.set()


def load(page: Page, breaking: Breaking, *answers: Answer, until: str) -> None:
    breaking.answers.extend(answers)
    page.evaluate(f"{ELEMENT}.setAttribute('src', '{breaking.address}')")
    page.wait(f"{SENTENCE}.includes('Fetching')")
    breaking.arrived.set()
    page.wait(until)


def test_what_is_not_there_when_the_connection_breaks_is_asked_for_by_range(
    page: Page, breaking: Breaking, content: bytes
) -> None:
    rest = content[BREAK:]
    load(page, breaking, Answer(206, len(rest), rest), until=LOADED)
    assert breaking.asked == [None, f"bytes={BREAK}-"]


@pytest.mark.parametrize("exposed", [True, False])
def test_a_proxy_that_compresses_a_file_gives_it_whole(
    page: Page, breaking: Breaking, content: bytes, exposed: bool
) -> None:
    """Whose length is that of the compressed bytes; a page of another address may know of the compression or not."""
    headers = [("Content-Encoding", "gzip")]
    if exposed:
        headers.append(("Access-Control-Expose-Headers", "Content-Encoding"))
    compressed = gzip.compress(content)
    breaking.first.append(Answer(200, len(compressed), compressed, headers=tuple(headers)))
    breaking.arrived.set()
    page.evaluate(f"{ELEMENT}.setAttribute('src', '{breaking.address}')")
    page.wait(LOADED)
    assert breaking.asked == [None]


def test_a_compressed_file_that_breaks_off_is_a_sentence(page: Page, breaking: Breaking, content: bytes) -> None:
    """Nobody knows where in the file as it stands on the server to go on."""
    compressed = gzip.compress(content)
    headers = (("Content-Encoding", "gzip"), ("Access-Control-Expose-Headers", "Content-Encoding"))
    breaking.first.append(Answer(200, len(compressed), compressed[:BREAK], headers=headers))
    load(page, breaking, until=f"{SENTENCE}.includes('was not fetched whole')")
    assert breaking.asked == [None]


def test_a_file_that_ends_early_where_no_length_was_told_is_a_sentence(
    page: Page, breaking: Breaking, content: bytes
) -> None:
    breaking.first.append(Answer(200, -1, content[:BREAK]))
    load(page, breaking, until=f"{SENTENCE}.includes('it is cut short')")
