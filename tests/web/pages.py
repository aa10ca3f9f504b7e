"""The player's page with a stand-in for the engine (fake_player.js), whose avatars are lines of JSON."""

import json
from collections.abc import Sequence
from pathlib import Path

from mua.share.site import PAGE, Content, Shown, page, player_files

FAKE = Path(__file__).parent / "fake_player.js"
CLIPS = [{"name": "walk", "seconds": 2.0, "frames": 60}, {"name": "wave", "seconds": 4.0, "frames": 120}]
# The parts of the element, by what they are called in element.js.
ELEMENT = "document.querySelector('mua-avatar')"
SHADOW = f"{ELEMENT}.shadowRoot"
SENTENCE = f"({SHADOW}.querySelector('.says').hidden ? '' : {SHADOW}.querySelector('.says p').textContent)"
# A device whose loss a test can bring about.
LOSABLE = """Object.defineProperty(GPUDevice.prototype, "lost", { get() {
  globalThis.lose = (reason) => { this.destroy(); this.reported({ reason, message: "" }); };
  return (this.losing ??= new Promise((resolve) => { this.reported = resolve; }));
} });"""
# How often the page asked for a device, and for what has to be compiled.
COUNTED = """globalThis.asked = {};
for (const [kind, name] of [[GPUAdapter, "requestDevice"], [GPUDevice, "createShaderModule"],
  ...["Compute", "Render"].flatMap((of) => ["", "Async"].map((end) => [GPUDevice, `create${of}Pipeline${end}`]))]) {
  const made = kind.prototype[name];
  asked[name] = 0;
  kind.prototype[name] = function (...given) { asked[name] += 1; return made.apply(this, given); };
}"""


def avatar(name: str, clips: Sequence[object] = CLIPS, **more: object) -> bytes:
    """An avatar as the stand-in reads it."""
    return json.dumps({"name": name, "clips": clips, **more}).encode()


def fake_site(attributes: dict[str, str] | None = None, **files: Content) -> dict[str, Content]:
    """The page with so many attributes of its element, and avatars by their names."""
    given = {"src": "hero.muaavatar"} if attributes is None else attributes
    found = {"hero": avatar("hero"), **files}
    site: dict[str, Content] = {**player_files(), "player.js": FAKE}
    site |= {f"{name}.muaavatar": content for name, content in found.items()}
    return {**site, PAGE: page(Shown("Hero"), given).encode()}
