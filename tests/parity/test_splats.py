"""Several avatars in one sort, each somewhere else, against the reference in float64 over all their splats together."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from frame_bounds import COLOR_BOUND, LEAST_PSNR, OPACITY_BOUND, POSITION_BOUND, psnr
from frame_errors import exact_colors
from joined_splats import joined, moved
from packed_splats import colors_of, opacities_of, unpacked
from splat_rounding import exact_keys
from synthetic_avatar import synthetic_avatar, with_texels

from mua import rotation
from mua.arrays import Array
from mua.asset import write
from mua.asset.avatar import Avatar
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.gpu import Device
from mua.kernels.splat_project import LAST_KEY
from mua.player.buffers import AvatarBuffers
from mua.player.draw import SplatRenderer, draw_image, image_format
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.rig.bounds import union

INDICES = (0, 3, 6)  # the frame that each avatar shows
HALF_LEVEL = 0.5 / 255  # a card places corners on a grid of 1/256 pixel, by which alpha was seen to move by 0.0018
VISIBLE_WORD = 4  # its place in `arguments`


def turned(angle: float, place: Sequence[float]) -> Array:
    """A rigid dual quaternion [8]: a turn about a slanted axis, then a move, metres."""
    axis = rotation.normalize(np.array([0.2, 1.0, -0.1]))
    return rotation.dual_from_rigid(rotation.from_axis_angle(axis, angle), np.array(place))


PLACES = (turned(0, (0, 0, 0)), turned(1.2, (0.35, 0.1, -0.2)), turned(-2.5, (-0.4, 0, 0.3)))  # they interpenetrate


def three() -> list[Avatar]:
    """Of three sizes, so that none starts at a whole group."""
    kept = (slice(None), slice(0, 301), slice(100, 457))
    return [with_texels(synthetic_avatar(seed), own) for seed, own in enumerate(kept, 1)]


class Crowd:
    """Avatars at PLACES, decoded and sorted on a device, and their reference."""

    def __init__(self, device: Device, directory: Path, avatars: Sequence[Avatar], *, eyes: int) -> None:
        for index, avatar in enumerate(avatars):
            write(directory / f"{index}.muaavatar", avatar, storage="f32")
        buffers = [AvatarBuffers(device, directory / f"{index}.muaavatar") for index in range(len(avatars))]
        self.device, self.frame = device, SplatFrame(device, [AvatarFrame(device, b) for b in buffers])
        alone = [
            moved(decode_clip_frame(avatar.avatar, avatar.avatar.clips[0], frame=index, dtype=np.float64), place)
            for avatar, index, place in zip(buffers, INDICES, PLACES, strict=True)
        ]
        self.exact = joined(alone)
        camera = orbit(frame_bounds(self.exact), screen=(256, 192), azimuth=0.7, elevation=0.3)
        self.cameras: tuple[Camera, ...] = (camera,) if eyes == 1 else stereo(camera, EYE_DISTANCE)
        commands = device.commands()
        for shown, index, place in zip(self.frame.avatars, INDICES, PLACES, strict=True):
            clip, window = shown.avatar.avatar.clips[0], shown.avatar.avatar.encoding.frames(index)
            shown.decode(commands, clip.rotations[window], clip.translations[window], place)
        self.frame.sort(commands, self.cameras)
        commands.submit()
        count = int(self.frame.arguments.read()[VISIBLE_WORD])
        slots = self.frame.order.read()[:count]
        self.keys = self.frame.keys.read(np.uint16)[slots].astype(int)
        firsts = self.frame.first_splats
        self.slots = np.concatenate(
            [first + np.arange(a.splat_count) for first, a in zip(firsts, self.frame.avatars, strict=True)]
        )
        self.order = np.searchsorted(self.slots, slots)  # splats, an odd avatar's last slot left out
        np.testing.assert_array_equal(self.slots[self.order], slots)


@pytest.fixture(scope="module", params=[1, 2])
def crowd(request: pytest.FixtureRequest, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Crowd:
    return Crowd(device, tmp_path_factory.mktemp("crowd"), three(), eyes=request.param)


def test_every_avatars_splats_agree_with_the_reference(crowd: Crowd) -> None:
    splats = unpacked(crowd.frame.splats.read())[crowd.slots]
    assert len(splats) == len(crowd.exact.centres) == sum(avatar.splat_count for avatar in crowd.frame.avatars)
    assert np.abs(splats["centre"] - crowd.exact.centres).max() < POSITION_BOUND
    assert np.abs(opacities_of(splats) - crowd.exact.opacities).max() < OPACITY_BOUND
    assert np.abs(colors_of(splats) - exact_colors(crowd.exact, crowd.cameras)).max() < COLOR_BOUND


def test_one_order_goes_through_all_avatars(crowd: Crowd) -> None:
    """That of the keys over the box around all; splats of equal keys stay in the order of avatars and texels."""
    bounds = union(np.stack([avatar.bounds for avatar in crowd.frame.avatars]))
    views = np.stack([camera.view for camera in crowd.cameras])
    exact, rounding = exact_keys(crowd.exact.centres, views, bounds)
    depths = np.ptp(np.stack(np.meshgrid(*bounds.T)).reshape(3, -1).T @ views.mean(axis=0)[2, :3])
    moved_by = LAST_KEY * POSITION_BOUND * np.sqrt(3) / depths
    np.testing.assert_array_equal(np.sort(crowd.order), np.arange(len(crowd.exact.centres)))
    assert np.abs(crowd.keys - exact[crowd.order]).max() <= 0.5 + rounding + moved_by
    assert np.all(np.diff(crowd.keys) >= 0)
    assert np.all(np.diff(crowd.order.astype(int))[np.diff(crowd.keys) == 0] > 0)
    owner = np.searchsorted(crowd.frame.first_splats, crowd.slots[crowd.order], side="right")
    assert np.count_nonzero(np.diff(owner)) > len(owner) / 10  # they do stand among each other


def test_the_box_of_each_avatar_holds_its_splats(crowd: Crowd) -> None:
    assert len(crowd.frame.avatars) > 1
    for avatar, first in zip(crowd.frame.avatars, crowd.frame.first_splats, strict=True):
        own = crowd.exact.centres[np.searchsorted(crowd.slots, first) :][: avatar.splat_count]
        assert np.all(avatar.bounds[0] <= own.min(axis=0))
        assert np.all(own.max(axis=0) <= avatar.bounds[1])


def test_the_picture_agrees_with_the_cpu_rasteriser(crowd: Crowd) -> None:
    renderer = SplatRenderer(crowd.device, image_format(crowd.device))
    image = draw_image(crowd.device, renderer, crowd.frame.sorted, crowd.cameras)
    assert len(crowd.cameras) > 0
    for found, camera in zip(np.split(image, len(crowd.cameras), axis=1), crowd.cameras, strict=True):
        assert psnr(found, render_premultiplied(crowd.exact, camera)) > LEAST_PSNR


@pytest.mark.parametrize("eyes", [1, 2])
@pytest.mark.parametrize("size", [16, 256])
def test_small_splats_are_triangles_large_ones_quads_and_both_make_the_same_picture(
    device: Device, tmp_path: Path, size: int, eyes: int
) -> None:
    crowd, corners = Crowd(device, tmp_path, three(), eyes=eyes), 3 if size == 16 else 6
    cameras = tuple(replace(camera, screen=(size, size)) for camera in crowd.cameras)
    commands = device.commands()
    crowd.frame.sort(commands, cameras)
    commands.submit()
    found, words = crowd.frame.sorted, crowd.frame.arguments.read()
    assert found.corners == corners
    assert words[0] == corners * words[VISIBLE_WORD] > 0
    renderer, other = SplatRenderer(device, image_format(device)), 9 - corners
    words[0] = other * words[VISIBLE_WORD]
    arguments = device.buffer(words, name="arguments", indirect=True)
    one, two = (
        draw_image(device, renderer, splats, cameras)
        for splats in (found, replace(found, arguments=arguments, corners=other))
    )
    assert one.any()
    np.testing.assert_allclose(one, two, rtol=0, atol=HALF_LEVEL)


def test_an_avatar_without_texels_stands_among_others(device: Device, tmp_path: Path) -> None:
    avatars = three()
    crowd = Crowd(device, tmp_path, [avatars[0], with_texels(avatars[1], slice(0, 0)), avatars[2]], eyes=1)
    np.testing.assert_array_equal(np.sort(crowd.order), np.arange(len(crowd.exact.centres)))


class Dispatched:
    """Passes dispatches on, and keeps which kernel read how many keys or texels."""

    def __init__(self, device: Device) -> None:
        self.commands, self.projected, self.keys = device.commands(), list[int](), set[int]()

    def dispatch(self, kernel: Any, *arguments: Any, **constants: Any) -> None:
        if "texel_count" in constants:
            self.projected.append(constants["texel_count"])
        if "key_count" in constants:
            self.keys.add(constants["key_count"])
        self.commands.dispatch(kernel, *arguments, **constants)


def sort_from(crowd: Crowd, cameras: Sequence[Camera]) -> Dispatched:
    listed = Dispatched(crowd.device)
    crowd.frame.sort(listed, cameras)  # type: ignore[arg-type]
    listed.commands.submit()
    return listed


def send_away(crowd: Crowd, index: int, place: Sequence[float]) -> None:
    """Pose an avatar elsewhere."""
    avatar, commands = crowd.frame.avatars[index], crowd.device.commands()
    clip, window = avatar.avatar.avatar.clips[0], avatar.avatar.avatar.encoding.frames(INDICES[index])
    avatar.decode(commands, clip.rotations[window], clip.translations[window], turned(0, place))
    commands.submit()


def past(camera: Camera) -> Camera:
    """The camera, gone on until all lies behind it."""
    view = camera.view.copy()
    view[2, 3] += 40
    return replace(camera, view=view)


@pytest.mark.parametrize("eyes", [1, 2])
def test_an_avatar_out_of_view_is_neither_projected_nor_sorted(device: Device, tmp_path: Path, eyes: int) -> None:
    crowd = Crowd(device, tmp_path, three(), eyes=eyes)
    send_away(crowd, 0, (40 * crowd.cameras[0].view[2, :3]).tolist())  # behind the camera
    listed = sort_from(crowd, crowd.cameras)
    counts = [avatar.splat_count for avatar in crowd.frame.avatars]
    assert listed.projected == counts[1:]
    assert listed.keys == {sum(count + count % 2 for count in counts[1:])}
    assert crowd.frame.arguments.read()[VISIBLE_WORD] == sum(counts[1:])
    image = draw_image(device, SplatRenderer(device, image_format(device)), crowd.frame.sorted, crowd.cameras)
    alone = [
        moved(decode_clip_frame(a.avatar.avatar, a.avatar.avatar.clips[0], frame=i, dtype=np.float64), place)
        for a, i, place in list(zip(crowd.frame.avatars, INDICES, PLACES, strict=True))[1:]
    ]
    for found, camera in zip(np.split(image, eyes, axis=1), crowd.cameras, strict=True):
        assert psnr(found, render_premultiplied(joined(alone), camera)) > LEAST_PSNR


def test_an_avatar_that_one_eye_sees_is_drawn(device: Device, tmp_path: Path) -> None:
    crowd = Crowd(device, tmp_path, three(), eyes=2)
    away = past(crowd.cameras[1])
    assert len(sort_from(crowd, (crowd.cameras[0], away)).projected) == 3
    assert len(sort_from(crowd, (away, crowd.cameras[0])).projected) == 3


def test_nothing_is_drawn_while_all_avatars_are_out_of_view(device: Device, tmp_path: Path) -> None:
    crowd = Crowd(device, tmp_path, three(), eyes=1)
    away = past(crowd.cameras[0])
    assert sort_from(crowd, [away]).projected == []
    assert sort_from(crowd, [away]).keys == {0}
    assert not draw_image(device, SplatRenderer(device, image_format(device)), crowd.frame.sorted, [away]).any()
    assert len(sort_from(crowd, crowd.cameras).projected) == 3  # and all are drawn when they are back
    np.testing.assert_array_equal(np.sort(crowd.frame.order.read()[: len(crowd.slots)]), np.sort(crowd.slots))
