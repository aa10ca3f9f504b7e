"""The source character beside its splats: the images of each painter, and the result of the comparison."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import gltf_files
import moderngl
import numpy as np
import pytest
from column_files import column_file
from spheres import sphere
from tube import tube

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.rendering import frame_bounds, render_premultiplied
from mua.baking.check import WITHOUT_FILE, fidelity_of
from mua.characters.read import read_character
from mua.fidelity import report
from mua.fidelity import splats as splat_painting
from mua.fidelity.canvas import opened
from mua.fidelity.compare import SCREEN, Fidelity, PoseFidelity, Shot, spread
from mua.fidelity.measure import MOST_DECIBELS, Agreement, agreement, worst_place
from mua.fidelity.painter import Painter
from mua.fidelity.posed_source import Poser, skinned
from mua.fidelity.sheet import fidelity_sheet
from mua.fidelity.splats import SplatPainter
from mua.kernels.splat_project import LEAST_OPACITY
from mua.rig.character import Character
from mua.scene import Material, Part, Source

SIDE = 9  # pixels, odd: a pixel's middle is on the axis
AHEAD = Camera(np.eye(4), np.diag([1.0, 1.0, 0.5, 1.0]), (SIDE, SIDE))  # sees -1..1; what has more z is behind
EIGHT_BITS = 1 / 255
TEXELS = 192


@pytest.fixture
def context() -> Iterator[moderngl.Context]:
    with opened() as there:
        yield there


def card(*, depth: float, material: int = 0, low: float = -1.0, uv: float = 1.0) -> Part:
    """A square from `low` to 1 that faces the camera; its texture repeats `uv` times."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    return Part(
        name="card",
        group=0,
        positions=np.column_stack([low + (1 - low) * corners, np.full(4, depth)]),
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
        uv=np.column_stack([corners[:, 0], 1 - corners[:, 1]]) * uv,
        uv_faces=np.array([[0, 1, 2], [0, 2, 3]]),
        material=material,
        skin=0,
        joints=np.zeros((4, 1), int),
        weights=np.ones((4, 1)),
    )


def plain(*color: int) -> Material:
    return Material("plain", np.array([[color]], np.uint8))


def drawn(context: moderngl.Context, parts: list[Part], materials: list[Material]) -> Array:
    painter = Painter(context, parts, materials, screen=(SIDE, SIDE))
    return painter([part.positions for part in parts], AHEAD)


def test_a_card_shows_its_picture_upright(context: moderngl.Context) -> None:
    picture = np.zeros((2, 2, 4), np.uint8)
    picture[0, 0], picture[1, 1], picture[..., 3] = (255, 0, 0, 255), (0, 255, 0, 255), 255
    image = drawn(context, [card(depth=0)], [Material("", picture, "clamp", "clamp")])
    np.testing.assert_allclose(image[0, 0], [1, 0, 0, 1], atol=EIGHT_BITS)  # its first row is at the top
    np.testing.assert_allclose(image[-1, -1], [0, 1, 0, 1], atol=EIGHT_BITS)
    np.testing.assert_allclose(image[0, -1], [0, 0, 0, 1], atol=EIGHT_BITS)


def test_a_mirrored_texture_turns_round_at_its_end(context: moderngl.Context) -> None:
    picture = np.zeros((1, 2, 4), np.uint8)
    picture[0, 0], picture[..., 3] = (255, 0, 0, 255), 255
    image = drawn(context, [card(depth=0, uv=2)], [Material("", picture, "mirror", "mirror")])
    reds = image[SIDE // 2, [0, SIDE // 2, -1], 0]
    np.testing.assert_allclose(reds, [1, 0, 1], atol=EIGHT_BITS)


def test_a_triangle_at_one_place_of_a_palette_has_its_colour(context: moderngl.Context) -> None:
    palette = np.full((1, 256, 4), 255, np.uint8)
    palette[0, :, 0] = np.where(np.arange(256) == 0, 200, 20)
    part = replace(card(depth=0), uv=np.full((4, 2), [0.5 / 256, 0.5]))
    np.testing.assert_allclose(drawn(context, [part], [Material("", palette)])[4, 4, 0], 200 / 255, atol=EIGHT_BITS)


def test_the_nearer_card_hides_the_farther_whatever_comes_first(context: moderngl.Context) -> None:
    materials = [plain(255, 0, 0, 255), plain(0, 255, 0, 255)]
    for near in (0, 1):
        parts = [card(depth=-0.5 if m == near else 0.5, material=m) for m in (0, 1)]
        np.testing.assert_allclose(drawn(context, parts, materials)[4, 4, :2], np.eye(2)[near], atol=EIGHT_BITS)


@pytest.mark.parametrize("first", [0, 1])
def test_drawing_what_is_near_first_changes_nothing_but_the_order(context: moderngl.Context, first: int) -> None:
    """Of two triangles in one place the first of the file is seen, and the near card hides the far one."""
    materials = [plain(255, 0, 0, 255), plain(0, 255, 0, 255), plain(0, 0, 255, 200)]
    parts = [card(depth=0.5, material=1 - first), card(depth=0.5, material=first), card(depth=0.6, material=2)]
    parts.append(card(depth=-0.5, material=0, low=0.3))
    expected = drawn(context, parts, materials)
    painter = Painter(context, parts, materials, screen=(SIDE, SIDE))
    shown = [np.ones(len(part.faces), bool) for part in parts]
    painter.near_first([part.positions for part in parts], AHEAD, shown)
    np.testing.assert_array_equal(painter([part.positions for part in parts], AHEAD), expected)
    np.testing.assert_allclose(expected[4, 2, :2], np.eye(2)[1 - first], atol=EIGHT_BITS)


def test_what_is_half_transparent_lies_over_what_is_behind(context: moderngl.Context) -> None:
    materials = [plain(255, 0, 0, 128), plain(0, 255, 0, 255)]
    share = 128 / 255
    before = drawn(context, [card(depth=-0.5), card(depth=0.5, material=1)], materials)
    np.testing.assert_allclose(before[4, 4], [share, 1 - share, 0, 1], atol=2 * EIGHT_BITS)
    behind = drawn(context, [card(depth=0.5), card(depth=-0.5, material=1)], materials)
    np.testing.assert_allclose(behind[4, 4], [0, 1, 0, 1], atol=2 * EIGHT_BITS)


def test_corner_colours_multiply_the_picture_as_light(context: moderngl.Context) -> None:
    part = replace(card(depth=0), colors=np.tile([0.5, 1, 0, 0.5], (2, 3, 1)))
    image = drawn(context, [part], [plain(255, 188, 255, 255)])
    half = 188 / 255  # as sRGB, of half the light
    np.testing.assert_allclose(image[4, 4], np.array([half, half, 0, 1]) * 0.5, atol=2 * EIGHT_BITS)


@pytest.mark.parametrize(("opacity", "seen"), [(0.6, 0), (0.7, 1)])
def test_a_mask_is_cut_where_picture_times_corners_is_below_the_cutoff(
    context: moderngl.Context, opacity: float, seen: int
) -> None:
    part = replace(card(depth=0), colors=np.tile([1, 1, 1, opacity], (2, 3, 1)))
    veil = replace(plain(255, 255, 255, 200), alpha_mode="mask", alpha_cutoff=0.5)  # 0.78 of it
    np.testing.assert_allclose(drawn(context, [part], [veil])[4, 4], [seen] * 4, atol=EIGHT_BITS)


def test_a_pixel_is_covered_by_the_share_of_its_samples(context: moderngl.Context) -> None:
    image = drawn(
        context, [card(depth=0, low=-1 / 27)], [plain(255, 255, 255, 255)]
    )  # all but the first third of its pixel
    np.testing.assert_allclose(image[3:6, 3:6, 3], np.outer([1, 2 / 3, 0], [0, 2 / 3, 1]), atol=EIGHT_BITS)


def test_splats_are_drawn_as_by_the_reference(context: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(splat_painting, "SAMPLES", 1)
    frame = sphere(400)
    camera = orbit(frame_bounds(frame), screen=(61, 47), azimuth=0.3)
    image = SplatPainter(context, camera.screen)(frame, camera)
    apart = np.abs(image - render_premultiplied(frame, camera))
    # Some 30 splats over each other, each with a few roundings of float32 in an exponent of up to 6.
    assert np.quantile(apart, 0.99) < 30 * 24 * 2**-24
    assert apart.max() < LEAST_OPACITY  # the error of a pixel on the rim of a quad


def column(tmp_path: Path) -> Character:
    """The same, as a bake reads it."""
    return read_character(column_file(tmp_path), atlas_size=128)


def column_with_source(tmp_path: Path) -> tuple[Character, Source, Part]:
    """The same, what it was read from, and the one part of that."""
    character = column(tmp_path)
    assert character.source is not None
    (part,) = character.source.scene.parts
    return character, character.source, part


def test_the_source_is_posed_alike_by_its_own_nodes_and_by_the_joints(tmp_path: Path) -> None:
    character, source, part = column_with_source(tmp_path)
    poser, clip = Poser(source, character.skeleton), character.clips[0]
    own = poser.of_clip(clip, len(clip) - 1).nodes
    moved = poser.of_clip(replace(clip, name="another"), len(clip) - 1).nodes
    assert np.abs(own - source.scene.rest).max() > 0.1
    np.testing.assert_allclose(moved, own, atol=1e-6)  # float32 keys of the file
    np.testing.assert_allclose(skinned(source.scene, part, poser.rest().nodes), part.positions, atol=1e-6)


def test_a_body_that_turns_on_a_still_root_is_seen_from_its_own_front(tmp_path: Path) -> None:
    character, source, _ = column_with_source(tmp_path)
    poser, clip = Poser(source, character.skeleton), character.clips[0]
    rotations = np.tile(character.skeleton.bind_rotations, (1, 1, 1))
    apart = rotations.copy()
    quarter = np.array([np.sqrt(0.5), 0, np.sqrt(0.5), 0])  # about +Y
    rotations[0, 1] = rotation.multiply(quarter, rotations[0, 1])  # three quarters of the surface hang on the spine
    turned = replace(clip, rotations=rotations, translations=clip.translations[:1])
    assert poser.of_clip(turned, 0).yaw == pytest.approx(np.pi / 2)
    for joint, times in ((1, 1), (2, 2)):  # hips, spine and head each another way: the root's
        for _ in range(times):
            apart[0, joint] = rotation.multiply(quarter, apart[0, joint])
    assert poser.of_clip(replace(turned, rotations=apart), 0).yaw == pytest.approx(0, abs=1e-6)


def test_a_poor_silhouette_is_reported_with_its_pose_and_place() -> None:
    image = np.zeros((2, 2, 4))
    shot = Shot(image, image, Agreement(90, 5, 5, 0.0), "front", (0, 0), "Spine", 0.1)
    (sentence,) = report.sentences(Fidelity((PoseFidelity("bow", (shot,)),)))
    assert "overlap by only 90.0 % in the pose 'bow'" in sentence
    assert sentence.endswith("worst at Spine, seen from front.")


def test_splats_look_like_the_character_that_they_are_of(tmp_path: Path) -> None:
    character = column(tmp_path)
    fidelity, warnings = fidelity_of(character, character.clips, texels=TEXELS)
    assert fidelity is not None
    assert len(fidelity.poses) == 4
    # Splats of 8 mm reach a few millimetres beyond the edges of a column 40 cm wide.
    assert fidelity.poses[0].agreement.iou > 0.96
    assert fidelity.iou > 0.93  # bent by dual quaternions here, by a linear blend there
    assert fidelity.psnr > 40
    assert not any("colours" in sentence for sentence in warnings)
    sheet = fidelity_sheet(fidelity)
    assert sheet.width == 2 * 3 * SCREEN[0]


FIN = np.array([0.6, 0.5])  # x and z of a corner that sticks out of the column, to its left and front
TURNED = np.radians(120)  # by which a clip turns the column to its left


def lopsided(tmp_path: Path) -> Character:
    """The column with one upper corner drawn out, so that no two sides look alike; a clip turns it and stays."""
    glb = gltf_files.body()
    points = gltf_files.POINTS.copy()
    points[np.ix_((points > [0, 1.2, 0]).all(axis=1), np.array([0, 2]))] = FIN
    gltf_files.primitive(glb)["attributes"]["POSITION"] = glb.accessor(points)
    turn = np.array([[0, np.sin(TURNED / 2), 0, np.cos(TURNED / 2)]] * 2)
    sampler = {"input": glb.accessor(np.array([0.0, 1.0])), "output": glb.accessor(turn)}
    channel = {"sampler": 0, "target": {"node": 0, "path": "rotation"}}
    glb.json["animations"] = [{"name": "turned", "samplers": [sampler], "channels": [channel]}]
    return read_character(glb.save(tmp_path / "fin.glb"), atlas_size=128)


@pytest.mark.parametrize("others", [False, True])
def test_source_and_splats_are_seen_from_the_same_named_side_of_a_turned_figure(tmp_path: Path, others: bool) -> None:
    """Whether the clip is the file's own, which moves its nodes, or another file's, which moves joints."""
    character = lopsided(tmp_path)
    clips = [replace(clip, name="of another file") for clip in character.clips] if others else character.clips
    fidelity, _ = fidelity_of(character, clips, texels=TEXELS)
    assert fidelity is not None
    assert [len(pose.shots) for pose in fidelity.poses] == [4, 1, 1, 1]
    assert fidelity.iou > 0.96
    # Degrees that the camera stands to the left.
    sides = {"front": 0, "left": 90, "back": 180, "front, right": -40, "back, left": 140}
    for shot in (shot for pose in fidelity.poses for shot in pose.shots):
        angle = np.radians(sides[shot.view])
        fin_is_right = np.array([np.cos(angle), -np.sin(angle)]) @ FIN > 0
        for image in (shot.source, shot.splats):
            columns = np.flatnonzero(image[..., 3].any(axis=0))
            mass = np.average(np.arange(SCREEN[0]), weights=image[..., 3].sum(axis=0))
            assert (mass < (columns[0] + columns[-1]) / 2) == fin_is_right, shot.view


@pytest.mark.parametrize("pale", [True, False])
def test_a_figure_stands_out_from_the_background_of_its_sheet(tmp_path: Path, pale: bool) -> None:
    character = column(tmp_path)  # which is white
    fidelity, _ = fidelity_of(character, (), texels=TEXELS)
    assert fidelity is not None
    if not pale:
        shots = tuple(replace(shot, source=shot.source * [0.2, 0.2, 0.2, 1]) for shot in fidelity.poses[0].shots)
        fidelity = Fidelity((replace(fidelity.poses[0], shots=shots),))
    picture = np.asarray(fidelity_sheet(fidelity), int)[-SCREEN[1] :, : SCREEN[0]]
    background, figure = picture[-1, -1], picture[SCREEN[1] // 2, SCREEN[0] // 2]
    assert (abs(figure - background) > 80).all()
    assert (background == 255).all() == (not pale)


def test_wrong_colours_are_measured_and_reported(tmp_path: Path) -> None:
    character = column(tmp_path)
    dark = replace(character, base_color=character.base_color // np.array([2, 2, 2, 1], np.uint8))
    fidelity, warnings = fidelity_of(dark, (), texels=TEXELS)
    assert fidelity is not None
    assert fidelity.psnr == pytest.approx(20 * np.log10(255 / 128), abs=0.1)  # white, drawn as 127
    assert any("The colours of splats and character" in sentence for sentence in warnings)


def test_a_figure_below_its_limit_never_reads_as_the_limit() -> None:
    nearly = Agreement(4, 0, 0, 3 * 4 / 10**2.9997)  # 29.997 dB
    image = picture([1], [1])
    shot = Shot(image, image, nearly, "front", (0, 0), "head", 0.0)
    (sentence,) = report.sentences(Fidelity((PoseFidelity("rest", (shot,)),)))
    assert "only 29.9 dB" in sentence


def test_a_missing_part_is_measured_and_the_joint_named(tmp_path: Path) -> None:
    character = column(tmp_path)
    top = character.mesh.vertices[character.mesh.faces][:, :, 1].min(axis=1) >= 1.0 - 1e-6
    mesh = replace(character.mesh, faces=character.mesh.faces[~top], uv_faces=character.mesh.uv_faces[~top])
    fidelity, warnings = fidelity_of(replace(character, mesh=mesh), (), texels=TEXELS)
    assert fidelity is not None
    assert 0.55 < fidelity.iou < 0.75  # a third is missing
    found = fidelity.poses[0].agreement
    assert found.missing > 5 * found.beyond
    assert fidelity.worst.worst.joint == "head"
    assert "head" in warnings[0]
    assert report.as_dict(fidelity)["iou"] == fidelity.iou


def test_a_character_without_a_file_is_not_compared() -> None:
    assert fidelity_of(tube(), (), texels=TEXELS) == (None, (WITHOUT_FILE,))


def test_frames_are_spread_over_all_clips(tmp_path: Path) -> None:
    clip = column(tmp_path).clips[0]
    short = replace(clip, name="short", rotations=clip.rotations[:1], translations=clip.translations[:1])
    chosen = spread([clip, short], 3)
    assert [(c.name, frame) for c, frame in chosen] == [("bend", 5), ("bend", 15), ("bend", 25)]
    still = replace(clip, name="T-pose", rotations=clip.rotations[:1].repeat(200, axis=0))
    assert spread([still, clip, short], 3) == chosen
    assert spread([short], 3) == [(short, 0)]
    assert spread([], 3) == []


def picture(alpha: list[float], red: list[float]) -> Array:
    """One row of pixels, premultiplied."""
    image = np.zeros((1, len(alpha), 4))
    image[0, :, 3], image[0, :, 0] = alpha, np.multiply(alpha, red)
    return image


def test_agreement_counts_half_covered_pixels_and_colours_where_both_are() -> None:
    found = agreement(picture([1, 0.5, 1, 0.4], [0.5, 1, 0.2, 0]), picture([1, 1, 0.4, 0.6], [0.4, 1, 0.9, 0]))
    assert (found.common, found.missing, found.beyond) == (2, 1, 1)
    assert found.iou == 0.5
    assert found.psnr == pytest.approx(10 * np.log10(3 * 2 / 0.01))


def test_equal_and_empty_pictures_have_bounded_figures() -> None:
    assert Agreement(4, 0, 0, 0.0).psnr == MOST_DECIBELS
    assert Agreement(0, 0, 0, 0.0).iou == 0.0
    assert Agreement(0, 3, 0, 0.0).psnr == 0.0


def test_the_worst_place_is_where_differences_gather() -> None:
    source, other = np.zeros((48, 48, 4)), np.zeros((48, 48, 4))
    source[10:14, 30:34] = other[40, 3] = 1
    assert worst_place(source, other)[:2] in {(c, r) for c in range(30, 34) for r in range(10, 14)}
