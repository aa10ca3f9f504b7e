"""Where the camera stands while a clip plays."""

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.bounds import frame_boxes, root_positions
from mua.camera import EYE_DISTANCE, Camera
from mua.player.shot import Shot, film

AVATAR = synthetic_avatar()
RIG, CLIP = AVATAR.rig, AVATAR.clips[0]
ROUNDING = 1e-9


def ndc(camera: Camera, points: Array) -> Array:
    clip = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ (camera.projection @ camera.view).T
    assert np.all(clip[:, 3] > 0)
    return np.asarray(clip[:, :2] / clip[:, 3:])


@pytest.mark.parametrize("shot", [Shot((64, 96)), Shot((64, 96), follow=True), Shot((64, 96), turning=2.0)])
def test_the_figure_is_in_the_picture_at_every_frame(shot: Shot) -> None:
    for (camera,), box in zip(film(shot, RIG, CLIP), frame_boxes(RIG, CLIP), strict=True):
        corners = np.array(np.meshgrid(*box.T)).reshape(3, -1).T
        assert np.abs(ndc(camera, corners)).max() <= 1


def test_a_still_camera_stands_still() -> None:
    views = [camera.view for (camera,) in film(Shot((64, 64)), RIG, CLIP)]
    assert all(np.array_equal(view, views[0]) for view in views)


def test_a_camera_that_follows_keeps_beside_the_figure_at_one_height() -> None:
    cameras = [camera for (camera,) in film(Shot((64, 64), follow=True), RIG, CLIP)]
    away = np.array([camera.position for camera in cameras]) - root_positions(RIG, CLIP)
    np.testing.assert_allclose(away[:, [0, 2]], np.tile(away[0, [0, 2]], (len(CLIP), 1)), atol=ROUNDING)
    assert np.ptp([camera.position[1] for camera in cameras]) < ROUNDING


def test_a_turning_camera_goes_round_at_its_speed() -> None:
    shot = Shot((64, 64), turning=np.pi)
    turned = [camera.view[:3, :3] for (camera,) in film(shot, RIG, CLIP)]
    step = np.arccos((np.trace(turned[1] @ turned[0].T) - 1) / 2)
    assert step == pytest.approx(np.pi / CLIP.rate)
    assert film(shot, RIG, CLIP)[1][0].position[0] > film(shot, RIG, CLIP)[0][0].position[0]  # to its left


def test_two_eyes_stand_about_the_one() -> None:
    one = film(Shot((64, 64)), RIG, CLIP)[0][0]
    left, right = film(Shot((64, 64), eyes=EYE_DISTANCE), RIG, CLIP)[0]
    np.testing.assert_allclose((left.position + right.position) / 2, one.position, atol=ROUNDING)
    assert np.linalg.norm(right.position - left.position) == pytest.approx(EYE_DISTANCE)


def test_one_frame_is_a_clip_too() -> None:
    single = CLIP.cut(slice(1))
    assert len(film(Shot((1, 1)), RIG, single)) == 1
