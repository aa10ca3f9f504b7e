"""Avatars in motion that they were not trained on: which motion is played, and how far from the teacher is measured."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import measure_unseen
import numpy as np
import pytest
from measure_unseen import BLOCK, Result, Ruler, main, report
from PIL import Image
from synthetic_avatar import synthetic_avatar, with_texels
from unseen_teacher import Motion, Shown, Teacher, broken_rigs, most_active, motions_of

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.decode import Splats, decode_clip_frame, pose_splats
from mua.channels import ATTRIBUTES, SH_C0
from mua.motion.poses_file import write_poses
from mua.pose.clip import Clip
from mua.recording.encode import align_rotations
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.teacher import TeacherFrame
from mua.teachers.procedural import procedural_character
from mua.teachers.simulated.teacher import SimulatedTeacher


class Stub:
    """A stand-in for the simulated teacher: the avatar itself, in other colours in a motion called "wrong"."""

    def __init__(self, avatar: Avatar) -> None:
        self.character, self._avatar = avatar.rig, avatar

    def shown(self, motion: Motion, reference: Array) -> Iterator[Shown]:
        for index in motion.frames:
            own = decode_clip_frame(self._avatar, motion.clip, frame=int(index))
            texture = own.texture.copy()
            if motion.clip.name == "wrong":
                texture[:, ATTRIBUTES["SH"]] += 0.3
            yield Shown(int(index), own.canonical, texture)


def nodding(frames: int, *, moving: slice) -> Clip:
    """A clip of 10 frames a second whose second joint turns steadily in some frames and else stands."""
    angles = np.zeros(frames)
    angles[moving] = 0.1
    half = np.cumsum(angles) / 2
    rotations = np.tile([1.0, 0, 0, 0], (frames, 3, 1))
    rotations[:, 1] = np.stack([np.cos(half), np.sin(half), 0 * half, 0 * half], axis=1)
    return Clip("nod", 10.0, rotations, np.arange(frames * 9.0).reshape(frames, 3, 3))


def bare_splats(avatar: Avatar, clip: Clip) -> Splats:
    """On the mean template, of one size."""
    texture = np.zeros((len(avatar.rig.texels.texels), 23), np.float32)
    texture[:, 3] = 1
    return pose_splats(avatar.rig, avatar.coarse.mean, texture=texture, pose=clip.pose(0))


def test_a_long_motion_is_cut_to_the_seconds_in_which_joints_turn_most() -> None:
    clip = nodding(100, moving=slice(61, 75))
    cut = most_active(clip, seconds=1.5)
    first = int(cut.translations[0, 0, 0]) // 9
    assert len(cut) == 15
    assert first <= 60
    assert first + 15 >= 75
    assert most_active(cut, seconds=1.5) is cut


def test_frames_are_measured_once_cloth_moves_and_up_to_the_last() -> None:
    clip = replace(nodding(120, moving=slice(0, 120)), rate=30.0)
    frames = Motion(clip, sound=True).frames
    assert frames[0] >= 15
    assert frames[-1] == 119
    assert set(np.diff(frames)) == {5}
    assert Motion(clip.cut(slice(0, 1)), sound=True).frames.tolist() == [0]


def test_a_broken_rig_has_one_joint_that_is_wrong() -> None:
    avatar = synthetic_avatar()
    walk = avatar.clips[0]
    avatar = replace(avatar, encoding=replace(avatar.encoding, joints=(0, 1, 2)), rig=_with_root(avatar, -1))
    spins, turned, jumps, random = broken_rigs(avatar)
    for motion in (spins, turned, jumps):
        wrong = [not np.allclose(motion.clip.rotations[:, joint], walk.rotations[:, joint]) for joint in range(3)]
        assert sum(wrong) == 1
    alike = np.abs(np.einsum("fjc,fjc->fj", turned.clip.rotations, walk.rotations))
    np.testing.assert_allclose(np.sort(alike, axis=1), [[0, 1, 1]] * len(walk), atol=1e-6)
    away = np.abs(np.einsum("fjc,fjc->fj", jumps.clip.rotations, walk.rotations)).min(axis=1)
    np.testing.assert_allclose(away, np.where(np.arange(len(walk)) % 2, 0.5, 1), atol=1e-6)  # cos 60 degrees
    assert len(random.clip) == 100
    np.testing.assert_allclose(np.linalg.norm(random.clip.rotations, axis=2), 1)
    between = np.abs(np.einsum("fjc,fjc->fj", random.clip.rotations[1:], random.clip.rotations[:-1]))
    assert np.median(between) < 0.7


def test_files_that_the_character_cannot_follow_are_named_and_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    character = procedural_character()
    write_poses(tmp_path / "walk.npz", character.skeleton, character.clips[0])
    (tmp_path / "noise.bvh").write_text("no motion")
    motions = list(motions_of(character, [tmp_path / "noise.bvh", tmp_path / "walk.npz"]))
    assert [motion.clip.name for motion in motions] == ["walk"]
    assert "left out: " in (printed := capsys.readouterr().out)
    assert "noise.bvh" in printed


def test_teacher_frames_are_those_of_a_bake() -> None:
    character = procedural_character()
    motion = Motion(character.clips[0].cut(slice(0, 12)), sound=True)
    simulated = SimulatedTeacher(replace(character, clips=(), source=None), texels=32)
    frames = simulated.frames(motion.clip, frozenset(motion.frames.tolist()))
    expected = [frame for frame in frames if isinstance(frame, TeacherFrame)]
    shown = list(Teacher(None, texels=32).shown(motion, expected[0].texture))
    assert [one.frame for one in shown] == motion.frames.tolist()
    for one, frame in zip(shown, expected, strict=True):
        np.testing.assert_array_equal(one.mesh, frame.mesh)
        np.testing.assert_array_equal(one.texture, align_rotations(frame.texture, expected[0].texture))


def test_the_farthest_splat_is_found_wherever_it_is() -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    splats, mean = bare_splats(avatar, clip), avatar.coarse.mean
    surface = splats.centres.copy()
    ruler = Ruler(avatar)
    assert ruler.distances(splats, mean) == (0, 0)
    splats.centres[7] += [0.5, 2.0, -1.0]
    expected = np.linalg.norm(surface - splats.centres[7], axis=1).min() / figure_scale(avatar.rig.mesh.vertices)
    np.testing.assert_allclose(ruler.distances(splats, mean), [expected, expected], rtol=1e-5)
    splats.centres[3] = np.nan
    assert ruler.distances(splats, mean) == (np.inf, np.inf)


def test_a_splat_near_the_teachers_own_mesh_is_not_far() -> None:
    """A skirt that swings far from the mean is not a broken avatar."""
    avatar = synthetic_avatar()
    pose, swung = avatar.clips[0].pose(0), avatar.coarse.mean + np.array([0.4, 0, 0], np.float32)
    texture = np.zeros((len(avatar.rig.texels.texels), 23), np.float32)
    texture[:, 3] = 1
    ruler = Ruler(avatar)
    followed = pose_splats(avatar.rig, swung, texture=texture, pose=pose)
    assert max(ruler.distances(followed, swung)) < 1e-5
    near, from_teacher = ruler.distances(bare_splats(avatar, avatar.clips[0]), swung)
    assert near < 1e-5 < from_teacher


def test_the_largest_splat_is_measured_in_texels_of_the_mean_size() -> None:
    avatar = synthetic_avatar()
    splats = bare_splats(avatar, avatar.clips[0])
    a, b, c = (avatar.coarse.mean[avatar.rig.mesh.faces[:, corner]].astype(float) for corner in range(3))
    area = sum(np.linalg.norm(np.cross(q - p, r - p)) / 2 for p, q, r in zip(a, b, c, strict=True))
    splats.scales[:] = 1e-3
    splats.scales[4, 2] = 12 * np.sqrt(area / len(splats))
    assert Ruler(avatar).size(splats) == pytest.approx(12, rel=1e-5)
    splats.scales[5, 0] = np.nan
    assert Ruler(avatar).size(splats) == np.inf


def test_the_mean_colour_of_one_block_of_many_is_seen() -> None:
    """A few texels at the border of a chart are no block: their mean may be anything."""
    avatar = synthetic_avatar()
    row, column = np.divmod(avatar.rig.texels.texels, avatar.rig.texels.size)
    few = (row >= BLOCK) & (column >= BLOCK)
    avatar = with_texels(avatar, ~few | (np.cumsum(few) <= 31))
    row, column = np.divmod(avatar.rig.texels.texels, avatar.rig.texels.size)
    texture = np.zeros((len(row), 23), np.float32)
    other, red = texture.copy(), ATTRIBUTES["SH"].start
    other[(row < BLOCK) & (column >= BLOCK), red + 1] = -50 / 255 / SH_C0
    other[(row >= BLOCK) & (column >= BLOCK), red] = 100 / 255 / SH_C0
    assert Ruler(avatar).colour(texture, other) == pytest.approx(50, abs=0.01)


def test_the_report_has_the_worst_motion_first_and_its_image(
    trained: Path, written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    avatar = read(trained)
    clip = avatar.clips[0]
    motions = [Motion(replace(clip, name=name), sound=True) for name in ("right", "wrong")]
    monkeypatch.setattr(measure_unseen, "Teacher", lambda *_, **__: Stub(avatar))
    monkeypatch.setattr(measure_unseen, "motions_of", lambda *_: motions)
    monkeypatch.setattr(measure_unseen, "broken_rigs", lambda *_: [])
    for bar in ("DISTANCE", "SIZE"):  # the random splats of this student have both
        monkeypatch.setattr(measure_unseen, bar, 1e9)
    options = [f"--recording={written}", f"--json={tmp_path / 'a.json'}", f"--sheet={tmp_path / 'a.png'}"]
    monkeypatch.setattr("sys.argv", ["measure", str(trained), *options])
    main()
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(" | ")[0] for line in lines[2:4]] == ["| wrong", "| right"]
    wrong, right = json.loads((tmp_path / "a.json").read_text())
    assert (wrong["name"], right["name"]) == ("wrong", "right")
    assert right["explained"]["SH"] == pytest.approx(1)
    assert right["colour"] == pytest.approx(0, abs=1e-6)
    assert wrong["explained"]["SH"] < 0.9
    assert wrong["explained"]["mesh"] == pytest.approx(1)
    assert wrong["colour"] == pytest.approx(0.3 * SH_C0 * 255, rel=0.3)  # clipped at white here and there
    sheet = np.asarray(Image.open(tmp_path / "a.png"))
    assert sheet.shape == (2 * (22 + 416), 2 * 288, 3)
    upper, lower = np.split(sheet, 2)  # right and wrong, in the order of the motions
    apart = [np.abs(np.diff(np.split(half[22:].astype(int), 2, axis=1), axis=0)).max() for half in (upper, lower)]
    assert apart[0] == 0 < apart[1]


def test_a_motion_misses_a_bar_beyond_it_and_where_less_than_nothing_is_explained(
    capsys: pytest.CaptureFixture[str],
) -> None:
    good = Result(
        "good", True, 3, distance=0.1, size=10, colour=40, explained=dict.fromkeys([*ATTRIBUTES, "mesh"], 0.0)
    )
    good.explained["opacity"] = None
    assert good.fails == []
    assert replace(good, distance=0.101).fails == ["distance"]
    assert replace(good, size=float("inf")).fails == ["size"]
    assert replace(good, colour=40.1).fails == ["colour"]
    assert replace(good, explained={**good.explained, "SH": -0.01}).fails == ["SH"]
    report([replace(good, name="bad", size=99.0), good], None)
    printed = capsys.readouterr().out
    assert "1 of 2 motions meet all bars" in printed
    assert "size: 1 of 2, worst 99.0 texels" in printed


def _with_root(avatar: Avatar, root: int) -> Rig:
    return replace(avatar.rig, skeleton=replace(avatar.rig.skeleton, root=root))
