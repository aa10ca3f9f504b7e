"""Avatars that a page poses, in a browser with the real engine: images, motion files, and when a page asks."""

import json
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from people import moving, person
from shared_data import SharedData
from synthetic_avatar import synthetic_avatar, with_surface
from web.browser import Browser, Page, Serve
from web.conftest import PLAIN
from web.engine import LEAST_PSNR, Open, desktop, load, opened, psnr, screenshot, small
from web.test_page_retarget import ANGLE, ROOM, animated, vrma

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.write import encode
from mua.gpu import Device
from mua.motion.load import load_motions
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton
from mua.share.site import Content, player_files

__all__ = ["opened", "small"]  # fixtures
FRAME = 4  # of the clip, whose poses the page sets
CLOCK = "globalThis.clock = 1000; performance.now = () => clock;"


def wxyz_to_page(rotations: Array) -> list[float]:
    return [float(value) for value in np.roll(rotations, -1, axis=-1).ravel()]


def pose_of(avatar: Avatar, frame: int) -> dict[str, list[float]]:
    """A frame of the first clip as a page gives it."""
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    translations = [float(value) for value in clip.translations[frame].ravel()]
    return {"rotations": wxyz_to_page(clip.rotations[frame]), "translations": translations}


def held(folder: Path, avatar: Avatar, frame: int) -> Path:
    """The avatar with a clip of one frame alone."""
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    path = folder / "held.muaavatar"
    path.write_bytes(encode(replace(avatar, clips=(clip.cut(slice(frame, frame + 1)),)), storage="i8"))
    return path


def test_a_pose_that_jumps_is_drawn_as_one_that_has_been_held(
    opened: Open, device: Device, small: Path, tmp_path: Path
) -> None:
    page = opened(a=small.read_bytes(), before=CLOCK)
    assert load(page) == ""
    page.evaluate("player.show.shadow = false")
    page.evaluate(f"avatar.setPose({json.dumps(pose_of(read(small), FRAME))})")
    found = screenshot(page)
    still = held(tmp_path, with_surface(synthetic_avatar()), FRAME)
    assert psnr(found, desktop(device, still, page, 0)) > LEAST_PSNR


def test_poses_at_the_avatars_rate_are_drawn_as_its_clip(opened: Open, device: Device, small: Path) -> None:
    """The decode depends on the last poses: the same window gives the same image."""
    page, avatar = opened(a=small.read_bytes(), before=CLOCK), read(small)
    assert load(page) == ""
    page.evaluate("player.show.shadow = false")
    for frame in range(FRAME + 1):
        pose = json.dumps(pose_of(avatar, frame))
        page.evaluate(f"(clock += {1000 / avatar.encoding.rate}, avatar.setPose({pose}), player.draw())")
    found = screenshot(page)
    assert psnr(found, desktop(device, small, page, FRAME)) > LEAST_PSNR
    page.evaluate(f"(avatar.setPose(null), player.time = {FRAME / avatar.encoding.rate}, player.draw())")
    clip = screenshot(page)
    page.evaluate(f"avatar.setPose({json.dumps(pose_of(avatar, FRAME))})")
    assert psnr(found, clip) > psnr(screenshot(page), clip), "a pose that jumps has another window"


def test_a_part_of_a_pose_moves_that_part_alone(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes(), before=CLOCK)
    assert load(page) == ""
    page.evaluate("(avatar.setPose({}), player.frameAll())")
    bind = screenshot(page)
    page.evaluate("avatar.setPose({ rotations: { tip: [0, 0, 0.7, 0.7] } })")
    bent = screenshot(page)
    changed = np.abs(bent - bind).max(axis=(1, 2)) > 8 / 255
    assert changed[: len(changed) // 2].any()
    assert not changed[-len(changed) // 4 :].any(), "the foot of the figure stands"
    page.evaluate("avatar.setPose({ translations: { root: [0, 0.4, 0] } })")
    assert np.abs(screenshot(page) - bind).max() > 8 / 255


def test_what_the_page_learns_of_the_skeleton_is_what_the_file_holds(opened: Open, small: Path) -> None:
    page, skeleton = opened(a=small.read_bytes()), read(small).rig.skeleton
    assert load(page) == ""
    told = page.evaluate(
        "(({ names, parents, root, rotations, translations }) => "
        "({ names, parents, root, rotations: [...rotations], translations: [...translations] }))(avatar.skeleton)"
    )
    assert (told["names"], told["parents"], told["root"]) == (
        list(skeleton.names),
        skeleton.parents.tolist(),
        skeleton.root,
    )
    np.testing.assert_allclose(told["rotations"], wxyz_to_page(skeleton.bind_rotations), atol=1e-6)
    np.testing.assert_allclose(told["translations"], skeleton.bind_translations.ravel(), atol=1e-6)
    assert page.evaluate("[...avatar.expressions]") == []
    found = page.evaluate("(() => { try { avatar.setExpressions({ smile: 1 }) } catch (e) { return e.message } })()")
    assert found == "setExpressions: the avatar has no expressions."


def on_person(skeleton: Skeleton) -> bytes:
    """An avatar with a person's joints, which need not look like one."""
    made = synthetic_avatar()
    moved = replace(made.rig, skeleton=skeleton)
    return encode(replace(made, rig=moved, clips=()), storage="i8")


@pytest.fixture
def element(browser: Browser, serve: Serve) -> Iterator[Any]:
    """A page with an element, `element`, that has not loaded, and files beside it."""
    with ExitStack() as stack:

        def begin(**files: Content) -> Page:
            named = {name.replace("_", "."): content for name, content in files.items()}
            address = serve({**player_files(), "index.html": PLAIN, **named})
            page = stack.enter_context(browser.page(address, size=(160, 200)))
            stack.callback(lambda: nothing_raised(page))
            page.wait("Boolean(customElements.get('mua-avatar'))")
            page.evaluate("""(globalThis.element = document.querySelector("mua-avatar"), globalThis.told = [],
              ["play", "pause", "loop", "end", "load", "error"].forEach((kind) => element.addEventListener(kind,
                ({ type, detail }) => told.push(type === "error" ? detail.message : type))), 0)""")
            return page

        yield begin


def nothing_raised(page: Page) -> None:
    assert page.reported["errors"] == []


def clip_of(page: Page, skeleton: Skeleton) -> tuple[Array, Array]:
    """Rotations and translations of the clip that a page has loaded last."""
    code = (
        "(({ rotations, translations }) => [[...rotations], [...translations]])(element.player.entries[0].added.at(-1))"
    )
    rotations, translations = page.evaluate(code)
    joints = len(skeleton.names)
    return np.array(rotations).reshape(-1, joints, 4), np.array(translations).reshape(-1, joints, 3)


def test_motion_files_play_as_the_package_retargets_them(element: Any, tmp_path: Path) -> None:
    """A real BVH, a VRMA and a glTF animation: every joint, left and right, from the first frame to the last."""
    target, source = person(arms_down=50, legs_apart=8, size=0.7, axes=3), person(size=1.3)
    file = tmp_path / "a.muaavatar"
    file.write_bytes(on_person(target))
    skeleton, rate = read(file).rig.skeleton, read(file).encoding.rate
    motions = [
        SharedData().path("motion/cmu/02_01.bvh"),
        vrma(source, moving(source)).save(tmp_path / "moves.vrma"),
        animated(source, moving(source)).save(tmp_path / "moves.glb"),
    ]
    page = element(a_muaavatar=file, walk_bvh=motions[0], moves_vrma=motions[1], moves_glb=motions[2])
    page.evaluate("element.src = 'a.muaavatar'")
    page.wait("told.includes('load')")
    for address, motion in zip(("walk.bvh", "moves.vrma", "moves.glb"), motions, strict=True):
        [loaded] = load_motions(motion, skeleton, mapping=None, rate=rate, feet="keep")
        played = page.evaluate(f"element.playClip('{address}', {{ name: '{address}' }})")
        assert (played["name"], played["frames"], played["loop"]) == (address, len(loaded.clip), True)
        rotations, translations = clip_of(page, skeleton)
        apart = np.abs(np.abs(np.sum(rotations * loaded.clip.rotations, axis=-1)) - 1)
        np.testing.assert_array_less(apart, ANGLE)
        np.testing.assert_array_less(np.abs(translations - loaded.clip.translations), ROOM)
        assert page.evaluate("[element.clip, element.player.playing]") == [address, True]


def test_what_is_asked_before_the_avatar_is_there_is_done_when_it_is(element: Any, tmp_path: Path) -> None:
    target = person(axes=3)
    page = element(
        a_muaavatar=on_person(target), moves_glb=animated(person(), moving(person())).save(tmp_path / "m.glb")
    )
    page.evaluate("element.setPose({ rotations: { LeftArm: [0, 0, 0.6, 0.8] } })")
    page.evaluate("(element.setPose({ rotations: { Head: [0.6, 0, 0, 0.8] } }), element.src = 'a.muaavatar')")
    page.wait("told.includes('load')")
    joint = target.names.index("Head")
    turned = f"element.player.entries[0].live.current.rotations[{4 * joint + 1}]"
    assert page.evaluate(turned) == pytest.approx(0.6)
    page.evaluate("(element.remove(), document.body.append(element), 0)")  # moved, not taken out
    assert page.evaluate(turned) == pytest.approx(0.6)
    page.evaluate("(element.src = 'a.muaavatar?again', 0)")
    assert page.evaluate("element.playClip('moves.glb').then(({ name }) => name)") == "moves"
    assert page.evaluate("element.clip") == "moves"


def test_an_element_that_is_taken_out_early_ends_what_was_asked(element: Any) -> None:
    page = element(a_muaavatar=on_person(person()))
    page.evaluate("globalThis.asked = element.playClip('nowhere.bvh'), element.src = 'a.muaavatar', element.remove()")
    assert page.evaluate("asked") is None
    assert page.evaluate("(element.setPose({}), element.setExpressions({}), element.skeleton)") is None
    assert page.evaluate("told") == []


def test_a_pose_that_is_wrong_is_a_sentence_before_and_after_loading(element: Any) -> None:
    page = element(a_muaavatar=on_person(person()))
    page.evaluate("(element.setPose({ rotations: { Tail: [0, 0, 0, 1] } }), element.src = 'a.muaavatar')")
    page.wait("told.includes('load')")
    assert page.evaluate("told[0]").startswith('setPose: rotations: the avatar has no joint "Tail", only Hips, ')
    code = "(() => { try { element.setPose({ rotations: [1, 2, 3] }) } catch (error) { return error.message } })()"
    assert page.evaluate(code).startswith("setPose: rotations holds 3 numbers, expected ")


def test_a_motion_that_is_not_there_is_a_sentence_and_an_event(element: Any) -> None:
    page = element(a_muaavatar=on_person(person()))
    page.evaluate("element.src = 'a.muaavatar'")
    page.wait("told.includes('load')")
    assert page.evaluate("element.playClip('none.bvh')") is None
    assert page.evaluate("told.at(-1)") == "none.bvh cannot be fetched: the server answers 404 Not Found."


def test_events_come_once_and_in_order(element: Any, tmp_path: Path) -> None:
    moves = animated(person(), moving(person())).save(tmp_path / "m.glb")
    page = element(a_muaavatar=on_person(person()), moves_glb=moves)
    page.evaluate("element.src = 'a.muaavatar'")
    page.wait("told.includes('load')")
    page.evaluate("(element.speed = 40, element.playClip('moves.glb', { loop: false }))")
    page.wait("told.includes('end')")
    page.evaluate("new Promise((done) => setTimeout(done, 200))")
    assert page.evaluate("told") == ["load", "play", "end"]
    page.evaluate("(element.play(), element.pause(), element.pause(), 0)")
    assert page.evaluate("told.slice(3)") == ["play", "pause"]
    page.evaluate("element.playClip('moves.glb')")
    page.wait("told.includes('loop')")
    assert page.evaluate("told.slice(5, 7)") == ["play", "loop"]


def test_a_paused_element_draws_a_pose_until_it_rests(element: Any) -> None:
    page = element(a_muaavatar=on_person(person()))
    page.evaluate("element.src = 'a.muaavatar'")
    page.wait("told.includes('load')")
    page.evaluate("element.setPose({})")
    page.wait("!element.player.moving")
    assert page.evaluate("(element.setPose({ translations: { Hips: [0, 2, 0] } }), element.player.moving)") is True
    page.wait("!element.player.moving && element.player.request === 0")
    window = page.evaluate("element.player.entries[0].live.window.map(({ translations }) => translations[1])")
    assert window == [2, 2, 2]
