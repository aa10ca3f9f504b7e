"""The server's end of a WebSocket on an open connection (RFC 6455): short texts, in one frame each."""

import base64
import hashlib
import select
import socket
from email.message import Message

PROOF = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # section 1.3
VERSION = "13"
TEXT, CLOSE, WHOLE, MASKED = 0x1, 0x8, 0x80, 0x80  # section 5.2
SHORT, LONG = 125, 0xFFFF  # bytes of a text whose length takes no field of its own, and of one with two bytes of it
MOST = 4096  # bytes of a page that are not read yet


def accept(key: str) -> str:
    """The header Sec-WebSocket-Accept for a Sec-WebSocket-Key."""
    return base64.b64encode(hashlib.sha1((key + PROOF).encode()).digest()).decode()


def asks_for_socket(headers: Message) -> bool:
    """Whether a request begins a WebSocket."""
    return (
        headers.get("Upgrade", "").lower() == "websocket"
        and headers.get("Sec-WebSocket-Version") == VERSION
        and bool(headers.get("Sec-WebSocket-Key"))
    )


class WebSocket:
    """A connection after the handshake; a browser that goes away ends it, whatever it sends."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection, self._waiting = connection, b""

    def send(self, text: str) -> None:
        """Send a text. Errors: OSError where the browser has gone."""
        payload = text.encode()
        size = len(payload)
        head = bytes([WHOLE | TEXT])
        if size <= SHORT:
            head += bytes([size])
        else:
            head += bytes([126]) + size.to_bytes(2) if size <= LONG else bytes([127]) + size.to_bytes(8)
        self._connection.sendall(head + payload)

    def replies(self, seconds: float) -> list[str] | None:
        """The short texts that come within so many seconds; None once the connection is closed or not understood."""
        if not select.select([self._connection], [], [], seconds)[0]:
            return []
        came = self._connection.recv(MOST)
        self._waiting += came
        if not came or len(self._waiting) > MOST:
            return None
        texts = []
        while frame := self._next():
            kind, payload = frame
            if kind != TEXT:
                return None
            texts.append(payload.decode(errors="replace"))
        return texts

    def _next(self) -> tuple[int, bytes] | None:
        """Kind and content of the next whole frame; anything but a short one closes the connection."""
        if len(self._waiting) < 6:
            return None
        first, second = self._waiting[:2]
        size = second & ~MASKED
        if not second & MASKED or size > SHORT:
            return CLOSE, b""
        if len(self._waiting) < 6 + size:
            return None
        mask, masked = self._waiting[2:6], self._waiting[6 : 6 + size]
        self._waiting = self._waiting[6 + size :]
        return first & ~WHOLE, bytes(byte ^ mask[at % 4] for at, byte in enumerate(masked))
