"""The orbit camera: where it stands and what it frames."""

import numpy as np
import pytest
from projected_points import ndc

from mua.avatar.camera import FILL, orbit, sees, stereo

BOX = np.array([[-0.3, 0.1, -0.2], [0.5, 1.9, 0.4]])
ROUNDING = 64 * np.finfo(float).eps


@pytest.mark.parametrize("screen", [(640, 960), (1, 1), (997, 13)])
@pytest.mark.parametrize(("azimuth", "elevation"), [(0, 0), (0.7, 0.3), (-2.5, 1.5), (3, -1)])
def test_the_whole_box_is_in_the_image_and_touches_its_margin(
    screen: tuple[int, int], azimuth: float, elevation: float
) -> None:
    camera = orbit(BOX, screen=screen, azimuth=azimuth, elevation=elevation)
    corners = np.array(np.meshgrid(*BOX.T)).reshape(3, -1).T
    assert np.abs(ndc(camera, corners)).max() == pytest.approx(FILL, abs=ROUNDING)
    np.testing.assert_allclose(ndc(camera, BOX.mean(axis=0)[None]), 0, atol=ROUNDING)


@pytest.mark.parametrize("size", [1.3e-3, 1.0, 22.0])
def test_the_near_plane_lies_before_a_figure_of_any_size(size: float) -> None:
    camera = orbit(size * BOX, screen=(64, 96))
    corners = np.array(np.meshgrid(*(size * BOX).T)).reshape(3, -1)
    depths = -(camera.view[:3, :3] @ corners + camera.view[:3, 3:])[2]
    assert 0 < camera.near < 0.1 * depths.min()


def test_azimuth_goes_round_to_the_left_and_elevation_up() -> None:
    middle = BOX.mean(axis=0)
    places = {(0, 0): [0, 0, 1], (np.pi / 2, 0): [1, 0, 0], (0, np.pi / 2): [0, 1, 0]}
    for (azimuth, elevation), direction in places.items():
        away = orbit(BOX, screen=(64, 64), azimuth=azimuth, elevation=elevation).position - middle
        np.testing.assert_allclose(away / np.linalg.norm(away), direction, atol=ROUNDING)


def test_up_is_up_and_the_characters_left_is_on_the_right_of_its_front_view() -> None:
    camera = orbit(BOX, screen=(64, 64))
    up, left = ndc(camera, BOX.mean(axis=0) + np.array([[0, 0.1, 0], [0.1, 0, 0]]))
    assert up[1] > 0
    assert left[0] > 0


def test_a_single_point_can_be_framed() -> None:
    assert np.isfinite(orbit(np.zeros((2, 3)), screen=(64, 64)).view).all()


def test_eyes_stand_their_distance_apart_across_the_view_about_the_camera() -> None:
    camera = orbit(BOX, screen=(64, 64), azimuth=0.7, elevation=0.3)
    left, right = stereo(camera, 0.063)
    across = right.position - left.position
    np.testing.assert_allclose(across, 0.063 * camera.view[0, :3], atol=ROUNDING)
    np.testing.assert_allclose((left.position + right.position) / 2, camera.position, atol=ROUNDING)
    np.testing.assert_array_equal(left.view[:3, :3], camera.view[:3, :3])


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_box_is_seen_until_all_of_it_lies_beyond_one_side(axis: int, side: int) -> None:
    camera = orbit(BOX, screen=(64, 48), azimuth=0.7, elevation=0.3)
    direction = side * camera.view[axis, :3]
    size = float(np.linalg.norm(np.ptp(BOX, axis=0)))
    assert sees(camera, BOX)
    assert sees(camera, BOX + 0.4 * size * direction)  # half of it is out of the image
    behind_all = axis == 2 and side == -1  # there is no far plane
    assert sees(camera, BOX + 20 * size * direction) == behind_all


def test_a_box_around_the_camera_or_wider_than_the_picture_is_seen() -> None:
    camera = orbit(BOX, screen=(64, 48))
    assert sees(camera, camera.position + np.array([[-1.0, -1, -1], [1, 1, 1]]))
    assert sees(camera, 100 * (BOX - BOX.mean(axis=0)) * [1, 1, 0.001] + BOX.mean(axis=0))
