"""Files that hold no single figure."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import BIND, HERE, NAMES, PARENTS, at, part, scene

from mua.characters.assemble import assemble
from mua.errors import InputError
from mua.scene import Scene, Skin


def two(aside: float, *, height: float = 1.0) -> Scene:
    """A figure and, so far to its side and so high, another on a skeleton of its own."""
    other = at(aside, 0, 0) @ np.diag([1, height, 1, 1])
    skins = (Skin(np.arange(5), np.linalg.inv(BIND)), Skin(np.arange(5, 10), np.linalg.inv(BIND)))
    return scene(
        node_names=(*NAMES, *(f"{name}.001" for name in NAMES)),
        parents=np.append(PARENTS, np.where(PARENTS < 0, -1, PARENTS + 5)),
        rest=np.concatenate([BIND, other @ BIND]),
        skins=skins,
        parts=(part(), part(group=1, skin=1, count=27)),
    )


def test_says_which_figure_stands_beside_the_largest() -> None:
    (note,) = (note for note in assemble(two(1.5), HERE).notes if "side by side" in note)
    assert "--leave-out" in note
    assert note.endswith(": part1.")


@pytest.mark.parametrize(("aside", "height"), [(0.1, 1.0), (1.5, 0.2)])
def test_clothes_and_low_things_on_joints_of_their_own_are_no_figures(aside: float, height: float) -> None:
    assert not any("side by side" in note for note in assemble(two(aside, height=height), HERE).notes)


def test_says_which_mesh_has_a_vertex_far_away() -> None:
    body = part(count=600)
    body.positions[7] = 300, 0, 0
    notes = assemble(scene(parts=(body, part(group=1))), HERE).notes
    assert any(note.startswith("Vertices lie so far away") and note.endswith(": 1 of part0.") for note in notes)


def test_rejects_joints_that_are_bound_in_one_point() -> None:
    skin = Skin(np.arange(5), np.tile(np.eye(4), (5, 1, 1)))
    with pytest.raises(InputError, match=r"body\.glb: all 5 joints with weights stand in one point in the bind pose"):
        assemble(scene(skins=(skin,)), HERE)


def test_joints_in_one_point_at_rest_too_are_kept() -> None:
    rest = np.tile(at(0, 1, 0), (5, 1, 1))
    assemble(scene(rest=rest, skins=(replace(scene().skins[0], inverse_binds=np.linalg.inv(rest)),)), HERE)
