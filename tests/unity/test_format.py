"""The C# reader gives the values of the Python reader bit for bit, and refuses the same files for the same reasons."""

import zlib
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from csharp import RUNTIME, CSharp
from format_program import values
from synthetic_avatar import sparse_avatar, synthetic_avatar, with_expressions, with_surface
from tree_edits import edited
from wrong_files import write_all, wrong_files

from mua.asset.flatbuffer import FormatError, Tree, parse
from mua.asset.packing import tensors
from mua.asset.read import decode_tree, parse_checked
from mua.asset.tensors import Storage
from mua.asset.write import encode
from mua.bench.random_avatar import random_avatar
from mua.student.settings import preset

GOLDEN = Path(__file__).parents[1] / "golden" / "synthetic.muaavatar"
KEPT = ("packed", "expressions")
CUTS = 211  # every so many bytes both readers are asked, which the Python reader can do in a second


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(with_surface(synthetic_avatar()), storage="i8")


@pytest.fixture(scope="module")
def large() -> bytes:
    """A packed file of megabytes, which the C# reader unpacks by several threads."""
    return encode(random_avatar(preset("tiny")), storage="packed")


def python_answer(content: bytes) -> tuple[str, ...]:
    try:
        decode_tree(parse_checked(content))
    except FormatError as error:
        return error.code, error.field
    return ("ok",)


def python_sentence(content: bytes) -> str:
    with pytest.raises(FormatError) as caught:
        decode_tree(parse_checked(content))
    return f"{caught.value.code}\t{caught.value.field}\t{caught.value}"


def csharp_answers(csharp: CSharp, program: Path, files: list[Path]) -> list[tuple[str, ...]]:
    """`ok`, or code and field for each file."""
    lines = csharp.run(program, "answers", *files).splitlines()
    return [tuple(line.split("\t")[:2]) for line in lines]


def test_format_knows_no_engine(csharp: CSharp) -> None:
    csharp.build([RUNTIME / "Format"], library=True)


@pytest.mark.parametrize("storage", ["golden", "golden packed", "golden expressions", "f32", "f16", "i8", "packed"])
def test_values_are_those_of_the_python_reader(
    csharp: CSharp, program: Path, tmp_path: Path, storage: Storage | str
) -> None:
    kept = {"golden": GOLDEN} | {f"golden {name}": GOLDEN.with_name(f"{name}.muaavatar") for name in KEPT}
    made = with_expressions(sparse_avatar(2))
    sound = kept[storage].read_bytes() if storage in kept else encode(made, storage=storage)  # type: ignore
    require_equal_values(csharp, program, tmp_path, sound)


def test_values_of_a_large_packed_file_are_those_of_the_python_reader(
    csharp: CSharp, program: Path, tmp_path: Path, large: bytes
) -> None:
    require_equal_values(csharp, program, tmp_path, large)


def test_of_many_damaged_tensors_the_first_one_is_named(
    csharp: CSharp, program: Path, tmp_path: Path, large: bytes
) -> None:
    packed = [path for path, tensor in tensors(parse(large)) if tensor["packing"] != "Plain" and len(tensor["data"])]
    assert len(packed) > 10
    files = [edited(large, partial(cut_short, paths=packed[at:])) for at in range(len(packed))]
    expected = [("packed", f"{path}.data") for path in packed]
    assert [python_answer(file) for file in files] == expected
    assert csharp_answers(csharp, program, write_all(tmp_path, files)) == expected


def cut_short(tree: Tree, paths: list[str]) -> None:
    """Take the last byte of some packed tensors."""
    found = dict(tensors(tree))
    for path in paths:
        found[path]["data"] = found[path]["data"][:-1]


def require_equal_values(csharp: CSharp, program: Path, folder: Path, sound: bytes) -> None:
    [path] = write_all(folder, [sound])
    expected = values(parse_checked(sound))
    found = {}
    for line in csharp.run(program, "dump", path).splitlines():
        name, kind, digits = line.split("\t")
        found[name] = (kind, bytes.fromhex(digits))
    assert found.keys() == expected.keys()
    assert [name for name in expected if found[name] != expected[name]] == []


@pytest.mark.parametrize("seed", range(8))
def test_triangles_over_scattered_texels_are_those_of_the_python_reader(
    csharp: CSharp, program: Path, tmp_path: Path, seed: int
) -> None:
    avatar = sparse_avatar(seed)
    assert avatar.surface
    [path] = write_all(tmp_path, [encode(avatar)])
    lines = [line.split("\t") for line in csharp.run(program, "dump", path).splitlines()]
    [found] = [bytes.fromhex(digits) for name, _, digits in lines if name == "surface.triangles"]
    expected = avatar.surface.triangles(avatar.rig.texels)
    np.testing.assert_array_equal(np.frombuffer(found, "<i4").reshape(-1, 3), expected)


def test_every_half_is_expanded_exactly(csharp: CSharp, program: Path) -> None:
    found = bytes.fromhex(csharp.run(program, "halves", GOLDEN).split()[2])
    expected = np.arange(1 << 16, dtype="<u2").view("<f2").astype("<f4")
    np.testing.assert_array_equal(np.frombuffer(found, "<f4"), expected)  # NaN equals NaN, whatever its payload
    np.testing.assert_array_equal(np.signbit(np.frombuffer(found, "<f4")), np.signbit(expected))


def test_checksum_is_that_of_zlib_at_any_length(csharp: CSharp, program: Path, content: bytes) -> None:
    found = csharp.run(program, "checksums", GOLDEN).split()
    golden = GOLDEN.read_bytes()
    assert found == [str(zlib.crc32(golden[: 3 * count + 1])) for count in range(64)]


def test_malformed_files_get_the_same_code_and_field(
    csharp: CSharp, program: Path, tmp_path: Path, content: bytes
) -> None:
    files, expected = wrong_files(content)
    assert csharp_answers(csharp, program, write_all(tmp_path, files)) == expected


@pytest.mark.parametrize("path", [GOLDEN, GOLDEN.with_name("packed.muaavatar")], ids=["plain", "packed"])
def test_truncation_at_every_offset_is_refused_in_the_same_words(csharp: CSharp, program: Path, path: Path) -> None:
    golden = path.read_bytes()
    answers = csharp.run(program, "truncate", path).splitlines()
    assert len(answers) == len(golden)
    assert "ok" not in answers
    cuts = [*range(0, 200), *range(200, len(golden), CUTS)]
    assert [answers[length] for length in cuts] == [python_sentence(golden[:length]) for length in cuts]
