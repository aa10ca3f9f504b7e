"""Tracks of a capture: what files say, and a sentence for each way to be wrong."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from captures import FRAMES, make_capture

from mua.arrays import Array
from mua.capture import Capture, open_capture
from mua.capture.check import check_capture
from mua.capture.lens import distorted, undistorted
from mua.capture.silhouette import pixels, posed_template
from mua.capture.tracks import read_tracks
from mua.capture.write import write_capture
from mua.errors import InputError

LENS = (-0.12, 0.05, 1e-3, -2e-3, 0.01)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Capture:
    """Each vertex of the template is a tracked point of both clips."""
    folder = tmp_path_factory.mktemp("capture")
    capture = replace(make_capture(folder, distortion=LENS), tracks="{clip}.npz", tracks_2d="{clip}.{camera}.npz")
    write_capture(capture)
    for clip in FRAMES:
        points = surfaces(capture, clip)
        np.savez(folder / f"{clip}.npz", points=points, bind=capture.surfaces.vertices)
        for camera in capture.cameras:
            at = (pixels(camera, points)[0] - camera.centre) / camera.focal
            shown = np.stack(distorted(at[..., 0], at[..., 1], LENS), axis=-1)
            np.savez(folder / f"{clip}.{camera.name}.npz", points=shown * camera.focal + camera.centre)
    return open_capture(folder)


def surfaces(capture: Capture, clip: str) -> Array:
    return posed_template(capture.surfaces, capture.motion(clip))


@pytest.fixture
def capture(made: Capture, tmp_path: Path) -> Capture:
    """A copy whose tracks a test may spoil."""
    for file in made.folder.iterdir():
        (tmp_path / file.name).symlink_to(file)
    return open_capture(tmp_path)


def spoil(capture: Capture, name: str = "walk.npz", **arrays: Array) -> None:
    """Put other arrays in a file; None leaves one out."""
    file = capture.folder / name
    with np.load(file) as held:
        said = {**held, **arrays}
    file.unlink()
    np.savez(file, **{name: value for name, value in said.items() if value is not None})


def test_points_in_the_world_are_read_with_where_they_are_on_the_template(made: Capture) -> None:
    world, *_ = read_tracks(made, "walk")
    np.testing.assert_allclose(world.points, surfaces(made, "walk"))
    np.testing.assert_array_equal(world.weights, 1)
    assert world.directions is None
    assert world.bind is not None
    np.testing.assert_allclose(world.bind, made.surfaces.vertices)


def test_points_in_pictures_are_rays_through_what_the_lens_showed(made: Capture) -> None:
    _, *seen = read_tracks(made, "walk")
    cameras = [camera for camera in made.cameras if not camera.held_out]
    assert [one.file.name for one in seen] == [f"walk.{camera.name}.npz" for camera in cameras]
    for camera, one in zip(cameras, seen, strict=True):
        assert one.directions is not None
        np.testing.assert_allclose(one.points, np.broadcast_to(camera.position, one.points.shape))
        away = surfaces(made, "walk") - one.points
        np.testing.assert_allclose(np.cross(away, one.directions), 0, atol=1e-9)
        assert (np.sum(away * one.directions, axis=2) > 1).all()


def test_undistorted_points_are_those_that_the_lens_bends_to_the_given_ones() -> None:
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(-0.6, 0.6, 9), np.linspace(-0.4, 0.4, 7)))
    there = undistorted(*distorted(x, y, LENS), LENS)
    np.testing.assert_allclose(there, (x, y), atol=1e-10)
    assert np.abs(np.array(distorted(x, y, LENS)) - (x, y)).max() > 0.01


def test_a_point_counts_where_it_was_seen(capture: Capture) -> None:
    points = surfaces(capture, "walk")
    points[1, 4] = np.nan
    spoil(capture, points=points)
    (world, *_) = read_tracks(capture, "walk")
    assert world.weights[1, 4] == 0
    assert world.weights.sum() == world.weights.size - 1
    assert np.isfinite(world.points).all()
    seen = np.full(points.shape[:2], 0.5)
    seen[:2, 4] = 0
    spoil(capture, points=points, seen=seen)
    np.testing.assert_array_equal(read_tracks(capture, "walk")[0].weights, seen)


def seen_at(capture: Capture, value: float) -> Array:
    return np.full(surfaces(capture, "walk").shape[:2], value)


def test_rejects_tracks_with_wrong_arrays(capture: Capture) -> None:
    points = surfaces(capture, "walk")
    broken = points.copy()
    broken[2, 7] = np.nan
    sentences: dict[str, dict[str, Any]] = {
        r"walk.npz: points has shape \[3, \d+, 3\]; expected \[4, points, 3\]: clip 'walk' has 4": {
            "points": points[:3]
        },
        r"walk.npz: points has shape \[4, \d+, 2\]; expected \[4, points, 3\]": {"points": points[..., :2]},
        r"walk.npz: frame 2: point 7 is seen, but its place is not": {"points": broken, "seen": seen_at(capture, 1)},
        r"walk.npz: seen has values from 2 to 2; expected 0 to 1": {"points": points, "seen": seen_at(capture, 2)},
        r"walk.npz: seen has shape \[4\]; expected \[4, \d+\] as points": {"seen": np.ones(4)},
        r"walk.npz: no point is seen in any frame": {"points": points * np.nan, "seen": None},
        r"walk.npz: bind has shape \[2, 3\]; expected finite": {"points": points, "bind": points[0, :2]},
        r"walk.npz: 'point' is no array of tracks; there are points, seen, bind": {"bind": None, "point": points},
    }
    for sentence, arrays in sentences.items():
        spoil(capture, **{"seen": None, **arrays})
        with pytest.raises(InputError, match=sentence):
            read_tracks(capture, "walk")
        spoil(capture, **{"points": points, "point": None, "seen": None, "bind": points[0]})


@pytest.mark.parametrize(
    ("content", "sentence"),
    [(None, "there is no such file; capture.json names tracks for every clip"), (b"half", "cannot be read as an .npz")],
)
def test_rejects_unreadable_file_of_tracks(capture: Capture, content: bytes | None, sentence: str) -> None:
    file = capture.folder / "walk.left.npz"
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(InputError, match=rf"walk\.left\.npz: {sentence}"):
        read_tracks(capture, "walk")


def test_tracks_of_several_clips_need_names_of_their_own(capture: Capture) -> None:
    file = capture.folder / "capture.json"
    said = json.loads(file.read_text()) | {"tracks": "all.npz"}
    file.unlink()
    file.write_text(json.dumps(said))
    with pytest.raises(InputError, match=r"tracks is 'all.npz'; expected \{clip\} in it: there are 2"):
        open_capture(capture.folder)


def test_the_check_reports_tracks_beside_the_person(capture: Capture) -> None:
    def problems() -> list[str]:
        return [problem for problem in check_capture(capture, frames=1).problems if ".npz" in problem]

    assert problems() == []
    spoil(capture, points=1000 * surfaces(capture, "walk"))
    (one,) = problems()
    assert "Clip walk" in one
    assert "walk.npz: half of the points are more than" in one
    (capture.folder / "reach.npz").unlink()
    assert any("reach.npz: there is no such file" in problem for problem in problems())
