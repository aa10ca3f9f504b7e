"""Stored tensors as words: the file's bytes, padded, then the scales."""

import numpy as np
import pytest

from mua.asset.tensors import pack
from mua.gpu.tensor_words import upload_words


def test_f32_is_its_bits() -> None:
    values = np.array([1.5, -2, 0.1], np.float32)
    words, layout = upload_words(pack(values))
    np.testing.assert_array_equal(words, values.view(np.uint32))
    assert layout == (0, 1, 0)


def test_f16_stands_in_pairs_and_an_odd_one_is_padded() -> None:
    words, layout = upload_words(pack(np.array([1.0, -2, 0.5]), "f16"))
    np.testing.assert_array_equal(words, np.array([0xC0003C00, 0x00003800], np.uint32))
    assert layout == (1, 1, 0)


def test_i8_is_followed_by_its_scales() -> None:
    values = np.array([[127, -127, 1], [254, 0, -2]], np.float32)
    words, layout = upload_words(pack(values, "i8", rows=2))
    np.testing.assert_array_equal(words[:2], np.array([0x7F01817F, 0x0000FF00], np.uint32))
    np.testing.assert_array_equal(words[2:].view(np.float32), [1, 2])
    assert layout == (2, 3, 2)


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
def test_an_empty_tensor_has_no_elements(storage: str) -> None:
    words, (_, per_scale, first_scale) = upload_words(pack(np.zeros((0, 3)), storage, rows=1))  # type: ignore[arg-type]
    assert words.dtype == np.uint32
    assert (len(words), per_scale, first_scale) == (int(storage == "i8"), 1, 0)
