"""The close look at a face: each expression of the file beside the splats' own, drawn only where it moves them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from face_files import grinning

from mua.avatar.decode import express, pose_splats
from mua.baking.check import fidelity_of
from mua.characters.read import read_character
from mua.fidelity import faces, report, source_faces
from mua.fidelity.canvas import Area, opened
from mua.fidelity.compare import face_of
from mua.fidelity.face_sheet import face_sheet
from mua.fidelity.faces import FaceFidelity, compare_faces
from mua.fidelity.measure import agreement
from mua.fidelity.posed_source import Moment, Poser
from mua.fidelity.source_faces import Patch
from mua.fidelity.source_process import SourceProcess
from mua.fidelity.splat_faces import StillFace
from mua.fidelity.splats import SplatPainter
from mua.pose.clip import Clip
from mua.rig.character import Character
from mua.scene import Source
from mua.teachers.simulated.still import StillTeacher

TEXELS = 192
ROUNDED = 64 * 2**-24  # colours of some splats over each other, of channels that lie in memory in another order


def grinning_character(tmp_path: Path) -> Character:
    return read_character(grinning(tmp_path), atlas_size=256)


def drawn_here(character: Character, teacher: StillTeacher, process: SourceProcess | None = None) -> FaceFidelity:
    """The faces of the character as the file stands, drawn by this process but for what another has drawn."""
    face, (source, rest) = still_face(character, teacher), at_rest(character)
    with opened() as context:
        return compare_faces(context, face, scene=source.scene, rest=rest, process=process or SourceProcess())


def still_face(character: Character, teacher: StillTeacher) -> StillFace:
    source, rest = at_rest(character)
    face = face_of(teacher, source.scene, rest)
    assert face is not None
    return face


def at_rest(character: Character) -> tuple[Source, Moment]:
    assert character.source is not None
    return character.source, Poser(character.source, character.skeleton).rest()


def test_the_source_makes_the_faces_of_a_clip_too(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    pose = character.skeleton.bind_pose
    clip = Clip("lean", 30.0, pose.rotations[None], pose.translations[None], expressions=np.array([[1.0, 0.0]]))
    fidelity, _ = fidelity_of(character, (clip,), texels=TEXELS)
    assert fidelity is not None
    rest, leaning = fidelity.poses
    assert leaning.agreement.iou > rest.agreement.iou - 0.01


def test_expressions_look_like_the_files_own_targets(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    fidelity, warnings = fidelity_of(character, (), texels=TEXELS, process=SourceProcess())
    assert fidelity is not None
    assert fidelity.face is not None
    assert [shot.name for shot in fidelity.face.expressions] == ["lean", "lift"]
    for shot in fidelity.face.expressions:
        assert shot.agreement.iou > fidelity.face.rest.agreement.iou - 0.02
        assert not np.array_equal(shot.source, fidelity.face.rest.source)
    assert not any("The face" in sentence for sentence in warnings)
    assert [*report.as_dict(fidelity)["expressions"]] == ["at rest", "lean", "lift"]
    assert face_sheet(fidelity.face).width == 2 * 3 * source_faces.SCREEN[0]
    plain, _ = fidelity_of(character, (), texels=TEXELS)
    assert plain is not None
    assert plain.face is None


def test_a_wrong_expression_is_measured_and_named(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    assert character.expressions is not None
    wrong = replace(character.expressions, offsets=character.expressions.offsets * np.array([-1, 1, 1], np.float32))
    fidelity, warnings = fidelity_of(replace(character, expressions=wrong), (), texels=TEXELS, process=SourceProcess())
    assert fidelity is not None
    assert fidelity.face is not None
    lean, lift = fidelity.face.expressions
    assert lean.agreement.iou < lift.agreement.iou - 0.1
    assert any("The face" in sentence and "lean" in sentence and "lift" not in sentence for sentence in warnings)


def test_of_many_expressions_those_least_like_the_file_are_in_the_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    character = grinning_character(tmp_path)
    assert character.expressions is not None
    wrong = replace(character.expressions, offsets=character.expressions.offsets * np.array([1, -1, 1], np.float32))
    character = replace(character, expressions=wrong)
    drawn = drawn_here(character, StillTeacher(character, texels=TEXELS))
    assert drawn.least_like == drawn.expressions
    monkeypatch.setattr(faces, "PICTURED", 1)
    assert [shot.name for shot in drawn.least_like] == ["lift"]
    assert face_sheet(drawn).height == face_sheet(drawn, every=True).height / 2


def test_an_expression_drawn_where_it_moves_is_the_picture_drawn_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    character = grinning_character(tmp_path)
    teacher = StillTeacher(character, texels=TEXELS)
    parts = drawn_here(character, teacher)
    areas = [patch.area for shot in parts.expressions for patch in shot.other]
    assert all(not area.empty and area != whole_screen() for area in areas)
    monkeypatch.setattr(Area, "about", classmethod(lambda *_: whole_screen()))
    whole = drawn_here(character, teacher)
    for part, all_of_it in zip(parts.expressions, whole.expressions, strict=True):
        np.testing.assert_array_equal(part.source, all_of_it.source)
        np.testing.assert_array_equal(part.splats, all_of_it.splats)
        assert part.agreement.iou == agreement(part.source, part.splats).iou
        assert part.agreement.psnr == pytest.approx(agreement(part.source, part.splats).psnr)


def test_what_a_process_leaves_is_drawn_here(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    teacher = StillTeacher(character, texels=TEXELS)
    whole = drawn_here(character, teacher)

    stopping = SourceProcess()
    for patch in Patch(whole_screen(), whole.rest.splats), Patch(Area(0, 0, 0, 0), np.empty((0, 0, 4))), None:
        stopping._splat_faces.put(patch)
    parts = drawn_here(character, teacher, stopping)
    np.testing.assert_array_equal(parts.expressions[0].splats, whole.rest.splats)
    np.testing.assert_array_equal(parts.expressions[1].splats, whole.expressions[1].splats)


def test_splats_that_an_expression_moves_lie_among_the_others_as_if_all_were_drawn_anew(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    teacher = StillTeacher(character, texels=TEXELS)
    still, drawn = still_face(character, teacher), drawn_here(character, teacher)
    with opened() as context:
        for shot, weights in zip(drawn.expressions, np.eye(2, dtype=np.float32), strict=True):
            mesh, texture = express(still.rig, still.mesh, texture=still.texture, weights=weights)
            posed = pose_splats(still.rig, mesh, texture=texture, pose=still.pose)
            expected = SplatPainter(context, source_faces.SCREEN)(posed, still.camera)
            assert np.quantile(np.abs(shot.splats - expected), 0.99) < ROUNDED
            assert not np.allclose(shot.splats, drawn.rest.splats, atol=0.1)


def test_splats_over_a_layer_of_those_behind_them_are_the_picture_of_all(tmp_path: Path) -> None:
    character = grinning_character(tmp_path)
    still = still_face(character, StillTeacher(character, texels=TEXELS))
    posed = pose_splats(still.rig, still.mesh, texture=still.texture, pose=still.pose)
    area = Area(100, 120, 180, 160)
    with opened() as context:
        paint = SplatPainter(context, source_faces.SCREEN)
        quads = paint.quads(posed, still.camera)
        layers, whole = paint.layers(quads), paint.drawn(quads)
        assert len({layer.key for layer in layers}) == len(layers) > 4
        for layer in layers:
            np.testing.assert_array_equal(paint.drawn(quads, area, layer), area.of(whole))
            front = paint.drawn(quads.between(layer.key))
            assert layer.image is None or not np.array_equal(front, whole)


def whole_screen() -> Area:
    return Area(0, 0, *source_faces.SCREEN)
