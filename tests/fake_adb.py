"""An adb server on loopback for fake headsets: the parts of its protocol that mua-deploy and `adb push` speak.

The protocol: packages/modules/adb, docs/dev/{services,sync,shell_v2}.md in Android's sources.
"""

import gc
import select
import socket
import socketserver
import stat
import struct
import threading
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest
from fake_headset import FakeHeadset

VERSION = 41
STDOUT, EXIT = 1, 3  # packets of version 2 of the shell protocol


class Cut(Exception):
    """The connection ends here."""


class FakeAdb(socketserver.ThreadingTCPServer):
    """Serves headsets until it is closed; the list may change meanwhile."""

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, headsets: list[FakeHeadset]) -> None:
        super().__init__(("127.0.0.1", 0), Link)
        self.headsets = headsets

    @property
    def port(self) -> int:
        return int(self.server_address[1])


@contextmanager
def serving(monkeypatch: pytest.MonkeyPatch, *headsets: FakeHeadset) -> Iterator[FakeAdb]:
    """A server that adb clients of this process and its children find."""
    with FakeAdb(list(headsets)) as server:
        monkeypatch.setenv("ANDROID_ADB_SERVER_HOST", "127.0.0.1")
        monkeypatch.setenv("ANDROID_ADB_SERVER_PORT", str(server.port))
        monkeypatch.delenv("ANDROID_SERIAL", raising=False)
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()
            with warnings.catch_warnings():  # adbutils leaves a socket open where a device refuses
                warnings.simplefilter("ignore", ResourceWarning)
                gc.collect()


class Link(socketserver.BaseRequestHandler):
    """One connection: requests to the host until one opens a device, then that device's one service."""

    server: FakeAdb
    request: socket.socket

    def handle(self) -> None:
        with suppress(Cut, OSError):
            while (headset := self._host(self._request())) is None:
                pass
            self._service(headset, self._request())

    def _host(self, request: str) -> FakeHeadset | None:
        """Answer the host's own requests; return the headset that the rest of the connection talks to."""
        if request == "host:version":
            self._answer(f"{VERSION:04x}")
        elif request in ("host:features", "host:host-features"):
            self._answer("shell_v2,cmd")
        elif request in ("host:devices", "host:devices-l"):
            self._answer("".join(f"{h.serial}\t{h.state}\n" for h in self.server.headsets))
        elif request.startswith("host-serial:") and request.endswith(":features"):
            self._answer(self._ready(request.split(":")[1]).features)
        elif request.startswith("host:transport:"):
            return self._opened(request.removeprefix("host:transport:"), b"")
        elif request.startswith("host:tport:serial:"):
            return self._opened(request.removeprefix("host:tport:serial:"), struct.pack("<Q", 1))
        else:
            self._refuse(f"unknown host service '{request}'")
        return None

    def _opened(self, serial: str, transport: bytes) -> FakeHeadset:
        headset = self._ready(serial)
        self.request.sendall(b"OKAY" + transport)
        return headset

    def _ready(self, serial: str) -> FakeHeadset:
        headset = next((h for h in self.server.headsets if h.serial == serial), None)
        if headset is None:
            self._refuse(f"device '{serial}' not found")
        elif headset.state != "device":
            self._refuse(f"device {headset.state}.")
        else:
            return headset
        raise Cut

    def _service(self, headset: FakeHeadset, request: str) -> None:
        name, _, command = request.partition(":")
        kind, *options = name.split(",")
        if kind not in ("shell", "sync"):
            self._refuse("closed")
        self.request.sendall(b"OKAY")
        if kind == "sync":
            while self._sync(headset):
                pass
        elif command.startswith("logcat") and "-c" not in command.split():
            self._log(headset)
        else:
            self._shell(headset, command, packets="v2" in options)

    def _shell(self, headset: FakeHeadset, command: str, *, packets: bool) -> None:
        code, text = headset.shell(command)
        content = text.encode()
        if not packets:
            self.request.sendall(content)
            return
        if content:
            self.request.sendall(struct.pack("<BI", STDOUT, len(content)) + content)
        self.request.sendall(struct.pack("<BIB", EXIT, 1, code))

    def _log(self, headset: FakeHeadset) -> None:
        """What the log holds, then each new line, until the reader goes or the test ends it."""
        sent = 0
        while not select.select([self.request], [], [], 0)[0]:  # readable: the reader has closed
            with headset.logged:
                new = headset.log[sent:]
                if not new and headset.log_ends:
                    return
                if not new:
                    headset.logged.wait(0.02)
            self.request.sendall("".join(f"{line}\n" for line in new).encode())
            sent += len(new)

    def _sync(self, headset: FakeHeadset) -> bool:
        """One request of the sync service; False for the last."""
        kind, length = struct.unpack("<4sI", self._read(8))
        if kind == b"QUIT":
            return False
        spec = self._read(length).decode()
        if kind == b"STAT":
            self.request.sendall(b"STAT" + struct.pack("<III", *_stat(headset, spec)))
        elif kind == b"SEND":
            self._receive(headset, spec.rpartition(",")[0])
        else:
            self._sync_fail(f"unknown command {kind!r}")
        return True

    def _receive(self, headset: FakeHeadset, path: str) -> None:
        content = bytearray()
        while True:
            kind, length = struct.unpack("<4sI", self._read(8))
            if kind == b"DONE":
                break
            assert kind == b"DATA"
            assert length <= 64 * 1024
            content += self._read(length)
            if headset.cut_after is not None and len(content) >= headset.cut_after:
                headset.files[path] = bytes(content)  # adbd leaves what had arrived
                if headset.gone_after_cut:
                    self.server.headsets.remove(headset)
                raise Cut
        if headset.refuses_push:
            self._sync_fail(headset.refuses_push)
            return
        headset.write(path, bytes(content))
        self.request.sendall(b"OKAY" + bytes(4))

    def _sync_fail(self, reason: str) -> None:
        self.request.sendall(b"FAIL" + struct.pack("<I", len(reason)) + reason.encode())

    def _request(self) -> str:
        return self._read(int(self._read(4), 16)).decode()

    def _answer(self, text: str) -> None:
        """The answer to a request of the host, after which it closes."""
        self.request.sendall(b"OKAY" + f"{len(text.encode()):04x}{text}".encode())
        raise Cut

    def _refuse(self, reason: str) -> None:
        self.request.sendall(b"FAIL" + f"{len(reason):04x}{reason}".encode())
        raise Cut

    def _read(self, length: int) -> bytes:
        content = b""
        while len(content) < length:
            came = self.request.recv(length - len(content))
            if not came:
                raise Cut
            content += came
        return content


def _stat(headset: FakeHeadset, path: str) -> tuple[int, int, int]:
    if path in headset.files:
        return stat.S_IFREG | 0o644, len(headset.files[path]), int(time.time())
    return (stat.S_IFDIR | 0o755, 4096, int(time.time())) if path.rstrip("/") in headset.folders else (0, 0, 0)
