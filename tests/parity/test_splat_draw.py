"""Blending against a loop; windows are in test_splat_draw_integral.py, colours in test_splat_draw_colors.py.

The shaders against the reference: one splat to the rounding of a half float, whole frames by their PSNR; against the
exact image in test_splat_draw_exact.py.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import wgpu
from drawn_scenes import places_in_quad, random_scene
from drawn_splats import draw_frame, random_frame, reference_frame, sort_frame, stereo
from packed_splats import unpacked
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera, orbit
from mua.avatar.decode import Splats, decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.gpu import Device
from mua.kernels import splat_draw as kernel
from mua.kernels.splat_draw import WEIGHT, pixel_share, splat_draw
from mua.kernels.splat_project import COLOR_STEPS, OPACITY_STEPS, PIXEL_VARIANCE, REACH, pack_splats
from mua.player.draw import IMAGE_FORMAT, SortedSplats, SplatRenderer, draw_image, read_image

SCREENS = [(1, 1), (1, 7), (13, 5), (31, 29)]


def painted(ellipses: Array, colors: Array, opacities: Array, order: Array, screen: tuple[int, int]) -> Array:
    """Each splat painted over the image, back to front, on all pixels whose centre lies in its quad."""
    row, column = np.mgrid[: screen[1], : screen[0]] + 0.5
    image = np.zeros((screen[1], screen[0], 4))
    for splat in order:
        offsets = np.stack([column, row], axis=-1) - ellipses[splat, :2]
        inside = (np.abs(places_in_quad(ellipses[splat], offsets)) <= 1).all(axis=-1)
        alpha = opacities[splat] * pixel_share(offsets, ellipses[splat]) * inside
        image = image * (1 - alpha[..., None]) + alpha[..., None] * np.append(colors[splat], 1)
    return image


def running_sum_bound(count: int, screen: tuple[int, int]) -> float:
    """Rounding of transmittances that are differences of one running sum over all pairs of splat and pixel."""
    largest_sum = -np.log(1 - WEIGHT) * count * screen[0] * screen[1]
    return float(np.finfo(float).eps * max(largest_sum, 1))


@pytest.mark.parametrize("screen", SCREENS)
@pytest.mark.parametrize("count", [0, 1, 7, 211])
def test_equals_painting_back_to_front(count: int, screen: tuple[int, int]) -> None:
    scene = random_scene(count, screen)
    image = splat_draw(*scene, screen=screen)
    assert image.shape == (screen[1], screen[0], 4)
    np.testing.assert_allclose(image, painted(*scene, screen=screen), rtol=0, atol=running_sum_bound(count, screen))


def test_neither_bands_nor_chunks_show(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = random_scene(211, (31, 29))
    whole = splat_draw(*scene, screen=(31, 29))
    monkeypatch.setattr(kernel, "BAND_PIXELS", 70)
    monkeypatch.setattr(kernel, "CHUNK_PAIRS", 101)
    bound = running_sum_bound(211, (31, 29))
    np.testing.assert_allclose(splat_draw(*scene, screen=(31, 29)), whole, rtol=0, atol=bound)


def test_draws_nothing_of_what_this_eye_does_not_see() -> None:
    ellipses, colors, opacities, order = random_scene(7, (13, 5))
    ellipses[:, 4:6] = 0
    assert not splat_draw(ellipses, colors, opacities, order, screen=(13, 5)).any()


def test_float32_scene_draws_as_float64() -> None:
    ellipses, colors, opacities = (a.astype(np.float32) for a in random_scene(31, (13, 5))[:3])
    order = np.arange(31)
    exact = splat_draw(ellipses.astype(float), colors.astype(float), opacities.astype(float), order, screen=(13, 5))
    found = splat_draw(ellipses, colors, opacities, order, screen=(13, 5))
    # Offsets of up to 20 pixels, in units of deviations of at least exp(-2), through 8 operations, then 31 blends.
    bound = 31 * 8 * 20 * np.exp(2) * np.finfo(np.float32).eps
    np.testing.assert_allclose(found, exact, rtol=0, atol=bound)


HELD_COLOR = np.array([[64, 192, 384]]) * 4 / COLOR_STEPS  # packed splats hold both exactly
HELD_OPACITY = np.array([1791]) / OPACITY_STEPS
LEAST_PSNR = 50.0  # dB, of the drawn image against the reference, for each eye
PICTURE = (512, 512)
RASTER_GRID = 1 / 256  # pixels; what Direct3D 11 demands, and desktop devices have
PLACED = 1e-4  # pixels, of a centre in float32 on these screens
BOX = 0.4 * np.array([[-1.0, -1, -1], [1, 1, 1]])  # metres; `camera` sees about 460 pixels to a metre of it
EYES = [1, 2]
FIELDS = ["centres", "rotations", "scales", "opacities", "sh", "texel_dq"]


@cache
def reference_scene(eyes: int) -> tuple[Splats, tuple[Camera, ...], Array]:
    """The scene and the reference's image of it [E, H, W, 4]."""
    frame, seen_by = scene(eyes)
    return frame, seen_by, reference_frame(frame, seen_by)


def cameras(bounds: Array, eyes: int, screen: tuple[int, int] = PICTURE) -> tuple[Camera, ...]:
    camera = orbit(bounds, screen=screen, azimuth=0.7, elevation=0.4)
    return (camera,) if eyes == 1 else stereo(camera)


def scene(eyes: int) -> tuple[Splats, tuple[Camera, ...]]:
    """Thin and round splats of 0.05 to 100 pixels, some beside the screen and some behind the camera."""
    seen_by = cameras(BOX, eyes)
    small = random_frame(4000, BOX, deviations=(1e-4, 0.05))
    large = random_frame(40, BOX, deviations=(0.05, 0.22), seed=1)
    both: dict[str, Any] = {name: np.concatenate([getattr(small, name), getattr(large, name)]) for name in FIELDS}
    frame = replace(small, **both)
    frame.centres[::9] = 2 * seen_by[0].position - frame.centres[::9]
    return frame, seen_by


def psnr(found: Array, expected: Array) -> list[float]:
    """Of each eye [E, H, W, 4], premultiplied colour and alpha alike, dB."""
    squared = np.mean(np.square(found - expected), axis=(1, 2, 3))
    return [float(-10 * np.log10(max(error, np.finfo(float).tiny))) for error in squared]


@pytest.mark.parametrize("eyes", EYES)
def test_shader_draws_random_splats_as_the_reference(device: Device, eyes: int) -> None:
    frame, seen_by, expected = reference_scene(eyes)
    assert expected[..., 3].mean() > 0.3
    assert min(psnr(draw_frame(device, frame, seen_by), expected)) >= LEAST_PSNR


@pytest.mark.parametrize("eyes", EYES)
def test_shader_draws_an_avatar_as_the_reference(device: Device, eyes: int) -> None:
    avatar = synthetic_avatar()
    frame = decode_clip_frame(avatar, avatar.clips[0], frame=3, dtype=np.float64)
    seen_by = cameras(frame_bounds(frame), eyes)
    expected = reference_frame(frame, seen_by)
    assert expected[..., 3].mean() > 0.1
    assert min(psnr(draw_frame(device, frame, seen_by), expected)) >= LEAST_PSNR


def test_shader_draws_what_render_does(device: Device) -> None:
    avatar = synthetic_avatar()
    frame = decode_clip_frame(avatar, avatar.clips[0], frame=3, dtype=np.float64)
    seen_by = cameras(frame_bounds(frame), 1, (97, 61))
    assert min(psnr(draw_frame(device, frame, seen_by), render_premultiplied(frame, seen_by[0])[None])) >= LEAST_PSNR


def test_front_to_back_is_another_image(device: Device) -> None:
    frame, seen_by, expected = reference_scene(1)
    splats = sort_frame(device, frame, seen_by)
    drawn = splats.arguments.read()[4]
    reversed_order = device.buffer(splats.order.read()[:drawn][::-1], name="order")
    wrong = replace(splats, order=reversed_order)
    found = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), wrong, seen_by)[None]
    assert max(psnr(found, expected)) < LEAST_PSNR


def test_eyes_differ(device: Device) -> None:
    left, right = draw_frame(device, *scene(2))
    assert max(psnr(left[None], right[None])) < LEAST_PSNR


def on_device(
    device: Device,
    ellipses: Array,  # [N, 6] of both eyes, or [E, N, 6]
    colors: Array,
    opacities: Array,
    order: Array,
    *,
    screen: tuple[int, int],
    depth: Array | float = 2.0,  # [N] metres
    corners: int = 6,
) -> SortedSplats:
    """Splats as the shaders would leave them for eyes at one place that look along -Z."""
    packed = ellipses if ellipses.ndim == 3 else ellipses[None]
    ellipses, both = packed[0], colors if colors.ndim == 3 else colors[None]
    (camera,) = facing(screen)
    ndc = (2 * ellipses[:, :2] / screen - 1) * [1, -1]
    focal, skew = np.diagonal(camera.projection)[:2], camera.projection[:2, 2]
    away = np.broadcast_to(depth, len(ellipses))[:, None]
    centres = np.concatenate([(ndc + skew) / focal * away, -away], axis=1)
    arguments = np.array([corners * len(order), 1, 0, 0, len(order)], np.uint32)
    return SortedSplats(
        splats=device.buffer(pack_splats(centres, both, opacities, packed), name="splats"),
        order=device.buffer(order.astype(np.uint32), name="order"),
        arguments=device.buffer(arguments, name="arguments", indirect=True),
        corners=corners,
    )


def in_halves(ellipses: Array) -> Array:
    """Ellipses [N, 6] whose axes half floats hold."""
    blank = np.zeros((len(ellipses), 3))
    fields = unpacked(pack_splats(blank, blank[None], blank[:, 0], ellipses[None]))
    axes, minors = (fields[name][:, 0].astype(float) for name in ("axes", "minors"))
    major = np.linalg.norm(axes, axis=1, keepdims=True)
    return np.concatenate([ellipses[:, :2], axes / np.maximum(major, 1e-30), major, minors[:, None]], axis=1)


def facing(screen: tuple[int, int]) -> tuple[Camera]:
    """A camera at the origin that looks along -Z."""
    return (replace(orbit(BOX, screen=screen), view=np.eye(4)),)


def integration_bound(exact: Array, opacity: float, major: float, minor: float) -> Array:
    """Error [H, W, 4] of one drawn splat whose premultiplied colours are at most 1.5 times its alpha.

    Corners of quads fall on a grid of pixels, which moves the offsets interpolated between them by half a step, and
    centres are projected in float32: the slope of a window is at most 2 of its peak to the ellipse's lesser half width,
    and there are two. Half floats round to the nearest or towards zero.
    """
    sigma = np.array([major, minor])
    wide = np.sqrt(sigma**2 + PIXEL_VARIANCE)
    peak = opacity * WEIGHT * np.prod(sigma / wide)
    shift = np.sqrt(0.5) * RASTER_GRID + PLACED
    alpha = peak * (2 * shift * 2 / (REACH * wide.min()) + 64 * np.finfo(np.float32).eps)
    half = np.finfo(np.float16)
    return np.asarray(1.5 * alpha + half.eps * exact + half.tiny)


@pytest.mark.parametrize("corners", [3, 6])
@pytest.mark.parametrize("screen", SCREENS)
@pytest.mark.parametrize("deviations", [(0.01, 0.01), (0.6, 0.05), (2.5, 0.3), (9.0, 4.0), (120.0, 90.0), (300.0, 0.5)])
def test_shader_integrates_a_splat_as_the_reference(
    device: Device, screen: tuple[int, int], deviations: tuple[float, float], corners: int
) -> None:
    rng = np.random.default_rng(screen[0])
    angle, middle = rng.uniform(-np.pi, np.pi), rng.uniform(0.2, 0.8, 2) * screen
    ellipses = in_halves(np.array([[*middle, np.cos(angle), np.sin(angle), *deviations]]))
    colors, opacities = HELD_COLOR, HELD_OPACITY
    splats = on_device(device, ellipses, colors, opacities, np.zeros(1), screen=screen, corners=corners)
    found = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, facing(screen))
    exact = splat_draw(ellipses, colors, opacities, np.zeros(1, int), screen=screen)
    row, column = np.mgrid[: screen[1], : screen[0]] + 0.5 - middle[::-1, None, None]
    from_edge = np.abs(np.abs(places_in_quad(ellipses[0], np.stack([column, row], axis=-1))) - 1).min(axis=-1)
    steepest = 1 / (REACH * np.sqrt(min(deviations) ** 2 + PIXEL_VARIANCE))  # change of (u, v) in a pixel
    certain = from_edge > RASTER_GRID * steepest  # nearer, a pixel may count as in or as out
    assert np.all((np.abs(found - exact) <= integration_bound(exact, 0.875, *deviations))[certain])


def test_each_eye_draws_its_own_ellipse_and_colour(device: Device) -> None:
    screen = (16, 16)
    level, upright = ([8.0, 8, 1, 0, 4, 1], [8.0, 8, 0, 1, 3, 2])
    ellipses, opacities = np.array([[level], [upright]]), HELD_OPACITY
    tint = np.array([[20, -63, 0]]) * 4 / COLOR_STEPS
    colors = np.stack([HELD_COLOR + tint, HELD_COLOR - tint])
    splats = on_device(device, ellipses, colors, opacities, np.zeros(1), screen=screen)
    found = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, 2 * facing(screen))
    for eye, picture in enumerate(np.split(found, 2, axis=1)):
        exact = splat_draw(ellipses[eye], colors[eye], opacities, np.zeros(1, int), screen=screen)
        np.testing.assert_allclose(picture, exact, rtol=0, atol=integration_bound(exact, 0.875, 3, 1).max())


def test_shader_draws_nothing_of_what_this_eye_does_not_see(device: Device) -> None:
    ellipses, colors, opacities, order = random_scene(7, (13, 5))
    ellipses[:, 4:6] = 0
    splats = on_device(device, ellipses, colors, opacities, order, screen=(13, 5))
    assert not draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, facing((13, 5))).any()


@pytest.mark.parametrize("eyes", EYES)
@pytest.mark.parametrize("count", [0, 1, 2])
@pytest.mark.parametrize("screen", [(1, 1), (3, 7)])
def test_shader_draws_few_splats_on_few_pixels(device: Device, count: int, screen: tuple[int, int], eyes: int) -> None:
    frame = random_frame(count, BOX, deviations=(0.02, 0.2))
    seen_by = cameras(BOX, eyes, screen)
    found, expected = draw_frame(device, frame, seen_by), reference_frame(frame, seen_by)
    assert found.shape == expected.shape
    assert min(psnr(found, expected)) >= LEAST_PSNR


@pytest.mark.parametrize("axis", [0, 2], ids=["beside", "behind"])
def test_no_visible_splat_gives_an_empty_picture(device: Device, axis: int) -> None:
    frame, seen_by = random_frame(31, BOX, deviations=(0.01, 0.02)), cameras(BOX, 2)
    away = replace(frame, centres=frame.centres + 10 * seen_by[0].view[axis, :3])
    assert not draw_frame(device, away, seen_by).any()


def test_what_stands_before_a_splat_hides_it(device: Device) -> None:
    screen = (16, 16)
    ellipses = np.tile([8.0, 8, 1, 0, 4, 4], (2, 1))
    splats = on_device(
        device, ellipses, np.eye(2, 3), np.ones(2), np.array([1, 0]), screen=screen, depth=np.array([1.0, 3.0])
    )
    renderer = SplatRenderer(device, IMAGE_FORMAT, depth_format="depth32float")
    found = draw_over_depth(device, renderer, splats, facing(screen), 1 - NEAR / 2.0)  # a wall 2 m away
    assert found[8, 8, 0] > 0.5
    assert not found[..., 1].any()


def test_a_splat_whose_middle_lies_before_the_near_plane_is_drawn(device: Device) -> None:
    """Half of it may lie behind: quads are flat, so that the device would cut all of it."""
    screen = (16, 16)
    seen_by = facing(screen)
    ellipses, colors, opacities = np.array([[8.0, 8, 1, 0, 4, 4]]), HELD_COLOR, HELD_OPACITY
    near = seen_by[0].near * np.array([0.5])
    splats = on_device(device, ellipses, colors, opacities, np.zeros(1), screen=screen, depth=near)
    found = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, seen_by)
    exact = splat_draw(ellipses, colors, opacities, np.zeros(1, int), screen=screen)
    np.testing.assert_allclose(found, exact, rtol=0, atol=integration_bound(exact, 0.875, 4, 4).max())


def draw_over_depth(
    device: Device, renderer: SplatRenderer, splats: SortedSplats, seen_by: Sequence[Camera], depth: float
) -> Array:
    """As draw_image, in a pass whose depth is cleared to one value."""
    size = (*seen_by[0].screen, 1)
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    target = device.wgpu.create_texture(size=size, format=IMAGE_FORMAT, usage=usage)
    wall = device.wgpu.create_texture(size=size, format="depth32float", usage=wgpu.TextureUsage.RENDER_ATTACHMENT)
    encoder = device.wgpu.create_command_encoder()
    stored = {"load_op": "clear", "store_op": "store"}
    render_pass = encoder.begin_render_pass(
        color_attachments=[{"view": target.create_view(), "clear_value": (0, 0, 0, 0), **stored}],
        depth_stencil_attachment={
            "view": wall.create_view(),
            "depth_clear_value": depth,
            "depth_load_op": "clear",
            "depth_store_op": "store",
        },
    )
    renderer.draw(render_pass, splats, seen_by)
    render_pass.end()
    device.wgpu.queue.submit([encoder.finish()])
    return read_image(device, target)
