"""Rounding for the network: steps are powers of two, and the demo's images lose less than a tenth of a decibel."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.asset.read import read
from mua.asset.rounding import channel_steps, in_steps, rounded, rows_in_steps
from mua.avatar.camera import orbit
from mua.avatar.decode import decode_clip_frame
from mua.avatar.model import Layer, Mlp
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.channels import ATTRIBUTES

DEMO = Path(__file__).resolve().parents[2] / "build" / "demo" / "avatar.muaavatar"
TEACHER = 53.6  # dB, of the demo's images beside the teacher's, of which the figure covers COVERED
COVERED = 0.08
LOSS = 0.1  # dB
STEADY = 0.999  # of the pixels; in a few, two splats of like depth change places, whatever moved them


@pytest.mark.parametrize(("step", "power"), [(1.0, 1.0), (0.9, 1.0), (0.26, 0.25), (3e-5, 2.0**-15)])
def test_values_become_the_nearest_multiples_of_the_power_of_two_nearest_to_the_step(step: float, power: float) -> None:
    values = np.random.default_rng(0).normal(size=1000)
    found = in_steps(values, step)
    np.testing.assert_array_equal(found / power, np.rint(found / power))
    assert np.abs(found - values).max() <= power / 2 * (1 + 1e-6)


def test_the_step_of_an_offset_grows_with_the_figure() -> None:
    giant, figure = channel_steps(20.0), channel_steps(2.0)
    offset = ATTRIBUTES["offset"]
    np.testing.assert_allclose(giant[offset], 10 * figure[offset])
    others = np.delete(np.arange(23), np.arange(23)[offset])
    np.testing.assert_array_equal(giant[others], figure[others])


def test_no_zero_is_negative() -> None:
    """Which would be another byte."""
    assert not np.signbit(in_steps(np.array([-0.1, 0.1, -0.0]), 1.0)).any()


def test_a_row_of_more_steps_than_a_byte_holds_has_larger_ones_where_few_do() -> None:
    values = np.full((20, 64), 100.0)
    few, many = values.copy(), values.copy()
    few[3, 5], many[:, 5] = 2.6 * 127, 2.6 * 127
    np.testing.assert_array_equal(rows_in_steps(few, np.ones((20, 1)))[3, 5], 332)  # a multiple of 4
    np.testing.assert_array_equal(np.delete(rows_in_steps(few + 1, np.ones((20, 1))), 3, axis=0), 101)
    np.testing.assert_array_equal(rows_in_steps(many, np.ones((20, 1)))[:, 5], 330)


def test_an_mlp_with_units_of_other_sizes_is_rounded_as_well() -> None:
    """Units are scaled to about 1, so that one step suits all weights of a row."""
    avatar = synthetic_avatar()
    first, *others, last = avatar.geometry.mlp
    sizes = 2.0 ** np.random.default_rng(0).integers(-6, 6, len(first.bias))
    second = (others or [last])[0]
    scaled = (
        Layer(first.weight * sizes[:, None], first.bias * sizes),
        Layer(second.weight / sizes, second.bias),
        *([*others[1:], last] if others else []),
    )
    errors = []
    for mlp in (avatar.geometry.mlp, scaled):
        found = rounded(replace(avatar, geometry=replace(avatar.geometry, mlp=mlp))).geometry.mlp
        errors.append(np.abs(outputs(found) - outputs(mlp)).mean())
    assert errors[1] < 1.2 * errors[0]


def test_hidden_units_stand_by_how_many_weights_read_them() -> None:
    avatar = synthetic_avatar()
    *others, last = avatar.appearance.mlp
    weight = last.weight.copy()
    weight[:, ::3] = 0
    mlp = (*others, Layer(weight, last.bias))
    found = rounded(replace(avatar, appearance=replace(avatar.appearance, mlp=mlp)), 1e-3).appearance.mlp
    read = np.count_nonzero(found[-1].weight, axis=0)
    assert (np.diff(read) <= 0).all()
    assert read[0] > read[-1] == 0
    np.testing.assert_allclose(outputs(found), outputs(mlp), atol=2e-3 * np.abs(outputs(mlp)).max())


def test_a_mesh_is_rounded_more_finely_where_its_vertices_carry_more_texels() -> None:
    avatar = synthetic_avatar()
    texels = avatar.rig.texels
    count = len(texels.texels)
    few = replace(texels, texels=texels.texels[: count // 16], triangles=texels.triangles[: count // 16])
    errors = []
    for held in (few, texels):
        found = rounded(replace(avatar, rig=replace(avatar.rig, texels=held)))
        errors.append(np.abs(found.coarse.basis - avatar.coarse.basis).mean())
    assert errors[0] > 2 * errors[1]


def test_texels_smaller_than_a_pixel_are_rounded_more_coarsely() -> None:
    avatar = synthetic_avatar()
    height = float(np.ptp(avatar.coarse.mean, axis=0).max())
    errors = []
    for share in (1 / 100, 1 / 1600):
        texels = replace(avatar.rig.texels, length=share * height)
        found = rounded(replace(avatar, rig=replace(avatar.rig, texels=texels)))
        errors.append(np.abs(found.appearance.static - avatar.appearance.static).mean())
    assert errors[1] > 3 * errors[0]


def test_what_is_rounded_stays_so() -> None:
    once = rounded(synthetic_avatar())
    twice = rounded(once)
    for branch in ("geometry", "appearance"):
        first, second = getattr(once, branch), getattr(twice, branch)
        np.testing.assert_array_equal(first.static, second.static)
        np.testing.assert_array_equal(first.ll_mean, second.ll_mean)


def test_a_row_that_moves_texels_little_is_rounded_coarsely() -> None:
    """Rows of the last layer by the size of what their coefficient multiplies."""
    avatar = synthetic_avatar()
    basis = avatar.geometry.ll_basis.copy()
    basis[0, 1] *= 1e-4
    geometry = replace(avatar.geometry, ll_basis=basis)
    error = np.abs(outputs(rounded(replace(avatar, geometry=geometry)).geometry.mlp) - outputs(geometry.mlp)).max(
        axis=0
    )
    assert error[1] > 5 * error[0]
    geometry = replace(avatar.geometry, ll_basis=1e3 * avatar.geometry.ll_basis)
    finer = np.abs(outputs(rounded(replace(avatar, geometry=geometry)).geometry.mlp) - outputs(geometry.mlp)).max(
        axis=0
    )
    assert finer[0] < error[0] / 5


def outputs(mlp: Mlp) -> Array:
    """Of random inputs [100, M]."""
    x = np.random.default_rng(0).normal(size=(100, mlp[0].weight.shape[1]))
    for layer in mlp:
        x = x @ layer.weight.T + layer.bias
        x = x if layer is mlp[-1] else np.maximum(x, 0)
    return x


def test_a_factor_is_rounded_as_finely_as_the_other_is_large() -> None:
    """What one factor of a detail gives to the other changes no product."""
    branch = synthetic_avatar().appearance
    details = tuple(replace(band, h=band.h / 4, w=band.w * 4) for band in branch.details)
    avatars = [replace(synthetic_avatar(), appearance=one) for one in (branch, replace(branch, details=details))]
    even, uneven = (rounded(one).appearance.details for one in avatars)
    assert len(even) == 2
    for first, second in zip(even, uneven, strict=True):
        np.testing.assert_array_equal(second.h * 4, first.h)
        np.testing.assert_array_equal(second.w / 4, first.w)


def test_weights_are_rounded_by_how_many_texels_their_coefficients_move() -> None:
    """Of like bases, the steps for LL and D3 are twice as large as those for D2, which has four times the samples."""
    branch = synthetic_avatar().appearance
    like = tuple(
        replace(band, h=np.full_like(band.h, 3**-0.25), w=np.full_like(band.w, 3**-0.25)) for band in branch.details
    )
    alike = replace(branch, ll_basis=np.ones_like(branch.ll_basis), details=like)
    weights = rounded(replace(synthetic_avatar(), appearance=alike)).appearance.mlp[-1].weight
    rows = np.cumsum([0, *(12 * rank for rank in branch.ranks)])
    powers = 2.0 ** -np.arange(30)
    steps = [
        next(power for power in powers if (part % power == 0).all())
        for part in (weights[first:end] for first, end in pairwise(rows))
    ]
    assert steps == [2 * steps[2], 2 * steps[2], steps[2]]


@pytest.mark.skipif(not DEMO.exists(), reason="needs build/demo/avatar.muaavatar: run `make demo`")
@pytest.mark.parametrize("frame", [0, 12])
def test_pictures_of_the_demo_lose_less_than_a_tenth_of_a_decibel(frame: int) -> None:
    """Beside the teacher, whose images the demo's miss by an error that this one is added to."""
    avatar = read(DEMO)
    clip = avatar.clips[0]
    exact, near = (decode_clip_frame(one, clip, frame=frame) for one in (avatar, rounded(avatar)))
    camera = orbit(frame_bounds(exact), screen=(192, 256), azimuth=0.4)
    images = [render_premultiplied(one, camera) for one in (exact, near)]
    covered = images[0][..., 3] > 0.5
    squares = np.sort(np.mean((images[0] - images[1])[covered][:, :3] ** 2, axis=1))
    error = squares[: int(STEADY * len(squares))].mean()
    missed = 10 ** (-TEACHER / 10) / COVERED
    assert 0 < 10 * np.log10(1 + error / missed) < LOSS
