"""Programs that are given file after file: their answers, and what is told of one that hangs or ends."""

import sys
import time

import pytest
from readers import Hangs, Reader, within

ECHO = """
import struct, sys
for _ in range(3):
    [size] = struct.unpack("<I", sys.stdin.buffer.read(4))
    print(len(sys.stdin.buffer.read(size)), flush=True)
sys.exit("that was all")
"""


def test_each_file_gets_its_answer_until_the_program_ends_with_its_words() -> None:
    with Reader([sys.executable, "-c", ECHO]) as reader:
        for content in (b"", b"abc", bytes(1 << 18)):  # more than a pipe holds
            reader.give(content)
            assert reader.answer() == str(len(content))
        reader.give(b"more")
        with pytest.raises(ChildProcessError, match="ended with 1: that was all"):
            reader.answer()


def test_a_program_that_does_not_answer_hangs() -> None:
    with Reader([sys.executable, "-c", "import time; time.sleep(600)"], seconds=0.1) as reader:
        reader.give(b"")
        with pytest.raises(Hangs, match=r"no answer within 0\.1 s"):
            reader.answer()


def test_a_block_that_takes_too_long_is_broken_off() -> None:
    with pytest.raises(Hangs, match=r"no answer within 0\.05 s"), within(0.05):
        time.sleep(600)
    with within(0.05):
        pass
    time.sleep(0.1)  # nothing comes after its end
