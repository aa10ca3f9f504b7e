"""The reader trusts nothing: every way to be wrong ends in one FormatError with its code and field."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from malformed import DAMAGED, MALFORMED, UNPACKABLE, malformed
from synthetic_avatar import synthetic_avatar, with_surface

from mua.asset.flatbuffer import FormatError, Tree
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.tensors import pack
from mua.asset.write import encode, seal
from mua.errors import InputError

MUTATIONS = 1000


@pytest.fixture(scope="module")
def content() -> bytes:
    return encode(with_surface(synthetic_avatar()), storage="i8")


@pytest.fixture(scope="module")
def network() -> bytes:
    return encode(with_surface(synthetic_avatar()), storage="packed")


def decode(content: bytes) -> None:
    decode_tree(parse_checked(content))


@pytest.mark.parametrize("storage", ["content", "network"])
def test_truncation_at_every_offset_is_refused(request: pytest.FixtureRequest, storage: str) -> None:
    content = request.getfixturevalue(storage)
    for length in range(len(content)):
        with pytest.raises(FormatError):
            decode(content[:length])


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


@pytest.mark.parametrize(
    ("code", "field", "edit"), MALFORMED, ids=lambda value: value if isinstance(value, str) else ""
)
def test_malformed_field_is_named(content: bytes, code: str, field: str, edit: Callable[[Tree], None]) -> None:
    with pytest.raises(FormatError) as caught:
        decode(malformed(content, edit))
    assert (caught.value.code, caught.value.field) == (code, field)


@pytest.mark.parametrize(
    ("code", "field", "edit"), UNPACKABLE, ids=lambda value: value if isinstance(value, str) else ""
)
def test_malformed_field_of_a_packed_file_is_named(
    network: bytes, code: str, field: str, edit: Callable[[Tree], None]
) -> None:
    with pytest.raises(FormatError) as caught:
        decode(malformed(network, edit))
    assert (caught.value.code, caught.value.field) == (code, field)


@pytest.mark.parametrize(
    ("code", "field", "damage"), DAMAGED, ids=lambda value: value if isinstance(value, str) else ""
)
def test_damaged_bytes_are_named(content: bytes, code: str, field: str, damage: Callable[[bytes], bytes]) -> None:
    with pytest.raises(FormatError) as caught:
        decode(damage(content))
    assert (caught.value.code, caught.value.field) == (code, field)


def test_a_third_barycentric_that_rounding_makes_negative_is_none(content: bytes) -> None:
    def edit(tree: Tree) -> None:
        stored = tree["texels"]["barycentrics"]["data"].view("<f4").copy().reshape(-1, 2)
        stored[0] = 0.75, 0.25 + 2.0**-23
        tree["texels"]["barycentrics"] = pack(stored)

    found = decode_tree(parse_checked(malformed(content, edit))).rig.texels.barycentrics
    assert found[0, 2] == 0
    assert (found >= 0).all()


def test_sentence_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "broken.muaavatar"
    path.write_bytes(b"no avatar at all")
    with pytest.raises(InputError, match=r"broken\.muaavatar: the file identifier is"):
        read(path)
    with pytest.raises(InputError, match=r"absent\.muaavatar"):
        read(tmp_path / "absent.muaavatar")
