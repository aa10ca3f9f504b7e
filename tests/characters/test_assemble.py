"""Scenes built by hand, merged into one surface."""

from dataclasses import replace

import numpy as np
import pytest
from boxes import boxes
from scenes import GREY, HERE, part, scene

from mua.characters.assemble import assemble, first_of_equal
from mua.errors import InputError
from mua.scene import Material, Part


def test_seams_keep_their_texture_coordinates() -> None:
    positions = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
    uv = np.array([(0, 0), (1, 0), (0, 1), (1.5, 0), (0, 1), (1, 1)])
    faces = np.array([[0, 1, 2], [3, 5, 4]])
    quad = replace(
        part(count=6),
        positions=positions,
        faces=faces,
        uv=uv,
        uv_faces=faces,
        joints=np.zeros((6, 2), int),
    )
    surfaces = assemble(scene(parts=(quad,)), HERE)
    assert len(surfaces.vertices) == 4
    assert len(surfaces.uv) == 5  # (1, 0) is torn, (0, 1) is not
    np.testing.assert_array_equal(surfaces.uv[surfaces.uv_faces], uv[faces])


def test_triangles_that_welding_empties_are_dropped() -> None:
    thin = replace(part(), positions=np.concatenate([part().positions[:1], part().positions[:-1]]))
    thin = replace(thin, joints=np.zeros((30, 2), int))
    assert len(assemble(scene(parts=(thin,)), HERE).faces) == 9


def test_missing_texture_coordinates_are_marked() -> None:
    bare = replace(part(group=1, seed=2), uv=np.zeros((0, 2)), uv_faces=np.full((10, 3), -1))
    surfaces = assemble(scene(parts=(bare, part())), HERE)
    assert (surfaces.uv_faces[:10] == -1).all()
    np.testing.assert_array_equal(surfaces.uv[surfaces.uv_faces[10:]], part().uv[part().faces])


def test_unused_materials_are_left_out() -> None:
    other = Material("other", GREY.image)
    surfaces = assemble(scene(materials=(other, GREY), parts=(replace(part(), material=1),)), HERE)
    assert [material.name for material in surfaces.materials] == ["grey"]
    assert not surfaces.face_material.any()


def test_first_of_equal_keeps_the_order_of_appearance() -> None:
    first, which = first_of_equal(np.array([[3, 1], [2, 2], [3, 1], [0, 0]]))
    assert first.tolist() == [0, 1, 3]
    assert which.tolist() == [0, 1, 0, 2]


@pytest.mark.parametrize("parts", [(), (replace(part(), faces=np.zeros((0, 3), int), uv_faces=np.zeros((0, 3), int)),)])
def test_scene_without_triangles_is_refused(parts: tuple[Part, ...]) -> None:
    with pytest.raises(InputError, match=r"body\.glb: no skinned mesh"):
        assemble(scene(parts=parts), HERE)


def test_closed_pieces_wound_inside_out_are_turned() -> None:
    """Their texture coordinates turn with them; the other pieces stay as they are."""
    mixed, outward = (assemble(scene(parts=(boxes(wound=wound),)), HERE) for wound in ((1, -1, -1), (1, 1, 1)))
    np.testing.assert_array_equal(mixed.faces, outward.faces)
    np.testing.assert_array_equal(mixed.uv[mixed.uv_faces], outward.uv[outward.uv_faces])
    assert "24 triangles of closed pieces are wound inside out and are turned." in mixed.notes
    assert not any("wound" in note for note in outward.notes)


@pytest.mark.parametrize("change", ["open", "not alike"])
def test_a_piece_without_an_inside_stays_as_it_is(change: str) -> None:
    box = boxes(wound=(-1,))
    faces = box.faces[1:] if change == "open" else np.concatenate([box.faces[:1, ::-1], box.faces[1:]])
    surfaces = assemble(scene(parts=(replace(box, faces=faces, uv_faces=faces),)), HERE)
    np.testing.assert_array_equal(surfaces.vertices[surfaces.faces], box.positions[faces])
