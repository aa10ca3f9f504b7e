"""Where the camera stands while a clip plays."""

from dataclasses import replace

import numpy as np
import pytest
from projected_points import ndc
from scipy.spatial.transform import Rotation
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.errors import InputError
from mua.player.focus import find_focus
from mua.player.shot import Shot, film, full_turn
from mua.pose.clip import Clip
from mua.rig.bounds import frame_boxes, root_positions, union

AVATAR = synthetic_avatar()
RIG, CLIP = AVATAR.rig, AVATAR.clips[0]
ROUNDING = 1e-9


@pytest.mark.parametrize("shot", [Shot((64, 96)), Shot((64, 96), follow=True), Shot((64, 96), turning=2.0)])
def test_the_figure_is_in_the_picture_at_every_frame(shot: Shot) -> None:
    assert len(CLIP) > 1
    for (camera,), box in zip(film(shot, RIG, CLIP), frame_boxes(RIG, CLIP), strict=True):
        corners = np.array(np.meshgrid(*box.T)).reshape(3, -1).T
        assert np.abs(ndc(camera, corners)).max() <= 1


def test_a_still_camera_stands_still() -> None:
    views = [camera.view for (camera,) in film(Shot((64, 64)), RIG, CLIP)]
    assert all(np.array_equal(view, views[0]) for view in views)


def test_a_camera_that_follows_keeps_beside_the_figure_at_one_height() -> None:
    places = CLIP.translations.copy()
    places[:, 0, 1] += np.linspace(0, 1, len(CLIP))  # it leaps
    leaping = replace(CLIP, translations=places)
    cameras = [camera for (camera,) in film(Shot((64, 64), follow=True), RIG, leaping)]
    away = np.array([camera.position for camera in cameras]) - root_positions(RIG, leaping)
    np.testing.assert_allclose(away[:, [0, 2]], np.tile(away[0, [0, 2]], (len(CLIP), 1)), atol=ROUNDING)
    assert np.ptp([camera.position[1] for camera in cameras]) < ROUNDING


def test_a_turning_camera_goes_round_at_its_speed() -> None:
    shot = Shot((64, 64), turning=np.pi)
    turned = [camera.view[:3, :3] for (camera,) in film(shot, RIG, CLIP)]
    step = np.arccos((np.trace(turned[1] @ turned[0].T) - 1) / 2)
    assert step == pytest.approx(np.pi / CLIP.rate)
    assert film(shot, RIG, CLIP)[1][0].position[0] > film(shot, RIG, CLIP)[0][0].position[0]  # to its left


def test_a_turning_camera_keeps_its_distance() -> None:
    still = CLIP.cut(np.zeros(7, int))
    cameras = [camera for (camera,) in film(Shot((64, 96), turning=5.0), RIG, still)]
    middle = union(frame_boxes(RIG, still)).mean(axis=0)
    away = np.linalg.norm([camera.position - middle for camera in cameras], axis=-1)
    np.testing.assert_allclose(away, away[0])


@pytest.mark.parametrize("degrees", [0.0, 70, 180])
def test_the_camera_stands_before_the_figures_front(degrees: float) -> None:
    turn = Rotation.from_euler("y", degrees, degrees=True).as_quat(scalar_first=True)
    rotations = np.tile(RIG.skeleton.bind_rotations, (3, 1, 1))
    rotations[:, 0] = rotation.multiply(turn, rotations[:, 0])
    clip = Clip("turned", 24, rotations, np.tile(RIG.skeleton.bind_translations, (3, 1, 1)))
    (camera,) = film(Shot((64, 64), azimuth=0.3), RIG, clip)[0]
    away = camera.position - union(frame_boxes(RIG, clip)).mean(axis=0)
    assert np.arctan2(away[0], away[2]) == pytest.approx(wrapped(np.radians(degrees) + 0.3))


def wrapped(angle: float) -> float:
    """The angle wrapped to within half a turn of 0."""
    return float(np.angle(np.exp(1j * angle)))


@pytest.mark.parametrize("zoom", [1.5, 30.0])
def test_what_is_looked_at_stays_in_the_middle_at_its_size(zoom: float) -> None:
    shot = Shot((64, 96), look_at="middle", zoom=zoom, follow=True)
    places = find_focus(RIG, "middle").places(RIG.skeleton, CLIP.rotations, CLIP.translations)
    sizes = []  # of a metre there, in halves of the image
    for (camera,), place in zip(film(shot, RIG, CLIP), places, strict=True):
        np.testing.assert_allclose(ndc(camera, place[None]), 0, atol=ROUNDING)
        sizes.append(camera.projection[1, 1] / np.linalg.norm(camera.position - place))
    np.testing.assert_allclose(sizes, sizes[0])
    (far,) = film(replace(shot, zoom=1.0), RIG, CLIP)[0]
    assert sizes[0] == pytest.approx(zoom * far.projection[1, 1] / np.linalg.norm(far.position - places[0]))


@pytest.mark.parametrize("look_at", [None, "tip"])
@pytest.mark.parametrize("azimuth", [0.0, np.pi / 2, 2.0])
def test_however_near_it_comes_the_camera_stays_outside_of_the_figure(look_at: str | None, azimuth: float) -> None:
    shot = Shot((64, 96), look_at=look_at, azimuth=azimuth, elevation=0.4, zoom=50.0, turning=1.0)
    for (camera,), (low, high) in zip(film(shot, RIG, CLIP), frame_boxes(RIG, CLIP), strict=True):
        assert np.maximum(low - camera.position, camera.position - high).max() > -ROUNDING


def test_a_camera_that_does_not_follow_looks_where_the_joint_was_at_first() -> None:
    cameras = [camera for (camera,) in film(Shot((64, 96), look_at="tip"), RIG, CLIP)]
    first = find_focus(RIG, "tip").places(RIG.skeleton, CLIP.rotations, CLIP.translations)[0]
    assert len(cameras) == len(CLIP)
    for camera in cameras:
        np.testing.assert_allclose(ndc(camera, first[None]), 0, atol=ROUNDING)


def test_refuses_to_look_at_what_is_not_there() -> None:
    with pytest.raises(InputError, match="--look-at is 'tail'"):
        film(Shot((64, 64), look_at="tail"), RIG, CLIP)


@pytest.mark.parametrize("speed", [-60.0, 0.0, 7.0, 360.0])
def test_after_a_full_turn_comes_the_first_picture_again(speed: float) -> None:
    shot, count, rate = full_turn(Shot((64, 64), turning=np.radians(speed)))
    turns = shot.turning * count / rate / (2 * np.pi)
    assert turns == pytest.approx(-1 if speed < 0 else 1)
    assert count == round(360 * rate / abs(speed or 60))


@pytest.mark.parametrize("speed", [0.5, 1000.0])
def test_a_turntable_too_slow_or_too_fast_is_refused(speed: float) -> None:
    with pytest.raises(InputError, match=f"--orbit is {speed:g}; a turntable turns by 1 to 360 degrees per second"):
        full_turn(Shot((64, 64), turning=np.radians(speed)))


def test_one_frame_is_a_clip_too() -> None:
    single = CLIP.cut(slice(1))
    assert len(film(Shot((1, 1)), RIG, single)) == 1
