"""The reader trusts nothing: every way to be wrong ends in one FormatError with its code and field."""

import re
import tracemalloc
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from damaged import DAMAGED
from malformed import EXPRESSIVE, MALFORMED, crowded, flipped
from synthetic_avatar import synthetic_avatar, with_expressions, with_surface
from tree_edits import edited, seal_unread, times
from unpackable import UNPACKABLE

from mua.asset.flatbuffer import FormatError, Tree, parse
from mua.asset.read import decode_tree, parse_checked, read
from mua.asset.sizes import require_sizes
from mua.asset.tensors import Storage, pack, pack_indices
from mua.asset.write import encode
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


def refused(content: bytes) -> bool:
    """Quicker than `pytest.raises` where it is asked often."""
    try:
        decode(content)
    except FormatError:
        return True
    return False


def test_truncation_at_every_offset_is_refused(content: bytes) -> None:
    assert all(refused(content[:length]) for length in range(len(content)))


def test_truncation_of_a_file_for_the_network_is_refused(network: bytes) -> None:
    """At every offset of the first stage, where all tables are; behind it at one in 29, as each parses them all."""
    first = int(parse(network)["stages"][0])
    assert all(refused(network[:length]) for length in (*range(first), *range(first, len(network), 29)))


@pytest.mark.parametrize("length", [3, 900, 0.2, 0.5, 0.99, -20])
def test_a_cut_file_says_how_many_bytes_it_had(network: bytes, content: bytes, length: float) -> None:
    """A file for the network states its size; another at least what it needs, within its name of all."""
    for whole in (network, content):
        size = int(length * len(whole)) if 0 < length < 1 else int(length) % len(whole)
        with pytest.raises(FormatError) as caught:
            decode(whole[:size])
        found = re.fullmatch(
            rf"the file has {size} bytes and needs at least (\d+): it is cut short or damaged; "
            "download or copy it again",
            str(caught.value),
        )
        assert found
        assert (caught.value.code, caught.value.field) == ("truncated", "")
        assert length == 3 or size < int(found[1]) <= len(whole)
        assert (
            length in {3, 900} or int(found[1]) == len(whole) or (whole is content and int(found[1]) > len(whole) - 64)
        )


def test_a_cut_file_without_stages_is_not_asked_what_it_states(content: bytes) -> None:
    root = int.from_bytes(content[:4], "little")
    taken = root + 4 * int.from_bytes(content[root : root + 4], "little", signed=True)  # as if byte 0 were of a vector
    spoilt = content[:taken] + b"\xff\xff\xff\x7f" + content[taken + 4 :]
    with pytest.raises(FormatError, match=r"needs at least (\d{1,6}):"):
        parse(spoilt[: len(content) // 2])


def test_every_single_bit_flip_of_the_header_is_refused(content: bytes) -> None:
    for bit in range(8 * 160):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << bit % 8
        with pytest.raises(FormatError):
            decode(bytes(flipped))


def test_mutated_bytes_with_a_right_checksum_never_escape_the_reader(content: bytes) -> None:
    """Whatever stands in the bytes, the reader returns an avatar or refuses in a sentence."""
    rng = np.random.default_rng(0)
    wrong = 0
    for _ in range(MUTATIONS):
        mutated = bytearray(content)
        for at in rng.integers(0, len(content), rng.integers(1, 6)):
            mutated[at] = rng.choice(np.array([0, 1, 0x7F, 0x80, 0xFF, rng.integers(256)]))
        wrong += refused(seal_unread(bytes(mutated)))
    assert 0 < wrong < MUTATIONS


def test_a_dual_quaternion_may_have_either_sign(content: bytes) -> None:
    decode(edited(content, times("skeleton.bind_inverse", -1)))


@pytest.mark.parametrize(
    ("code", "field", "edit"), MALFORMED, ids=lambda value: value if isinstance(value, str) else ""
)
def test_malformed_field_is_named(content: bytes, code: str, field: str, edit: Callable[[Tree], None]) -> None:
    with pytest.raises(FormatError) as caught:
        decode(edited(content, edit))
    assert (caught.value.code, caught.value.field) == (code, field)


@pytest.mark.parametrize(
    ("code", "field", "edit"), EXPRESSIVE, ids=lambda value: value if isinstance(value, str) else ""
)
@pytest.mark.parametrize("storage", ["f32", "f16"])
def test_malformed_expression_is_named(storage: Storage, code: str, field: str, edit: Callable[[Tree], None]) -> None:
    with pytest.raises(FormatError) as caught:
        decode(edited(encode(with_expressions(synthetic_avatar()), storage=storage), edit))
    assert (caught.value.code, caught.value.field) == (code, field)


@pytest.mark.parametrize(("expressions", "sound"), [(1, True), (600, False)])
def test_weights_count_among_what_clips_gain(expressions: int, sound: bool) -> None:
    """3 joints and an expression in each frame stay within 2^24 numbers at the rate of the encoding, and 603 do not."""
    content = edited(encode(with_expressions(synthetic_avatar()), storage="f32"), crowded(expressions))
    with nullcontext() if sound else pytest.raises(FormatError, match="too many for the encoding's rate"):
        decode(content)


@pytest.mark.parametrize(
    ("code", "field", "edit"), UNPACKABLE, ids=lambda value: value if isinstance(value, str) else ""
)
def test_malformed_field_of_a_packed_file_is_named(
    network: bytes, code: str, field: str, edit: Callable[[Tree], None]
) -> None:
    with pytest.raises(FormatError) as caught:
        decode(edited(network, edit))
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

    found = decode_tree(parse_checked(edited(content, edit))).rig.texels.barycentrics
    assert found[0, 2] == 0
    assert (found >= 0).all()


def test_sentence_names_the_file(tmp_path: Path) -> None:
    path = tmp_path / "broken.muaavatar"
    path.write_bytes(b"no avatar at all")
    with pytest.raises(InputError, match=r"broken\.muaavatar: the file is no \.muaavatar"):
        read(path)
    with pytest.raises(InputError, match=r"absent\.muaavatar"):
        read(tmp_path / "absent.muaavatar")


def test_the_inverse_of_the_bind_pose_may_have_the_opposite_sign(content: bytes) -> None:
    decode(edited(content, flipped(0)))


@pytest.mark.parametrize(
    ("side", "count", "sound"), [(256, 0, True), (272, 0, False), (512, 12288, True), (512, 12287, False)]
)
def test_a_texture_is_as_large_as_its_valid_texels_justify(content: bytes, side: int, count: int, sound: bool) -> None:
    tree = parse(content)
    tree["texels"] |= {"size": side, "texels": {**tree["texels"]["texels"], "shape": np.array([count])}}
    with nullcontext() if sound else pytest.raises(FormatError, match=f"too large for {count} valid texels"):
        require_sizes(tree)


def test_the_largest_texture_without_texels_decodes_in_little_memory(content: bytes) -> None:
    """256 texels along a side: 23 channels of f32 are 6 MB."""

    def wide(tree: Tree) -> None:
        sides, channels = {"size": 256, "texels": pack_indices(np.zeros(0)), "levels": []}, (11, 12)
        nothing = {"triangles": pack_indices(np.zeros(0)), "barycentrics": pack(np.zeros((0, 2)))}
        tree["texels"] = {**sides, **nothing, "length": 0.0}
        tree["wavelet"]["levels"] = 7
        for name, count in zip(("geometry", "appearance"), channels, strict=True):
            tree[name]["static_offset"] = pack(np.zeros((count, 0)))
        del tree["surface"]

    avatar = decode_tree(parse_checked(edited(content, wide)))
    tracemalloc.start()
    splats = avatar.decode(avatar.clips[0], 1)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(splats.centres) == 0
    assert most < 8 * 23 * 4 * 256**2
