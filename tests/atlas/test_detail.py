"""Finer texels for parts of the body: what is asked for, where charts are cut, and what comes out."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from patches import grid_faces, grid_points
from people import upright

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.detail import BY_DEFAULT, LARGEST_SHARES, factors, read_detail
from mua.atlas.texel_density import describe_texels
from mua.atlas.uv import build_atlas
from mua.cli.bake import main
from mua.errors import InputError
from mua.rig.body_parts import BODY_PARTS, body_parts
from mua.rig.character import Character
from mua.rig.charts import areas
from mua.rig.texel_map import build_texel_map
from mua.scene import Material

pytestmark = pytest.mark.usefixtures("first_try")

JOINTS = ("Hips", "Head", "LeftEye", "LeftHand", "LeftHandIndex1")
PARENTS = (-1, 0, 1, 0, 3)
CELLS = 20
SNAPPED = 0.1  # charts are packed on a grid of whole texels


def strip(joint_of_column: list[int], *, joined: bool = True) -> Surfaces:
    """A strip of unit squares along x, one for each joint; one chart, or one for each square."""
    grid, square = grid_points(CELLS), grid_faces(CELLS, CELLS)
    count = len(joint_of_column)
    places = np.concatenate([grid + np.array([k if joined else 2 * k, 0]) for k in range(count)])
    faces = np.concatenate([square + k * len(grid) for k in range(count)])
    joints = np.repeat(joint_of_column, len(grid))
    rows, first, welded = np.unique(np.round(places, 9), axis=0, return_index=True, return_inverse=True)
    faces = welded.reshape(-1)[faces].astype(np.int32)
    indices = np.zeros((len(rows), 8), np.int32)
    indices[:, 0] = joints[first]
    weights = np.zeros((len(rows), 8), np.float32)
    weights[:, 0] = 1
    return Surfaces(
        name="strip",
        skeleton=upright(JOINTS, PARENTS),
        vertices=np.column_stack([rows, np.zeros(len(rows))]),
        faces=faces,
        uv=rows / (2 * count),
        uv_faces=faces,
        face_material=np.zeros(len(faces), np.int32),
        materials=(Material("skin", np.full((8, 8, 4), 255, np.uint8)),),
        skin_indices=indices,
        skin_weights=weights,
        clips=(),
        notes=(),
    )


def texels_by_square(character: Character, count: int, *, apart: int = 1) -> Array:
    """Texels that show each of the squares of a strip."""
    texels = build_texel_map(character.mesh, 256)
    middle = character.mesh.vertices[character.mesh.faces].mean(axis=1)[texels.triangles, 0]
    return np.bincount((middle // apart).astype(int), minlength=count)


def test_parts_follow_joints_and_their_descendants() -> None:
    surfaces = strip([0, 1, 2, 3, 4], joined=False)
    parts = body_parts(surfaces.skeleton, surfaces.faces, surfaces.skin_indices, surfaces.skin_weights)
    assert [BODY_PARTS[k] for k in parts[:: 2 * CELLS * CELLS]] == ["body", "head", "head", "hands", "hands"]


def test_what_the_file_says_of_a_joint_goes_before_its_name() -> None:
    surfaces = strip([0, 1, 3], joined=False)
    parts = body_parts(
        surfaces.skeleton, surfaces.faces, surfaces.skin_indices, surfaces.skin_weights, stated={"LeftHand": "head"}
    )
    assert BODY_PARTS[parts[-1]] == "head"


def test_detail_doubles_the_density_of_the_heads_chart() -> None:
    surfaces = strip([0, 0, 0, 1], joined=False)
    plain = texels_by_square(build_atlas(surfaces, uv="auto", size=64, detail={"head": 1}), 4, apart=2)
    finer = texels_by_square(build_atlas(surfaces, uv="auto", size=64, detail={"head": 2}), 4, apart=2)
    np.testing.assert_allclose(plain, plain.mean(), rtol=SNAPPED)
    np.testing.assert_allclose(finer[3] / finer[:3].mean(), 2**2, rtol=2 * SNAPPED)  # an area


def test_a_chart_across_parts_is_cut_along_their_border() -> None:
    surfaces = strip([0, 0, 0, 1])
    character = build_atlas(surfaces, uv="auto", size=64, detail={"head": 2})
    drawn = areas(character.mesh.uv[character.mesh.uv_faces])
    middle = character.mesh.vertices[character.mesh.faces].mean(axis=1)[:, 0]
    finer = drawn[middle > 3 + 1 / CELLS].mean() / drawn[middle < 3].mean()
    np.testing.assert_allclose(finer, 2**2, rtol=2 * SNAPPED)
    assert len(character.mesh.uv) - len(surfaces.uv) == 2 * CELLS  # a border that zigzags across the squares
    assert build_texel_map(character.mesh, 256).claimed_twice == 0


def test_a_piece_of_a_chart_too_small_for_its_own_border_stays_in_it() -> None:
    surfaces = strip([0, 0, 0, 0])
    indices = surfaces.skin_indices.copy()
    corner = (surfaces.vertices[:, :2] > [4 - 1.5 / CELLS, 1 - 1.5 / CELLS]).all(axis=1)
    indices[corner, 0] = 1
    character = build_atlas(replace(surfaces, skin_indices=indices), uv="auto", size=64, detail={"head": 2})
    assert len(character.mesh.uv) == len(surfaces.uv)


def test_by_default_the_head_is_finer_but_takes_no_more_than_its_share() -> None:
    small, large = (np.array([1 - share, share]) for share in (0.05, 0.5))
    parts = np.array([BODY_PARTS.index("body"), BODY_PARTS.index("head")])
    assert factors(parts, small, {})[0].tolist() == [1, BY_DEFAULT["head"]]
    assert factors(parts, large, {})[0].tolist() == [1, 1]
    between = np.array([0.8, 0.2])
    texels = between * factors(parts, between, {})[0] ** 2
    assert texels[1] / texels.sum() == pytest.approx(LARGEST_SHARES["head"])
    assert factors(parts, large, {"head": 3})[0].tolist() == [1, 3]


def test_a_part_that_is_not_there_is_said() -> None:
    character = build_atlas(strip([0, 1]), uv="auto", size=32, detail={"feet": 2})
    assert character.notes[-1] == "--detail feet=2 changes nothing: no joint of the feet was recognised."


def test_the_width_of_texels_is_described_by_part() -> None:
    character = build_atlas(strip([0, 1], joined=False), uv="auto", size=64, detail={"head": 2})
    body, head = texels_by_square(character, 2, apart=2)
    described = describe_texels(character, 256)
    assert described == (
        f"{(body + head) / 256**2:.0%} of 256 x 256 texels are in use; a texel is wide: "
        f"{1000 / np.sqrt(head):.1f} mm on the head, {1000 / np.sqrt(body):.1f} mm on the body."
    )


def test_reads_parts_and_factors() -> None:
    assert read_detail(["head=2", "feet=0.5"], uv="auto") == {"head": 2, "feet": 0.5}


@pytest.mark.parametrize(
    ("texts", "uv", "sentence"),
    [
        (["head"], "auto", "--detail head: expected a part and a factor such as head=2, parts: head, hands, "),
        (["nose=2"], "auto", "--detail nose=2: expected a part and a factor such as head=2, parts: head, hands, "),
        (["head=much"], "auto", "--detail head=much: the factor is 'much', expected 0.125 to 8"),
        (["head=nan"], "auto", "--detail head=nan: the factor is 'nan', expected 0.125 to 8"),
        (["head=9"], "auto", "--detail head=9: the factor is '9', expected 0.125 to 8"),
        (["head=0"], "auto", "--detail head=0: the factor is '0', expected 0.125 to 8"),
        (["head=2", "head=3"], "auto", "--detail head=3: head is named more than once"),
        (["head=2"], "keep", "--detail head=2: --uv keep leaves all texels as they are, expected auto or unwrap"),
    ],
)
def test_refuses_what_is_no_detail(texts: list[str], uv: str, sentence: str) -> None:
    with pytest.raises(InputError) as refused:
        read_detail(texts, uv=uv)
    assert str(refused.value).startswith(sentence)


def test_a_bad_detail_is_refused_before_anything_is_read() -> None:
    with pytest.raises(InputError, match="--detail nose=2"):
        main(character=Path("missing.glb"), detail=["nose=2"])
