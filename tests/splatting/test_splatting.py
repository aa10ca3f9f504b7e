"""The differentiable rasteriser: its image against the reference renderer, its gradients against differences."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields, replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import torch
from synthetic_avatar import synthetic_avatar
from torch_splats import SCREEN, camera, in_torch, random_splats

from mua import rotation
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, decode_clip_frame
from mua.avatar.rendering import render_premultiplied
from mua.kernels.splat_project import LEAST_OPACITY, REACH, splat_project
from mua.kernels.splat_project import half_extents as extents_of
from mua.kernels.splat_sort import splat_sort
from mua.splatting.projection import Eye, TorchSplats, half_extents, project
from mua.splatting.rasterise import BLOCKS, draw_quads, largest_shares, rasterise, rasterise_views
from mua.splatting.tiles import TILE, assign, split

STEP = 1e-8  # the step of the finite differences; a larger one reaches over the edges of windows
DIFFERENTIATED = [field.name for field in fields(TorchSplats) if field.name != "normals"]


def drawn(splats: Splats, eye: Camera, dtype: torch.dtype = torch.float64) -> torch.Tensor:
    tensors = in_torch(splats, dtype)
    return rasterise(tensors, Eye.of(eye, tensors.centres), torch.tensor(splats.bounds, dtype=dtype))


@pytest.mark.parametrize("count", [0, 1, 300])
def test_the_picture_is_the_reference_renderers(count: int) -> None:
    splats = random_splats(count)
    expected = render_premultiplied(splats, camera())
    np.testing.assert_allclose(drawn(splats, camera()), expected, rtol=0, atol=2e-5)  # what a done pixel leaves out
    assert count == 0 or expected[..., 3].max() > 0.2


def test_a_large_splat_beside_the_picture_is_drawn_as_by_the_reference_renderer() -> None:
    """Its middle lies so far out that its shape is taken nearer to the image."""
    splats = random_splats(40)
    aside = splats.centres * [2.2, 1.5, 1]
    splats = replace(splats, centres=aside, scales=np.full_like(splats.scales, 0.4) * [1, 0.3, 0.1])
    expected = render_premultiplied(splats, camera())
    np.testing.assert_allclose(drawn(splats, camera()), expected, rtol=0, atol=2e-5)
    assert expected[..., 3].max() > 0.2


def test_splats_are_seen_shaped_and_ordered_as_by_the_reference_kernels() -> None:
    """The camera's principal point is off centre; splats are thinner than a pixel, far aside, and in one place."""
    splats = random_splats(400)
    centres = splats.centres * np.where(np.arange(400) % 3 == 0, 2.0, 1.0)[:, None]
    centres[200:300] = centres[:100]  # the later of two equal ones lies before the earlier
    scales = splats.scales * np.where(np.arange(400) % 2, 1, 1e-3)[:, None] * [1, 1, 1e-3]
    scales[::7] *= 20
    splats = replace(splats, centres=centres, scales=scales)
    projection = camera().projection.copy()
    projection[:2, 2] = 0.6, -0.3
    eye, near = replace(camera(), projection=projection), -projection[2, 3] / 2
    axes = rotation.to_matrix(splats.rotations) * scales[:, None]
    covariance = (axes @ axes.swapaxes(1, 2))[:, *np.triu_indices(3)]
    views = eye.view[None], projection[None]
    seen, keys, ellipses = splat_project(
        centres, covariance, splats.opacities, *views, screen=SCREEN, near=near, bounds=splats.bounds
    )
    front = splat_sort(keys)[::-1]
    tensors = in_torch(splats)
    quads = project(tensors, Eye.of(eye, tensors.centres), torch.tensor(splats.bounds))
    assert len(np.unique(keys)) < len(keys) > 200
    np.testing.assert_array_equal(quads.splats, seen[front])
    np.testing.assert_allclose(quads.shapes[:, :2], ellipses[0, front, :2], rtol=1e-9)
    np.testing.assert_allclose(half_extents(quads.shapes), extents_of(ellipses[0, front]), rtol=1e-6)


def test_a_splat_that_changes_no_8_bit_picture_is_left_out() -> None:
    splats = in_torch(random_splats(3))
    opacities = torch.tensor([LEAST_OPACITY, np.nextafter(LEAST_OPACITY, 0), 0.5], dtype=torch.float64)
    bounds = torch.stack([splats.centres.amin(dim=0), splats.centres.amax(dim=0)])
    quads = project(replace(splats, opacities=opacities), Eye.of(camera(), splats.centres), bounds)
    assert sorted(quads.splats.tolist()) == [0, 2]


def test_one_sided_splats_are_left_out_where_the_reference_leaves_them_out() -> None:
    splats = random_splats(300)
    normals = np.random.default_rng(1).normal(size=(300, 3))
    normals[::3] = 0
    one_sided = replace(splats, normals=normals)
    expected = render_premultiplied(one_sided, camera())
    np.testing.assert_allclose(drawn(one_sided, camera()), expected, rtol=0, atol=2e-5)
    assert np.abs(expected - render_premultiplied(splats, camera())).max() > 0.2


@pytest.mark.parametrize("screen", [(1, 1), (9, 5)])
def test_the_shares_of_a_pixel_add_up_to_what_is_covered(screen: tuple[int, int]) -> None:
    """Over more than one pixel, the sum of the largest shares is at least the mean coverage."""
    drawn_splats = random_splats(800)
    splats = in_torch(drawn_splats)
    eye, bounds = Eye.of(camera(screen), splats.centres), torch.tensor(drawn_splats.bounds)
    shares, covered = largest_shares(splats, eye, bounds), rasterise(splats, eye, bounds)[..., 3]
    if screen == (1, 1):
        assert float(shares.sum()) == pytest.approx(float(covered), rel=1e-6)
    assert float(shares.sum()) >= float(covered.mean()) * (1 - 1e-6)
    assert float(shares.max()) < 1
    assert float(covered.max()) > 0.5


def test_a_share_is_the_largest_of_all_pixels() -> None:
    drawn_splats = random_splats(30)
    splats = in_torch(drawn_splats)
    eye, bounds = Eye.of(camera(), splats.centres), torch.tensor(drawn_splats.bounds)
    quads, expected = project(splats, eye, bounds), torch.zeros(30, dtype=torch.float64)
    for place, splat in enumerate(quads.splats.tolist()):
        alone = torch.zeros(len(quads.splats), 3, dtype=torch.float64)
        alone[place] = 1
        expected[splat] = draw_quads([(quads.shapes, alone)], [SCREEN])[0][..., 0].max()
    torch.testing.assert_close(largest_shares(splats, eye, bounds), expected)
    assert 0 < len(quads.splats) < 30


def test_an_avatar_is_drawn_as_by_the_reference_renderer_in_single_precision() -> None:
    avatar = synthetic_avatar()
    splats = decode_clip_frame(avatar, avatar.clips[0], frame=3, dtype=np.float64)
    eye = orbit(splats.bounds, screen=(96, 128), azimuth=0.4)
    error = drawn(splats, eye, torch.float32).numpy() - render_premultiplied(splats, eye)
    assert -10 * np.log10(np.mean(error**2)) > 60
    assert np.abs(error).max() < 1 / 255


def test_a_background_fills_what_the_splats_leave() -> None:
    tensors = in_torch(random_splats(20))
    given = Eye.of(camera(), tensors.centres), torch.tensor(random_splats(20).bounds)
    image, blue = rasterise(tensors, *given), torch.tensor([0.0, 0.0, 1.0], dtype=torch.float64)
    over = rasterise(tensors, *given, background=blue)
    torch.testing.assert_close(over, image[..., :3] + (1 - image[..., 3:]) * blue)


def slopes(loss: Callable[[torch.Tensor], torch.Tensor], at: torch.Tensor, along: torch.Tensor) -> tuple[float, float]:
    """The change of the loss along a direction: by its gradient, and by a central difference."""
    variable = at.clone().requires_grad_()
    (gradient,) = torch.autograd.grad(loss(variable), variable)
    with torch.no_grad():
        difference = (loss(at + STEP * along) - loss(at - STEP * along)) / (2 * STEP)
    return float((gradient * along).sum()), float(difference)


@pytest.mark.parametrize("name", DIFFERENTIATED)
def test_gradients_are_those_of_finite_differences(name: str) -> None:
    splats, rng = random_splats(200), torch.Generator().manual_seed(3)
    tensors, bounds = in_torch(splats), torch.tensor(splats.bounds)
    eye, weights = Eye.of(camera(), tensors.centres), torch.randn(*SCREEN[::-1], 4, generator=rng, dtype=torch.float64)

    def loss(values: torch.Tensor) -> torch.Tensor:
        return (weights * rasterise(replace(tensors, **{name: values}), eye, bounds)).sum()

    at = getattr(tensors, name)
    for _ in range(5):
        by_gradient, by_difference = slopes(loss, at, torch.randn(at.shape, generator=rng, dtype=torch.float64))
        assert by_gradient == pytest.approx(by_difference, rel=0.01)


@pytest.mark.parametrize("name", ["view", "projection"])
def test_gradients_reach_the_camera(name: str) -> None:
    splats, rng = random_splats(200), torch.Generator().manual_seed(4)
    tensors, bounds = in_torch(splats), torch.tensor(splats.bounds)
    eye, weights = Eye.of(camera(), tensors.centres), torch.randn(*SCREEN[::-1], 4, generator=rng, dtype=torch.float64)

    def loss(values: torch.Tensor) -> torch.Tensor:
        change: dict[str, Any] = {name: values}
        return (weights * rasterise(tensors, replace(eye, **change), bounds)).sum()

    along = torch.zeros(4, 4, dtype=torch.float64)
    rows = 3 if name == "view" else 2  # the others move the near plane only
    along[:rows] = torch.randn(rows, 4, generator=rng, dtype=torch.float64) * 0.1
    by_gradient, by_difference = slopes(loss, getattr(eye, name), along)
    assert by_gradient == pytest.approx(by_difference, rel=0.01)


def views() -> tuple[TorchSplats, list[Eye], torch.Tensor]:
    """Splats that want gradients, and cameras of different sizes, of which the third sees nothing."""
    splats = random_splats(200)
    tensors = in_torch(splats)
    for name in DIFFERENTIATED:
        getattr(tensors, name).requires_grad_()
    screens = [SCREEN, (TILE, TILE), (9, 5), (2 * TILE + 1, 50)]
    eyes = [Eye.of(camera(screen), tensors.centres.detach()) for screen in screens]
    eyes[2].view[:3, :3] = torch.diag(torch.tensor([-1.0, 1, -1]))
    return tensors, eyes, torch.tensor(splats.bounds)


def test_several_cameras_in_one_call_see_what_they_see_one_after_another() -> None:
    tensors, eyes, bounds = views()
    together = rasterise_views(tensors, eyes, bounds)
    alone = [rasterise(tensors, eye, bounds) for eye in eyes]
    assert [image.shape for image in together] == [(eye.screen[1], eye.screen[0], 4) for eye in eyes]
    assert all(torch.equal(a, b) for a, b in zip(together, alone, strict=True))
    assert [bool(image.any()) for image in alone] == [True, True, False, True]


def test_gradients_of_several_cameras_are_the_sums_of_each_ones() -> None:
    rng = torch.Generator().manual_seed(7)
    tensors, eyes, bounds = views()
    weights = [torch.randn(*eye.screen[::-1], 4, generator=rng, dtype=torch.float64) for eye in eyes]
    together = rasterise_views(tensors, eyes, bounds)
    torch.stack([(w * image).sum() for w, image in zip(weights, together, strict=True)]).sum().backward()
    found = {name: getattr(tensors, name).grad.clone() for name in DIFFERENTIATED}
    for name in DIFFERENTIATED:
        getattr(tensors, name).grad = None
    for eye, weight in zip(eyes, weights, strict=True):
        (weight * rasterise(tensors, eye, bounds)).sum().backward()
    for name in DIFFERENTIATED:
        wanted = getattr(tensors, name).grad
        assert wanted.any()
        torch.testing.assert_close(found[name], wanted, rtol=0, atol=1e-12 * float(wanted.abs().max()))


def test_round_splats_have_finite_gradients() -> None:
    splats = random_splats(30)
    splats = replace(splats, scales=np.full((30, 3), 0.1), centres=np.tile([[0.0, 0, -2]], (30, 1)))
    straight = replace(camera((32, 32)), view=np.eye(4))
    tensors = in_torch(splats)
    for name in DIFFERENTIATED:
        getattr(tensors, name).requires_grad_()
    rasterise(
        tensors, Eye.of(straight, tensors.centres.detach()), torch.tensor(splats.bounds)
    ).square().sum().backward()
    assert all(getattr(tensors, name).grad.isfinite().all() for name in DIFFERENTIATED)


def test_splats_behind_the_camera_get_no_gradient() -> None:
    splats = random_splats(40)
    splats.centres[:20, 2] *= -1
    tensors = in_torch(splats)
    tensors.centres.requires_grad_()
    rasterise(tensors, Eye.of(camera(), tensors.centres.detach()), torch.tensor(splats.bounds))[..., 3].sum().backward()
    assert tensors.centres.grad is not None
    assert not tensors.centres.grad[:20].any()
    assert tensors.centres.grad[20:].any()


def test_a_pixel_that_is_done_blends_nothing_and_passes_no_gradient() -> None:
    half = 1 / (2 * TILE)
    shapes = torch.tensor([[8.5, 8.5, half, 0, half, 0.884]], dtype=torch.float64).repeat(40, 1)
    colors = torch.linspace(0, 1, 40, dtype=torch.float64)[:, None].repeat(1, 3).requires_grad_()
    draw_quads([(shapes, colors)], [(TILE, TILE)])[0].sum().backward()
    assert colors.grad is not None
    assert colors.grad[0].all()
    assert not colors.grad[30:].any()


@pytest.mark.parametrize("screen", [(TILE, TILE), (TILE + 1, 2 * TILE - 1), (3 * TILE, 5)])
def test_tiles_hold_every_quad_whose_pixels_they_have_front_to_back(screen: tuple[int, int]) -> None:
    rng = np.random.default_rng(6)
    middle = rng.uniform(-10, 60, (50, 2))
    extent = rng.uniform(0.1, 20, (50, 2))
    tiles = assign(torch.tensor(middle), torch.tensor(extent), screen)
    column, row = np.meshgrid(*(np.arange(side) for side in screen))
    inside = np.abs(np.stack([column, row], axis=-1) + 0.5 - middle[:, None, None]) <= extent[:, None, None]
    quads, rows, columns = np.nonzero(inside.all(axis=-1))
    starts, held = tiles.starts.numpy(), tiles.quads.numpy()
    columns_of_tiles = -(-screen[0] // TILE)
    expected = {(q, r // TILE * columns_of_tiles + c // TILE) for q, r, c in zip(quads, rows, columns, strict=True)}
    found = [(q, tile) for tile in range(len(starts) - 1) for q in held[starts[tile] : starts[tile + 1]]]
    assert len(found) == len(set(found))
    assert expected <= set(found)
    assert all((np.diff(held[low:high]) > 0).all() for low, high in pairwise(starts))


@pytest.mark.parametrize("count", [1, 4, 200])
def test_parts_hold_each_tile_once_and_about_as_many_pairs(count: int) -> None:
    rng = np.random.default_rng(3)
    middle, extent = rng.uniform(-10, 120, (300, 2)), rng.uniform(0.1, 20, (300, 2))
    tiles = assign(torch.tensor(middle), torch.tensor(extent), (90, 100))
    parts = split(tiles, count)
    assert torch.equal(torch.cat([part.places for part in parts]), tiles.places)
    assert torch.equal(torch.cat([part.starts[:-1] for part in parts]), tiles.starts[:-1])
    assert parts[-1].starts[-1] == tiles.starts[-1]
    largest = int(tiles.starts.diff().max())
    assert all(int(part.starts[-1] - part.starts[0]) <= len(tiles.quads) / count + 2 * largest for part in parts)


def test_images_and_gradients_do_not_depend_on_the_number_of_threads() -> None:
    found = []
    for threads in (1, 3):
        tensors, eyes, bounds = views()
        with torch_threads(threads):
            image = rasterise(tensors, eyes[0], bounds)
            image.square().sum().backward()
        found.append((image.detach(), *(getattr(tensors, name).grad for name in DIFFERENTIATED)))
    assert all(torch.equal(one, other) for one, other in zip(*found, strict=True))


def test_images_gradients_and_shares_do_not_depend_on_how_many_pixels_a_thread_has(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """CUDA's kernels have one pixel, the CPU's eight."""
    found = []
    for block in BLOCKS.values():
        monkeypatch.setitem(BLOCKS, "cpu", block)
        tensors, eyes, bounds = views()
        image = rasterise(tensors, eyes[0], bounds)
        image.square().sum().backward()
        gradients = [getattr(tensors, name).grad for name in DIFFERENTIATED]
        found.append((image.detach(), largest_shares(tensors, eyes[0], bounds).detach(), *gradients))
    one, other = found
    torch.testing.assert_close(one, other, rtol=1e-10, atol=1e-12)
    assert BLOCKS["cuda"] == (1, 1)


@contextmanager
def torch_threads(count: int) -> Iterator[None]:
    """Let torch compute with that many threads."""
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def test_quads_are_drawn_as_far_as_the_reference_reaches() -> None:
    splats = random_splats(100)
    tensors = in_torch(splats)
    quads = project(tensors, Eye.of(camera(), tensors.centres), torch.tensor(splats.bounds))
    assert 0 < len(quads.splats) < 100  # some lie beyond the edges
    assert (half_extents(quads.shapes) > REACH * 0.3).all()  # a pixel's own deviation at the least
