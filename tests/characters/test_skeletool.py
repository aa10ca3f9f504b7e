"""Skeletool's characters and motion: joints and skin follow the DoFs as matrices say, and what is wrong is named."""

from pathlib import Path

import numpy as np
import pytest
from gltf_files import posed
from PIL import Image
from shared_data import SharedData
from skeletool_files import DOFS, CharacterFiles, motion_text, sway, write_character

from mua.characters.read import read_character, read_surfaces
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.motion.read import read_motion

FRAMES = 7
# Float32 weights, and vertices of one place that are welded: micrometres on a body of 2 m.
CORNER_BOUND = 5e-6
# A chain of some 30 joints, a dozen roundings each, on lengths of 10 m.
JOINT_BOUND = 30 * 12 * 10 * np.finfo(float).eps


def assert_follows(character: Path, motion: Path, content: CharacterFiles, rest: np.ndarray, dofs: np.ndarray) -> None:
    """A motion's joints and the surface that hangs on them are where the files' own matrices have them."""
    surfaces = read_surfaces(character)
    (loaded,) = load_motions(motion, surfaces.skeleton, mapping=None, rate=25)
    clip, skeleton = loaded.clip, surfaces.skeleton
    _, placed = skeleton.world(clip.rotations, clip.translations)
    order = [content.bones.index(name) for name in skeleton.names]
    for frame in np.linspace(0, len(dofs) - 1, FRAMES).astype(int):
        matrices = content.bone_matrices(dofs[frame])[order]
        np.testing.assert_allclose(placed[frame], matrices[:, :3, 3] / 1000, atol=JOINT_BOUND)
        corners = posed(surfaces, clip.rotations[frame], clip.translations[frame])[surfaces.faces]
        np.testing.assert_allclose(corners, content.skinned(rest, dofs[frame]), atol=CORNER_BOUND)


@pytest.fixture
def character(tmp_path: Path) -> Path:
    return write_character(tmp_path / "subject")


def read_files(character: Path) -> CharacterFiles:
    return CharacterFiles.of(*(character.with_suffix(end) for end in (".skeleton", ".obj", ".skin")))


def dofs_of(motion: Path) -> np.ndarray:
    return np.loadtxt(motion, skiprows=1, ndmin=2)[:, 1:]


def test_joints_and_skin_follow_random_dofs_as_matrices_say(character: Path) -> None:
    dofs = np.random.default_rng(5).normal(0, 0.6, (40, len(DOFS)))
    motion = character.parent / "poses" / "wild.motion"
    motion.parent.mkdir()
    motion.write_text(motion_text(dofs, first=3))
    assert_follows(character, motion, read_files(character), dofs_of(character.with_suffix(".motion"))[0], dofs)


def test_files_in_another_unit_become_a_person_and_a_path_in_metres(character: Path, tmp_path: Path) -> None:
    """In metres, 1.75 stands for 1.75 mm: it is taken for what a person measures, and so is the path of the motion."""
    other = write_character(tmp_path / "metres", millimetre=0.001)
    found = []
    for one in (character, other):
        motion = one.parent / "walk.motion"
        motion.write_text(motion_text(sway(5)))
        surfaces = read_surfaces(one)
        (loaded,) = load_motions(motion, surfaces.skeleton, mapping=None, rate=25)
        scale = surfaces.skeleton.size
        found.append((loaded.clip.translations / scale, len(surfaces.notes)))
    np.testing.assert_allclose(found[1][0], found[0][0], atol=1e-9)
    assert [notes for _, notes in found] == [0, 1]


def test_the_familys_own_sample_follows_its_matrices(shared_data: SharedData) -> None:
    files = [shared_data.path(f"ddc/ddc.{end}") for end in ("character", "skeleton", "obj", "skin", "motion")]
    motion = shared_data.path("ddc/poseAngles.motion")
    rest, dofs = dofs_of(files[4])[0], dofs_of(motion)
    assert_follows(files[0], motion, CharacterFiles.of(*files[1:4]), rest, dofs)


def test_the_sample_stands_as_tall_and_on_the_floor_as_published(shared_data: SharedData) -> None:
    surfaces = read_surfaces(shared_data.path("ddc/ddc.character"))
    assert np.ptp(surfaces.vertices[:, 1]) == pytest.approx(1.764, abs=1e-3)
    assert (len(surfaces.vertices), len(surfaces.faces), len(surfaces.skeleton.names)) == (5514, 11024, 69)
    assert surfaces.notes == ()


def test_the_texture_lies_where_the_obj_has_it(character: Path) -> None:
    picture = np.zeros((8, 8, 3), np.uint8)
    picture[:4] = [250, 10, 10]  # the upper half, where v is above 0.5
    Image.fromarray(picture).save(character.with_suffix(".png"))
    read = read_character(character, uv="keep", atlas_size=32)
    high = read.mesh.vertices[read.mesh.faces].mean(axis=1)[:, 1] > 0.9
    middle = (read.mesh.uv[read.mesh.uv_faces].mean(axis=1) * len(read.base_color)).astype(int)
    red = read.base_color[middle[:, 1], middle[:, 0], 0] > 128
    assert (red == high).mean() > 0.95


def test_motion_has_25_frames_a_second_and_its_files_name(character: Path) -> None:
    (character.parent / "walk.motion").write_text(motion_text(sway(9)))
    (found,) = read_motion(character.parent / "walk.motion")
    assert (found.clip.name, found.clip.rate, len(found.clip)) == ("walk", 25.0, 9)


def test_an_obj_may_have_large_faces_several_materials_and_no_texture(character: Path) -> None:
    mesh = character.with_suffix(".obj")
    faces = [line for line in mesh.read_text().splitlines() if line.startswith("f ")]
    square = "f 1//1 2//2 15//15 14//14"
    mesh.write_text(mesh.read_text().replace("\n".join(faces[:2]), f"usemtl cloth\n{square}\nusemtl skin"))
    surfaces = read_surfaces(character)
    assert len(surfaces.faces) == len(faces)
    assert sorted(material.name for material in surfaces.materials) == ["cloth", "skin"]
    assert np.count_nonzero(surfaces.uv_faces[:, 0] < 0) == 2


SKELETON = {
    "another format": ("Definition V1.0", "v0.9", "the first line is 'Skeletool Skeleton v0.9', expected 'Skeletool"),
    "another kind": ("Hips      revolute", "Hips      scale", "line 7: joint Hips is 'scale', expected revolute or"),
    "a column": (" 0 0 -2 1.0", " 0 0 -2", "line 7: has 9 columns, expected the 10 of a joint"),
    "no axis": ("0 0 -2", "0 0 0", "line 7: the axis is 0 0 0"),
    "no number": ("0 50", "0 tall", "line 3: number 2 is 'tall', expected a finite number"),
    "not finite": ("0 50", "0 nan", "line 3: number 2 is 'nan', expected a finite number"),
    "no parent": ("HipsScale 0", "Belly 0", "line 10: the parent of Spine_ry is 'Belly', which is no joint"),
    "a circle": ("prismatic none", "prismatic Chest", "joints are their own parents: "),
    "twice": ("  Spine_rx  rev", "  Spine_ry  rev", "line 11: a second joint is called 'Spine_ry'"),
    "other joints": ("Root_ty 1000", "Belly 1000", "'Belly 1000', expected a joint that DoF move_y moves"),
    "no count": ("joints: 9", "joints: nine", "line 2: 'nine', expected a whole number"),
    "another section": ("markers: 1", "dofs: 1", "line 12: 'dofs: 1', expected 'markers: N'"),
    "none": ("joints: 9", "joints: 0", "joints is 0, expected at least one"),
}


FAULTS = {
    "no skin": (".character", "tube.skin", "arm.skin", "line 7: skin is 'arm.skin': there is no such file beside it"),
    "no pose": (".character", "pose\n  tube.motion\n", "", "names no pose, expected skeleton, mesh, skin, pose"),
    "a label": (".character", "  tube.motion\n", "", "ends after line 8, expected the file of 'pose'"),
    "a bone": (".skin", "Chest Hips", "Chest Tail", "line 3: bone 'Tail' is no joint of the skeleton"),
    "a bone twice": (".skin", "Chest Hips", "Chest Chest", "line 3: bone 'Chest' is named twice"),
    "no bones": (".skin", "bones:", "names:", "line 2: 'names:', expected 'bones:'"),
    "a bone's number": (".skin", "\n1 1 ", "\n1 7 ", "line 6: bone 7, expected 0 to 2"),
    "half a pair": (".skin", "\n1 1 ", "\n1 ", "line 6: has 5 numbers after the vertex, expected pairs"),
    "a vertex": (".skin", "\n1 1 ", "\n3 1 ", "line 6: is about vertex 3, expected 1"),
    "a weight": (".skin", "\n1 1 ", "\n1 1 -", "of bone 1, expected at least 0"),
    "no weight": (".skin", "\n1 ", "\n1 0 0\n1 ", "line 6: all weights are 0"),
    "a material": (".mtl", "tube.png", "gone.png", "gone.png: the texture of material skin cannot be read"),
    "materials": (".obj", "tube.mtl", "gone.mtl", "gone.mtl: there is no such file"),
    "a corner": (".obj", "f 1/1/1", "f 999/1/1", "line 786: 'f 999/1/1 "),
    "a place": (".obj", "v ", "v nan", "line 2: 'v nan300.0 0.0 "),
    "a rest pose": (".motion", "\n0 ", "\n0 1 ", "line 2: has 11 DoFs, expected the 10 of the skeleton"),
}


FAULTS |= {f"skeleton, {name}": (".skeleton", *fault) for name, fault in SKELETON.items()}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_character_that_is_wrong_is_named(character: Path, fault: str) -> None:
    suffix, before, after, sentence = FAULTS[fault]
    file = character.with_suffix(suffix)
    text = file.read_text()
    assert before in text
    file.write_text(text.replace(before, after, 1))
    with pytest.raises(InputError) as refused:
        read_surfaces(character)
    assert sentence in str(refused.value)
    assert "\n" not in str(refused.value)


MOTION = {
    "too many": ("\n2 ", "\n2 0.5 ", "walk.motion, line 4: has 11 DoFs, expected the 10 of the skeleton"),
    "not finite": ("\n2 ", "\n2 inf", "walk.motion, line 4: number 2 is 'inf0."),
    "a gap": ("\n2 ", "\n4 ", "walk.motion, line 4: is frame 4, expected 2 after 1"),
    "a frame": ("\n0 ", "\n0.5 ", "walk.motion, line 2: the frame is 0.5, expected a whole number"),
    "another format": ("Motion File V1.0", "Motion File V2.0", "walk.motion: the first line is 'Skeletool Motion"),
}


@pytest.mark.parametrize("fault", MOTION)
def test_motion_that_is_wrong_is_named(character: Path, fault: str) -> None:
    before, after, sentence = MOTION[fault]
    motion = character.parent / "walk.motion"
    motion.write_text(motion_text(sway(4)).replace(before, after, 1))
    with pytest.raises(InputError) as refused:
        read_motion(motion)
    assert sentence in str(refused.value)


def test_motion_that_was_cut_is_named(character: Path) -> None:
    motion = character.parent / "walk.motion"
    motion.write_text(motion_text(sway(4))[:-60])
    with pytest.raises(InputError, match=r"walk\.motion, line 5: has 7 DoFs, expected the 10 of the skeleton"):
        read_motion(motion)


def test_motion_without_frames_or_a_character_is_refused(character: Path, tmp_path: Path) -> None:
    motion = character.parent / "walk.motion"
    motion.write_text(motion_text(sway(0)))
    with pytest.raises(InputError, match=r"walk\.motion: holds no frame"):
        read_motion(motion)
    character.with_name("b.character").write_text("")
    with pytest.raises(InputError, match=r"holds b\.character and tube\.character; expected one character"):
        read_motion(motion)
    (tmp_path / "far" / "away").mkdir(parents=True)
    lost = motion.rename(tmp_path / "far" / "away" / "walk.motion")
    with pytest.raises(InputError, match=r"there is no \.character beside it or in the folder above"):
        read_motion(lost)


@pytest.mark.parametrize("suffix", [".character", ".skeleton", ".skin", ".motion", ".obj"])
def test_rejects_files_that_end_early(character: Path, suffix: str) -> None:
    file = character.with_suffix(suffix)
    lines = file.read_text().splitlines(keepends=True)
    for kept in {*range(min(len(lines) - 1, 12)), len(lines) // 2}:
        file.write_text("".join(lines[:kept]))
        with pytest.raises(InputError) as refused:
            read_surfaces(character)
        assert "\n" not in str(refused.value)
        assert str(file.parent) in str(refused.value)
