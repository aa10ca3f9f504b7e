"""The plan of a virtual capture: frames, path of the hips, cameras."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from people import person, walk
from virtual_studio import FILL, RUN, Run, chosen_runs, held_back, on_the_spot, ring

from mua.capture import CaptureCamera
from mua.rotation import rotate


@pytest.mark.parametrize(("frames", "expected"), [(60, [20, 20, 20]), (45, [15, 15, 15]), (7, [7]), (0, [])])
def test_frames_are_spread_over_a_clip_in_runs(frames: int, expected: list[int]) -> None:
    runs = chosen_runs([Run(0, 100, 300)], frames)
    assert [run.frames for run in runs] == expected
    assert all(run.frames <= RUN for run in runs)
    ends = [100, *(end for run in runs for end in (run.first, run.first + run.frames)), 400]
    gaps = [b - a for a, b in pairwise(ends)][::2]
    assert not runs or max(gaps) - min(gaps) <= 1  # the frames left out lie evenly before, between and after


def test_a_short_clip_gives_all_it_has_and_others_the_rest() -> None:
    runs = chosen_runs([Run(0, 0, 200), Run(1, 0, 10), Run(2, 0, 200)], 90)
    assert [sum(run.frames for run in runs if run.clip == clip) for clip in range(3)] == [40, 10, 40]


def test_held_out_are_the_named_clips_or_the_last_or_the_end_of_the_only_one() -> None:
    first, second, third = (Run(i, 0, length) for i, length in enumerate((50, 60, 70)))
    assert held_back([50, 60, 70], named=2, frames=30) == ([first], [second, third])
    assert held_back([50, 60, 70], named=0, frames=30) == ([first, second], [third])
    assert held_back([50], named=0, frames=30) == ([Run(0, 0, 5)], [Run(0, 20, 30)])  # half a second lies between
    assert held_back([50, 60], named=0, frames=0) == ([first, second], [])


def test_a_figure_walks_on_the_spot_and_still_bobs_and_sways() -> None:
    skeleton = person()
    clip = walk(skeleton, frames=90)
    spot = on_the_spot(clip, skeleton)
    _, before = skeleton.world(clip.rotations, clip.translations)
    _, after = skeleton.world(spot.rotations, spot.translations)
    np.testing.assert_array_equal(spot.rotations, clip.rotations)
    np.testing.assert_allclose(after[..., 1], before[..., 1], atol=1e-12)
    hips = after[:, skeleton.root]
    assert np.ptp(before[:, skeleton.root, 2]) > 3  # metres: it went somewhere
    assert np.ptp(hips[30:60, [0, 2]], axis=0).max() < 0.1


def test_hips_that_sway_keep_swaying() -> None:
    """Some times a second, at the clip's rate."""
    skeleton = person()
    clip = walk(skeleton, frames=90)
    translations = clip.translations.copy()
    translations[:, 0, 0] += 0.05 * np.sin(2 * np.pi * 2 * np.arange(90) / clip.rate)
    spot = on_the_spot(replace(clip, translations=translations), skeleton).translations
    still = on_the_spot(clip, skeleton).translations
    assert np.ptp((spot - still)[20:70, 0, 0]) == pytest.approx(0.1, rel=0.1)


def test_a_figure_below_a_turned_node_walks_on_the_spot_too() -> None:
    skeleton = person()
    clip, turn = walk(skeleton, frames=60), np.array([0.5**0.5, 0, 0.5**0.5, 0])
    below = replace(
        skeleton,
        names=("armature", *skeleton.names),
        parents=np.append(-1, skeleton.parents + 1).astype(np.int32),
        bind_rotations=np.concatenate([[turn], skeleton.bind_rotations]),
        bind_translations=np.concatenate([np.zeros((1, 3)), skeleton.bind_translations]),
        root=skeleton.root + 1,
    )
    rotations = np.concatenate([np.tile(turn, (60, 1, 1)), clip.rotations], axis=1)
    carried = replace(
        clip, rotations=rotations, translations=np.concatenate([np.zeros((60, 1, 3)), clip.translations], axis=1)
    )
    (ours, theirs) = (
        bones.world(spot.rotations, spot.translations)[1]
        for bones, spot in ((skeleton, on_the_spot(clip, skeleton)), (below, on_the_spot(carried, below)))
    )
    np.testing.assert_allclose(theirs[:, 1:], rotate(turn, ours), atol=1e-9)


def pixels(camera: CaptureCamera, points: np.ndarray) -> np.ndarray:
    """Column and row [N, 2], by the pinhole's definition."""
    x, y, z = (camera.world_to_camera @ np.concatenate([points, np.ones((len(points), 1))], 1).T)[:3]
    assert (z > 0).all()
    return np.stack([camera.focal[0] * x / z + camera.centre[0], camera.focal[1] * y / z + camera.centre[1]], axis=1)


def test_every_camera_sees_the_whole_figure_and_one_of_them_as_large_as_it_may_be() -> None:
    points = np.random.default_rng(0).normal([0, 0.9, 0.2], [0.2, 0.4, 0.1], (300, 3))
    cameras = ring(points, cameras=6, held_out=2, size=200, rng=np.random.default_rng(1))
    reach = [np.abs(pixels(camera, points) - 100).max() / 100 for camera in cameras]
    assert max(reach) == pytest.approx(FILL)
    assert [camera.held_out for camera in cameras] == [False] * 6 + [True] * 2


def test_every_camera_sees_a_wide_figure_upright_and_not_mirrored() -> None:
    points = np.random.default_rng(0).normal([0, 0.9, 0.2], [0.6, 0.2, 0.6], (300, 3))
    cameras = ring(points, cameras=5, held_out=1, size=200, rng=np.random.default_rng(1))
    assert max(np.abs(pixels(camera, points) - 100).max() / 100 for camera in cameras) == pytest.approx(FILL)
    for camera in cameras:
        assert np.linalg.det(camera.world_to_camera[:3, :3]) == pytest.approx(1)
        head, foot = pixels(camera, np.array([[0, 1.5, 0.2], [0, 0.3, 0.2]]))[:, 1]
        assert head < foot


def test_held_out_cameras_stand_between_the_others() -> None:
    points = np.random.default_rng(0).normal(size=(50, 3))
    cameras = ring(points, cameras=8, held_out=2, size=64, rng=np.random.default_rng(2))
    looks = np.array([camera.world_to_camera[2, :3] for camera in cameras])
    level = looks[:, [0, 2]] / np.linalg.norm(looks[:, [0, 2]], axis=1, keepdims=True)
    apart = np.degrees(np.arccos(np.clip(level[8:] @ level[:8].T, -1, 1))).min(axis=1)
    assert (apart > 15).all()  # neighbours stand 45 degrees apart, jittered by at most 4.5 each
    assert looks[0, 1] < 0  # from above
    assert looks[1, 1] < looks[0, 1]  # the second ring higher
