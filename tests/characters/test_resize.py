"""How high a character is: what the file says, what is plausible, what is asked for."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scenes import HERE, in_units, part, scene

from mua.atlas.character_surfaces import Surfaces
from mua.characters.assemble import assemble
from mua.characters.correction import ADULT, plausible_unit
from mua.characters.figure_size import FigureSize
from mua.characters.resize import resized
from mua.errors import InputError


@pytest.mark.parametrize(("unit", "metres"), [(100.0, 0.01), (1000.0, 0.001), (0.01, 100.0)])
def test_implausible_height_is_brought_to_metres_with_a_note(unit: float, metres: float) -> None:
    surfaces = assemble(in_units(unit), HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=1e-12)
    assert f"one unit is taken as {metres:g} m" in surfaces.notes[0]
    assert "--scale" in surfaces.notes[0]
    assert "--height" in surfaces.notes[0]
    np.testing.assert_allclose(surfaces.clips[0].translations[-1, surfaces.skeleton.root], [0.8, 0.9, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("height", "unit"),
    [
        (0.01, 100.0),
        (0.03, 100.0),
        (0.099, 1.0),
        (0.1, 1.0),
        (8.0, 1.0),
        (20.1, 0.01),
        (300, 0.01),
        (401, 0.001),
        (15, 1.0),
    ],
)
def test_a_unit_is_the_likeliest_that_makes_a_figure_of_usual_height(height: float, unit: float) -> None:
    assert plausible_unit(height)[0] == unit


def high(surfaces: Surfaces) -> float:
    return float(np.ptp(surfaces.vertices[:, 1]))


@pytest.mark.parametrize("unit", [1e-6, 1e5])
def test_a_height_that_no_unit_explains_is_made_that_of_an_adult_with_a_note(unit: float) -> None:
    surfaces = assemble(in_units(unit), HERE)
    assert high(surfaces) == pytest.approx(ADULT)
    assert f"it is scaled to {ADULT} m. --height METRES" in surfaces.notes[0]


def test_a_figure_that_creeps_is_not_taken_for_a_small_one() -> None:
    flat = part().positions * [1, 0.03, 1]
    surfaces = assemble(scene(parts=(replace(part(), positions=flat),)), HERE)
    assert surfaces.unit == 1
    assert surfaces.size_notes == ()


def test_a_giant_keeps_its_size_with_a_note() -> None:
    surfaces = assemble(in_units(15 / high(assemble(scene(), HERE))), HERE)
    assert high(surfaces) == pytest.approx(15)
    assert "is 15 m high, which is unusual; its size is kept. --height METRES" in surfaces.notes[0]


@pytest.mark.parametrize("height", [0.02, 2.0, 40.0])
def test_an_asked_height_scales_skeleton_surface_and_clips_alike(height: float) -> None:
    found = assemble(in_units(100.0), HERE)
    made = resized(found, FigureSize(height=height), HERE)
    factor = height / high(found)
    assert high(made) == pytest.approx(height)
    np.testing.assert_allclose(made.skeleton.bind_translations, factor * found.skeleton.bind_translations)
    np.testing.assert_allclose(made.clips[0].translations, factor * found.clips[0].translations)
    assert not any("unit" in note for note in made.notes)


def test_an_asked_scale_multiplies_the_units_of_the_file_not_those_guessed() -> None:
    found = assemble(in_units(100.0), HERE)  # taken as centimetres
    made = resized(found, FigureSize(scale=0.02), HERE)
    assert high(made) == pytest.approx(2 * high(found))
    again = resized(resized(found, FigureSize(height=3.0), HERE), FigureSize(scale=0.02), HERE)
    assert high(again) == pytest.approx(high(made))


def test_a_scale_that_leaves_no_possible_size_is_refused() -> None:
    with pytest.raises(InputError, match=r"--scale 1e-05: makes the character of .* measure .* expected 0.01 to 100"):
        resized(assemble(scene(), HERE), FigureSize(scale=1e-5), HERE)


@pytest.mark.parametrize(
    ("asked", "error"),
    [
        ({"scale": 2.0, "height": 1.0}, "--scale 2 and --height 1: expected one of them"),
        ({"scale": 0.0}, "--scale 0: expected a number above 0"),
        ({"scale": -1.0}, "--scale -1: expected a number above 0"),
        ({"scale": float("nan")}, "--scale nan: expected a number above 0"),
        ({"scale": float("inf")}, "--scale inf: expected a number above 0"),
        ({"height": 0.0}, "--height 0: expected 0.01 to 100 metres"),
        ({"height": 101.0}, "--height 101: expected 0.01 to 100 metres"),
        ({"height": float("nan")}, "--height nan: expected 0.01 to 100 metres"),
    ],
)
def test_impossible_sizes_are_refused(asked: dict[str, float], error: str) -> None:
    with pytest.raises(InputError, match=re.escape(error)):
        FigureSize(**asked)
