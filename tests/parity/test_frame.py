"""The whole frame, from a window of poses to sorted splats and their image, against the reference in float64."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from frame_bounds import (
    COLOR_BOUND,
    FEWER_THAN,
    FRAME_ORDER,
    LEAST_PSNR,
    OPACITY_BOUND,
    POSITION_BOUND,
    psnr,
)
from frame_errors import PosedFrame
from synthetic_avatar import sparse_avatar, synthetic_avatar, with_random_poses, with_texels

from mua.arrays import Array
from mua.asset import write
from mua.asset.avatar import Avatar
from mua.asset.tensors import Storage
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.bench.random_avatar import random_avatar
from mua.errors import InputError
from mua.gpu import Device
from mua.kernels.splat_project import AWAY, facing
from mua.player.buffers import AvatarBuffers
from mua.player.cpu_image import Reference
from mua.player.draw import SplatRenderer, draw_image, image_format
from mua.player.frame import AvatarFrame
from mua.player.offscreen import Offscreen
from mua.player.splats import SplatFrame
from mua.player.toggles import Toggles
from mua.student.settings import preset

MOST_KEYS = 4.0  # in 65535ths: splats that differ by less may be sorted wrongly
FAR = 0.9  # outside of training
OPACITY = 10  # channel


class Listed:
    """Takes dispatches down instead of running them."""

    def __init__(self) -> None:
        self.names: list[str] = []

    def dispatch(self, kernel: object, *_: object, **__: object) -> None:
        self.names.append(kernel.name)  # type: ignore[attr-defined]


def saved(avatar: Avatar, directory: Path, *, storage: Storage = "f32") -> Path:
    path = directory / f"{storage}.muaavatar"
    write(path, avatar, storage=storage)
    return path


def opened(device: Device, avatar: Avatar, directory: Path, *, storage: Storage = "f32") -> SplatFrame[AvatarFrame]:
    return SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, saved(avatar, directory, storage=storage)))])


def faint(avatar: Avatar) -> Avatar:
    """The avatar with every opacity below what an image can show."""
    mean = avatar.geometry.ll_mean.copy()
    mean[OPACITY] -= 20 * 2**avatar.wavelet.levels
    return replace(avatar, geometry=replace(avatar.geometry, ll_mean=mean))


def picture(device: Device, frame: SplatFrame[AvatarFrame], cameras: tuple[Camera, ...], *, index: int = 0) -> Array:
    avatar = frame.avatars[0].avatar.avatar
    clip, window = avatar.clips[0], avatar.encoding.frames(index)
    commands = device.commands()
    frame.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
    frame.sort(commands, cameras)
    commands.submit()
    return draw_image(device, SplatRenderer(device, image_format(device)), frame.sorted, cameras)


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
@pytest.mark.parametrize("eyes", [1, 2])
def test_frames_agree_with_the_reference_on_the_same_stored_values(
    device: Device, tmp_path: Path, storage: Storage, eyes: int
) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path, storage=storage)
    for index in (0, 3, 6):
        posed = PosedFrame(device, frame, frame.avatars[0].avatar.avatar.clips[0], index, eyes=eyes, screen=256)
        errors = posed.errors()
        assert errors.position < POSITION_BOUND
        assert errors.color < COLOR_BOUND
        assert errors.opacity < OPACITY_BOUND
        assert errors.key <= errors.key_bound < MOST_KEYS


def test_poses_far_outside_of_training_agree(device: Device, tmp_path: Path) -> None:
    frame = opened(device, with_random_poses(synthetic_avatar(1), 6), tmp_path)
    (gpu,) = frame.avatars
    clip = gpu.avatar.avatar.clips[0]
    for index in range(len(clip)):
        posed = PosedFrame(device, frame, clip, index, eyes=1, screen=256)
        assert gpu.outside == pytest.approx(posed.exact.outside, abs=1e-12)
        assert gpu.outside > FAR
        errors = posed.errors()
        assert errors.position < POSITION_BOUND
        assert errors.color < COLOR_BOUND
        assert errors.opacity < OPACITY_BOUND


@pytest.mark.parametrize("storage", ["f32", "i8"])
def test_coarser_levels_agree_and_the_finest_comes_back(device: Device, tmp_path: Path, storage: Storage) -> None:
    frame = opened(device, sparse_avatar(2), tmp_path, storage=storage)
    (gpu,) = frame.avatars
    counts = []
    for level in (1, 2, 0):
        clip = gpu.avatar.avatar.clips[0]
        posed = PosedFrame(device, frame, clip, 3, eyes=1, screen=256, level=level)
        errors = posed.errors()
        assert errors.position < POSITION_BOUND
        assert errors.color < COLOR_BOUND
        assert errors.opacity < OPACITY_BOUND
        assert errors.key <= errors.key_bound < MOST_KEYS
        assert posed.exact.normals is not None
        away = facing(posed.exact.centres, posed.exact.normals, posed.cameras[0].view)
        np.testing.assert_array_equal(np.sort(posed.order), np.flatnonzero(away <= AWAY))
        assert posed.visible == len(posed.order)
        assert np.any(away > AWAY)
        counts.append(posed.visible)
    assert counts[1] < counts[0] < counts[2]


@pytest.mark.parametrize("eyes", [1, 2])
def test_order_is_back_to_front_and_keeps_the_texels_of_equal_keys(device: Device, tmp_path: Path, eyes: int) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    posed = PosedFrame(device, frame, frame.avatars[0].avatar.avatar.clips[0], 5, eyes=eyes, screen=256)
    assert posed.visible == len(posed.exact.centres)  # none is out of view
    np.testing.assert_array_equal(np.sort(posed.order), np.arange(len(posed.exact.centres)))
    keys, order = posed.keys.astype(int), posed.order.astype(int)
    assert np.all(np.diff(keys) >= 0)
    assert np.all(np.diff(order)[np.diff(keys) == 0] > 0)
    assert len(np.unique(keys)) > frame.splat_count / 2


def test_a_frame_is_few_dispatches_in_the_order_of_the_kernels(device: Device, tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    frame, clip, listed = opened(device, avatar, tmp_path), avatar.clips[0], Listed()
    frame.avatars[0].decode(listed, clip.rotations[:3], clip.translations[:3])  # type: ignore[arg-type]
    frame.sort(listed, [orbit(avatar.bounds, screen=(8, 8))])  # type: ignore[arg-type]
    assert listed.names == FRAME_ORDER
    assert len(listed.names) < FEWER_THAN


@pytest.mark.parametrize("wavelet", ["bior1.1", "bior3.3", "bior6.8"])  # 2, 8 and 18 taps
def test_other_wavelets_agree(device: Device, tmp_path: Path, wavelet: str) -> None:
    frame = opened(device, synthetic_avatar(wavelet=wavelet), tmp_path)
    errors = PosedFrame(device, frame, frame.avatars[0].avatar.avatar.clips[0], 4, eyes=1, screen=64).errors()
    assert errors.position < POSITION_BOUND
    assert errors.color < COLOR_BOUND


def test_planes_that_are_not_whole_words_agree(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(levels=5), tmp_path)  # whose lowest plane is a single sample
    errors = PosedFrame(device, frame, frame.avatars[0].avatar.avatar.clips[0], 4, eyes=1, screen=64).errors()
    assert errors.position < POSITION_BOUND
    assert errors.color < COLOR_BOUND


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_branches_of_fewer_levels_agree(device: Device, tmp_path: Path, levels: int) -> None:
    avatar = synthetic_avatar()
    geometry, appearance = (
        replace(branch, details=branch.details[: levels - 1], mlp=branch.mlp)
        for branch in (avatar.geometry, avatar.appearance)
    )
    trimmed = [(branch, sum(branch.ranks) * branch.channels) for branch in (geometry, appearance)]
    geometry, appearance = (
        replace(
            branch,
            mlp=(
                *branch.mlp[:-1],
                replace(branch.mlp[-1], weight=branch.mlp[-1].weight[:n], bias=branch.mlp[-1].bias[:n]),
            ),
        )
        for branch, n in trimmed
    )
    shorter = replace(avatar, geometry=geometry, appearance=appearance)
    frame = opened(device, shorter, tmp_path)
    errors = PosedFrame(device, frame, avatar.clips[0], 4, eyes=1, screen=64).errors()
    assert errors.position < POSITION_BOUND
    assert errors.color < COLOR_BOUND


@pytest.mark.parametrize("index", [0, 6])
def test_pictures_of_both_eyes_agree_with_the_cpu_rasteriser(device: Device, tmp_path: Path, index: int) -> None:
    path = saved(synthetic_avatar(), tmp_path)
    buffers = AvatarBuffers(device, path)
    clip = buffers.avatar.clips[0]
    posed = decode_clip_frame(buffers.avatar, clip, frame=index, dtype=np.float64)
    cameras = stereo(orbit(frame_bounds(posed), screen=(512, 512), azimuth=0.5), EYE_DISTANCE)
    image = Offscreen(device, buffers, clip, Toggles()).picture(index, cameras)
    for found, camera in zip(np.split(image, 2, axis=1), cameras, strict=True):
        assert psnr(found, render_premultiplied(posed, camera)) > LEAST_PSNR


def test_a_figure_of_the_papers_proportions_agrees(device: Device, tmp_path: Path) -> None:
    """Random numbers in the shapes of preset tiny, 54 joints, 18,496 splats."""
    frame = opened(device, random_avatar(preset("tiny")), tmp_path, storage="f16")
    avatar = frame.avatars[0].avatar.avatar
    posed = PosedFrame(device, frame, avatar.clips[0], 12, eyes=1, screen=256)
    errors = posed.errors()
    assert errors.position < POSITION_BOUND
    assert errors.color < COLOR_BOUND
    image = draw_image(device, SplatRenderer(device, image_format(device)), frame.sorted, posed.cameras)
    assert psnr(image, render_premultiplied(posed.exact, posed.cameras[0])) > LEAST_PSNR


def test_the_next_frame_does_not_see_the_last(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    camera = orbit(synthetic_avatar().bounds, screen=(64, 64))
    first = picture(device, frame, (camera,), index=6)
    picture(device, frame, stereo(replace(camera, screen=(32, 32)), EYE_DISTANCE), index=0)
    np.testing.assert_array_equal(picture(device, frame, (camera,), index=6), first)


def test_depth_keys_follow_the_figure_away_from_the_origin(device: Device, tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    parents = avatar.rig.skeleton.parents
    far = replace(clip, translations=clip.translations + np.array([30.0, 0, -40]) * (parents < 0)[:, None])
    frame = opened(device, replace(avatar, clips=(far,)), tmp_path)
    posed = PosedFrame(device, frame, frame.avatars[0].avatar.avatar.clips[0], 3, eyes=1, screen=64)
    assert len(np.unique(posed.keys)) > frame.splat_count / 2
    assert posed.errors().position < POSITION_BOUND


def test_depth_is_keyed_over_the_references_box(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    avatar = frame.avatars[0].avatar.avatar
    posed = PosedFrame(device, frame, avatar.clips[0], 3, eyes=1, screen=64)
    np.testing.assert_allclose(frame.box(), posed.exact.bounds, rtol=0, atol=4 * float(np.finfo(np.float32).eps))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_an_avatar_of_few_texels_is_drawn(device: Device, tmp_path: Path, count: int) -> None:
    few = with_texels(synthetic_avatar(), slice(300, 300 + count))
    frame = opened(device, few, tmp_path)
    posed = decode_clip_frame(frame.avatars[0].avatar.avatar, few.clips[0], frame=0)
    camera = orbit(synthetic_avatar().bounds, screen=(96, 64))
    image = picture(device, frame, (camera,))
    assert psnr(image, render_premultiplied(posed, camera)) > LEAST_PSNR
    assert image.any() == (count > 0)


def test_an_avatar_too_faint_to_see_leaves_the_picture_empty(device: Device, tmp_path: Path) -> None:
    frame = opened(device, faint(synthetic_avatar()), tmp_path)
    cameras = stereo(orbit(synthetic_avatar().bounds, screen=(64, 64)), EYE_DISTANCE)
    assert not picture(device, frame, cameras).any()
    np.testing.assert_array_equal(frame.arguments.read(), [0, 1, 0, 0, 0])


def test_a_camera_that_looks_away_leaves_the_picture_empty(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    camera = orbit(synthetic_avatar().bounds, screen=(64, 64))
    away = replace(camera, view=np.diag([-1.0, 1, -1, 1]) @ camera.view)
    assert not picture(device, frame, (away,)).any()


def test_a_camera_inside_the_body_sees_what_the_reference_sees(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    avatar = frame.avatars[0].avatar.avatar
    posed = decode_clip_frame(avatar, avatar.clips[0], frame=0, dtype=np.float64)
    camera = orbit(frame_bounds(posed), screen=(64, 64))
    view = camera.view.copy()
    view[:3, 3] = -view[:3, :3] @ posed.centres.mean(axis=0)
    inside = replace(camera, view=view)
    image = picture(device, frame, (inside,))
    assert np.isfinite(image).all()
    assert psnr(image, Reference(avatar, avatar.clips[0]).picture(0, (inside,))) > LEAST_PSNR


@pytest.mark.parametrize("screen", [(1, 1), (1, 7), (37, 1)])
def test_the_smallest_pictures_agree(device: Device, tmp_path: Path, screen: tuple[int, int]) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    avatar = frame.avatars[0].avatar.avatar
    camera = orbit(avatar.bounds, screen=screen)
    image = picture(device, frame, (camera,))
    assert image.shape == (screen[1], screen[0], 4)
    assert psnr(image, Reference(avatar, avatar.clips[0]).picture(0, (camera,))) > LEAST_PSNR


def test_refuses_eyes_of_different_screens_and_more_than_two(device: Device, tmp_path: Path) -> None:
    frame = opened(device, synthetic_avatar(), tmp_path)
    camera = orbit(synthetic_avatar().bounds, screen=(64, 48))
    for cameras in ([], [camera] * 3, [camera, replace(camera, screen=(64, 64))]):
        with pytest.raises(InputError, match="expected one or 2 of one size"):
            frame.sort(device.commands(), cameras)
