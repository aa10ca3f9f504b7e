"""AvatarRenderer in a player loop of stand-ins: what it shows beside others, and what that costs."""

import json
from pathlib import Path

import numpy as np
import pytest
from component import Story, counts
from frame_bounds import FRAME_ORDER, PARTS_ORDER
from synthetic_avatar import synthetic_avatar, with_surface, with_texels

from mua.asset import write


def test_a_component_without_an_avatar_has_nothing_and_takes_nothing(story: Story) -> None:
    reported = story("IsPlain")
    assert reported["plain"] == ["Empty '' 0 '' 0"]
    assert reported["clip"] == ["0 of 0, 0 of 0, 0"]
    assert reported["outside"] == ["0"]
    assert reported["plays"] == ["True 1, Splats, Shadow, Automatic, True"]
    assert reported["bounds"] == ["1 2 3 0"]
    assert reported["log"] == []


def test_a_frame_allocates_nothing_and_looks_up_no_name(story: Story) -> None:
    reported = story("Plays", "first")
    assert (reported["allocated"], reported["lookups"]) == (["0"], ["0"])
    assert story("FollowsRig", "first")["allocated"] == ["0"]


def test_a_still_avatar_is_only_sorted(story: Story) -> None:
    reported = story("Plays", "first")
    sorting = FRAME_ORDER[FRAME_ORDER.index("SplatProject") :]
    assert reported["frame"] == ["3"]
    assert reported["idle"] == [str(10 * len(sorting))]


def test_an_avatar_stands_where_its_object_stands(story: Story) -> None:
    assert float(story("Plays", "first")["moved"][0]) == pytest.approx(5, abs=1e-4)


def test_views_are_drawn_in_their_order(story: Story) -> None:
    reported = story("ShowsViews", "first")
    assert reported["order"] == [
        "Hidden/MUA/Surface 0",
        "Hidden/MUA/Surface 1",
        "Hidden/MUA/Splat 0",
        "Hidden/MUA/Surface 2",
    ]
    assert reported["together"] == ["4 1"]  # draws of the camera, draws that wait for lights
    assert reported["shadow"] == ["0 1"]
    assert reported["nothing"] == ["0 0"]
    assert reported["log"] == []


def test_an_avatar_of_two_texels_has_no_geometry_and_shows_the_rest(story: Story, folder: Path) -> None:
    few = with_texels(synthetic_avatar(1), slice(2))
    write(folder / "sparse.muaavatar", with_surface(few), storage="f16")
    reported = story("ShowsSparse", "sparse")
    assert reported["order"] == ["Hidden/MUA/Surface 1", "Hidden/MUA/Splat 0", "Hidden/MUA/Surface 2"]
    assert reported["log"] == []


def test_a_file_without_a_surface_is_told_once_and_shows_the_rest(story: Story, folder: Path) -> None:
    write(folder / "bare.muaavatar", synthetic_avatar(1), storage="f16")
    reported = story("ShowsSparse", "bare")
    assert reported["order"] == ["Hidden/MUA/Surface 1", "Hidden/MUA/Splat 0", "Hidden/MUA/Surface 2"]
    sentence = "synthetic cannot show its Geometry: the file holds no surface to show; bake it again."
    assert [line.rpartition("MUA: ")[2] for line in reported["log"]] == [sentence]


def test_splats_are_drawn_where_surfaces_cannot_be(story: Story) -> None:
    reported = story("LacksSurface", "first")
    assert reported["together"] == ["1 0"]
    assert len(reported["log"]) == 1
    assert "cannot show its Shadow: the surface shader is missing" in reported["log"][0]


def test_avatars_come_and_go(story: Story) -> None:
    reported = story("Crowd", "first", "second")
    first, second = (counts(seed)[0] for seed in (1, 2))
    assert reported["both"] == [str(first + second)]
    assert reported["one"] == [str(first)]
    assert (reported["fewer"], reported["again"]) == (["1"], ["1"])
    assert reported["state"] == ["Ready Ready"]
    assert reported["log"] == []


def test_an_avatar_that_rests_is_posed_again_into_the_buffer_that_is_left(story: Story) -> None:
    """Splats of all avatars lie in one, which is another when one of them has gone."""
    reported = story("StaysBehind", "first", "second")
    posed = FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :]
    assert reported["left"] == [str(len(posed))]
    assert reported["idle"] == [str(len(posed) - posed.index("SplatProject"))]


def test_an_avatar_out_of_view_rests_unless_its_shadow_may_be_seen(story: Story) -> None:
    reported = story("StandsOutOfView", "first", "second")
    at_rest = len(FRAME_ORDER) - FRAME_ORDER.index("SplatProject")
    assert reported["both"] == reported["back"] == [str(at_rest + 1)]  # each is projected
    part = len(PARTS_ORDER[0])  # of two avatars, one has its turn
    assert int(reported["shadow"][0]) == at_rest + 1 + part  # posed, not projected
    assert reported["one"] == reported["far"] == reported["without"] == [str(at_rest)]
    assert reported["stands"] == ["1"]  # where it would be seen
    assert (reported["none"], reported["drawn"]) == (["0"], ["0"])
    assert int(reported["again"][0]) == at_rest + 1 + 2 + part  # both are posed, and one decodes what it missed


def test_a_game_that_starts_without_a_reload_keeps_its_avatars_and_says_anew_what_is_wrong(story: Story) -> None:
    reported = story("StartsWithoutReload", "first")
    assert reported["draws"] == ["10"]
    assert len(reported["log"]) == 2  # once in each game
    assert all("nowhere.muaavatar" in line for line in reported["log"])


def test_an_avatar_that_one_eye_sees_is_drawn_for_both(story: Story) -> None:
    reported, sorting = story("IsSeenByOneEye", "first"), len(FRAME_ORDER) - FRAME_ORDER.index("SplatProject")
    assert reported["seen"] == [f"True {sorting} True", f"True {sorting} True", "False 0 False"]


def test_an_avatar_stands_where_its_parents_carry_it(story: Story) -> None:
    reported = story("HasParent", "first")
    before, moved, turned = (np.array(line.split(), float) for line in reported["box"])
    np.testing.assert_allclose(moved, np.add(before, [5, 1, 0, 0, 0, 0]), atol=1e-5)
    x, y, z, *_ = before
    np.testing.assert_allclose(turned[:3], [5 + z, 1 + y, -x], atol=1e-5)
    np.testing.assert_allclose(turned[3:], before[[5, 4, 3]], atol=1e-5)
    assert int(reported["turned"][0]) == len(FRAME_ORDER) - FRAME_ORDER.index("BlendVertices")
    assert "only one scale for all axes" in reported["message"][0]


def test_an_avatar_casts_no_shadow_before_it_has_a_shape(story: Story) -> None:
    assert story("IsNotDrawnYet", "first")["shadows"] == ["Ready 0", "Ready 2"]  # after two and after three frames


def test_a_camera_draws_the_avatars_of_its_layers_alone(story: Story) -> None:
    reported = story("LiesOnLayers", "first", "second")
    assert reported["drawn"] == ["1", "1", "0"]
    whole = [counts(seed)[0] for seed in (1, 2)]
    assert reported["splats"] == [*(str(count + count % 2) for count in whole), "0"]
    layer, away = reported["shadow"][0].split()
    assert (layer, float(away)) == ("7", pytest.approx(0, abs=1e-5))
    assert float(reported["shadow size"][0]) == pytest.approx(1, abs=1e-5)


def test_an_avatar_is_as_large_as_its_parents_make_it(story: Story) -> None:
    reported = story("IsScaled", "first")
    plain, double, none, stretched, mirrored = (np.array(line.split(), float) for line in reported["box"])
    np.testing.assert_allclose(double, 2 * plain, atol=1e-5)
    assert np.abs(none).max() < 1e-3
    np.testing.assert_allclose(stretched, plain, atol=1e-5)  # at its own size
    np.testing.assert_allclose(mirrored[3:], plain[3:], atol=1e-5)
    posed = len(FRAME_ORDER) - FRAME_ORDER.index("BlendVertices")
    assert reported["posed"][1] == str(posed)
    assert reported["said"][:3] == [""] * 3
    assert reported["state"] == ["Ready"]
    assert len(reported["log"]) == 1
    assert "only one scale for all axes" in reported["log"][0]


def test_views_of_each_avatar_are_drawn_from_its_own_buffers(story: Story, folder: Path) -> None:
    """Also those of two that show the same file."""
    story("ShowsViewsOfTwo", "first")
    events = [json.loads(line) for line in (folder / "first of two.json").read_text().splitlines()]
    draws = [event for event in events if event["event"] == "draw"]
    for index in range(3):
        first, second = (draw["block_buffers"] for draw in draws if draw["pass"] == index)
        assert first.keys() == second.keys()
        own = {"ring", "vertex_dq", "joints"} & first.keys()
        assert len(own) == 1
        assert all(first[name] != second[name] for name in own)
