"""Files that nobody wrote: both readers answer alike, in bounded memory; what they accept decodes to finite numbers."""

import resource
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from csharp import CSharp
from mutants import mutants, packed_mutants
from synthetic_avatar import synthetic_avatar, with_surface
from test_format import program, values, write_all  # noqa: F401 program is a fixture

from mua.asset.flatbuffer import FormatError, parse
from mua.asset.packing import ROOM as UNPACKED
from mua.asset.packing import TIMES, tensors
from mua.asset.read import MAX_FRAMES, decode_tree, parse_checked
from mua.asset.tensors import Storage
from mua.asset.write import encode
from mua.decode import decode_clip_frame
from mua.pose.resample import resample

STORAGES: tuple[Storage, ...] = ("i8", "f16", "f32", "packed")
Made = Callable[[list[bytes], np.random.Generator, int], Iterator[bytes]]
BATCH = 500  # files on the disk at once
ROOM = 1 << 29  # bytes that reading and decoding one of them may take here: 5,000 times its size
CSHARP_ROOM = 3  # times the file's size that the C# reader may take: many small tables, beside the words of a refusal
WORDS = 20_000
CLIPS = 3  # of a file that are decoded; a mutant may hold one many times


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs Linux, which bounds what a process may take")
@pytest.mark.parametrize("made", [mutants, packed_mutants], ids=["all", "packed"])
@pytest.mark.parametrize("count", [300, pytest.param(100_000, marks=pytest.mark.long)])
def test_readers_agree_on_mutants_and_what_they_accept_is_finite(
    csharp: CSharp,
    program: Path,  # noqa: F811
    tmp_path: Path,
    made: Made,
    count: int,
) -> None:
    """The C# reader also gives the values of each file that is accepted."""
    storages: tuple[Storage, ...] = ("packed",) if made is packed_mutants else STORAGES
    contents = [encode(with_surface(synthetic_avatar()), storage=storage) for storage in storages]
    files = made(contents, np.random.default_rng(count), count)
    codes = Counter[str]()
    while some := list(islice(files, BATCH)):
        with room(ROOM):
            expected = [answer(content) for content in some]
        lines = csharp.run(program, "digests", *write_all(tmp_path, some)).splitlines()
        found = [tuple(line.split("\t")[:3]) for line in lines]
        first = sum(codes.values())
        assert {first + k: line[1:] for k, line in enumerate(found)} == {
            first + k: own for k, own in enumerate(expected)
        }
        for (allocated, *_), content in zip(found, some, strict=True):
            assert int(allocated) < CSHARP_ROOM * len(content) + 2 * claimed(content) + WORDS
        codes.update(code for code, _ in expected)
    assert count / (10 if made is packed_mutants else 5) < codes["ok"] < count * 4 / 5
    assert len(codes) > 8
    assert codes["packed"] > (count / 5 if made is packed_mutants else 0)


def claimed(content: bytes) -> int:
    """Bytes that the packed tensors of a file may give; each is made twice, in planes and in order."""
    try:
        packed = [tensor for _, tensor in tensors(parse(content)) if tensor["packing"] == "Deflate"]
    except FormatError:
        return 0
    return TIMES * len(content) + UNPACKED if packed else 0


def answer(content: bytes) -> tuple[str, str]:
    """Code and field of the refusal, or "ok" and a digest of all values once the avatar has been decoded."""
    try:
        tree = parse_checked(content)
        avatar = decode_tree(tree)
    except FormatError as error:
        return error.code, error.field
    for clip in avatar.clips[:CLIPS]:
        played = resample(clip, avatar.encoding.rate)
        assert len(played) <= MAX_FRAMES
        frame = decode_clip_frame(avatar, played, frame=min(3, len(played) - 1))
        assert all(np.isfinite(values).all() for values in vars(frame).values() if values is not None)
    parts = (zlib.crc32(data, zlib.crc32((name + kind).encode())) for name, (kind, data) in values(tree).items())
    return "ok", str(sum(parts))


@contextmanager
def room(size: int) -> Iterator[None]:
    """Within the block this process is refused more than `size` bytes beyond what it has."""
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (taken + size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
