"""Images that are drawn while kernels are still being compiled: the same, and none of what has gone meanwhile."""

import json
from pathlib import Path

import numpy as np
import pytest
from web.browser import Page
from web.engine import Open, load, opened, small
from web.test_modules import node, pytestmark

from mua.arrays import Array
from mua.kernels.splat_project import HIDDEN
from mua.kernels.splat_sort import splat_sort

__all__ = ["opened", "pytestmark", "small"]  # fixtures, and what the tests need
NONE = np.zeros(0, np.uint16)
# Of kernels with a name, which are compiled when a test says so; and what the page has waited for, and drawn.
HELD = """const create = GPUDevice.prototype.createComputePipelineAsync;
GPUDevice.prototype.createComputePipelineAsync = async function (described) {
  const made = await create.call(this, described);
  if (described.label === "NAME") await new Promise((resolve) => (globalThis.release = resolve));
  return made;
};
globalThis.waitedFor = [];
const createNow = GPUDevice.prototype.createComputePipeline;
GPUDevice.prototype.createComputePipeline = function (described) {
  waitedFor.push(described.label);
  return createNow.call(this, described);
};
globalThis.pictures = 0;
const draw = GPUCanvasContext.prototype.getCurrentTexture;
GPUCanvasContext.prototype.getCurrentTexture = function () { pictures += 1; return draw.call(this); };
globalThis.words = async (name) => {
  const { device, splats } = player.renderer;
  const size = splats[name].size;
  const read = device.gpu.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.gpu.createCommandEncoder();
  encoder.copyBufferToBuffer(splats[name], 0, read, 0, size);
  device.gpu.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  return Array.from(new Uint32Array(read.getMappedRange()));
};"""

# Something is changed as soon as the page begins to read from the device.
CHANGING = """(() => {
  const map = GPUBuffer.prototype.mapAsync;
  GPUBuffer.prototype.mapAsync = function (...given) {
    const mapping = map.apply(this, given);
    if (!globalThis.changed) { globalThis.changed = true; CHANGE; }
    return mapping;
  };
})()"""


@pytest.mark.parametrize(
    "keys",
    [
        NONE,
        np.array([HIDDEN, HIDDEN], np.uint16),
        np.array([0, HIDDEN - 1, 0, HIDDEN, 3], np.uint16),
        np.random.default_rng(1).integers(0, 1 << 16, 5000).astype(np.uint16),
        np.random.default_rng(2).integers(7, 10, 999).astype(np.uint16),
    ],
    ids=["none", "hidden", "ends", "many", "ties"],
)
def test_the_processor_sorts_as_the_reference_does(tmp_path: Path, keys: Array) -> None:
    (tmp_path / "keys.json").write_text(json.dumps(keys.tolist()))
    np.testing.assert_array_equal(node("order", tmp_path / "keys.json")[0], splat_sort(keys))


def sorted_splats(page: Page) -> list[int]:
    """What is drawn, back to front."""
    vertices = page.evaluate("words('arguments')")
    order: list[int] = page.evaluate("words('order')")
    assert vertices[0] in (3 * vertices[4], 6 * vertices[4])
    assert vertices[1:4] == [1, 0, 0]
    return order[: vertices[4]]


def test_the_first_picture_waits_for_no_kernel_that_sorts(opened: Open, small: Path) -> None:
    page = opened(before=HELD.replace("NAME", "ScatterDigits"), a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("player.draw()")
    early = sorted_splats(page)
    assert page.evaluate("[pictures, player.renderer.ready]") == [1, False]
    page.wait("globalThis.release")
    page.evaluate("release()")
    page.wait("player.renderer.ready")
    page.evaluate("player.renderer.device.write(player.renderer.splats.order, new Uint32Array(99))")
    page.evaluate("player.draw()")
    assert sorted_splats(page) == early
    assert len(set(early)) == len(early) > 99
    assert page.evaluate("waitedFor") == []


def test_an_avatar_plays_while_kernels_are_compiled(opened: Open, small: Path) -> None:
    page = opened(before=HELD.replace("NAME", "ScatterDigits"), a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("player.playing = true")
    page.evaluate("player.start()")
    page.wait("pictures > 2")
    assert page.evaluate("[player.renderer.ready, player.time > 0, waitedFor, faults]") == [False, True, [], []]


def test_a_screenshot_waits_for_all_kernels(opened: Open, small: Path) -> None:
    page = opened(before=HELD.replace("NAME", "ScatterDigits"), a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("void player.screenshot().then((made) => (globalThis.made = made))")
    page.wait("globalThis.release")
    assert page.evaluate("globalThis.made ?? null") is None
    page.evaluate("release()")
    page.wait("globalThis.made?.size > 0")
    assert page.evaluate("waitedFor") == []


@pytest.mark.parametrize(
    ("change", "drawn"),
    [
        *(("avatar.remove()", 0), ("player.dispose()", 0), ("player.canvas.width = 100", 0)),
        *(("player.canvas.height = 100", 0), ("0", 1)),
    ],
    ids=["removed", "disposed of", "wider", "higher", "nothing"],
)
def test_what_has_changed_meanwhile_is_not_drawn(opened: Open, small: Path, change: str, drawn: int) -> None:
    page = opened(before=HELD.replace("NAME", "SplatProject"), a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("void player.draw().then(() => (globalThis.done = true))")
    page.wait("globalThis.release")
    page.evaluate(CHANGING.replace("CHANGE", change))
    page.evaluate("release()")
    page.wait("globalThis.done")
    assert page.evaluate("[changed, pictures, faults]") == [True, drawn, []]
