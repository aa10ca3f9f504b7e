"""The messages of an OSC packet (https://opensoundcontrol.stanford.edu/spec-1_0.html).

Packets come from anybody on the network: a packet is read whole or refused, in time that grows with its length alone.
(python-osc 1.10 reads a bundle whose element has the length -4 for ever.)
"""

import struct
from collections.abc import Iterator
from typing import Any, NamedTuple, TypeAlias

Argument: TypeAlias = int | float | str | bytes | bool | None

BUNDLE = b"#bundle\0"
TIME_TAG = 8  # bytes, after the name of a bundle
DEEPEST = 4  # bundles in one another
SIZE = struct.Struct(">i")
_LAYOUTS = {"i": ">i", "f": ">f", "h": ">q", "d": ">d", "t": ">Q", "c": ">I", "r": ">I", "m": ">I"}
NUMBERS = {tag: struct.Struct(layout) for tag, layout in _LAYOUTS.items()}
CONSTANTS: dict[str, Argument] = {"T": True, "F": False, "N": None, "I": float("inf")}


class Message(NamedTuple):
    """An address and its arguments."""

    address: str
    arguments: tuple[Argument, ...]


class MalformedError(ValueError):
    """A packet that is no OSC."""


def messages(packet: bytes, *, depth: int = 0) -> Iterator[Message]:
    """The messages of a packet, those of bundles in their order; time tags are not waited for.

    Errors: MalformedError, maybe after the messages before the fault.
    """
    if not packet.startswith(BUNDLE):
        yield _message(packet)
        return
    if depth == DEEPEST:
        raise MalformedError(f"bundles are nested more than {DEEPEST} deep")
    at = len(BUNDLE) + TIME_TAG
    if len(packet) < at:
        raise MalformedError("a bundle ends before its time tag")
    while at < len(packet):
        (size,) = _number(packet, at, SIZE)
        at += SIZE.size
        if not 0 < size <= len(packet) - at:
            raise MalformedError(f"an element of a bundle has {size} bytes, {len(packet) - at} are left")
        yield from messages(packet[at : at + size], depth=depth + 1)
        at += size


def _message(packet: bytes) -> Message:
    if not packet.startswith(b"/"):
        raise MalformedError("neither a bundle nor an address begins here")
    address, at = _text(packet, 0)
    if at == len(packet):  # old senders leave out the types of no arguments
        return Message(address, ())
    tags, at = _text(packet, at)
    if not tags.startswith(","):
        raise MalformedError("no list of types follows the address")
    arguments = []
    for tag in tags[1:]:
        argument, at = _argument(packet, at, tag)
        arguments.append(argument)
    return Message(address, tuple(arguments))


def _argument(packet: bytes, at: int, tag: str) -> tuple[Argument, int]:
    """An argument that begins at a byte, and where the next one does."""
    if tag in NUMBERS:
        (number,) = _number(packet, at, NUMBERS[tag])
        return number, at + NUMBERS[tag].size
    if tag in ("s", "S"):
        return _text(packet, at)
    if tag == "b":
        (size,) = _number(packet, at, SIZE)
        at += SIZE.size
        if not 0 <= size <= len(packet) - at:
            raise MalformedError(f"a blob has {size} bytes, more than the packet")
        return packet[at : at + size], at + _padded(size)
    if tag in CONSTANTS:
        return CONSTANTS[tag], at
    raise MalformedError(f"{tag!r} is no type of an argument")


def _number(packet: bytes, at: int, layout: struct.Struct) -> Any:
    try:
        return layout.unpack_from(packet, at)
    except struct.error as error:
        raise MalformedError("the packet ends within a number") from error


def _text(packet: bytes, at: int) -> tuple[str, int]:
    """A text that begins at a byte, and where what follows it does."""
    end = packet.find(b"\0", at)
    if end < 0:
        raise MalformedError("the packet ends within a text")
    try:
        return packet[at:end].decode(), at + _padded(end + 1 - at)
    except UnicodeDecodeError as error:
        raise MalformedError("a text is not UTF-8") from error


def _padded(size: int) -> int:
    return -(-size // 4) * 4
