"""Silhouettes of a posed template in a camera: what they cover, and how far they overlap masks."""

import numpy as np
import pytest
from captures import MIDDLE, SIDE

from mua.capture import Capture
from mua.capture.camera import CaptureCamera
from mua.capture.silhouette import overlap, pixels, rough_overlap, silhouette


def test_an_outline_covers_what_splats_do(small_capture: Capture) -> None:
    """Compares with point-in-triangle tests at every pixel's middle, by signed areas."""
    rng = np.random.default_rng(4)
    camera = small_capture.cameras[0]
    vertices = rng.normal([0, 0.85, 0], [0.5, 0.5, 0.3], (12, 3))
    faces = np.arange(12).reshape(4, 3)
    found = silhouette(vertices, faces, camera)
    places, _ = pixels(camera, vertices)
    rows, columns = np.mgrid[:SIDE, :SIDE] + 0.5
    expected, near = np.zeros((SIDE, SIDE), bool), np.zeros((SIDE, SIDE), bool)
    for corners in places[faces]:
        turned = np.roll(corners, -1, axis=0) - corners
        sides = [
            ((columns - x) * dy - (rows - y) * dx) / np.hypot(dx, dy)
            for (x, y), (dx, dy) in zip(corners, turned, strict=True)
        ]
        expected |= (np.min(sides, axis=0) >= 0) | (np.max(sides, axis=0) <= 0)
        near |= np.abs(sides).min(axis=0) < 0.4  # what drawing at three times the size may be off, in pixels
    assert expected.any()
    np.testing.assert_array_equal(found[~near], expected[~near])


def test_what_lies_behind_a_camera_is_not_drawn(small_capture: Capture) -> None:
    camera = small_capture.cameras[0]
    behind = camera.position + np.array([[0, 0, 1.0], [1, 0, 1], [0, 1, 1]])
    assert not silhouette(behind, np.array([[0, 1, 2]]), camera).any()
    behind[0], behind[1] = MIDDLE, np.add(MIDDLE, (0.1, 0.2, 0))
    assert not silhouette(behind, np.array([[0, 1, 2]]), camera).any()


def test_an_outline_lies_in_the_middle_of_what_it_covers() -> None:
    """Rectangles that begin anywhere between pixels cover as much to the left of their middles as to the right."""
    camera = CaptureCamera("plain", (48, 40), (50.0, 50.0), (24.0, 20.0), np.eye(4))
    rng = np.random.default_rng(0)
    off = []
    for low, high in zip(rng.uniform(4, 14, (150, 2)), rng.uniform(24, 36, (150, 2)), strict=True):
        edges = (np.array([low, high]) - camera.centre) / camera.focal * 2  # two metres away
        corners = np.array([[edges[i, 0], edges[j, 1], 2] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
        rows, columns = np.nonzero(silhouette(corners, np.array([[0, 1, 2], [0, 2, 3]]), camera))
        middle = [(side.min() + side.max() + 1) / 2 for side in (columns, rows)]
        off.append(np.array(middle) - (low + high) / 2)
    np.testing.assert_allclose(np.mean(off, axis=0), 0, atol=0.08)  # half a step of a third of a pixel is 0.17


def test_what_a_camera_does_not_see_takes_its_share_off_a_rough_overlap() -> None:
    camera = CaptureCamera("plain", (48, 48), (50.0, 50.0), (24.0, 24.0), np.eye(4))
    rows, columns = np.mgrid[:48, :48] + 0.5
    all_over = np.stack([(columns - 24) / 25, (rows - 24) / 25, np.full((48, 48), 2.0)], axis=-1).reshape(-1, 3)
    mask = np.ones((48, 48), bool)
    assert rough_overlap(all_over[:1400], camera, mask[: 1400 // 48]) == pytest.approx(1, abs=0.05)
    for unseen in ([0, 0, -2.0], [9.0, 0, 2]):
        half = np.stack([all_over[:700], np.tile(unseen, (700, 1))], axis=1).reshape(-1, 3)
        whole = rough_overlap(all_over[:700], camera, mask)
        assert rough_overlap(half, camera, mask) == pytest.approx(whole / 2, rel=1e-3)


def test_overlap_is_what_both_cover_of_what_either_does() -> None:
    row = np.array([[True, True, False, False]])
    assert overlap(row, np.roll(row, 1)) == pytest.approx(1 / 3)
    assert overlap(row & False, row & False) == 0
