"""The reader trusts nothing: every way to be wrong ends in one FormatError with its code and field."""

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.asset.flatbuffer import FormatError, Tree, build, parse
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.tensors import pack, pack_indices
from mua.asset.write import encode, seal
from mua.errors import InputError

MUTATIONS = 3000


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(synthetic_avatar(), storage="i8")


def decode(content: bytes) -> None:
    decode_tree(parse_checked(content))


def test_truncation_at_every_offset_is_refused(content: bytes) -> None:
    for length in range(len(content)):
        with pytest.raises(FormatError):
            decode(content[:length])


def test_appended_bytes_are_refused(content: bytes) -> None:
    with pytest.raises(FormatError, match="damaged"):
        decode(content + b"\0")


def test_every_single_bit_flip_of_the_header_is_refused(content: bytes) -> None:
    for bit in range(8 * 160):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << bit % 8
        with pytest.raises(FormatError):
            decode(bytes(flipped))


def test_mutated_bytes_with_a_right_checksum_never_escape_the_reader(content: bytes) -> None:
    """Whatever stands in the bytes, the reader returns an avatar or refuses in a sentence."""
    rng = np.random.default_rng(0)
    refused = 0
    for _ in range(MUTATIONS):
        mutated = bytearray(content)
        for at in rng.integers(0, len(content), rng.integers(1, 6)):
            mutated[at] = rng.choice([0, 1, 0x7F, 0x80, 0xFF, rng.integers(256)])
        try:
            decode(seal(bytes(mutated)))
        except FormatError:
            refused += 1
    assert 0 < refused < MUTATIONS


def child(tree: Tree, path: str) -> tuple[Any, Any]:
    """The container of the last part of a dotted path, and that part."""
    parts: list[Any] = [int(p) if p.isdigit() else p for p in path.split(".")]
    for part in parts[:-1]:
        tree = tree[part]
    return tree, parts[-1]


def put(path: str, value: Any) -> Callable[[Tree], None]:
    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        container[last] = value

    return edit


def poke(path: str, at: int, value: float) -> Callable[[Tree], None]:
    """Change one element of an f32, f16 or i32 tensor."""

    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        tensor = container[last]
        dtype = {"F32": "<f4", "F16": "<f2", "I32": "<i4"}[tensor["type"]]
        values = tensor["data"].view(dtype).copy()
        values[at] = value
        container[last] = {**tensor, "data": values.view(np.uint8)}

    return edit


def drop(path: str) -> Callable[[Tree], None]:
    def edit(tree: Tree) -> None:
        container, last = child(tree, path)
        del container[last]

    return edit


NAN = float("nan")
MALFORMED = [
    ("version", "version_major", put("version_major", 2)),
    ("missing", "skeleton", drop("skeleton")),
    ("missing", "geometry.mlp", drop("geometry.mlp")),
    ("value", "skeleton.parents", poke("skeleton.parents", 1, 2)),
    ("range", "skeleton.parents", poke("skeleton.parents", 1, 9)),
    ("value", "skeleton.root", put("skeleton.root", 3)),
    ("value", "skeleton.bind_rotations", poke("skeleton.bind_rotations", 0, 2)),
    ("finite", "skeleton.bind_translations", poke("skeleton.bind_translations", 0, NAN)),
    ("value", "skeleton.bind_inverse", poke("skeleton.bind_inverse", 5, 0.5)),
    ("shape", "skeleton.bind_inverse.shape", put("skeleton.bind_inverse", pack(np.zeros((3, 7))))),
    ("value", "encoding.joints", poke("encoding.joints", 0, 0)),
    ("range", "encoding.joints", poke("encoding.joints", 0, 7)),
    ("value", "encoding.window", put("encoding.window", 0)),
    ("shape", "encoding.scale.shape", put("encoding.window", 2)),
    ("value", "encoding.rate", put("encoding.rate", NAN)),
    ("value", "encoding.scale", poke("encoding.scale", 0, 0)),
    ("finite", "encoding.mean", poke("encoding.mean", 0, NAN)),
    ("range", "template.faces", poke("template.faces", 0, 12)),
    ("range", "template.faces", poke("template.faces", 0, -1)),
    ("range", "template.uv_faces", poke("template.uv_faces", 2, 99)),
    ("range", "template.skin_indices", poke("template.skin_indices", 0, 3)),
    ("value", "template.skin_weights", poke("template.skin_weights", 0, 5)),
    ("type", "template.faces", put("template.faces", pack(np.zeros((18, 3))))),
    ("type", "template.uv", put("template.uv", pack_indices(np.zeros((16, 2))))),
    ("value", "texels.size", put("texels.size", 0)),
    ("shape", "geometry.ll_basis.shape", put("texels.size", 64)),
    ("value", "texels.texels", poke("texels.texels", 0, 900)),
    ("range", "texels.texels", poke("texels.texels", 0, 1024)),
    ("range", "texels.triangles", poke("texels.triangles", 0, 18)),
    ("value", "texels.barycentrics", poke("texels.barycentrics", 0, 1.5)),
    ("value", "wavelet.levels", put("wavelet.levels", 99)),
    ("value", "wavelet.rec_lo", put("wavelet.rec_lo", np.zeros(3))),
    ("finite", "wavelet.rec_lo", put("wavelet.rec_lo", np.full(10, NAN))),
    ("finite", "coarse.mean", poke("coarse.mean", 3, float("inf"))),
    ("shape", "coarse.basis.shape", put("coarse.basis", pack(np.zeros((4, 11, 3))))),
    ("shape", "coarse.mlp", put("coarse.mlp", [])),
    ("finite", "geometry.ll_mean", poke("geometry.ll_mean", 0, NAN)),
    ("finite", "geometry.details[0].mean", poke("geometry.details.0.mean", 0, NAN)),
    ("shape", "geometry.static_offset.shape", put("geometry.static_offset", pack(np.zeros((11, 3))))),
    ("shape", "appearance.ll_basis.shape", put("appearance.ll_basis", pack(np.zeros((11, 4, 2, 2))))),
    ("shape", "geometry.ll_basis.scale", put("geometry.ll_basis.scale", np.ones(7))),
    ("shape", "geometry.ll_basis.data", put("geometry.ll_basis.data", np.zeros(5, np.uint8))),
    ("shape", "geometry.ll_basis.shape", put("geometry.ll_basis.shape", np.ones(9, np.uint32))),
    ("finite", "geometry.ll_basis", put("geometry.ll_basis.scale", np.full(44, NAN))),
    ("value", "clips[0].rotations", poke("clips.0.rotations", 0, 9)),
    ("shape", "clips[0].translation.shape", put("clips.0.translation", pack(np.zeros((3, 3))))),
    ("value", "clips[0].rate", put("clips.0.rate", 0)),
    ("value", "bounds", poke("bounds", 0, 5)),
    ("value", "thumbnail", put("thumbnail", np.frombuffer(b"GIF89a", np.uint8))),
]


@pytest.mark.parametrize(
    ("code", "field", "edit"), MALFORMED, ids=lambda value: value if isinstance(value, str) else ""
)
def test_malformed_field_is_named(content: bytes, code: str, field: str, edit: Callable[[Tree], None]) -> None:
    tree = parse(content)
    edit(tree)
    with pytest.raises(FormatError) as caught:
        decode(seal_unread(build(tree)))
    assert (caught.value.code, caught.value.field) == (code, field)


def seal_unread(content: bytes) -> bytes:
    """Seal a file that the parser may refuse."""
    try:
        return seal(content)
    except FormatError:
        return content


def test_newer_major_version_is_refused_whatever_else_it_holds(content: bytes) -> None:
    at = parse(content)["_at"]["version_major"]
    newer = content[:at] + struct.pack("<H", 9) + content[at + 2 :]
    with pytest.raises(FormatError, match="update mua"):
        decode(newer[: len(newer) // 2] + bytes(len(newer) // 2))


def test_sentence_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "broken.muaavatar"
    path.write_bytes(b"no avatar at all")
    with pytest.raises(InputError, match=r"broken\.muaavatar: the file identifier is"):
        read(path)
    with pytest.raises(InputError, match=r"absent\.muaavatar"):
        read(tmp_path / "absent.muaavatar")
