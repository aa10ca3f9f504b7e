"""Levels of detail are chosen by the size of texels and within a budget, without flicker."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mua.avatar.camera import EYE_DISTANCE, Camera, perspective, stereo
from mua.avatar.level_choice import (
    HYSTERESIS,
    LARGEST_TEXEL,
    Seen,
    choose_level,
    choose_levels,
    splat_corners,
    texel_pixels,
)

CASES = json.loads((Path(__file__).parents[1] / "golden" / "level_choice.json").read_text())
COUNTS = (300_000, 76_000, 20_000)
BOX = np.array([[-0.5, 0, -0.25], [0.5, 2, 0.25]])


def camera(z: float) -> Camera:
    """A camera level with the middle of the box, in front of it at this distance from the origin."""
    view = np.eye(4)
    view[:3, 3] = 0, -1, -z
    return Camera(view, perspective(1.0, aspect=800 / 600), (800, 600))


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_the_table_that_both_players_choose_by(case: dict) -> None:
    avatars = [Seen(a["distance"], a["texel"], tuple(a["counts"]), a["shown"]) for a in case["avatars"]]
    assert choose_levels(avatars, case["budget"]) == case["levels"]


@pytest.mark.parametrize("budget", [0, 60_000, 150_000, 400_000, 10**7])
def test_a_budget_is_kept_wherever_the_coarsest_levels_fit(budget: int) -> None:
    rng = np.random.default_rng(budget)
    for _ in range(100):
        avatars = [Seen(float(d), 2 / float(d), COUNTS, int(rng.integers(3))) for d in rng.uniform(0.5, 9, 3)]
        levels = choose_levels(avatars, budget)
        splats = sum(COUNTS[level] for level in levels)
        assert splats <= max(budget, 3 * COUNTS[-1])
        assert all(level >= choose_level(seen) for level, seen in zip(levels, avatars, strict=True))


def test_a_texel_looks_as_large_as_the_camera_shows_it() -> None:
    """On the nearest side of the box, whose middle the camera sees straight ahead."""
    seen = camera(4.25)
    distance, pixels = texel_pixels(0.01, BOX, [seen])
    ends = np.array([[0, 1, 0.25, 1], [0.01, 1, 0.25, 1]]) @ (seen.projection @ seen.view).T
    columns = ends[:, 0] / ends[:, 3] * seen.screen[0] / 2
    assert distance == pytest.approx(4)
    assert pixels == pytest.approx(np.ptp(columns))


@pytest.mark.parametrize("apart", [EYE_DISTANCE, 3.0])
def test_two_eyes_see_from_their_middle(apart: float) -> None:
    """Also a giant's, each of which lies beside the box."""
    assert texel_pixels(0.01, BOX, stereo(camera(3), apart)) == pytest.approx(texel_pixels(0.01, BOX, [camera(3)]))


def test_a_crowd_far_away_is_drawn_by_triangles_and_from_near_by_quads() -> None:
    """As many pixels for each splat in twice the avatars, in twice the pixels from half as far."""
    found = [splat_corners([BOX], 10_000, [camera(z)]) for z in (1.0, 2.0, 4.0, 8.0)]
    assert found == sorted(found, reverse=True)
    assert (found[0], found[-1]) == (6, 3)
    for z in np.linspace(1, 8, 15):
        one, eyes = splat_corners([BOX], 10_000, [camera(z)]), stereo(camera(z), EYE_DISTANCE)
        assert splat_corners([BOX, BOX], 20_000, [camera(z)]) == one
        assert splat_corners([BOX], 40_000, [camera(z / 2)]) == one
        assert splat_corners([BOX], 10_000, eyes) == one


def test_inside_the_box_a_texel_is_as_large_as_at_the_near_plane() -> None:
    seen = camera(0.1)
    focal = seen.projection[1, 1] * seen.screen[1] / 2
    assert texel_pixels(0.01, BOX, [seen]) == (0, pytest.approx(0.01 * focal / seen.near))


def test_walking_to_and_fro_about_a_switch_changes_the_level_once() -> None:
    level, switches = 0, 0
    for step in np.sin(np.linspace(0, 20 * np.pi, 400)):
        seen = Seen(3.0, LARGEST_TEXEL / 2 * (1 + 0.4 * (HYSTERESIS - 1) * step), COUNTS, level)
        switches += choose_level(seen) != level
        level = choose_level(seen)
    assert (level, switches) == (1, 1)


def test_two_avatars_about_as_near_do_not_swap_their_levels() -> None:
    avatars, changes = [Seen(2.0, 1.0, COUNTS), Seen(2.0, 1.0, COUNTS)], 0
    for step in np.sin(np.linspace(0, 20 * np.pi, 200)):
        avatars = [replace(avatars[0], distance=2 + 0.1 * step), replace(avatars[1], distance=2 - 0.1 * step)]
        levels = choose_levels(avatars, COUNTS[0] + COUNTS[1])
        changes += levels != [seen.shown for seen in avatars]
        avatars = [replace(seen, shown=level) for seen, level in zip(avatars, levels, strict=True)]
    assert changes == 1
