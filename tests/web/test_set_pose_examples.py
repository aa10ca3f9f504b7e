"""Examples in which a page poses an avatar: by a webcam's landmarks and by a skeleton of three.js."""

import json
from pathlib import Path

import numpy as np
import pytest
from people import moving, person
from web.browser import Page
from web.pages import ELEMENT
from web.test_page_retarget import animated
from web.test_set_pose import on_person
from web.test_shared import EXAMPLES, THREE, Open, opened

from mua.arrays import Array
from mua.motion.load import load_motions
from mua.share.site import Content, player_files

__all__ = ["opened"]  # a fixture

PERSON = person(axes=3)
STAND_IN = """
export const FilesetResolver = { forVisionTasks: async () => "files" };
const landmarker = (seen) => ({ createFromOptions: async () => ({ detectForVideo: () => seen() }) });
export const PoseLandmarker = landmarker(() => ({ worldLandmarks: globalThis.seen ? [globalThis.seen] : [] }));
const open = [{ categoryName: "jawOpen", score: 0.5 }];
export const FaceLandmarker = landmarker(() => ({ faceBlendshapes: [{ categories: open }] }));
"""
CAMERA = """navigator.mediaDevices.getUserMedia = async () => {
  const canvas = document.createElement("canvas");
  canvas.getContext("2d").fillRect(0, 0, 9, 9);
  return canvas.captureStream();
};"""
FOUND = "(({ rotations, translations }) => [[...rotations], [...translations]])(%s.live.current)"
ENTRY = f"{ELEMENT}.player.entries[0]"


def person_site(page: str, **files: Content) -> dict[str, Content]:
    """An example's page with an avatar on a person's joints, and three.js."""
    player = {f"player/{path}": file for path, file in player_files().items()}
    used = ["build/three.module.js", "build/three.core.js"]
    used += ["examples/jsm/loaders/GLTFLoader.js", "examples/jsm/utils/BufferGeometryUtils.js"]
    three = {f"three/{path}": THREE / path for path in used}
    shown = (EXAMPLES / page).read_bytes().replace(b".mjs", b".js")  # which the tests' server knows
    examples: dict[str, Content] = {"index.html": shown, "landmarks.js": EXAMPLES / "landmarks.js"}
    return {**player, **three, **examples, "hero.muaavatar": on_person(PERSON), **files}


def followed(page: Page) -> dict[str, Array]:
    """Where the joints are in the pose that the page has set last."""
    rotations, translations = (np.array(values) for values in page.evaluate(FOUND % ENTRY))
    _, at = PERSON.world(rotations.reshape(-1, 4), translations.reshape(-1, 3))
    return dict(zip(PERSON.names, at, strict=True))


def landmarks(**moved: tuple[float, float, float]) -> list[dict[str, float]]:
    """A standing body's world landmarks with its arms out, as MediaPipe has them: Y down, Z away from the camera."""
    places: dict[int, tuple[float, float, float]] = dict.fromkeys(range(33), (0.0, 0.6, 0.1))
    places[0] = (0.0, 0.62, 0.12)
    for side, first in ((1, 0), (-1, 1)):
        arm = {11: (0.18, 0.45, 0), 13: (0.46, 0.45, 0), 15: (0.7, 0.45, 0)}
        leg = {23: (0.1, 0, 0), 25: (0.1, -0.42, 0), 27: (0.1, -0.84, 0), 31: (0.1, -0.9, 0.14)}
        head = {7: (0.08, 0.62, 0)}
        places |= {number + first: (side * x, y, z) for number, (x, y, z) in {**arm, **leg, **head}.items()}
    places |= {int(number[1:]): place for number, place in moved.items()}
    return [{"x": x, "y": -y, "z": -z} for _, (x, y, z) in sorted(places.items())]


def test_the_example_of_a_webcam_follows_a_persons_landmarks(opened: Open) -> None:
    """With a stand-in for MediaPipe, whose models a page fetches from elsewhere."""
    page = opened(person_site("webcam.html", **{"vision/vision_bundle.js": STAND_IN.encode()}), before=CAMERA)
    page.evaluate(f"(globalThis.seen = {json.dumps(landmarks())}, document.querySelector('button').click(), 0)")
    page.wait(f"Boolean({ENTRY}.live)")
    at_rest = followed(page)
    bound = dict(zip(PERSON.names, PERSON.world(PERSON.bind_rotations, PERSON.bind_translations)[1], strict=True))
    for name in ("LeftHand", "RightHand", "LeftFoot", "RightFoot"):
        np.testing.assert_allclose(at_rest[name], bound[name], atol=0.05)
    raised = landmarks(_13=(0.18, 0.73, 0), _15=(0.18, 0.97, 0))  # the left arm straight up
    before = page.evaluate(f"{ENTRY}.live.version")
    page.evaluate(f"(globalThis.seen = {json.dumps(raised)}, 0)")
    page.wait(f"{ENTRY}.live.version > {before}")
    up = followed(page)
    assert up["LeftHand"][1] - up["LeftArm"][1] > 0.45
    np.testing.assert_allclose(up["RightHand"], at_rest["RightHand"], atol=0.02)
    page.evaluate("(globalThis.seen = null, 0)")  # nobody before the camera
    page.wait(f"!{ELEMENT}.player.moving")
    assert followed(page)["LeftHand"][1] == pytest.approx(up["LeftHand"][1])
    assert page.evaluate("document.querySelector('#says').textContent") == ""


def test_the_example_of_bones_follows_a_figure_of_three(opened: Open, tmp_path: Path) -> None:
    source = person(size=1.2)
    clip = moving(source)
    made = animated(source, clip)
    made.json["skins"] = [{"joints": list(range(len(source.names)))}]  # which are bones to three.js
    figure = made.save(tmp_path / "figure.glb")
    page = opened(person_site("bones.html", **{"figure.glb": figure}))
    page.wait(f"{ENTRY}.live?.version > 2")
    found = followed(page)
    [loaded] = load_motions(figure, PERSON, mapping=None, rate=clip.rate, feet="keep")
    _, at = PERSON.world(loaded.clip.rotations, loaded.clip.translations)
    hips = PERSON.names.index("Hips")
    shape = np.stack([found[name] - found["Hips"] for name in PERSON.names])
    apart = np.abs((at - at[:, [hips]]) - shape).max(axis=(1, 2))
    assert apart.min() < 0.03, "one of the clip's poses"  # between two of its frames
