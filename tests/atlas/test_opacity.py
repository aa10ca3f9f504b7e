"""Materials that are clear in places: what is left out, where edges lie, and that no colour of what is clear shows."""

from dataclasses import replace

import numpy as np
import pytest
from patches import patch, plain, points, ramp, surfaces_of, texels_and_colours, uv_map

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.opacity import without_unseen
from mua.atlas.uv import build_atlas
from mua.errors import InputError
from mua.kernels.splat_project import LEAST_OPACITY
from mua.scene import AlphaMode, Wrap, wrapped
from mua.teachers.simulated.texels import MOST_CLEAR
from mua.texture.albedo import sample_albedo

pytestmark = pytest.mark.usefixtures("first_try")

WHOLE = uv_map(1, 1, at=(0, 0))
RED, GREEN = (200, 30, 20), (0, 255, 0)
ROUNDED = 1  # in 255ths
RADIUS = 0.3  # radius of a red disc in a clear green image; the image's side is 1
BY_PIXELS = 0.03  # relative: the area of a disc counted in texels whose edges are smooth


def disc(size: int, *, soft: float = 0.0) -> Array:
    """A red disc on clear green; `soft` texels from solid to clear."""
    middle = (np.arange(size) + 0.5) / size - 0.5
    inside = RADIUS * size - np.hypot(middle[:, None], middle) * size  # texels
    picture = np.empty((size, size, 4), np.uint8)
    alpha = np.clip(inside / max(soft, 1e-9) + 0.5, 0, 1)
    picture[..., :3] = np.where(alpha[..., None] > 0, RED, GREEN)
    picture[..., 3] = np.rint(255 * alpha)
    return picture


def card(
    picture: Array, mode: AlphaMode, *, cutoff: float | None = None, cells: int = 1, behind: bool = True
) -> Surfaces:
    """A square sheet that shows the image, and a solid one behind it."""
    sheets = [patch(cells, at=0, uv=WHOLE)] + [patch(2, at=2, uv=WHOLE)] * behind
    surfaces = surfaces_of(*sheets, images=(picture, plain(9, 9, 9, 255))[: 1 + behind])
    first = replace(surfaces.materials[0], alpha_mode=mode)
    first = first if cutoff is None else replace(first, alpha_cutoff=cutoff)
    return replace(surfaces, materials=(first, *surfaces.materials[1:]))


def test_a_material_that_shows_nothing_is_left_out_and_named() -> None:
    picture = ramp(8)
    picture[..., 3] = 0
    surfaces = card(picture, "blend")
    left = without_unseen(surfaces)
    assert left.notes[-1] == (
        "Material material 0 is fully transparent (its alpha is 0) and is left out; --alpha material 0=opaque shows it."
    )
    assert [material.name for material in left.materials] == ["material 1"]
    assert (left.face_material == 0).all()
    assert left.vertices[:, 0].min() == 2
    assert len(left.skin_weights) == len(left.skin_indices) == len(left.vertices)


def test_a_mask_below_its_cutoff_shows_nothing() -> None:
    assert len(without_unseen(card(plain(9, 9, 9, 127), "mask")).materials) == 1
    assert len(without_unseen(card(plain(9, 9, 9, 128), "mask")).materials) == 2
    assert len(without_unseen(card(plain(9, 9, 9, 127), "mask", cutoff=0.4)).materials) == 2


def test_a_character_that_shows_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="patches: the alpha of every material is 0"):
        without_unseen(card(plain(9, 9, 9, 0), "blend", behind=False))


def test_a_character_without_texture_coordinates_is_kept_whole() -> None:
    surfaces = surfaces_of(patch(2, at=0, uv=WHOLE), images=(plain(9, 9, 9, 255),))
    bare = replace(surfaces, uv=np.zeros((0, 2)), uv_faces=np.full_like(surfaces.uv_faces, -1))
    assert without_unseen(bare) is bare


def test_what_is_solid_is_left_as_it_is() -> None:
    surfaces = surfaces_of(patch(2, at=0, uv=WHOLE), images=(ramp(8),))
    assert without_unseen(surfaces) is surfaces


@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
@pytest.mark.parametrize(
    ("size", "scale", "at"), [(64, 1.0, (0.0, 0.0)), (33, 2.5, (-0.75, -0.9)), (300, 0.4, (0.6, 0.1))]
)
def test_triangles_clear_all_over_are_left_out_and_no_others(
    wrap: Wrap, size: int, scale: float, at: tuple[float, float]
) -> None:
    cells = 24
    sheet = patch(cells, at=0, uv=uv_map(scale, scale, at=at))
    surfaces = surfaces_of(sheet, images=(disc(size),), wrap=wrap)
    left = without_unseen(surfaces)
    kept = {tuple(row) for row in np.round(left.vertices[left.faces].mean(axis=1), 6)}
    middle = np.round(surfaces.vertices[surfaces.faces].mean(axis=1), 6)
    is_kept = np.array([tuple(row) in kept for row in middle])
    steps = np.arange(20)
    grid = np.array([(a, b, 19 - a - b) for a in steps for b in steps[: 20 - a]]) / 19
    place = np.einsum("gk,nkd->ngd", grid, surfaces.uv[surfaces.uv_faces]) * size
    column, row = np.floor(place).astype(int).transpose(2, 0, 1)
    alpha = surfaces.materials[0].image[wrapped(row, size, wrap), wrapped(column, size, wrap), 3]
    assert is_kept[(alpha > 0).any(axis=1)].all()
    beside = place[..., None, :] + 4 * np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)])
    column, row = np.floor(beside).astype(int).transpose(3, 0, 1, 2)
    far = ~(surfaces.materials[0].image[wrapped(row, size, wrap), wrapped(column, size, wrap), 3] > 0).any(axis=(1, 2))
    if scale * size / cells < 4:  # else a step of the map of what shows is larger than these
        assert far.any()
        assert not is_kept[far].any()


@pytest.mark.parametrize("texel", [(0, 0), (63, 63), (20, 41)])
def test_triangles_stay_that_interpolation_gives_a_share_of_a_solid_texel(texel: tuple[int, int]) -> None:
    size = 64
    picture = np.zeros((size, size, 4), np.uint8)
    picture[texel] = 255
    left = without_unseen(surfaces_of(patch(size, at=0, uv=WHOLE), images=(picture,)))
    places = np.floor(left.vertices[left.faces].mean(axis=1)[:, 1::-1] * size).astype(int)  # row, column
    away = {(int(row), int(column)) for row, column in (places - texel + size // 2) % size - size // 2}
    assert away >= {(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)}
    assert np.abs(list(away)).max() <= 2  # those that touch a neighbour


@pytest.mark.parametrize("size", [16, 64, 512])
@pytest.mark.parametrize("mode", ["mask", "blend"])
def test_a_cut_out_keeps_its_outline_and_takes_no_colour_from_what_is_clear(size: int, mode: AlphaMode) -> None:
    surfaces = card(disc(size, soft=4 if mode == "mask" else 1), mode, cells=1)
    character = build_atlas(surfaces, uv="auto", size=160)
    texels, colours = texels_and_colours(character)
    on_card = points(character, texels)[:, 0] < 1.5
    alpha = colours[on_card, 3] / 255
    assert alpha.mean() == pytest.approx(np.pi * RADIUS**2, rel=BY_PIXELS if size > 16 else 3 * BY_PIXELS)
    np.testing.assert_allclose(colours[on_card, :3], [RED] * on_card.sum(), atol=ROUNDED)
    between = (alpha > 0.1) & (alpha < 0.9)
    assert between.any()  # the edge is smooth,
    if mode == "mask":
        assert between.sum() < 0.12 * on_card.sum()  # but no wider than about a texel


def test_a_mask_is_solid_from_its_cutoff_on() -> None:
    picture = np.full((32, 32, 4), 255, np.uint8)
    picture[..., 3] = np.linspace(0, 255, 32)
    surfaces = card(picture, "mask", cutoff=0.25)
    texels, colours = texels_and_colours(build_atlas(surfaces, uv="keep", size=64))
    place = points(build_atlas(surfaces, uv="keep", size=64), texels)
    u = place[:, 0]
    assert (colours[(u < 0.22), 3] == 0).all()
    assert (colours[(u > 0.30) & (u < 1.5), 3] == 255).all()


def by_width(surfaces: Surfaces) -> Surfaces:
    """The same, its vertices as opaque as they are far to the right on their sheet."""
    colors = np.ones((len(surfaces.faces), 3, 4))
    colors[..., 3] = np.clip(surfaces.vertices[surfaces.faces][..., 0], 0, 1)
    return replace(surfaces, corner_colors=colors)


def test_a_mask_is_cut_where_picture_times_vertices_is_below_the_cutoff() -> None:
    surfaces = by_width(card(plain(9, 9, 9, 204), "mask"))  # 0.8, and so 0.5 where the vertices have 0.625
    character = build_atlas(surfaces, uv="keep", size=64)
    texels, colours = texels_and_colours(character)
    across = points(character, texels)[:, 0]
    assert (colours[across < 0.6, 3] == 0).all()
    assert (colours[(across > 0.65) & (across < 1.5), 3] == 255).all()


def test_triangles_whose_vertices_are_clear_are_left_out() -> None:
    surfaces = by_width(card(plain(9, 9, 9, 255), "mask", cells=10))  # solid from the middle on
    left = without_unseen(surfaces)
    on_card = left.vertices[left.vertices[:, 0] < 1.5]
    assert on_card[:, 0].min() == pytest.approx(0.4)  # of the triangles that reach into the solid half
    assert left.corner_colors is not None
    assert len(left.corner_colors) == len(left.faces)


def test_no_colour_of_what_is_clear_reaches_the_texels() -> None:
    atlas = disc(64)
    colors = sample_albedo(atlas, np.random.default_rng(0).random((500, 2)), 24)
    np.testing.assert_allclose(colors[:, :3] * 255, [RED] * 500, atol=ROUNDED)
    assert (colors[:, 3] == 0).any()


def test_a_clear_texel_is_not_drawn() -> None:
    assert 1 / (1 + np.exp(MOST_CLEAR)) < LEAST_OPACITY
