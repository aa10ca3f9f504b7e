"""Where a character faces and which side is left: by the body, whatever names say, or as the user says."""

from dataclasses import replace

import numpy as np
import pytest
from people import person
from scenes import HERE, at
from scipy.spatial.transform import Rotation
from test_upright import whole

from mua.atlas.character_surfaces import Surfaces
from mua.characters.assemble import assemble
from mua.characters.facing import Facing
from mua.pose.joint_names import roles
from mua.scene import Scene

AWAY = {"+z": 0, "+x": 90, "-z": 180, "-x": -90}


def swapped(scene: Scene) -> Scene:
    """The scene with the names of left and right exchanged."""
    other = {"Left": "Right", "Righ": "Left"}
    names = tuple(
        other[name[:4]] + name[5 if name.startswith("Right") else 4 :] if name[:4] in other else name
        for name in scene.node_names
    )
    return replace(scene, node_names=names)


def ahead(surfaces: Surfaces) -> np.ndarray:
    """Where the toes point [3], both together, of their length."""
    skeleton = surfaces.skeleton
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    toes = sum(
        places[skeleton.names.index(f"{side}Toe_End")] - places[skeleton.names.index(f"{side}ToeBase")]
        for side in ("Left", "Right")
    )
    return np.asarray(toes / np.linalg.norm(toes))


def left(surfaces: Surfaces) -> float:
    """How far the joint that is taken for the left thigh is on the left of a body that faces +Z."""
    skeleton = surfaces.skeleton
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    return float(places[roles(skeleton, surfaces.roles)["left thigh"][0], 0])


def read(scene: Scene, facing: Facing | None = None) -> Surfaces:
    return assemble(scene, HERE, facing=facing or Facing())


@pytest.mark.parametrize("names", [lambda scene: scene, swapped], ids=["true names", "swapped names"])
@pytest.mark.parametrize("direction", AWAY)
def test_a_person_faces_ahead_with_the_left_side_on_the_left(direction: str, names: object) -> None:
    assert callable(names)
    surfaces = read(names(whole(Rotation.from_euler("y", AWAY[direction], degrees=True))))
    assert ahead(surfaces)[2] > 0.9
    assert left(surfaces) > 0
    assert any("does not face +Z" in note for note in surfaces.notes) is (direction != "+z")
    assert any("are exchanged" in note for note in surfaces.notes) is (names is swapped)


@pytest.mark.parametrize("direction", AWAY)
def test_a_direction_that_is_given_becomes_the_front(direction: str) -> None:
    """Whatever the feet say: the toes point to +Z in the file, so afterwards to where the direction went from +Z."""
    surfaces = read(whole(Rotation.identity()), Facing(direction))  # type: ignore[arg-type]
    expected = Rotation.from_euler("y", -AWAY[direction], degrees=True).apply(ahead(read(whole(Rotation.identity()))))
    np.testing.assert_allclose(ahead(surfaces), expected, atol=1e-9)
    assert direction in ("+x", "-x") or left(surfaces) > 0


def test_a_turn_goes_from_z_towards_x_and_on_top_of_the_direction() -> None:
    surfaces = read(whole(Rotation.identity()), Facing("-x", 60.0))
    straight = ahead(read(whole(Rotation.identity())))
    np.testing.assert_allclose(ahead(surfaces), Rotation.from_euler("y", 150, degrees=True).apply(straight), atol=1e-9)
    assert not any("does not face" in note for note in surfaces.notes)


def test_a_turn_by_half_a_circle_makes_the_other_side_left() -> None:
    surfaces = read(whole(Rotation.identity()), Facing(turn=180.0))
    assert left(surfaces) > 0
    assert ahead(surfaces)[2] < -0.9


def test_a_mirrored_figure_is_said_and_has_its_left_on_the_left() -> None:
    mirror = np.diag([-1.0, 1, 1, 1])
    scene = whole(Rotation.identity())
    root = at(0, 0, 0) @ mirror
    rest = np.concatenate([root[None], mirror @ scene.rest])
    skins = (replace(scene.skins[0], joints=scene.skins[0].joints + 1),)
    names, parents = ("mirror", *scene.node_names), np.concatenate([[-1], np.maximum(scene.parents + 1, 0)])
    surfaces = read(replace(scene, node_names=names, parents=parents, rest=rest, skins=skins))
    assert any(note.startswith("A negative scale of mirror mirrors the figure") for note in surfaces.notes)
    assert ahead(surfaces)[2] > 0.9
    assert left(surfaces) > 0


def test_the_person_of_these_tests_has_its_left_on_the_left() -> None:
    skeleton = person()
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    assert places[skeleton.names.index("LeftUpLeg"), 0] > 0
