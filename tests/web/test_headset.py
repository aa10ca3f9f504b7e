"""The player in a headset: what a stand-in for WebXR (fake_headset.js) is shown, beside the desktop's images."""

import base64
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from web.browser import Page
from web.engine import FULL, LEAST_PSNR, SHOWN, Open, load, opened, psnr, show, small
from web.pages import LOSABLE

from mua.arrays import Array
from mua.asset.read import read
from mua.avatar.camera import Camera
from mua.gpu import Device
from mua.player.buffers import AvatarBuffers
from mua.player.cpu_image import over
from mua.player.levels import Levels
from mua.player.offscreen import Offscreen
from mua.player.overlays import ground_height
from mua.pose.resample import resample

__all__ = ["opened", "small"]  # fixtures

FAKE = (Path(__file__).parent / "fake_headset.js").read_text()
BACKDROP = (0.44, 0.47, 0.5)  # sRGB of the empty room
IMAGE, SEEN = (168, 128), (slice(6, 166), slice(4, 124))  # rows and columns: of an image, and of what an eye sees of it
SCREEN = (120, 160)
ROUNDED = 2 / 255  # two images of 8 bits, each rounded
BEFORE = 1.2  # metres between the reader and what is nearest
NEAR, FAR = 0.02, 1000.0
FRAME, AZIMUTH = 3, 0.7


def eye_to_clip(aside: float) -> Array:
    """A projection [4, 4] of an eye whose image reaches farther to one side, z of 0 to w."""
    left, right, down, up = -0.45 - aside, 0.45 - aside, -0.7, 0.5  # slopes
    return np.array(
        [
            [2 / (right - left), 0, (right + left) / (right - left), 0],
            [0, 2 / (up - down), (up + down) / (up - down), 0],
            [0, 0, FAR / (NEAR - FAR), FAR * NEAR / (NEAR - FAR)],
            [0, 0, -1, 0],
        ]
    )


def projection_of(clip: Array) -> Array:
    """The same with z of -w to w, as cameras have it."""
    projection = clip.copy()
    projection[2] = 2 * clip[2] - clip[3]
    return projection


def room_to_eye(aside: float) -> Array:
    """[4, 4] of a head at 0.9 m that looks a little down and to the side."""
    (cy, sy), (cx, sx) = [(np.cos(angle), np.sin(angle)) for angle in (0.05, 0.1)]
    turn = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]) @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    view = np.eye(4)
    view[:3, :3] = turn
    view[:3, 3] = -turn @ [0.1, 0.9, 0.2] - [aside, 0, 0]
    return view


EYES = [(room_to_eye(aside), eye_to_clip(aside)) for aside in (-0.032, 0.032)]
APART = [(room_to_eye(aside), eye_to_clip(aside / 2)) for aside in (-0.5, 0.5)]  # as no person's, to tell them apart


def columns(matrix: Array) -> list[float]:
    return [float(value) for value in matrix.T.ravel()]


def given(eyes: Sequence[tuple[Array, Array]]) -> str:
    """Views as a session gives them: matrices column by column."""
    views = [
        {"eye": i, "projectionMatrix": columns(clip), "transform": {"inverse": {"matrix": columns(view)}}}
        for i, (view, clip) in enumerate(eyes)
    ]
    return json.dumps(views)


def world_to_room(file: Path) -> Array:
    """[4, 4]: the figure stands on the floor, its box's middle before the reader, seen from the page's side."""
    avatar = read(file)
    clip, skeleton = resample(avatar.clips[0], avatar.encoding.rate), avatar.rig.skeleton
    root = skeleton.world(clip.rotations[FRAME], clip.translations[FRAME])[1][skeleton.root]
    (left, _, back), (right, _, front) = avatar.bounds + root
    foot = [(left + right) / 2, ground_height(avatar.rig, clip), (back + front) / 2]
    c, s = np.cos(AZIMUTH), np.sin(AZIMUTH)
    room = np.eye(4)
    room[:3, :3] = [[c, 0, -s], [0, 1, 0], [s, 0, c]]
    room[:3, 3] = -room[:3, :3] @ foot - [0, 0, BEFORE + np.hypot(right - left, front - back) / 2]
    return room


def desktop(device: Device, file: Path, eyes: Sequence[tuple[Array, Array]], shown: str) -> Array:
    """The desktop player's image for these eyes, side by side over the empty room, [H, E W, 3] of 0 to 1."""
    buffers, room = AvatarBuffers(device, file), world_to_room(file)
    cameras = [Camera(view @ room, projection_of(clip), SCREEN) for view, clip in eyes]
    played = resample(buffers.avatar.clips[0], buffers.avatar.encoding.rate)
    levels = Levels(buffers.avatar, FULL)
    return over(Offscreen(device, buffers, played, SHOWN[shown], levels=levels).picture(FRAME, cameras), BACKDROP) / 255


def image(page: Page, eye: int) -> Array:
    """What an eye is shown, [H, W, 4] of 0 to 1."""
    content = base64.b64decode(page.evaluate(f"headset.image({eye})"))
    return np.frombuffer(content, np.uint8).reshape(*IMAGE, 4) / 255


def enter(page: Page, file: Path, shown: str = "shadow") -> None:
    assert load(page) == ""
    page.evaluate(f"(player.camera.azimuth = {AZIMUTH}, globalThis.said = [], player.onvr = (vr) => said.push(vr))")
    show(page, SHOWN[shown], FRAME, read(file).encoding.rate)
    page.evaluate("player.enterVR()")


@pytest.mark.parametrize("shown", ["shadow", "all"])
def test_each_eye_is_shown_what_the_desktop_would_draw_for_it(
    opened: Open, device: Device, small: Path, shown: str
) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small, shown)
    assert page.evaluate("headset.asked") == ["immersive-vr", ["webgpu", "local-floor"]]
    assert page.evaluate("headset.session.state.depthNear") == NEAR
    page.evaluate(f"headset.show(1000, {given(EYES)})")
    found = [image(page, eye) for eye in range(2)]
    expected = desktop(device, small, EYES, shown)
    seen = np.concatenate([one[SEEN] for one in found], axis=1)
    assert seen[..., 3].min() == 1
    assert psnr(seen[..., :3], expected) > LEAST_PSNR
    assert np.abs(expected - BACKDROP).max() > 0.2, "the figure is in the picture"
    assert np.abs(found[0] - found[1]).max() > 8 / 255
    assert found[0][:6].max() == 0, "nothing is drawn beside what the eye sees"


def test_each_eye_has_colours_and_shapes_of_its_own(opened: Open, device: Device, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small, "splats")
    page.evaluate(f"headset.show(1000, {given(APART)})")
    seen = np.concatenate([image(page, eye)[SEEN] for eye in range(2)], axis=1)
    expected = desktop(device, small, APART, "splats")
    assert np.abs(seen[..., :3] - expected).max() <= ROUNDED


def test_an_eye_of_a_headset_has_the_matrices_of_a_camera(opened: Open) -> None:
    (view, clip), room = EYES[0], room_to_eye(0.3)
    eye = f"eyeInRoom({columns(room.T)}, {given(EYES)}[0], {list(SCREEN)})"
    found = opened().evaluate(f"import('./camera.js').then(({{ eyeInRoom }}) => {eye})")
    expected = Camera(view @ room, projection_of(clip), SCREEN)
    assert found["near"] == pytest.approx(NEAR)
    np.testing.assert_allclose(found["view"], expected.view.ravel(), atol=1e-12)
    np.testing.assert_allclose(found["projection"], expected.projection.ravel(), atol=1e-12)
    np.testing.assert_allclose(found["viewProjection"], (clip @ expected.view).ravel(), atol=1e-12)
    np.testing.assert_allclose(found["position"], expected.position, atol=1e-12)


@pytest.mark.parametrize("follow", [False, True])
def test_the_room_goes_with_a_figure_that_is_followed(opened: Open, small: Path, follow: bool) -> None:
    page, rate = opened(before=FAKE, a=small.read_bytes()), read(small).encoding.rate
    assert load(page) == ""
    page.evaluate(f"(player.follow = {json.dumps(follow)}, player.time = 0, player.enterVR())")
    place = "player.room.headset.asks.room()"
    before = page.evaluate(place)
    page.evaluate(f"player.time = {FRAME / rate}")
    moved, walked = np.subtract(page.evaluate(place), before), page.evaluate("player.followed()")
    np.testing.assert_allclose(moved.reshape(4, 4)[:3, 3], np.multiply(walked, -1), atol=1e-12)
    assert bool(np.abs(walked).max() > 1e-4) is follow


def test_a_picture_is_made_anew_only_for_images_of_another_size(opened: Open, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    sizes = []
    for viewport in ({}, {}, {"width": 100}, {"width": 100, "height": 90}):
        page.evaluate(f"(Object.assign(headset.viewport, {json.dumps(viewport)}), headset.show(1000, {given(EYES)}))")
        textures = (
            "player.room.headset.memory.textures.map((one) => [(one.mark ??= Math.random()), one.width, one.height])"
        )
        sizes.append(page.evaluate(textures))
    assert sizes[0] == sizes[1]
    assert [[size[1:] for size in held] for held in sizes[1:]] == [[[240, 160]], [[200, 160]], [[200, 90]]]


def test_a_headset_of_one_eye_is_shown_one(opened: Open, device: Device, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    page.evaluate(f"headset.show(1000, {given(EYES[:1])})")
    assert psnr(image(page, 0)[SEEN][..., :3], desktop(device, small, EYES[:1], "shadow")) > LEAST_PSNR


COUNTED = """globalThis.drawn = 0; const draw = GPUCanvasContext.prototype.getCurrentTexture;
GPUCanvasContext.prototype.getCurrentTexture = function () { globalThis.drawn += 1; return draw.call(this); };"""


def test_the_sessions_frames_move_the_time_and_leave_the_canvas(opened: Open, small: Path) -> None:
    page = opened(before=FAKE + COUNTED, a=small.read_bytes())
    enter(page, small)
    page.evaluate("Object.assign(player, { time: 0, speed: 0.5, playing: true }), player.start()")
    page.evaluate(f"headset.show(1e6, {given(EYES)})")
    before, drawn = page.evaluate("[player.time, drawn]")
    page.evaluate(f"(headset.show(1e6 + 100, {given(EYES)}), player.draw())")
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")
    assert page.evaluate("[player.time, drawn]") == [pytest.approx(before + 0.05), drawn]


def test_a_head_that_nobody_finds_leaves_the_last_picture(opened: Open, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    page.evaluate(f"headset.show(1000, {given(EYES)})")
    before = image(page, 0)
    page.evaluate("(headset.show(1100, null), headset.show(1200, []))")
    np.testing.assert_array_equal(image(page, 0), before)
    assert page.evaluate("headset.session.frames.length") == 1, "it asks for the next frame"


@pytest.mark.parametrize("how", ["player.leaveVR()", "headset.session.end()"], ids=["by the page", "by the headset"])
def test_the_page_has_its_picture_again_when_the_session_ends(opened: Open, small: Path, how: str) -> None:
    page = opened(before=FAKE + COUNTED, a=small.read_bytes())
    enter(page, small)
    camera = page.evaluate("JSON.stringify(player.look.camera)")
    page.evaluate(f"headset.show(1000, {given(EYES)})")
    assert page.evaluate("[player.vr, said]") == [True, [True]]
    held, drawn = page.evaluate("[player.room.headset.memory.textures.length, drawn]")
    page.evaluate(f"(globalThis.was = player.room.headset, {how})")
    page.wait("!player.vr")
    assert page.evaluate("[player.vr, said]") == [False, [True, False]]
    assert page.evaluate("drawn") == drawn + 1
    assert page.evaluate("JSON.stringify(player.look.camera)") == camera
    assert (held, page.evaluate("was.memory.textures.length")) == (1, 0)
    page.evaluate("player.enterVR()")  # once more
    assert page.evaluate("player.vr")


@pytest.mark.parametrize(
    ("before", "said"),
    [
        ("headset.refused = 'denied by the reader'", "denied by the reader"),
        ("headset.adapters.push(false)", "The device does not fit the headset"),
        ("headset.floorless = true", "There is no floor"),
        ("delete globalThis.XRGPUBinding", "this browser has no WebXR with WebGPU"),
    ],
    ids=["refused", "unfit device", "no floor", "without WebGPU"],
)
def test_a_session_that_is_refused_is_a_sentence(opened: Open, small: Path, before: str, said: str) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    assert load(page) == ""
    page.evaluate(f"({before}, globalThis.said = [], player.onvr = (vr) => said.push(vr))")
    reported = page.evaluate("player.enterVR().catch((error) => [error.constructor.name, error.message])")
    assert reported == ["AvatarError", f"The headset cannot show the avatar: {said}"]
    assert page.evaluate("[player.vr, said, headset.session?.ended ?? true]") == [False, [], True]


def test_a_picture_that_cannot_be_drawn_leaves_the_headset_and_is_told(opened: Open, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    page.evaluate(f"(headset.session.state.layers = [], headset.show(1000, {given(EYES)}))")
    page.wait("!player.vr")
    assert page.evaluate("headset.session.ended")
    assert page.evaluate("faults") == ["The avatar cannot be drawn: Not a layer of this session"]


def test_without_an_avatar_there_is_nothing_to_show(opened: Open) -> None:
    page = opened(before=FAKE)
    reported = page.evaluate("player.enterVR().catch((error) => error.message)")
    assert reported == "There is no avatar yet that a headset could show."


def test_what_is_disposed_of_leaves_the_headset(opened: Open, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    page.evaluate("player.dispose()")
    page.wait("headset.session.ended && !player.vr")


def test_a_lost_device_leaves_the_headset(opened: Open, small: Path) -> None:
    page = opened(before=FAKE + LOSABLE, a=small.read_bytes())
    enter(page, small)
    page.evaluate("new Promise((resolve) => setTimeout(resolve, 2100))")  # a device lost at once is given up
    page.evaluate('lose("unknown")')
    page.wait("headset.session.ended && player.bytes > 0 && !player.vr")
    assert page.evaluate("faults") == []


def test_a_headset_that_is_being_left_is_shown_no_more(opened: Open, small: Path) -> None:
    page = opened(before=FAKE, a=small.read_bytes())
    enter(page, small)
    page.evaluate(f"headset.show(1000, {given(EYES)})")
    before = image(page, 0)
    page.evaluate(f"(player.leaveVR(), headset.show(1100, {given(EYES[::-1])}))")
    page.wait("!player.vr")
    np.testing.assert_array_equal(image(page, 0), before)


OFFERED = "import('./player.js').then(({ offersVR }) => offersVR())"


@pytest.mark.parametrize(
    ("before", "offered"),
    [
        ("", False),
        (FAKE, True),
        (FAKE + "headset.supported = async () => false;", False),
        (FAKE + "headset.supported = async () => { throw new Error('no'); };", False),
        (FAKE + "delete globalThis.XRGPUBinding;", False),
    ],
    ids=["neither", "both", "no headset", "unknown", "without WebGPU"],
)
def test_a_headset_is_offered_where_there_is_one_that_webgpu_draws_on(opened: Open, before: str, offered: bool) -> None:
    page = opened(before=before)
    assert page.evaluate(OFFERED) is offered
    if before:
        assert page.evaluate("headset.adapters") == [offered]


def test_where_no_device_fits_the_headset_another_one_draws(opened: Open, small: Path) -> None:
    page = opened(before=FAKE + "headset.unfit = true;", a=small.read_bytes())
    assert page.evaluate("headset.adapters") == [True, False]
    assert load(page) == ""
