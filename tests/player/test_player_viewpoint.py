"""The camera of the window: turned, moved and brought nearer by the mouse, about figures of any size."""

import numpy as np
import pytest

from mua.avatar.camera import orbit
from mua.player.viewpoint import FARTHEST, NEAREST, Viewpoint, framing

FRONT = np.zeros(1)


def test_keeps_what_is_panned_under_the_mouse() -> None:
    screen = (400, 300)
    view = Viewpoint(np.array([0.1, 1.0, -0.2]), 3.0, azimuth=0.7, elevation=0.3)
    moved = view.panned(25, -40, height=screen[1]).camera(screen)
    x, y, _, w = moved.projection @ moved.view @ np.append(view.target, 1)
    at = (np.array([x, -y]) / w + 1) / 2 * screen
    np.testing.assert_allclose(at, [200 + 25, 150 - 40])


@pytest.mark.parametrize("size", [1.3e-3, 1.8, 40.0])
def test_a_figure_of_any_size_is_framed_before_the_near_plane_and_can_be_come_close_to(size: float) -> None:
    bounds = size * np.array([[-0.3, 0, -0.2], [0.3, 1, 0.2]])
    view = framing(bounds, (300, 500), azimuths=FRONT)
    assert 1 < view.distance / size < 5
    for seen in (view, view.zoomed(10), view.zoomed(1000)):
        camera = seen.camera((300, 500))
        assert 0 < camera.near < 0.02 * seen.distance
    assert view.zoomed(1000).distance < 0.05 * size
    assert view.zoomed(-1000).distance > 20 * size


def test_holds_distance_and_elevation() -> None:
    view = Viewpoint(np.zeros(3), 3.0, framed=2.0)
    assert view.zoomed(1000).distance == 2 * NEAREST
    assert view.zoomed(-1000).distance == 2 * FARTHEST
    assert view.turned(0, 1e6).elevation < np.pi / 2
    bounds = np.array([[-0.5, 0, -0.3], [0.5, 1.8, 0.3]])
    framed, screen = framing(bounds, (300, 500), azimuths=FRONT), (300, 500)
    np.testing.assert_allclose(framed.camera(screen).view, orbit(bounds, screen=screen).view, atol=1e-12)
