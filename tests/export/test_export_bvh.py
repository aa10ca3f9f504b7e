"""Exported BVH: the same joints in the world, read by an independent reader and by our own."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from people import upright

from mua import rotation
from mua.errors import InputError
from mua.export.bvh import bvh_text
from mua.motion.bvh import read_bvh
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

WRITTEN = 0.5e-6  # metres or degrees, by which a number is rounded
PLACE_BOUND = 1e-5  # metres: three joints of half a metre, each turned by angles that are rounded so; bvhio is float32


def tree() -> tuple[Skeleton, Clip]:
    """Joints whose bind pose is turned; the children of the root are not beside each other in the list."""
    parents = (-1, 0, 0, 1, 2)
    skeleton = upright(("hips", "left leg", "spine", "left foot", "head"), parents, [[0, 1, 0]] + [[0.1, 0.3, 0.2]] * 4)
    rng = np.random.default_rng(4)
    skeleton = replace(skeleton, bind_rotations=rotation.normalize(rng.normal(size=(5, 4))))
    turns = rotation.normalize(np.concatenate([np.ones((6, 5, 1)), 0.7 * rng.normal(size=(6, 5, 3))], axis=-1))
    path = skeleton.bind_translations[0] + rng.normal(size=(6, 3))
    return skeleton, Clip("move", 25.0, turns, skeleton.with_root(path))


def by_bvhio(path: Path, frames: int) -> dict[str, np.ndarray]:
    """Positions [F, 3] of joints by name."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # a warning of the reader's own dependency
        import bvhio
    hierarchy = bvhio.readAsHierarchy(str(path))
    found: dict[str, list[np.ndarray]] = {}
    for frame in range(frames):
        hierarchy.loadPose(frame)
        for joint, _, _ in hierarchy.layout():
            found.setdefault(joint.Name, []).append(np.array(joint.PositionWorld))
    return {name: np.array(places) for name, places in found.items()}


@pytest.mark.parametrize("moving", [False, True])
def test_an_independent_reader_finds_the_joints_where_they_were(tmp_path: Path, moving: bool) -> None:
    skeleton, clip = tree()
    if moving:
        clip.translations[:, 4] += np.linspace(0, 0.2, len(clip))[:, None]
    path = tmp_path / "a.bvh"
    path.write_text(bvh_text(skeleton, clip))
    _, placed = skeleton.world(clip.rotations, clip.translations)
    found = by_bvhio(path, len(clip))
    assert len(found) >= len(skeleton.names) > 1
    for j, name in enumerate(skeleton.names):
        np.testing.assert_allclose(found[name.replace(" ", "_")], placed[:, j], atol=PLACE_BOUND)


def test_our_reader_finds_rate_names_joints_and_bind_pose(tmp_path: Path) -> None:
    skeleton, clip = tree()
    clip = replace(clip, rate=27.4)
    path = tmp_path / "a.bvh"
    path.write_text(bvh_text(skeleton, clip))
    read = read_bvh(path, scale=1.0)
    turned, placed = skeleton.world(clip.rotations, clip.translations)
    bind, rest = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    order = [read.skeleton.names.index("_".join(name.split())) for name in skeleton.names]
    found_turned, found = read.skeleton.world(read.clip.rotations, read.clip.translations)
    assert (read.clip.rate, len(read.clip)) == (pytest.approx(27.4, rel=1e-6), len(clip))
    np.testing.assert_allclose(found[:, order], placed, atol=PLACE_BOUND)
    since = rotation.multiply(turned, np.broadcast_to(rotation.conjugate(bind), turned.shape))
    np.testing.assert_allclose(np.abs(np.sum(since * found_turned[:, order], axis=-1)), 1, atol=1e-9)
    offsets, upwards = read.skeleton.bind_translations[order], skeleton.parents >= 0
    expected = (rest - rest[skeleton.parents])[upwards]
    np.testing.assert_allclose(offsets[upwards], expected, atol=2 * WRITTEN)
    (root,) = (line.split()[1:] for line in path.read_text().splitlines() if line.startswith("  OFFSET"))
    np.testing.assert_allclose(np.array(root, float), rest[skeleton.root], atol=2 * WRITTEN)


def test_joints_follow_the_order_of_the_skeleton_and_their_parents() -> None:
    skeleton, clip = tree()
    text = bvh_text(skeleton, clip)
    named = [line.split()[1] for line in text.splitlines() if line.split()[0] in ("ROOT", "JOINT")]
    assert named == ["hips", "left_leg", "left_foot", "spine", "head"]
    assert text.count("End Site") == 2
    assert text.count("CHANNELS 6") == 1


def test_a_root_that_stands_still_has_positions_too() -> None:
    skeleton = upright(("hips", "head"), (-1, 0), [[0, 1, 0], [0, 0.5, 0]])
    clip = Clip("a", 30.0, skeleton.bind_rotations[None], skeleton.bind_translations[None])
    assert bvh_text(skeleton, clip).count("CHANNELS 6 Xposition Yposition Zposition") == 1


def test_angles_do_not_jump_by_whole_turns() -> None:
    skeleton = upright(("hips", "head"), (-1, 0), [[0, 1, 0], [0, 0.5, 0]])
    turns = rotation.from_axis_angle(np.array([0.0, 0, 1]), np.radians(np.arange(0, 500, 50.0)))
    clip = Clip("spin", 30.0, np.stack([turns, turns], axis=1), np.tile(skeleton.bind_translations, (10, 1, 1)))
    rows = bvh_text(skeleton, clip).split("Frame Time")[1].splitlines()[1:]
    about_z = [float(row.split()[3]) for row in rows]
    np.testing.assert_allclose(about_z, np.arange(0, 500, 50.0), atol=WRITTEN)


@pytest.mark.parametrize("x", [90.0, -90.0])
def test_an_upright_turn_about_x_is_kept(tmp_path: Path, x: float) -> None:
    skeleton = upright(("hips", "head"), (-1, 0), [[0, 1, 0], [0, 0.5, 0]])
    about = [
        rotation.from_axis_angle(np.eye(3)[axis], np.radians(angle)) for axis, angle in ((2, 40.0), (0, x), (1, 25.0))
    ]
    turn = rotation.multiply(rotation.multiply(about[0], about[1]), about[2])
    clip = Clip("a", 30.0, np.stack([turn, turn])[None], skeleton.bind_translations[None])
    (tmp_path / "a.bvh").write_text(bvh_text(skeleton, clip))
    found = read_bvh(tmp_path / "a.bvh", scale=1.0).clip.rotations[0, :2]
    np.testing.assert_allclose(np.abs(found @ turn), 1, atol=1e-9)


def test_several_roots_are_refused() -> None:
    skeleton = upright(("a", "b"), (-1, -1), [[0, 1, 0], [0, 0.5, 0]])
    clip = Clip("a", 30.0, skeleton.bind_rotations[None], skeleton.bind_translations[None])
    with pytest.raises(InputError, match=r"the skeleton has 2 joints without a parent \(a, b\); a \.bvh holds one"):
        bvh_text(skeleton, clip)
