"""The built-in range of motion in a bake: how much of it is recorded, and what a character without animation does."""

from dataclasses import replace
from pathlib import Path

import gltf_files
import numpy as np
import pytest
from column_files import column_file
from many_rigs import RIGS, character
from PIL import Image
from silent import Silent
from small_bakes import SMALL

from mua.asset import read
from mua.baking.contact_sheet import CELL
from mua.baking.pipeline import bake
from mua.baking.ranges import planned_range, range_frames, settings_for
from mua.baking.settings import BakeSettings, MotionRange
from mua.baking.sources import clips_of, load_baked_character, load_character
from mua.errors import InputError
from mua.fidelity.strips import CAPTION
from mua.pose.clip import Clip, is_range

pytestmark = pytest.mark.usefixtures("first_try")


def bake_settings(directory: Path, *, frames: int = 240, motion_range: MotionRange = "full") -> BakeSettings:
    student = replace(SMALL, frames=frames)
    return BakeSettings(directory / "a.muaavatar", directory / "work", student, "cpu", motion_range=motion_range)


@pytest.mark.parametrize(
    ("asked", "own", "expected"),
    [
        (240, 240, 75),
        (240, 200, 75),
        (240, 86, 135),
        (1500, 1500, 375),
        (1500, 86, 500),
        (1500, 1080, 420),
        (17000, 17000, 4250),
        (100, 100, 50),
        (3, 3, 1),
    ],
)
def test_more_than_a_quarter_is_added_where_few_are_asked_for_or_the_motion_is_short(
    asked: int, own: int, expected: int
) -> None:
    assert range_frames(asked, own) == expected


def test_frames_are_recorded_of_all_clips_of_the_range_and_none_kept_whole(tmp_path: Path) -> None:
    planned = planned_range(bake_settings(tmp_path), character(RIGS["T-pose"]), (), 240)
    assert len(planned) == 6
    assert sum(len(clip.wanted) for clip in planned) == 75
    assert all(len(clip.wanted) > 3 and not clip.whole and not clip.held_out for clip in planned)
    assert all(max(clip.wanted) > 0.8 * len(clip.clip) for clip in planned)


def test_nothing_is_recorded_of_a_range_that_is_not_asked_for(tmp_path: Path) -> None:
    assert planned_range(bake_settings(tmp_path, motion_range="none"), character(RIGS["T-pose"]), (), 240) == []


def test_the_pose_in_which_a_file_stands_is_recorded_of_joints_that_the_range_moves(tmp_path: Path) -> None:
    """All other joints would widen the description of every pose."""
    glb, bent = gltf_files.body(), [0, 0, np.sin(0.3), np.cos(0.3)]
    glb.json["nodes"][1]["rotation"] = bent
    glb.json["nodes"][2]["children"] = [4]
    glb.json["nodes"].append({"name": "tip", "translation": [0, 0.5, 0], "rotation": bent})
    binds = np.tile(np.eye(4), (4, 1, 1))
    binds[:, 3, 1] = [0, -0.5, -1, -1.5]
    glb.json["skins"] = [{"joints": [0, 1, 2, 4], "inverseBindMatrices": glb.accessor(binds)}]
    figure = load_character(glb.save(tmp_path / "bent.glb"), uv="auto", seed=0)
    (*others, standing) = planned_range(bake_settings(tmp_path), figure, (), 240)
    assert is_range(standing.clip.name)
    assert (len(standing.clip), standing.wanted, standing.held_out) == (1, {0}, False)
    turns = {name: standing.clip.rotations[0, joint] for joint, name in enumerate(figure.skeleton.names)}
    np.testing.assert_allclose(abs(turns["spine"] @ [bent[3], *bent[:3]]), 1, atol=1e-6)
    still = others[0].clip.rotations[0, figure.skeleton.names.index("tip")]
    assert np.array_equal(turns["tip"], still)
    assert abs(still @ [bent[3], *bent[:3]]) < 0.99
    assert sum(len(clip.wanted) for clip in others) == 75


def test_a_person_without_animation_has_the_range_as_its_motion(tmp_path: Path) -> None:
    figure = character(RIGS["T-pose"])
    clips, (note,) = clips_of(bake_settings(tmp_path), figure)
    assert len(clips) == len({clip.name for clip in clips}) > 5
    assert clips[0].name == "stand"  # with which players begin
    assert sum(map(len, clips)) > 2 * 240
    assert "holds no animation; its motion is a built-in range of motion" in note
    assert planned_range(bake_settings(tmp_path), figure, clips, 240) == []
    with pytest.raises(InputError, match="rig: holds no animation; give a file or directory with --motion"):
        clips_of(bake_settings(tmp_path, motion_range="none"), figure)


def with_take(directory: Path, *, turn: float = 0.0, lift: float = 0.0, weight: float | None = None) -> BakeSettings:
    """A bake of the column, whose only take turns its spine, lifts its hips and shows an expression, if anything."""
    glb, turned = gltf_files.body(), [0, 0, np.sin(turn / 2), np.cos(turn / 2)]
    gltf_files.animate(glb, 1, "rotation", times=[0, 1], values=[[0, 0, 0, 1], turned], name="Take 001")
    gltf_files.animate(glb, 0, "translation", times=[0, 1], values=[[0, 0, 0], [0, lift, 0]], name="Take 001")
    if weight is not None:
        lean = np.where(gltf_files.POINTS[:, 1:2] > 1, [[0.1, 0, 0]], 0)
        gltf_files.primitive(glb)["targets"] = [{"POSITION": glb.accessor(lean)}]
        mesh = next(number for number, node in enumerate(glb.json["nodes"]) if "mesh" in node)
        gltf_files.animate(glb, mesh, "weights", times=[0, 1], values=[0, weight], name="Take 001")
    return replace(bake_settings(directory), character=glb.save(directory / "take.glb"))


def test_a_take_of_one_pose_is_no_animation(tmp_path: Path) -> None:
    """Programs write one with each rest pose that they export."""
    asked = with_take(tmp_path, weight=0.0)
    figure = load_baked_character(asked)
    assert figure.clips == ()
    assert "Take 001: shows one pose, which counts as no animation." in figure.notes
    assert "Take 001" not in [clip.name for clip in clips_of(asked, figure)[0]]
    (kept,) = load_baked_character(replace(asked, motion_range="none")).clips
    assert kept.name == "Take 001"


@pytest.mark.parametrize("moved", [{"turn": 0.1}, {"lift": 0.05}, {"weight": 1.0}])
def test_a_take_that_moves_anything_is_the_characters_motion(tmp_path: Path, moved: dict[str, float]) -> None:
    asked = with_take(tmp_path, **moved)
    assert [clip.name for clip in clips_of(asked, load_baked_character(asked))[0]] == ["Take 001"]


def test_only_motion_of_a_user_is_followed_closely(tmp_path: Path) -> None:
    figure, still = character(RIGS["T-pose"]), RIGS["T-pose"]
    assert not settings_for(bake_settings(tmp_path), figure).generalisation.own
    own = Clip("own", 30.0, still.bind_rotations[None], still.bind_translations[None])
    asked = bake_settings(tmp_path)
    assert settings_for(asked, replace(figure, clips=(own,))) == asked.student
    moved = replace(asked, motions=(tmp_path / "walk.bvh",))
    assert settings_for(moved, figure) == moved.student


def test_a_character_with_animation_keeps_to_it(tmp_path: Path) -> None:
    skeleton = RIGS["T-pose"]
    own = Clip("own", 30.0, skeleton.bind_rotations[None], skeleton.bind_translations[None])
    clips, notes = clips_of(bake_settings(tmp_path), replace(character(skeleton), clips=(own,)))
    assert ([clip.name for clip in clips], notes) == (["own"], [])


@pytest.mark.usefixtures("forked")
def test_a_file_without_animation_is_baked_played_and_compared_with_its_source(tmp_path: Path) -> None:
    notes: list[str] = []

    class Hearing(Silent):
        def note(self, sentence: str) -> None:
            notes.append(sentence)

    asked = bake_settings(tmp_path, frames=12)
    student = replace(asked.student, texels=32)
    baked = bake(replace(asked, student=student, character=column_file(tmp_path, clip=False)), Hearing())
    clips = read(baked.output).clips
    assert clips
    assert not any(is_range(clip.name) or len(clip) <= 10 for clip in clips)
    assert set(baked.errors) == {"training", *(f"{clip.name} (end)" for clip in clips)}
    assert any(sentence.startswith("Splats compared with the source: silhouettes overlap by") for sentence in notes)
    assert baked.sheet is not None
    with Image.open(baked.sheet) as sheet:
        strip = CELL[1] + CAPTION
        assert sheet.height % strip == 0
        pictures = np.asarray(sheet)[CAPTION : 2 * strip, :, :].astype(int)
    source, splats = pictures[: CELL[1], : CELL[0]], pictures[: CELL[1], CELL[0] : 2 * CELL[0]]
    assert np.count_nonzero((source == 255).all(axis=-1) != (splats == 255).all(axis=-1)) < 0.1 * source[..., 0].size
