"""Listens for VMC on a UDP port, in a thread of its own."""

import select
import socket
import time
from collections import deque
from dataclasses import dataclass
from threading import Lock, Thread
from types import TracebackType
from typing import Self

import numpy as np

from mua.arguments import amount
from mua.errors import InputError
from mua.live.vmc import Assembler, Counts, Frame

LOOPBACK = "127.0.0.1"
LARGEST = 65535  # bytes of a packet
AT_ONCE = 0.005  # seconds: whoever floods the port does not stop what is drawn
REMEMBERED = 600  # latencies: of ten seconds


@dataclass(frozen=True)
class Address:
    """Where to listen; only this machine can reach the loopback address."""

    port: int  # 0: any that is free
    host: str = LOOPBACK

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"


class Latency:
    """How long it took from packets to pictures, of the newest ones."""

    def __init__(self) -> None:
        self._seconds: deque[float] = deque(maxlen=REMEMBERED)
        self._arrived: float | None = None

    def drawn(self, arrived: float | None, now: float) -> None:
        """Note that a picture has been drawn of what arrived at a time; later pictures of the same are not counted."""
        if arrived is not None and arrived != self._arrived:
            self._seconds.append(now - arrived)
        self._arrived = arrived

    def __str__(self) -> str:
        if not self._seconds:
            return "no picture yet"
        middle, late = np.quantile(self._seconds, (0.5, 0.95)) * 1e3
        return f"{middle:.0f} ms from packet to picture (95 % within {late:.0f} ms)"


class Receiver:
    """What has come so far on an open port; any number of avatars may follow it. Close it at the end."""

    def __init__(self, address: Address) -> None:
        """Open the port. Errors: InputError where it is taken, or no such address is of this machine."""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((address.host, address.port))
        except OSError as error:
            self._socket.close()
            raise InputError(f"--listen is {address}; that port cannot be opened: {error.strerror or error}") from error
        self._socket.setblocking(False)
        self.address = Address(self._socket.getsockname()[1], address.host)
        self.latency = Latency()
        self._assembler, self._lock, self._open = Assembler(), Lock(), True
        self._end, self._ended = socket.socketpair()  # closing one wakes the thread, whoever takes the packets
        self._thread = Thread(target=self._run, name="VMC", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Close the port; nothing comes any more."""
        if self._open:
            self._open = False
            self._end.close()
            self._thread.join()
            self._ended.close()
            self._socket.close()

    @property
    def counts(self) -> Counts:
        """What has come so far."""
        return self._assembler.counts

    @property
    def figures(self) -> str:
        """What has come so far and how late it was shown, in one line."""
        counts = self.counts
        parts = [f"{amount(counts.packets, 'packet')}, {amount(counts.frames, 'pose')}, {self.latency}"]
        parts += [f"{counts.malformed:,} packets are no OSC and were dropped"] if counts.malformed else []
        parts += [f"{counts.ignored:,} values mean nothing and were ignored"] if counts.ignored else []
        return "; ".join(parts)

    def newest(self, now: float) -> Frame | None:
        """The newest whole frame at a time of time.monotonic()."""
        with self._lock:
            self._take()
            self._assembler.settle(now)
            return self._assembler.newest

    def _run(self) -> None:
        while self._open:
            select.select([self._socket, self._ended], [], [])
            with self._lock:
                self._take()

    def _take(self) -> None:
        """Take the packets that wait; on a busy machine the thread that draws does, before the other has its turn."""
        until = time.monotonic() + AT_ONCE
        while time.monotonic() < until:
            try:
                packet = self._socket.recv(LARGEST)
            except OSError:  # none waits, or Windows has something to say of another
                return
            self._assembler.feed(packet, time.monotonic())
