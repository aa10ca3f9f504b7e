"""The engine in a browser: images beside the desktop player's, levels, time and place."""

import json
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar, with_random_poses
from web.engine import (
    LEAST_PSNR,
    SCREEN,
    SHOWN,
    SPLATS,
    Open,
    desktop,
    load,
    opened,
    psnr,
    screenshot,
    show,
    small,
    transparent,
)

from mua.asset.read import read
from mua.asset.write import encode
from mua.gpu import Device
from mua.player.toggles import Toggles
from mua.pose.resample import resample

__all__ = ["opened", "small"]  # fixtures

DEMO = Path(__file__).parents[2] / "build" / "demo" / "avatar.muaavatar"
SHARE = 1e-6  # rounding of a clip's quaternions as a file stores them
FAR = 0.9  # outside of training


def test_pictures_are_those_of_the_desktop(opened: Open, device: Device, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("Object.assign(player.camera, { azimuth: 0.7, elevation: 0.3 })")
    found = {}
    for name, toggles in SHOWN.items():
        show(page, toggles, 3, read(small).encoding.rate)
        found[name] = psnr(screenshot(page), desktop(device, small, page, 3, toggles))
    assert min(found.values()) > LEAST_PSNR, found


def test_a_shadow_that_is_shown_while_nothing_moves_falls_where_the_figure_stands(
    opened: Open, device: Device, small: Path
) -> None:
    page, rate = opened(a=small.read_bytes()), read(small).encoding.rate
    assert load(page) == ""
    page.evaluate("player.camera.elevation = 0.4")
    for toggles in (Toggles(), Toggles(shadow=True)):
        show(page, toggles, 3, rate)
        found = screenshot(page)
    assert psnr(found, desktop(device, small, page, 3, Toggles(shadow=True))) > LEAST_PSNR


def test_two_eyes_side_by_side_are_those_of_the_desktop(opened: Open, device: Device, small: Path) -> None:
    page, half = opened(a=small.read_bytes()), SCREEN[0] // 2
    assert load(page) == ""
    page.evaluate("Object.assign(player.camera, { azimuth: 0.7, elevation: 0.3 })")
    page.evaluate("(player.stereo = true, player.frameAll())")
    found = {}
    for name, toggles in SHOWN.items():
        show(page, toggles, 3, read(small).encoding.rate)
        pair = screenshot(page)
        found[name] = psnr(pair, desktop(device, small, page, 3, toggles, both=True))
        assert np.abs(pair[:, :half] - pair[:, half:]).max() > 8 / 255, "an eye sees it from elsewhere"
    assert min(found.values()) > LEAST_PSNR, found


def test_a_picture_too_narrow_for_two_eyes_is_one(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("(player.canvas.width = 1, player.stereo = true, player.draw())")
    assert transparent(page).shape == (SCREEN[1], 1, 4)
    assert page.evaluate("faults") == []


def test_two_eyes_see_all_of_what_is_framed(opened: Open, small: Path) -> None:
    page, half = opened(a=small.read_bytes()), SCREEN[0] // 2
    assert load(page) == ""
    page.evaluate("(player.stereo = true, player.frameAll())")
    show(page, SPLATS, 0, 24.0)
    covered = transparent(page)[..., 3] > 0.2
    assert covered.any()
    assert not covered[:, [0, half - 1, half, -1]].any(), "cut off at a side"


def test_the_demo_looks_as_on_the_desktop(opened: Open, device: Device) -> None:
    if not DEMO.is_file():
        pytest.skip(f"needs {DEMO}: make demo")
    page = opened(a=DEMO.read_bytes())
    assert load(page) == ""
    page.evaluate("player.camera.elevation = 0.25")  # from the side, the ground is a line that devices round either way
    show(page, Toggles(shadow=True), 9, read(DEMO).encoding.rate)
    assert psnr(screenshot(page), desktop(device, DEMO, page, 9, Toggles(shadow=True))) > LEAST_PSNR


def test_filters_and_planes_that_are_not_whole_words_look_as_on_the_desktop(
    opened: Open, device: Device, tmp_path: Path
) -> None:
    file = tmp_path / "a.muaavatar"
    file.write_bytes(encode(synthetic_avatar(wavelet="bior3.1", levels=5), storage="f32"))
    page = opened(a=file.read_bytes())
    assert load(page) == ""
    show(page, SPLATS, 3, read(file).encoding.rate)
    assert psnr(screenshot(page), desktop(device, file, page, 3)) > LEAST_PSNR


@pytest.mark.parametrize("size", [16, 8])
def test_coarser_levels_are_those_of_the_desktop(opened: Open, device: Device, small: Path, size: int) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    show(page, SPLATS, 2, read(small).encoding.rate)
    full = screenshot(page)
    page.evaluate(f"player.level = {size}")
    coarse = screenshot(page)
    assert psnr(coarse, desktop(device, small, page, 2, level=size)) > LEAST_PSNR
    assert np.abs(coarse - full).max() > 2 / 255


def test_far_away_an_avatar_is_coarser_unless_its_surface_is_shown(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    shown = "player.entries[0].slot.frame.shown.level.size"
    page.evaluate('(player.level = "auto", player.camera.distance = 500, player.draw())')
    assert page.evaluate(shown) == 8
    page.evaluate("(player.show.geometry = true, player.draw())")
    assert page.evaluate(shown) == 32


def test_a_budget_is_for_the_nearest(opened: Open, small: Path) -> None:
    page, splats = opened(a=small.read_bytes(), b=small.read_bytes()), len(read(small).rig.texels.texels)
    assert load(page) == load(page, '"b.muaavatar"') == ""
    page.evaluate(
        "Object.assign(player.avatars[0].place, [0, 0, -3]), player.level = 'auto', player.camera.distance = 2"
    )

    def shown(budget: object) -> object:
        page.evaluate(f"(player.budget = {budget}, player.draw())")
        return page.evaluate("player.entries.map((one) => one.slot.frame.shown.level.size)")

    assert shown("null") == [32, 32]
    assert shown(round(1.5 * splats)) == [16, 32]
    assert shown(0) == [8, 8]


def test_a_camera_that_follows_goes_along_the_ground_with_the_figure(opened: Open, small: Path) -> None:
    page, avatar = opened(a=small.read_bytes()), read(small)
    assert load(page) == ""
    clip, skeleton = resample(avatar.clips[0], avatar.encoding.rate), avatar.rig.skeleton
    roots = skeleton.world(clip.rotations[[0, 3]], clip.translations[[0, 3]])[1][:, skeleton.root]
    moved = (roots[1] - roots[0]) * (1, 0, 1)
    show(page, SPLATS, 3, avatar.encoding.rate)
    before = np.array(page.evaluate("player.look.camera.target"))
    page.evaluate("player.follow = true")
    np.testing.assert_allclose(page.evaluate("player.look.camera.target"), before + moved, atol=1e-6)
    assert np.linalg.norm(moved) > 1e-4
    page.evaluate("player.frameAll()")  # on where the figure is now
    np.testing.assert_allclose(page.evaluate("player.look.camera.target"), before + moved, atol=1e-6)


def test_a_decode_that_is_spread_shows_what_one_at_once_shows(opened: Open, small: Path) -> None:
    page, rate = opened(a=small.read_bytes()), read(small).encoding.rate
    assert load(page) == ""
    show(page, SPLATS, 4, rate)
    at_once = screenshot(page)
    show(page, SPLATS, 3, rate)
    page.evaluate("""(() => {
      const posed = player.posed().map((one) => ({ ...one, following: 4, spread: true }));
      for (const turn of [0, 1, 2]) turn ? player.renderer.lookAhead(posed) : player.renderer.draw(posed, player);
    })()""")
    frame = "player.entries[0].slot.frame"
    state = "player.renderer.decodes.schedule.states.get(player.entries[0].slot)"
    assert page.evaluate(f"[{frame}.partsLeft, {state}.coming.frame]") == [0, 4]
    show(page, SPLATS, 4, rate)
    before = page.evaluate(f"(globalThis.made = {frame}.hidden, true)")
    np.testing.assert_array_equal(screenshot(page), at_once)
    assert before
    assert page.evaluate(f"{frame}.shown === made"), "it was not decoded anew"


def test_avatars_that_take_turns_show_what_one_alone_shows(opened: Open, small: Path) -> None:
    """Both play on until each has had its turn, then rest at that frame: bit for bit, without another decode."""
    other = synthetic_avatar(3)
    page, rate = opened(a=small.read_bytes(), b=encode(other, storage="f32")), read(small).encoding.rate
    assert load(page) == load(page, '"b.muaavatar"') == ""
    show(page, SPLATS, 4, rate)
    at_once = screenshot(page)
    show(page, SPLATS, 3, rate)
    page.evaluate("""(() => {
      player.renderer.draw(player.posed(), player);
      const posed = player.posed().map((one) => ({ ...one, following: 4, spread: true }));
      for (let turn = 0; turn < 10; turn++) player.renderer.lookAhead(posed);
      globalThis.made = player.entries.map(({ slot }) => slot.frame.hidden);
    })()""")
    assert page.evaluate("player.entries.map(({ slot }) => slot.frame.partsLeft)") == [0, 0]
    page.evaluate("""
      player.renderer.draw(player.posed().map((one) => ({ ...one, frame: 4, following: 5, spread: true })), player)
    """)
    assert page.evaluate("player.entries.map(({ slot }, i) => slot.frame.shown === made[i])") == [True, True]
    show(page, SPLATS, 4, rate)
    np.testing.assert_array_equal(screenshot(page), at_once)
    assert page.evaluate("player.entries.map(({ slot }, i) => slot.frame.shown === made[i])") == [True, True]


def test_a_handle_says_what_the_file_holds(opened: Open, small: Path) -> None:
    page, avatar = opened(a=small.read_bytes()), read(small)
    assert load(page) == ""
    reported = json.loads(page.evaluate("JSON.stringify({ ...avatar, clip: player.clip })"))
    frames, rate = len(avatar.clips[0]), avatar.encoding.rate
    clips = [{"name": avatar.clips[0].name, "frames": frames, "seconds": frames / rate, "loop": True}]
    assert (reported["name"], reported["clips"], reported["clip"]) == (avatar.name, clips, avatar.clips[0].name)
    assert reported["splats"] == len(avatar.rig.texels.texels)


def test_a_handle_says_how_far_outside_of_training_the_pose_is(opened: Open, small: Path) -> None:
    one, other = read(small), synthetic_avatar(3)
    page = opened(a=small.read_bytes(), b=encode(other, storage="f32"))
    assert load(page) == load(page, '"b.muaavatar"') == ""
    assert page.evaluate("player.avatars.map((one) => one.outsideTraining)") == [0, 0]
    found = []
    for frame in (3, 5):
        show(page, SPLATS, frame, one.encoding.rate)
        page.evaluate("player.draw()")
        found.append(page.evaluate("player.avatars.map((one) => one.outsideTraining)"))
        expected = [avatar.decode(avatar.clips[0], frame).outside for avatar in (one, other)]
        assert found[-1] == pytest.approx(expected, abs=SHARE)
    assert len({share for pair in found for share in pair}) == 4
    page.evaluate("player.renderer.lookAhead(player.posed().map((one) => ({ ...one, following: 3, spread: true })))")
    assert page.evaluate("player.avatars.map((one) => one.outsideTraining)") == found[1], "of what is shown"
    assert page.evaluate("(avatar.remove(), avatar.outsideTraining)") == 0


def test_poses_far_outside_of_training_look_as_on_the_desktop(opened: Open, device: Device, tmp_path: Path) -> None:
    """Every joint turned at random; networks that read such a pose as it is would throw splats out of the image."""
    file = tmp_path / "a.muaavatar"
    file.write_bytes(encode(with_random_poses(synthetic_avatar(), 3), storage="f32"))
    page, avatar = opened(a=file.read_bytes()), read(file)
    assert load(page) == ""
    page.evaluate("player.camera.distance *= 1.5")
    for frame in range(len(avatar.clips[0])):
        show(page, SPLATS, frame, avatar.encoding.rate)
        assert psnr(screenshot(page), desktop(device, file, page, frame)) > LEAST_PSNR
        expected = avatar.decode(avatar.clips[0], frame).outside
        assert page.evaluate("avatar.outsideTraining") == pytest.approx(expected, abs=SHARE)
        assert expected > FAR
        covered = transparent(page)[..., 3] > 0.2
        assert covered.any()
        assert not covered[:, [0, -1]].any()
        assert not covered[[0, -1]].any()


def test_playing_moves_the_time_and_the_picture(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("(player.playing = true, player.speed = 0.5, player.start())")
    page.wait("player.time > 0.02")
    page.evaluate("player.stop()")
    stood = page.evaluate("player.time")
    assert page.evaluate("new Promise((resolve) => setTimeout(() => resolve(player.time), 100))") == stood


def test_two_avatars_stand_where_they_are_placed(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    assert load(page) == ""
    show(page, Toggles(), 0, 24.0)
    page.evaluate("(avatar.place = [3, 0, 0], player.frameAll())")
    alone = page.evaluate("player.camera.target[0]")
    covered, half = transparent(page)[..., 3] > 0.2, SCREEN[0] // 2
    assert covered[:, :half].any()
    assert covered[:, half:].any()
    page.evaluate("player.frameAll([avatar])")
    assert page.evaluate("player.camera.target[0]") == pytest.approx(alone + 1.5)
    page.evaluate("(avatar.remove(), player.frameAll())")
    assert page.evaluate("player.camera.target[0]") == pytest.approx(alone - 1.5)


def test_a_packed_avatar_and_a_plain_one_beside_each_other_look_as_alone(opened: Open, small: Path) -> None:
    avatar = read(small)
    page = opened(a=encode(avatar, storage="i8"), b=encode(avatar, storage="packed"))
    alone = []
    for source in ('"a.muaavatar"', '"b.muaavatar"'):
        assert load(page, source) == ""
        show(page, SPLATS, 0, 24.0)
        alone.append(screenshot(page))
        page.evaluate("avatar.remove()")
    assert not np.array_equal(alone[0], alone[1])
    camera = page.evaluate("({...player.camera})")
    for source in ('"a.muaavatar"', '"b.muaavatar"'):
        assert load(page, source) == ""
    for seen in (0, 1):
        page.evaluate(f"player.avatars.forEach((one, i) => (one.place = [0, 0, i === {seen} ? 0 : 200]))")
        page.evaluate(f"(Object.assign(player.camera, {json.dumps(camera)}), 0)")
        np.testing.assert_array_equal(screenshot(page), alone[seen])


def test_an_avatar_out_of_view_is_not_sorted_and_the_other_looks_as_alone(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    show(page, SPLATS, 0, 24.0)
    alone = screenshot(page)
    assert load(page) == ""
    page.evaluate("player.avatars[0].place = [0, 0, 200]")  # behind the camera
    np.testing.assert_array_equal(screenshot(page), alone)
    assert page.evaluate("player.renderer.splats.seen") == [False, True]
    page.evaluate("player.avatars[1].place = [0, 0, 200]")
    assert transparent(page).max() == 0
