import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from compare_blender import Points, View, compare, distances, files_of, scenes, view
from gltf_files import POINTS, animate, body

from mua import rotation

FRAMES = 31
TURN = np.linspace(0, 0.5, FRAMES)


@pytest.fixture
def column(tmp_path: Path) -> Path:
    glb = body()
    turns = rotation.from_axis_angle(np.array([1.0, 0, 0]), TURN)
    animate(glb, 1, "rotation", times=np.arange(FRAMES) / 30, values=np.roll(turns, -1, axis=-1))
    return glb.save(tmp_path / "column.glb")


def moved(points: Points, by: float) -> Points:
    """The first vertex moved along x."""
    found = {name: places.copy() for name, places in points.items()}
    next(iter(found.values()))[:, 0, 0] += by
    return found


def test_vertices_of_a_clip_are_where_it_bends_them(column: Path) -> None:
    ours = view(scenes(column))
    assert (ours.kind, [round(30 * seconds) for _, seconds in ours.moments]) == ("vertices", [0, 5, 10, 15, 20, 25, 30])
    (places,) = ours.points.values()
    np.testing.assert_allclose(places[0], POINTS, atol=1e-6)
    assert np.abs(places[-1] - places[0]).max() > 0.1


def test_the_largest_distance_is_told_whichever_side_is_off(column: Path) -> None:
    ours = view(scenes(column))
    assert distances(ours, ours)[0].max() == 0
    for by in (0.002, -0.002):
        apart, words = distances(ours, replace(ours, points=moved(ours.points, by)))
        np.testing.assert_allclose(apart, 0.002)
        assert words == []


def test_a_mesh_that_only_blender_draws_is_named_and_not_measured(column: Path) -> None:
    ours = view(scenes(column))
    apart, words = distances(ours, replace(ours, points=ours.points | {"Floor": 5 + next(iter(ours.points.values()))}))
    assert apart.max() == 0
    assert words == ["only in Blender: Floor"]


def test_bones_are_compared_by_name() -> None:
    at = {"hips": np.zeros((1, 1, 3)), "tail": np.ones((1, 1, 3))}
    ours = View("bones", [(None, 0.0)], at, np.ones(1, bool))
    apart, words = distances(ours, replace(ours, points={"hips": at["hips"] + [0, 0.25, 0]}))
    assert apart.tolist() == [0.25]
    assert words == ["Blender lacks 1 of 2"]


def test_a_file_that_one_side_cannot_read_is_said(column: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken.glb"
    broken.write_bytes(column.read_bytes()[:40])
    assert compare(broken, blender=sys.executable)[0][-1].startswith("refused: ")
    assert compare(column, blender=sys.executable)[0][-1] == "Blender: ModuleNotFoundError: No module named 'bpy'"
    assert list(files_of(tmp_path)) == sorted([broken, column])
