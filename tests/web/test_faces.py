"""Faces that expressions move, in a browser with the real engine: images beside the desktop player's, and buffers."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar, with_expressions, with_rules, with_surface
from web.browser import Page
from web.engine import LEAST_PSNR, SHOWN, SPLATS, Open, desktop, load, opened, psnr, screenshot, show
from web.test_set_pose import CLOCK, pose_of

from mua.asset.avatar import Avatar
from mua.asset.write import encode
from mua.gpu import Device
from mua.pose.resample import resample

__all__ = ["opened"]  # fixture
BODY = with_surface(synthetic_avatar())
AVATAR = with_expressions(BODY)
FRAME = 3
GEOMETRY = SHOWN["geometry"]  # in which a small face counts for more than in its splats
WEIGHTS = [0.25, 1.0, 0.5, 0.75]
READ = """globalThis.bytesOf = async ({ shown }) => {
  const texts = [];
  for (const buffer of [shown.mesh, shown.texelChannels]) {
    const { gpu } = player.renderer.device;
    const read = gpu.createBuffer({ size: buffer.size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = gpu.createCommandEncoder();
    encoder.copyBufferToBuffer(buffer, 0, read, 0, buffer.size);
    gpu.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    texts.push(new Uint32Array(read.getMappedRange()).join());
  }
  return texts;
}, 0"""


@pytest.fixture(scope="module")
def face(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return saved(tmp_path_factory.mktemp("face") / "a.muaavatar", AVATAR)


def weighted(avatar: Avatar, weights: list[float]) -> Avatar:
    """The avatar with the same weights in every frame of its clips."""
    clips = [replace(clip, expressions=np.tile(weights, (len(clip), 1))) for clip in avatar.clips]
    return replace(avatar, clips=tuple(clips))


def saved(path: Path, avatar: Avatar) -> Path:
    path.write_bytes(encode(avatar, storage="i8"))
    return path


def named(weights: list[float]) -> str:
    return json.dumps(dict(zip(AVATAR.expressions, weights, strict=True)))


def channels(page: Page, number: int) -> list[str]:
    """The mesh and the channels that an avatar shows."""
    page.evaluate("player.draw()")
    found: list[str] = page.evaluate(f"bytesOf(player.entries[{number}].slot.frame)")
    return found


def test_a_face_moves_by_the_clip_and_by_the_page_as_on_the_desktop(
    opened: Open, device: Device, face: Path, tmp_path: Path
) -> None:
    page, rate = opened(a=face.read_bytes(), before=CLOCK), AVATAR.encoding.rate
    assert load(page) == ""
    show(page, SPLATS, FRAME, rate)
    still = saved(tmp_path / "still.muaavatar", weighted(AVATAR, [0.0] * 4))
    resting = desktop(device, still, page, FRAME, GEOMETRY)

    def assert_drawn(file: Path, frame: int) -> None:
        found = screenshot(page)
        assert psnr(found, desktop(device, file, page, frame, GEOMETRY)) > LEAST_PSNR
        assert psnr(found, resting) < LEAST_PSNR

    assert psnr(screenshot(page), desktop(device, face, page, FRAME)) > LEAST_PSNR
    show(page, GEOMETRY, FRAME, rate)
    assert_drawn(face, FRAME)
    page.evaluate(f"avatar.setExpressions({named(WEIGHTS)})")
    assert_drawn(saved(tmp_path / "set.muaavatar", weighted(AVATAR, WEIGHTS)), FRAME)
    clip = resample(AVATAR.clips[0], rate)
    held = weighted(replace(AVATAR, clips=(clip.cut(slice(FRAME, FRAME + 1)),)), WEIGHTS)
    pose = {**pose_of(AVATAR, FRAME), "expressions": WEIGHTS}
    page.evaluate(f"(avatar.setExpressions(null), avatar.setPose({json.dumps(pose)}))")
    assert_drawn(saved(tmp_path / "held.muaavatar", held), 0)


def test_a_trackers_names_move_the_nearest_that_an_avatar_has(opened: Open) -> None:
    """To the bytes that its own names give."""
    assert AVATAR.rig.expressions
    names = ("aa", "blink", "nothing", "Smoking")
    rig = replace(AVATAR.rig, expressions=replace(AVATAR.rig.expressions, names=names))
    page = opened(a=encode(replace(AVATAR, rig=rig), storage="i8"))
    page.evaluate(READ)
    assert load(page) == ""
    show(page, SPLATS, FRAME, AVATAR.encoding.rate)
    page.evaluate("avatar.setExpressions({ aa: 0.5, blink: 0.75 })")
    own = channels(page, 0)
    page.evaluate("(avatar.setExpressions(null), avatar.setExpressions({ jawOpen: 0.25, eyeBlinkLeft: 1 }))")
    assert channels(page, 0) != own
    page.evaluate("avatar.setExpressions({ jawOpen: 0.5, eyeBlink_R: 0.5, cheekPuff: 1 })")
    assert channels(page, 0) == own
    said = "(() => { try { avatar.setExpressions({ wink: 1 }) } catch (e) { return e.message } })()"
    assert page.evaluate(said) == f'setExpressions: the avatar has no expression "wink", only {", ".join(names)}.'


def test_weights_of_0_give_the_bytes_of_the_avatar_without(opened: Open, face: Path) -> None:
    """Also after a decode that moved the face."""
    page = opened(a=face.read_bytes(), b=encode(BODY, storage="i8"))
    page.evaluate(READ)
    assert load(page, '"b.muaavatar"') == load(page) == ""
    assert page.evaluate("player.avatars.map(({ expressions }) => expressions.length)") == [0, 4]
    show(page, SPLATS, FRAME, AVATAR.encoding.rate)
    without, by_clip = channels(page, 0), channels(page, 1)
    assert [a == b for a, b in zip(without, by_clip, strict=True)] == [False, False]
    for weights, same in (([0.0] * 4, True), (WEIGHTS, False), ([0.0] * 4, True), ([0, 0, 1.0, 0], True)):
        page.evaluate(f"avatar.setExpressions({named(weights)})")
        assert [a == b for a, b in zip(without, channels(page, 1), strict=True)] == [same, same]
    page.evaluate("avatar.setExpressions(null)")
    assert channels(page, 1) == by_clip


def test_rules_of_a_file_hold_back_what_a_page_sets_over_its_clip(opened: Open) -> None:
    """To the bytes of an avatar without rules that is given what they leave; a switch holds back the clip's blink."""
    ruled, rate = with_rules(AVATAR), AVATAR.encoding.rate
    assert ruled.rig.expressions
    clip = resample(AVATAR.clips[0], rate).expressions
    assert clip is not None
    page = opened(a=encode(ruled, storage="i8"), b=encode(AVATAR, storage="i8"))
    page.evaluate(READ)
    assert load(page, '"b.muaavatar"') == load(page) == ""
    show(page, SPLATS, 0, rate)
    over = clip[0] * [1, 1, 1, 0] + [0, 0, 0, 0.75]
    for given, weights in ((named(WEIGHTS), WEIGHTS), (json.dumps({"Mund auf": 0.75}), over)):
        left = ruled.rig.expressions.shown(np.array(weights, np.float32)).astype(float)
        assert (left != weights).sum() >= 2
        page.evaluate(f"(player.avatars[1].setExpressions(null), player.avatars[1].setExpressions({given}))")
        page.evaluate(f"player.avatars[0].setExpressions({named(weights)})")
        assert channels(page, 1) != channels(page, 0)
        page.evaluate(f"player.avatars[0].setExpressions({named(left.tolist())})")
        assert channels(page, 1) == channels(page, 0)
