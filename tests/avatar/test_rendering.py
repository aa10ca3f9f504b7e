"""Rendering: what stands before what, what is covered, and images that must not depend on how they are made."""

import dataclasses

import numpy as np
import pytest
from spheres import sphere, splats

from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats
from mua.avatar.rendering import frame_bounds, render_over, render_premultiplied
from mua.kernels.splat_draw import WEIGHT

RED, GREEN = (1.0, 0, 0), (0, 1.0, 0)
BOX = np.array([[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]])


def cast(frame: Splats, dtype: type) -> Splats:
    held = {f.name: getattr(frame, f.name) for f in dataclasses.fields(Splats)}
    return Splats(
        **{name: values.astype(dtype) if isinstance(values, np.ndarray) else values for name, values in held.items()}
    )


def front(screen: tuple[int, int] = (65, 65)) -> Camera:
    return orbit(BOX, screen=screen)


@pytest.mark.parametrize("screen", [(1, 1), (7, 3)])
def test_no_splats_give_the_background(screen: tuple[int, int]) -> None:
    empty = splats(np.zeros((0, 3)), np.zeros((0, 3)))
    np.testing.assert_array_equal(frame_bounds(empty), np.zeros((2, 3)))
    image = render_over(empty, front(screen), background=(0.2, 0.4, 0.6))
    np.testing.assert_array_equal(image, np.broadcast_to([0.2, 0.4, 0.6], (*screen[::-1], 3)))


def test_one_splat_shows_its_colour_in_the_middle() -> None:
    image = render_over(splats(np.zeros((1, 3)), np.array([RED]), scale=0.1), front())
    expected = WEIGHT * np.array(RED) + (1 - WEIGHT)  # to what a pixel adds to a splat of 20
    np.testing.assert_allclose(image[32, 32], expected, rtol=0, atol=5e-3)
    np.testing.assert_array_equal(image[0, 0], 1)


@pytest.mark.parametrize("first", [RED, GREEN])
def test_the_nearer_splat_hides_the_farther_in_any_order(first: tuple[float, float, float]) -> None:
    colors = [first, GREEN if first == RED else RED]
    places = [[0, 0, 0.3 if color == GREEN else -0.3] for color in colors]
    image = render_over(splats(np.array(places), np.array(colors), scale=0.2), front())
    assert image[32, 32].argmax() == 1


def test_a_sphere_covers_its_outline_and_nothing_more() -> None:
    frame, camera = sphere(4000), front()
    alpha = render_premultiplied(frame, camera)[..., 3]
    row, column = np.mgrid[:65, :65] + 0.5
    distance = np.linalg.norm(camera.position)
    slope = np.tan(np.arcsin(0.4 / distance)) * camera.projection[1, 1] * 65 / 2  # radius of the tangent cone, pixels
    away = np.hypot(row - 32.5, column - 32.5) - slope
    # How far a quad reaches beyond its centre.
    reach = 4 * frame.scales.max() / distance * camera.projection[1, 1] * 65 / 2 + 1
    assert np.all(alpha[away < -2] > 0.95)
    assert np.all(alpha[away > reach] == 0)


def test_background_shows_through_by_one_minus_alpha() -> None:
    frame = sphere(101)
    image = render_premultiplied(frame, front())
    assert image[..., 3].min() >= 0
    assert image[..., 3].max() <= 1
    black, white = (render_over(frame, front(), background=(level,) * 3) for level in (0.0, 1.0))
    np.testing.assert_array_equal(black, image[..., :3])
    np.testing.assert_allclose(white - black, 1 - image[..., 3:].repeat(3, axis=2), rtol=0, atol=1e-14)


def test_two_renders_are_equal_to_the_bit() -> None:
    frame = sphere(503)
    np.testing.assert_array_equal(render_over(frame, front()), render_over(frame, front()))


def test_an_image_does_not_depend_on_the_order_of_the_splats() -> None:
    frame = sphere(211)
    order = np.random.default_rng(0).permutation(211)
    names = ("centres", "rotations", "scales", "opacities", "sh", "texel_dq")
    mixed = dataclasses.replace(frame, **{name: getattr(frame, name)[order] for name in names})
    np.testing.assert_allclose(render_over(mixed, front()), render_over(frame, front()), rtol=0, atol=1e-11)


def test_float32_image_is_the_float64_image_to_a_fraction_of_a_grey_level() -> None:
    frame = cast(sphere(503), np.float32)
    single, double = render_over(frame, front()), render_over(cast(frame, float), front())
    np.testing.assert_allclose(single, double, rtol=0, atol=0.25 / 255)


def test_a_camera_inside_the_splats_sees_finite_colours() -> None:
    camera = front()
    inside = dataclasses.replace(
        camera, view=camera.view @ np.block([[np.eye(3), camera.position[:, None]], [0, 0, 0, 1]])
    )
    around = np.random.default_rng(0).normal(size=(211, 3)) * 0.2
    frame = splats(np.concatenate([np.zeros((1, 3)), around]), np.full((212, 3), 0.5), scale=0.1)
    np.testing.assert_allclose(inside.position, 0, atol=1e-12)
    assert np.isfinite(render_over(frame, inside)).all()


def test_a_one_pixel_image_holds_the_mean_colour() -> None:
    image = render_over(sphere(101), front((1, 1)), background=(0, 0, 0))
    assert image.shape == (1, 1, 3)
    assert np.all(image > 0.1)
