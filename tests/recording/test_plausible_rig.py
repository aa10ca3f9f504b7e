"""Mistakes in a rig: each is refused or warned of with its cause before anything is written."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from people import person
from synthetic_avatar import texels_at

from mua.arrays import Array
from mua.errors import InputError
from mua.recording import LikelyMistake, TeacherWriter
from mua.recording.plausible import rig_findings
from mua.rig.build import build_rig
from mua.rig.rig import Rig
from mua.teachers.procedural import procedural_character


@pytest.fixture(scope="module")
def rig() -> Rig:
    return build_rig(procedural_character(), texels=96)[0]


RIG_MISTAKES: dict[str, tuple[Callable[[Rig], Rig], str]] = {
    "millimetres": (lambda r: with_mesh(r, 1000 * r.mesh.vertices), ".* longest side .* is it in millimetres?"),
    "centimetres": (lambda r: with_mesh(r, 100 * r.mesh.vertices), ".* longest side .* is it in centimetres?"),
    "joints in millimetres": (
        lambda r: with_joints(r, bind_translations=1000 * r.skeleton.bind_translations),
        "joints are .* are these millimetres?",
    ),
    "template with Z up": (
        lambda r: with_mesh(r, r.mesh.vertices[:, [0, 2, 1]] * [1, -1, 1]),
        "joints are .* are the axes others?",
    ),
    "weights in per cent": (lambda r: replace(r, skin_weights=100 * r.skin_weights), "skin_weights .* sum to 100"),
    "children first": (
        lambda r: with_joints(r, parents=r.skeleton.parents[::-1]),
        "skeleton.parents: a parent comes after its child",
    ),
    "joints below themselves": (
        lambda r: with_joints(r, parents=np.append(r.skeleton.parents[:-1], len(r.skeleton.parents) - 1)),
        "skeleton.parents: a parent comes after its child",
    ),
    "joints in the world": (
        lambda r: with_joints(r, bind_translations=r.skeleton.world(*bind_of(r))[1]),
        "joints are .* bind_translations are places in the world: are they?",
    ),
    "four weights": (
        lambda r: replace(r, skin_weights=r.skin_weights[:, :4]),
        r"skin_weights has shape \[\d+, 4\], expected \[\d+, 8\]",
    ),
    "faces from 1": (
        lambda r: replace(r, mesh=replace(r.mesh, faces=r.mesh.faces + 1)),
        r"mesh.faces holds 1 to \d+, expected 0 to",
    ),
    "a name too few": (
        lambda r: replace(r, skeleton=replace(r.skeleton, names=r.skeleton.names[:-1])),
        r"skeleton.names has \d+ names, expected \d+, as skeleton.parents has",
    ),
    "a name twice": (
        lambda r: replace(r, skeleton=replace(r.skeleton, names=("Hand", *r.skeleton.names[1:-1], "Hand"))),
        r"skeleton.names: 'Hand' is the name of joints 0 and \d+, expected names that differ",
    ),
    "an empty name": (
        lambda r: replace(r, skeleton=replace(r.skeleton, names=(*r.skeleton.names[:-1], " "))),
        r"skeleton.names: joint \d+ is named ' ', expected a text",
    ),
    "a rotation too many": (
        lambda r: with_joints(r, bind_rotations=r.skeleton.bind_rotations[[0, *range(len(r.skeleton.names))]]),
        r"skeleton.bind_rotations has shape \[\d+, 4\], expected \[\d+, 4\]",
    ),
    "no texel": (
        lambda r: replace(r, texels=texels_at(r.texels, slice(0))),
        "texels: no texel is valid",
    ),
}


def with_mesh(rig: Rig, vertices: Array) -> Rig:
    return replace(rig, mesh=replace(rig.mesh, vertices=vertices))


def bind_of(rig: Rig) -> tuple[Array, Array]:
    return rig.skeleton.bind_rotations, rig.skeleton.bind_translations


def with_joints(rig: Rig, **change: Any) -> Rig:
    return replace(rig, skeleton=replace(rig.skeleton, **change))


@pytest.mark.parametrize("name", RIG_MISTAKES)
def test_a_rig_that_cannot_be_meant_is_refused_before_anything_is_written(rig: Rig, tmp_path: Path, name: str) -> None:
    change, expected = RIG_MISTAKES[name]
    with pytest.raises(InputError, match="recording .*: rig: " + expected.replace("?", r"\?")):
        TeacherWriter(tmp_path / "r", change(rig), rate=30)
    assert not (tmp_path / "r").exists()


def test_triangles_that_face_inward_are_warned_of(rig: Rig, tmp_path: Path) -> None:
    inward = replace(rig, mesh=replace(rig.mesh, faces=rig.mesh.faces[:, ::-1]))
    with pytest.warns(LikelyMistake, match=r"rig: triangles of the template face inward: are they clockwise"):
        TeacherWriter(tmp_path, inward, rate=30)


def test_bind_rotations_in_another_order_are_found_by_where_the_joints_lie(rig: Rig) -> None:
    skeleton = person(axes=3)
    places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)[1]
    count = len(rig.mesh.vertices)
    main = np.arange(count) % len(places)
    indices = np.tile(main[:, None], (1, 8)).astype(np.int32)
    weights = np.zeros((count, 8), np.float32)
    weights[:, 0] = 1
    of_person = replace(with_mesh(rig, places[main]), skeleton=skeleton, skin_indices=indices, skin_weights=weights)
    assert list(rig_findings(of_person)) == []
    (found,) = rig_findings(with_joints(of_person, bind_rotations=np.roll(skeleton.bind_rotations, -1, axis=1)))
    assert "bind_rotations are xyzw: are they?" in found.sentence
