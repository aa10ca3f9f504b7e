"""Serves a site to browsers on this machine alone.

Only the paths of the site are there: no directory is listed, and no other file can be reached, whatever is asked for.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from io import BufferedIOBase, BytesIO
from pathlib import Path, PurePosixPath
from typing import IO, Protocol
from urllib.parse import unquote, urlsplit

from mua.share.site import PAGE, Content, Site

LOOPBACK = "127.0.0.1"
TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wgsl": "text/wgsl; charset=utf-8",
}
BINARY = "application/octet-stream"
BLOCK = 1 << 18  # bytes that are read at once
RANGE = re.compile(r"bytes=(\d{0,18})-(\d{0,18})")  # longer numbers are no file's
LONGEST_REPLY = 32  # bytes of what a page sends


class Stream(Protocol):
    """Texts for pages as server-sent events, and what the pages answer."""

    def texts(self) -> Iterator[str]: ...

    def replied(self, text: str) -> None: ...


@contextmanager
def serving(
    site: Site,
    streams: Mapping[str, Stream] | None = None,  # by path
) -> Iterator[ThreadingHTTPServer]:
    """A server on a free port of the loopback address; `serve_forever` runs it, and it is closed at the end."""
    handler = type("Handler", (_Handler,), {"site": site, "streams": streams or {}})
    server = ThreadingHTTPServer((LOOPBACK, 0), handler)
    server.daemon_threads = True  # a browser that keeps its connection delays nobody
    try:
        yield server
    finally:
        server.server_close()


def address(server: ThreadingHTTPServer) -> str:
    """The URL of a server."""
    return f"http://{LOOPBACK}:{server.server_port}/"


class _Handler(BaseHTTPRequestHandler):
    """Answers one connection."""

    protocol_version = "HTTP/1.1"
    server_version, sys_version = "mua", ""
    disable_nagle_algorithm = True  # a body would wait until the browser has confirmed the header before it
    site: Site
    streams: Mapping[str, Stream]

    def handle(self) -> None:
        """Answer requests until the browser closes or resets the connection."""
        with suppress(ConnectionError):
            super().handle()

    def do_GET(self) -> None:
        stream = self.streams.get(self._named)
        if stream is None:
            self._answer(body=True)
        elif self._is_for_our_page():
            self._send_texts(stream)

    def do_POST(self) -> None:
        size = self.headers.get("Content-Length", "")
        if not (size.isdecimal() and int(size) <= LONGEST_REPLY):
            self.close_connection = True  # what the request holds is not read
            self._refuse(HTTPStatus.BAD_REQUEST)
            return
        reply = self.rfile.read(int(size)).decode(errors="replace")
        if self._is_for_our_page():
            self.streams[self._named].replied(reply)
            self.send_response(HTTPStatus.NO_CONTENT)
            self.end_headers()

    def do_HEAD(self) -> None:
        self._answer(body=False)

    def log_message(self, format: str, *arguments: object) -> None:
        """Log nothing: the page reports failures."""

    @property
    def _named(self) -> str:
        return unquote(urlsplit(self.path).path).removeprefix("/") or PAGE

    @property
    def _is_of_this_machine(self) -> bool:
        """Whether the browser asks for this machine; for another port, too, which ssh may forward to this one."""
        return self.headers.get("Host", "").partition(":")[0] in (LOOPBACK, "localhost")

    def _is_for_our_page(self) -> bool:
        """Refuse a stream to all but pages of this server; where there is none, to them too."""
        ours = self.headers.get("Origin") in (None, f"http://{self.headers.get('Host')}")
        if not (ours and self._is_of_this_machine and self._named in self.streams):
            self._refuse(HTTPStatus.FORBIDDEN)
            return False
        return True

    def _send_texts(self, stream: Stream) -> None:
        """Send a stream until the page has gone."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        for name, value in {"Content-Type": "text/event-stream", "Cache-Control": "no-store"}.items():
            self.send_header(name, value)
        self.end_headers()
        with suppress(OSError):
            for text in stream.texts():
                self.wfile.write(f"data: {text}\n\n".encode())

    def _answer(self, *, body: bool) -> None:
        """Send the file at a path, or the requested part of it."""
        path = self._named
        content = self.site.get(path)
        # Another site whose name leads to this address must not read what is served here.
        if not self._is_of_this_machine:
            self._refuse(HTTPStatus.MISDIRECTED_REQUEST)
            return
        if content is None or (isinstance(content, Path) and not content.is_file()):
            self._refuse(HTTPStatus.NOT_FOUND)
            return
        size = len(content) if isinstance(content, bytes) else content.stat().st_size
        part = self._part(size)
        if part is None:
            self._refuse(HTTPStatus.REQUESTED_RANGE_NOT_SATISFIABLE, {"Content-Range": f"bytes */{size}"})
            return
        first, end = part
        status = HTTPStatus.OK if self._asked() is None else HTTPStatus.PARTIAL_CONTENT
        self._begin(status, PurePosixPath(path).suffix, first, end, size)
        if body:
            self._send(content, first, end)

    def _asked(self) -> re.Match[str] | None:
        """The requested range; several ranges, and other units, may be answered by the whole file."""
        found = RANGE.fullmatch(self.headers.get("Range", "").strip())
        return found if found and (found[1] or found[2]) else None

    def _part(self, size: int) -> tuple[int, int] | None:
        """First byte and end of a range; None where the range is empty."""
        asked = self._asked()
        if asked is None:
            return 0, size
        if not asked[1]:  # the last bytes, by their number
            first, end = max(size - int(asked[2]), 0), size
        else:
            first, end = int(asked[1]), min(int(asked[2]) + 1, size) if asked[2] else size
        return (first, end) if first < end else None

    def _begin(self, status: HTTPStatus, suffix: str, first: int, end: int, size: int) -> None:
        self.send_response(status)
        self.send_header("Content-Type", TYPES.get(suffix, BINARY))
        self.send_header("Content-Length", str(end - first))
        self.send_header("Accept-Ranges", "bytes")
        if status == HTTPStatus.PARTIAL_CONTENT:
            self.send_header("Content-Range", f"bytes {first}-{end - 1}/{size}")
        self.send_header("Cache-Control", "no-store")  # the next run may serve another file at this address
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()

    def _send(self, content: Content, first: int, end: int) -> None:
        try:
            with BytesIO(content) if isinstance(content, bytes) else content.open("rb") as source:
                self.close_connection |= not _copy(source, self.wfile, first, end)
        except OSError:  # the browser went away, or the file did
            self.close_connection = True

    def _refuse(self, status: HTTPStatus, headers: dict[str, str] | None = None) -> None:
        body = f"{status.phrase}\n".encode()
        self.send_response(status)
        for name, value in {"Content-Type": "text/plain", "Content-Length": str(len(body)), **(headers or {})}.items():
            self.send_header(name, value)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)


def _copy(source: IO[bytes], target: BufferedIOBase, first: int, end: int) -> bool:
    """Copy a part; whether all of it was there, which a file that was replaced meanwhile may not have."""
    source.seek(first)
    left = end - first
    while left > 0 and (block := source.read(min(left, BLOCK))):
        target.write(block)
        left -= len(block)
    return left <= 0
