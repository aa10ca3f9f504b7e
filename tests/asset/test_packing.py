"""Packed tensors: their exact bytes, their way back, and streams that claim what they do not give."""

import tracemalloc
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar
from tree_edits import edited, put
from unpackable import stream

from mua.arrays import Array
from mua.asset.flatbuffer import FormatError, parse
from mua.asset.packing import packed, tensors, unpack
from mua.asset.read import parse_checked, read
from mua.asset.tensors import Element, pack, pack_indices, reals, stored
from mua.asset.write import encode, write
from mua.limits import UNPACKED_ROOM, UNPACKED_TIMES

WORDS = 1 << 17  # bytes of Python's own that reading a small file takes


def sparse(rng: np.random.Generator, *shape: int) -> Array:
    """Mostly zeros, of small whole numbers."""
    return np.where(rng.random(shape) < 0.1, rng.integers(-100, 100, shape), 0).astype(np.float64)


@pytest.fixture(scope="module")
def network() -> bytes:
    return encode(synthetic_avatar(), storage="packed")


def test_the_stream_holds_the_first_bytes_of_all_elements_then_the_second_ones() -> None:
    tensor = packed(pack_indices(np.array([0x04030201, 0x14131211] * 9)))
    planes = zlib.decompress(tensor["data"].tobytes(), wbits=-15)
    assert planes == b"\x01\x11" * 9 + b"\x02\x12" * 9 + b"\x03\x13" * 9 + b"\x04\x14" * 9
    assert tensor["packing"] == "Deflate"


@pytest.mark.parametrize("element", ["f32", "f16", "i8"])
@pytest.mark.parametrize("shape", [(1013,), (31, 37), (3, 11, 5, 13)])
def test_what_is_packed_is_given_back(element: Element, shape: tuple[int, ...]) -> None:
    plain = pack(sparse(np.random.default_rng(1), *shape), element, rows=shape[0] if element == "i8" else 0)
    tree = {"bounds": {"type": "F32", **packed(plain)}}
    assert tree["bounds"]["data"].nbytes < plain["data"].nbytes / 2
    unpack(tree, 1 << 20)
    np.testing.assert_array_equal(reals(tree["bounds"], "bounds", shape), reals(plain, "bounds", shape))


@pytest.mark.parametrize(
    ("most", "kind", "scales"),
    [
        (127, ("I8", "Deflate"), [0.25, 0.25]),
        (-127, ("I8", "Deflate"), [0.25, 0.25]),
        (254, ("I8", "Deflate"), [0.25, 0.5]),
        (129, ("F16", "Steps"), [0.25, 0.25]),
        (-2047, ("F16", "Steps"), [0.25, 0.25]),
    ],
    ids=["the most", "the least", "one row twice as coarse", "too many", "far too many"],
)
def test_multiples_of_a_rows_power_of_two_are_bytes_or_steps(
    most: int, kind: tuple[str, str], scales: list[float]
) -> None:
    """Up to 127 of them are bytes; 254 are 127 that are twice as large, where all of the row are multiples of those."""
    rng = np.random.default_rng(0)
    steps = rng.integers(-60, 60, (2, 4000))
    steps[:, 0] = 3, most
    if scales[0] != scales[1]:
        steps[1] &= -2
    plain = pack(steps / 4, "f16")
    tensor = packed(plain)
    assert (tensor["type"], tensor["packing"]) == kind
    np.testing.assert_array_equal(np.broadcast_to(tensor["scale"], 2), scales)
    tree = {"bounds": tensor}
    unpack(tree, 1 << 20)
    np.testing.assert_array_equal(reals(tensor, "bounds", (2, 4000)), reals(plain, "bounds", (2, 4000)))


def test_the_stream_of_steps_holds_their_low_bytes_then_their_high_ones() -> None:
    steps = np.random.default_rng(0).choice([0, -1, 1, -2, 300, -301], 4000)
    planes = np.frombuffer(zlib.decompress(packed(pack(steps / 8, "f16"))["data"].tobytes(), wbits=-15), np.uint8)
    numbers = np.select([steps == step for step in (0, -1, 1, -2, 300, -301)], [0, 1, 2, 3, 600, 601])
    np.testing.assert_array_equal(planes, np.concatenate([numbers % 256, numbers // 256]))


def test_each_multiple_of_each_scale_is_the_nearest_half() -> None:
    """Also where it is no half itself: a file may hold it, though no writer of ours does."""
    numbers = np.arange(1 << 16)
    multiples = np.where(numbers % 2, -(numbers + 1) // 2, numbers // 2)
    scales = 2.0 ** -np.arange(25)
    planes = np.tile(numbers.astype("<u2"), 25).view(np.uint8).reshape(-1, 2).T
    tensor = {"shape": np.array((25, 1 << 16), "<u4"), "type": "F16", "scale": scales.astype("<f4"), "packing": "Steps"}
    tree = {"bounds": {**tensor, "data": stream(planes.tobytes())}}
    unpack(tree, 1 << 20)
    expected = (multiples * scales[:, None]).astype(np.float16)
    np.testing.assert_array_equal(reals(tree["bounds"], "bounds", (25, 1 << 16)), expected)


def test_rows_whose_scales_take_more_than_they_save_share_one() -> None:
    """Rows of 32 numbers, each with a step of its own."""
    steps = np.random.default_rng(0).integers(-100, 100, (64, 32)) | 1
    fine, coarse = (packed(pack(steps * 2.0 ** -(np.arange(64) % most)[:, None], "f16")) for most in (1, 4))
    assert fine["scale"].size == 1
    assert coarse["scale"].size == 64


def test_a_tensor_that_does_not_shrink_stays_as_it_is() -> None:
    noise = {**pack(np.zeros(500), "i8", rows=1), "data": np.random.default_rng(0).integers(0, 256, 500, np.uint8)}
    assert packed(noise) is noise


def test_an_unpacked_file_holds_what_was_packed(network: bytes) -> None:
    held = {path: tensor for path, tensor in tensors(parse(network)) if tensor["packing"] != "Plain"}
    lost = {path: tensor["scale"].nbytes for path, tensor in held.items() if tensor["packing"] == "Steps"}
    before = {path: tensor["data"].nbytes + lost.get(path, 0) for path, tensor in held.items()}
    assert lost
    after = dict(tensors(parse_checked(network)))
    assert len(before) > 5
    assert {path: after[path]["_stored"] for path in before} == before
    assert all(stored(tensor, path).size for path, tensor in after.items() if path in before)


def test_a_bomb_is_refused_in_bounded_memory(network: bytes) -> None:
    """A gigabyte of zeros in a megabyte; not even what the file may claim is made before all claims are known."""
    bomb = {
        "shape": np.array([1 << 28], np.uint32),
        "type": "F32",
        "data": stream(bytes(1 << 26)),
        "packing": "Deflate",
    }
    content = edited(network, put("surface", {"runs": np.zeros(0, np.uint8), "strips": bomb}))
    tracemalloc.start()
    with pytest.raises(FormatError) as caught:
        parse_checked(content)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (caught.value.code, caught.value.field) == ("value", "surface.strips.data")
    assert peak < 2 * len(content) + WORDS


def test_a_stream_longer_than_its_shape_is_not_unpacked_to_its_end(network: bytes) -> None:
    tensor = {**pack(np.zeros((2, 3))), "data": stream(bytes(1 << 26)), "packing": "Deflate"}
    content = edited(network, put("bounds", tensor))
    tracemalloc.start()
    with pytest.raises(FormatError, match="gives more than 24 bytes, expected 24"):
        parse_checked(content)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 * len(content) + WORDS


def test_the_claims_of_all_tensors_count_together(network: bytes) -> None:
    """Each alone is within what a file of this size may claim."""
    held = [path for path, tensor in tensors(parse(network)) if tensor["packing"] == "Deflate"]
    size = UNPACKED_ROOM // 2
    bomb = {"shape": np.array([1, size], np.uint32), "type": "I8", "data": stream(bytes(size)), "packing": "Deflate"}

    def several(tree: dict[str, object]) -> None:
        tree["clips"] = [{**tree["clips"][0], "rotations": bomb}] * 40  # type: ignore[index]

    content = edited(network, several)
    assert held
    assert size < UNPACKED_TIMES * len(content) + UNPACKED_ROOM < 40 * size
    with pytest.raises(FormatError) as caught:
        parse_checked(content)
    assert caught.value.code == "value"
    assert caught.value.field.startswith("clips[")


def test_texels_that_are_not_where_uv_has_them_stay_where_they_are(tmp_path: Path) -> None:
    """Places that a reader can compute are left out of the file, these are not."""
    avatar = synthetic_avatar()
    barycentrics = avatar.rig.texels.barycentrics.copy()
    barycentrics[[3, 8]] = [[0.5, 0.25, 0.25], [0, 0, 1]]
    texels = replace(avatar.rig.texels, barycentrics=barycentrics)
    write(tmp_path / "a.muaavatar", replace(avatar, rig=replace(avatar.rig, texels=texels)), storage="packed")
    np.testing.assert_allclose(read(tmp_path / "a.muaavatar").rig.texels.barycentrics, barycentrics, atol=1e-6)
