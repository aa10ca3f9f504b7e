"""OSC packets: what python-osc writes is read as it was meant, anything else is refused."""

import struct

import numpy as np
import pytest
from pythonosc.osc_bundle import OscBundle
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from vmc_senders import bundle, message

from mua.live.osc import DEEPEST, MalformedError, messages

HEAD = b"#bundle\0" + bytes(8)


def test_reads_every_argument_that_python_osc_writes() -> None:
    given = ("text", "", "表情", 3, -4, 0.25, True, False, None, b"12345")
    (found,) = messages(message("/VMC/Ext/T", *given))
    assert found == ("/VMC/Ext/T", given)


def test_reads_bundles_within_bundles_in_their_order() -> None:
    outer = OscBundleBuilder(IMMEDIATELY)
    for number in range(2):
        outer.add_content(OscBundle(bundle((f"/{number}", number), ("/after",))))
    assert [found.address for found in messages(outer.build().dgram)] == ["/0", "/after", "/1", "/after"]


def test_reads_what_follows_a_blob_of_any_length() -> None:
    for length in range(1, 7):
        blob = bytes(range(1, length + 1))
        (found,) = messages(message("/a", blob, 7, "end"))
        assert found.arguments == (blob, 7, "end")


def test_reads_a_message_without_types() -> None:
    (found,) = messages(b"/a\0\0")
    assert found == ("/a", ())


@pytest.mark.parametrize(
    ("packet", "sentence"),
    [
        (b"", "neither a bundle nor an address"),
        (b"abc\0", "neither a bundle nor an address"),
        (b"/abc", "ends within a text"),
        (b"/a\0\0f\0\0\0", "no list of types"),
        (b"/a\0\0,f\0\0\0\0", "ends within a number"),
        (b"/a\0\0,s\0\0abcd", "ends within a text"),
        (b"/a\0\0,s\0\0\xff\xfe\0\0", "not UTF-8"),
        (b"/a\0\0,b\0\0\0\0\0\x08abcd", "a blob has 8 bytes"),
        (b"/a\0\0,b\0\0\xff\xff\xff\xff", "a blob has -1 bytes"),
        (b"/a\0\0,?\0\0", "'\\?' is no type"),
        (b"#bundle\0\0\0\0", "before its time tag"),
        (HEAD + b"\0\0", "ends within a number"),
        (HEAD + struct.pack(">i", -4), "has -4 bytes"),
        (HEAD + struct.pack(">i", 0), "has 0 bytes"),
        (HEAD + struct.pack(">i", 8) + b"/a\0\0", "has 8 bytes, 4 are left"),
    ],
)
def test_refuses_what_is_no_osc(packet: bytes, sentence: str) -> None:
    with pytest.raises(MalformedError, match=sentence):
        list(messages(packet))


def test_refuses_bundles_that_are_nested_too_deep() -> None:
    packet = b"/a\0\0"
    for depth in range(DEEPEST + 1):
        assert len(list(messages(packet))) == 1, depth
        packet = HEAD + struct.pack(">i", len(packet)) + packet
    with pytest.raises(MalformedError, match="nested"):
        list(messages(packet))


def test_any_bytes_are_read_or_refused() -> None:
    random, sound = np.random.default_rng(5), bundle(("/a", "name", 0.5, 3), ("/b", b"blob", True))
    for _ in range(2000):
        packet = bytearray(sound if random.random() < 0.7 else random.bytes(int(random.integers(64))))
        for at in random.integers(len(packet), size=3) if packet else ():
            packet[at] = random.integers(256)
        try:
            list(messages(bytes(packet)))
        except MalformedError:
            continue
