"""Components of the descriptor: as they are within training, held beyond it, in numpy and in torch."""

import numpy as np
import pytest
import torch

from mua.arrays import Array
from mua.pose.components import FORGONE, INPUT_FLOOR, JITTER, hold, principal_components, read_components
from mua.pose.descriptor import normalization
from mua.pose.encoding import Components, Normalization
from mua.student.components import Components as TorchComponents

WIDTH, FRAMES = 6, 200
HALF = 2.0**-10  # twice the rounding of half precision


def frames(seed: int = 0, *, apart: float = 0.2) -> Array:
    """Descriptors of which the last two numbers follow the first ones, one but for some noise, the last exactly."""
    rng = np.random.default_rng(seed)
    free = rng.normal(size=(FRAMES, 4)) * [1.0, 0.5, 0.1, 0.02] + [0, 1, 2, 3]
    return np.column_stack([free, free[:, 0] + apart * rng.normal(size=FRAMES), free[:, 1] - free[:, 2]])


def components(columns: Array, units: Array | None = None, groups: Array | None = None) -> Components:
    units = np.ones(columns.shape[1]) if units is None else units
    groups = np.zeros(columns.shape[1]) if groups is None else groups
    return principal_components(columns, normalization(columns, units), units, groups)


def one_component(low: float, high: float, margin: float) -> Components:
    plain = Normalization(np.zeros(1), np.ones(1))
    return Components(plain, np.ones((1, 1)), np.array([[low], [high]]), np.array([margin]))


def test_frames_of_training_are_read_as_they_are() -> None:
    columns = frames()
    own = components(columns)
    x, outside = read_components(own, columns)
    normal = (columns - columns.mean(axis=0)) / columns.std(axis=0)
    np.testing.assert_allclose(x, normal @ own.directions.T.astype(float), rtol=0, atol=1e-6)
    np.testing.assert_allclose(outside, 0, rtol=0, atol=1e-6)
    np.testing.assert_allclose(x.min(axis=0), own.ranges[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(x.max(axis=0), own.ranges[1], rtol=0, atol=1e-6)


def test_components_do_not_vary_together_and_vary_alike_down_to_the_floor() -> None:
    columns = frames()
    x, _ = read_components(components(columns), columns)
    variance = np.linalg.eigvalsh(np.cov(((columns - columns.mean(axis=0)) / columns.std(axis=0)).T, bias=True))[::-1]
    expected = variance[: x.shape[1]] / (variance[: x.shape[1]] + INPUT_FLOOR)
    np.testing.assert_allclose(np.cov(x.T, bias=True), np.diag(expected), rtol=0, atol=20 * HALF)


@pytest.mark.parametrize(("apart", "count"), [(0.2, WIDTH - 1), (0.05, WIDTH - 2)])
def test_what_all_but_follows_from_the_rest_is_no_component(apart: float, count: int) -> None:
    columns = frames(apart=apart)
    own = components(columns)
    assert own.directions.shape == (count, WIDTH)
    variance = np.linalg.eigvalsh(np.cov(((columns - columns.mean(axis=0)) / columns.std(axis=0)).T, bias=True))
    seen = variance / (variance + INPUT_FLOOR)
    held = read_components(own, columns)[0].var(axis=0).sum()
    assert held == pytest.approx(seen.sum(), rel=FORGONE)


@pytest.mark.parametrize("still", [np.zeros((5, 3)), np.ones((1, 3))])
def test_frames_that_do_not_move_have_one_component(still: Array) -> None:
    own = components(still)
    assert own.directions.shape == (1, 3)
    assert (own.margins > 0).all()
    x, outside = read_components(own, still)
    assert not x.any()
    assert not outside.any()


def test_a_joint_in_a_new_pose_bounds_no_other_joint() -> None:
    columns, groups = frames(), np.array([-1, -1, 4, 4, 7, 7])
    own = components(columns, groups=groups)
    used = [set(groups[direction != 0]) for direction in own.directions]
    assert all(len(one) == 1 for one in used)
    assert set.union(*used) == {-1, 4, 7}
    moved = columns[:5].copy()
    moved[:, 2:4] += 30
    legs = [joint != {4} for joint in used]
    before, after = (read_components(own, rows)[0] for rows in (columns[:5], moved))
    np.testing.assert_array_equal(before[:, legs], after[:, legs])
    assert np.abs(after - before).max() > 1e-3


@pytest.mark.parametrize("size", [1.0, 10.0, 1e3, 1e6])
def test_nothing_leaves_the_margins(size: float) -> None:
    own = components(frames())
    away = size * np.random.default_rng(1).normal(size=(500, WIDTH))
    x, outside = read_components(own, away)
    slack = 1e-6 * np.abs(own.ranges).max()
    assert (x >= own.ranges[0] - own.margins - slack).all()
    assert (x <= own.ranges[1] + own.margins + slack).all()
    assert ((outside >= 0) & (outside <= 1)).all()
    assert outside.max() > 0.1


@pytest.mark.parametrize(
    ("found", "expected"),
    [(-1.0, -1.0), (2.0, 2.0), (0.5, 0.5), (2.5, 2.25), (3.5, 2.375), (-1.5, -1.25), (1e9, 2.5), (-1e9, -1.5)],
)
def test_a_component_beyond_its_range_approaches_the_margin(found: float, expected: float) -> None:
    own = one_component(-1, 2, 0.5)
    assert hold(np.array([found]), own)[0] == pytest.approx(expected, abs=1e-8)


def test_a_component_without_a_margin_ends_with_its_range() -> None:
    own = one_component(-1, 2, 0)
    np.testing.assert_array_equal(hold(np.array([[-7.0], [-1], [0], [2], [9]]), own)[:, 0], [-1, -1, 0, 2, 2])


def test_a_hold_begins_gently() -> None:
    """The slope is 1 where the range ends and never negative: motion that leaves training neither jumps nor stops."""
    own = one_component(-1, 2, 0.5)
    path = hold(np.linspace(-4, 5, 9001)[:, None], own)[:, 0]
    steps = np.diff(path) / 1e-3
    assert (steps > 0).all()
    assert (steps < 1 + 1e-6).all()
    assert np.abs(np.diff(steps)).max() < 0.01


def test_how_far_outside_is_the_share_that_is_taken_off() -> None:
    two = Components(Normalization(np.zeros(2), np.ones(2)), np.eye(2), np.array([[-1.0, -1], [1, 1]]), np.zeros(2))
    x, outside = read_components(two, np.array([[0.0, 0], [0.6, 0.8], [3, 4], [4, 0]]))
    np.testing.assert_allclose(x, np.array([[0, 0], [0.6, 0.8], [1, 1], [1, 0]]))
    np.testing.assert_allclose(outside, [0, 0, np.hypot(2, 3) / 5, 0.75])


def test_a_degree_of_every_joint_is_within_the_margins_of_components_that_hardly_vary() -> None:
    columns = frames() * [1, 1, 1e-5, 1e-5, 1, 1]
    own = components(columns)
    trembling = columns.mean(axis=0) + JITTER * np.eye(WIDTH)[2:4]
    found = (trembling - columns.mean(axis=0)) / own.normalization.scale @ own.directions.T.astype(float)
    assert (found >= own.ranges[0] - own.margins - 1e-6).all()
    assert (found <= own.ranges[1] + own.margins + 1e-6).all()


def test_a_small_figure_is_read_and_held_as_a_large_one() -> None:
    columns, units = frames(), np.array([0.01, 1, 0.01, 1, 0.01, 1])
    person, small = components(columns), components(columns * units, units)
    np.testing.assert_allclose(np.abs(small.directions), np.abs(person.directions), rtol=0, atol=HALF)
    np.testing.assert_allclose(small.margins, person.margins, rtol=0.02)


@pytest.mark.parametrize("size", [0.5, 3.0, 100.0])
def test_torch_holds_alike(size: float) -> None:
    own = components(frames())
    away = own.normalization.mean + own.normalization.scale * size * np.random.default_rng(2).normal(size=(50, WIDTH))
    normal = torch.from_numpy((away - own.normalization.mean) / own.normalization.scale).float()
    held = TorchComponents(*(torch.from_numpy(part) for part in (own.directions, own.ranges, own.margins)))
    expected, _ = read_components(own, away)
    np.testing.assert_allclose(held.hold(held(normal)).numpy(), expected, rtol=0, atol=1e-5 * max(size, 1))
    still = TorchComponents(held.directions, held.ranges, torch.zeros_like(held.margins))
    assert torch.isfinite(still.hold(still(normal))).all()
