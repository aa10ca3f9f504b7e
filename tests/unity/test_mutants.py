"""Files that nobody wrote: all readers answer alike, in bounded memory; what they accept decodes to finite numbers."""

import json
import resource
import sys
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csharp import CSharp
from format_program import program, values  # noqa: F401 program is a fixture
from mutated_files import expression_mutant, mutant, packed_mutant
from oracle import expressions, file
from oracle.motion import Pose
from readers import SECONDS, Reader, within
from recent_node import NEEDS_NODE
from synthetic_avatar import synthetic_avatar, with_expressions, with_rules, with_surface

from mua.asset.flatbuffer import FormatError, parse
from mua.asset.packing import tensors
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.tensors import Storage
from mua.asset.write import encode
from mua.avatar.decode import decode_clip_frame, express
from mua.limits import MAX_FRAMES, UNPACKED_ROOM, UNPACKED_TIMES
from mua.pose.resample import resample

STORAGES: tuple[Storage, ...] = ("i8", "f16", "f32", "packed")
Made = Callable[[list[bytes], int], bytes]
NEEDS_LINUX = pytest.mark.skipif(
    not sys.platform.startswith("linux"),
    reason="needs Linux, which refuses a process more memory than it may take: any machine with Linux runs this test",
)
MODULES = Path(__file__).parents[1] / "web" / "modules.mjs"
FEW, ALL, BLOCK = 300, 100_000, 10_000
ROOM = 1 << 29  # bytes that reading and decoding one of them may take here: 5,000 times its size
CSHARP_ROOM = 4  # times the file's size that the C# reader may take: 40 clips of 524 bytes take five times their own
WORDS = 20_000  # bytes of a refusal's words
WEB_ROOM = 1 << 29  # bytes that Node and its reading of all these files may take at once
SAME = 1e-6  # in float64: metres of 1, and channels of triangles with edges a millionth of the largest number
STEP = 7  # of so many texels one is bent by the slower decoder
CLIPS = 3  # at most so many of a file are decoded; a mutant may hold one many times


@pytest.fixture
def csharp_reader(csharp: CSharp, program: Path) -> Iterator[Reader]:  # noqa: F811
    with Reader(["mono", program, "digests"]) as reader:
        yield reader


@pytest.fixture
def web_reader() -> Iterator[Reader]:
    with Reader(["node", "--no-warnings", MODULES, "mutants"]) as reader:
        yield reader


def blocks() -> list[Any]:
    """The seeds of a short run, and those of a long one in parts that can be reported apart."""
    return [range(FEW), *(pytest.param(range(k, k + BLOCK), marks=pytest.mark.long) for k in range(0, ALL, BLOCK))]


@NEEDS_LINUX
@NEEDS_NODE
@pytest.mark.parametrize("made", [mutant, packed_mutant], ids=["all", "packed"])
@pytest.mark.parametrize("seeds", blocks(), ids=lambda seeds: f"{seeds.start}-{seeds.stop}")
def test_readers_agree_on_mutants_and_what_they_accept_is_finite(
    csharp_reader: Reader, web_reader: Reader, made: Made, seeds: range
) -> None:
    """In bounded memory and time. The C# reader also gives the values of each file that is accepted; the browser's also
    reads each as one that arrives part by part."""
    storages: tuple[Storage, ...] = ("packed",) if made is packed_mutant else STORAGES
    sound, codes = [encode(with_surface(synthetic_avatar()), storage=storage) for storage in storages], Counter[str]()
    for seed in seeds:
        content, named = made(sound, seed), f"{made.__name__} {seed}"
        csharp_reader.give(content)
        web_reader.give(content)
        with telling(f"Python: {named}"), within(SECONDS), room(ROOM):
            expected = answer(content)
        with telling(f"C#: {named}"):
            allocated, *found = csharp_reader.answer().split("\t")[:3]
        assert (named, *found) == (named, *expected)
        with telling(f"JavaScript: {named}"):
            *found, taken = json.loads(web_reader.answer())
        assert (named, *found) == (named, *(expected if expected[0] != "ok" else ["ok"]))
        assert int(allocated) < CSHARP_ROOM * len(content) + WORDS or int(allocated) < largest(content), named
        assert taken < WEB_ROOM, named
        codes[expected[0]] += 1
    count = len(seeds)
    print(f"{made.__name__} {seeds.start} to {seeds.stop - 1}: {codes['ok']} of {count} accepted, {dict(codes)}")
    assert count / (15 if made is packed_mutant else 5) < codes["ok"] < count * 4 / 5
    assert len(codes) > 8
    assert codes["packed"] > (count / 5 if made is packed_mutant else 0)


@NEEDS_LINUX
@NEEDS_NODE
@pytest.mark.parametrize("seeds", blocks(), ids=lambda seeds: f"{seeds.start}-{seeds.stop}")
def test_mutants_with_expressions_are_refused_or_move_a_face_as_the_page_says(
    csharp_reader: Reader, web_reader: Reader, tmp_path: Path, seeds: range
) -> None:
    """In bounded memory and time, to finite numbers; a decoder written from the page moves and bends as ours does.

    The C# reader answers alike and gives the same values; the browser's answers alike.
    """
    made = with_expressions(synthetic_avatar())
    sound = [encode(with_rules(made) if ruled else made, storage=s) for ruled in (False, True) for s in STORAGES]
    codes, moving = Counter[str](), 0
    for seed in seeds:
        content = expression_mutant(sound, seed)
        csharp_reader.give(content)
        web_reader.give(content)
        with telling(f"expression_mutant {seed}"), within(SECONDS), room(ROOM):
            code, field = answer(content)
            if code == "ok":
                (tmp_path / "a.muaavatar").write_bytes(content)
                moving += moves_alike(tmp_path / "a.muaavatar")
        with telling(f"C#: expression_mutant {seed}"):
            allocated, *found = csharp_reader.answer().split("\t")[:3]
        assert (seed, *found) == (seed, code, field)
        with telling(f"JavaScript: expression_mutant {seed}"):
            *found, taken = json.loads(web_reader.answer())
        assert (seed, *found) == (seed, *([code, field] if code != "ok" else ["ok"]))
        assert taken < WEB_ROOM, seed
        assert int(allocated) < CSHARP_ROOM * len(content) + WORDS or int(allocated) < largest(content), seed
        codes[code] += 1
    print(f"expression_mutant {seeds.start} to {seeds.stop - 1}: {codes['ok']} accepted, {moving} move, {dict(codes)}")
    assert len(seeds) / 5 < moving <= codes["ok"] < len(seeds) * 4 / 5
    assert len(codes) > 8


def moves_alike(path: Path) -> bool:
    """Whether an expression moves anything; fails where two decoders of a file move or bend otherwise."""
    avatar, record = read(path), file.load(path)
    rig, mesh = avatar.rig, avatar.coarse.mean.astype(float)
    weights = np.linspace(0.3, 1, len(avatar.expressions))
    if rig.expressions is None or not np.abs(rig.expressions.offsets).max(initial=0) > 0:
        return False
    texture = np.random.default_rng(0).normal(size=(len(rig.texels.texels), 23))
    found, bent = express(rig, mesh, texture=texture, weights=weights)
    pose = Pose(mesh, mesh, weights)
    moved = expressions.moved(record, pose)
    faces, barycentrics = record.template.faces, rig.texels.barycentrics[::STEP].astype(float)
    corners = faces[record.texels.triangles[::STEP]]
    expected = expressions.bend(texture[::STEP], corners, barycentrics, faces, record.coarse.mean, moved)
    expected = expressions.light(expected, corners, barycentrics, expressions.brightened(record, pose))
    scale = max(np.abs(mesh).max(), np.abs(moved).max())
    np.testing.assert_allclose(found, record.coarse.mean + moved, rtol=0, atol=SAME * scale)
    channels = np.delete(np.arange(23), slice(3, 7))  # quaternions have either sign
    np.testing.assert_allclose(bent[::STEP, channels], expected[:, channels], rtol=0, atol=SAME)
    return True


@contextmanager
def telling(named: str) -> Iterator[None]:
    """Whatever ends the block is reported with this name."""
    try:
        yield
    except Exception as error:
        error.add_note(named)
        raise


def largest(content: bytes) -> int:
    """Bytes that the C# reader may take for a file whose packed tensors give as much as they may."""
    return CSHARP_ROOM * len(content) + 2 * claimed(content) + WORDS


def claimed(content: bytes) -> int:
    """Bytes that the packed tensors of a file may give; each is made twice, in planes and in order."""
    try:
        packed = [tensor for _, tensor in tensors(parse(content)) if tensor["packing"] == "Deflate"]
    except FormatError:
        return 0
    return UNPACKED_TIMES * len(content) + UNPACKED_ROOM if packed else 0


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
