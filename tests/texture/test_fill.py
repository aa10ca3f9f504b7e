"""Filling of empty texels."""

import numpy as np
import pytest
import torch

from mua import wavelets
from mua.errors import InputError
from mua.rig.texel_map import TexelMap
from mua.texture.fill import Fill, fill_of

PYRAMID_LEVELS = 10  # enough for a texture of up to 1,024 texels
ROUNDING = 16 * PYRAMID_LEVELS * float(torch.finfo(torch.float32).eps)  # about 16 operations per level on unit values


def texel_map(valid: np.ndarray) -> TexelMap:
    texels = np.flatnonzero(valid).astype(np.int32)
    zeros = np.zeros(len(texels), np.int32)
    return TexelMap(len(valid), texels, zeros, np.zeros((len(texels), 3), np.float32), 0)


def discs(size: int) -> np.ndarray:
    """[size, size] bool: four charts with a gap between them and about the border."""
    row, column = (np.mgrid[:size, :size] + 0.5) / size
    return ((row % 0.5 - 0.25) ** 2 + (column % 0.5 - 0.25) ** 2) < 0.2**2


def at(image: np.ndarray, valid: np.ndarray) -> torch.Tensor:
    return torch.from_numpy(image[valid].astype(np.float32))[:, None]


@pytest.mark.parametrize("size", [1, 2, 7, 13, 48, 96])
def test_constant_stays_constant_and_valid_texels_are_untouched(size: int) -> None:
    rng = np.random.default_rng(size)
    valid = rng.random((size, size)) < 0.3
    valid[size // 2, size // 2] = True
    values = torch.from_numpy(rng.standard_normal((int(valid.sum()), 3)).astype(np.float32))
    values[:, 0] = 1
    filled = Fill(texel_map(valid))(values)
    assert filled.shape == (3, size, size)
    assert torch.equal(filled[:, torch.from_numpy(valid)], values.T)
    torch.testing.assert_close(filled[0], torch.ones(size, size), rtol=0, atol=ROUNDING)
    assert filled.amin() >= values.amin() - ROUNDING  # weighted means stay between the values
    assert filled.amax() <= values.amax() + ROUNDING


def test_without_empty_texels_nothing_changes() -> None:
    values = torch.from_numpy(np.random.default_rng(0).standard_normal((36, 2)))
    assert torch.equal(Fill(texel_map(np.ones((6, 6), bool)))(values), values.T.reshape(2, 6, 6))


def test_a_texture_has_no_border() -> None:
    """Wavelets are periodic, so that a step from one border to the other would be detail too."""
    size, random = 32, np.random.default_rng(1)
    valid, image = random.random((size, size)) < 0.2, random.random((size, size))
    filled = Fill(texel_map(valid))(at(image, valid))
    for axis in (0, 1):
        moved, shown = (np.roll(values, size // 2, axis) for values in (valid, image))
        found = Fill(texel_map(moved))(at(shown, moved))
        torch.testing.assert_close(found, filled.roll(size // 2, axis + 1), rtol=0, atol=ROUNDING)


def test_each_map_is_filled_as_its_own_texels_lie() -> None:
    for size in (8, 16):
        valid = discs(size)
        filled = fill_of(texel_map(valid))(at(valid.astype(float), valid))
        torch.testing.assert_close(filled, torch.ones(1, size, size), rtol=0, atol=ROUNDING)


def test_one_valid_texel_fills_everything() -> None:
    valid = np.zeros((16, 16), bool)
    valid[3, 5] = True
    filled = Fill(texel_map(valid))(torch.tensor([[2.0]]))
    torch.testing.assert_close(filled, torch.full((1, 16, 16), 2.0), rtol=0, atol=2 * ROUNDING)


def test_linear_ramp_is_approximated_in_a_hole() -> None:
    size, hole = 64, slice(24, 40)
    valid = np.ones((size, size), bool)
    valid[hole, hole] = False
    ramp = np.broadcast_to(np.arange(size) / size, (size, size))
    error = Fill(texel_map(valid))(at(ramp, valid))[0].numpy() - ramp
    step = 1 / size
    assert np.abs(error[hole, hole]).max() < 2 * step  # the ramp rises by 16 steps over the hole


def test_is_smooth_across_the_wrap() -> None:
    """Beside a strip in the middle, the empty columns left and right meet without a jump where the texture wraps."""
    size = 64
    valid = np.zeros((size, size), bool)
    valid[:, 16:48] = True
    ramp = np.broadcast_to(np.arange(size) / size, (size, size))
    filled = Fill(texel_map(valid))(at(ramp, valid))[0]
    jump = (filled[:, 0] - filled[:, -1]).abs().max()
    mean_slope = (31 / size) / 33  # from column 47 around to column 16
    assert jump < 3 * mean_slope


def test_details_hold_far_less_energy_than_with_zeros() -> None:
    size = 192
    valid = discs(size)
    row, column = (np.mgrid[:size, :size] + 0.5) / size
    image = 3 + np.sin(2 * np.pi * (row + column)) + 0.2 * np.cos(6 * np.pi * row)
    filled = Fill(texel_map(valid))(at(image, valid))
    zeros = torch.from_numpy(np.where(valid, image, 0).astype(np.float32))[None]

    def energies(x: torch.Tensor) -> list[float]:
        return [float(level.square().sum()) for level in wavelets.wavedec2(x, "bior4.4", 4)[1]]

    assert len(energies(filled)) == 4
    for level, (smooth, cut) in enumerate(zip(energies(filled), energies(zeros), strict=True)):
        assert smooth < 0.01 * cut, f"D{3 - level}"


def test_rejects_a_map_without_valid_texels() -> None:
    with pytest.raises(InputError, match="of 8 x 8 texels none is valid"):
        Fill(texel_map(np.zeros((8, 8), bool)))
