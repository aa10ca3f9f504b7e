// What mouse, fingers, keys and dropped files ask for, with a canvas that is no more than its events.

import assert from "node:assert/strict";
import { test } from "node:test";
import { cameraOf } from "../../../python/mua/web/camera.js";
import { acceptFiles } from "../../../python/mua/web/drop.js";
import { listen } from "../../../python/mua/web/hands.js";
import { pressed } from "../../../python/mua/web/keys.js";

Object.assign(globalThis, { HTMLElement: class {}, HTMLInputElement: class {} });

const STEP = (0.4 / 180) * Math.PI; // radians of a pixel
const eventOf = (kind, given) => Object.assign(new Event(kind, { cancelable: true }), given);

function held() {
  const canvas = Object.assign(new EventTarget(), { setPointerCapture() {}, clientHeight: 100 });
  const camera = { azimuth: 0, elevation: 0, distance: 4, target: [0, 1, 0], fov: 0.5 };
  listen(canvas, { camera: () => camera, framed: () => 4, moved() {} });
  const pointer = (kind, pointerId, clientX, clientY, more = {}) =>
    canvas.dispatchEvent(
      eventOf(`pointer${kind}`, { pointerId, clientX, clientY, buttons: 1, shiftKey: false, ...more }),
    );
  const wheel = (given) => canvas.dispatchEvent(eventOf("wheel", { deltaMode: 0, ...given }));
  return { camera, pointer, wheel };
}

test("one finger turns, and another one that the browser took away moves nothing", () => {
  const { camera, pointer } = held();
  pointer("down", 1, 10, 10);
  pointer("cancel", 1, 10, 10); // the page scrolls
  pointer("move", 1, 10, 50);
  assert.equal(camera.elevation, 0);
  pointer("down", 2, 10, 10);
  pointer("move", 2, 20, 15);
  assert.ok(Math.abs(camera.azimuth + 10 * STEP) < 1e-12);
  assert.ok(Math.abs(camera.elevation - 5 * STEP) < 1e-12);
  pointer("up", 2, 20, 15);
  pointer("move", 2, 90, 90);
  assert.deepEqual([camera.distance, camera.target], [4, [0, 1, 0]]);
});

test("two fingers zoom as they go apart and move aside together", () => {
  const { camera, pointer } = held();
  pointer("down", 1, 0, 0);
  pointer("down", 2, 40, 0);
  pointer("move", 2, 80, 0);
  assert.ok(Math.abs(camera.distance - 2) < 1e-9);
  assert.equal(camera.azimuth, 0);
  assert.ok(camera.target[0] < 0);
});

test("the right button and shift move aside: what is at the target stays under the hand", () => {
  for (const aside of [{ buttons: 2 }, { shiftKey: true }])
    for (const [azimuth, elevation] of [
      [0, 0],
      [0.6, 0.9],
    ]) {
      const { camera, pointer } = held();
      Object.assign(camera, { azimuth, elevation });
      const { view, projection } = cameraOf(camera, [100, 100]);
      pointer("down", 1, 50, 50, aside);
      pointer("move", 1, 40, 75, aside);
      const moved = [0, 1, 2].map((i) => [0, 1, 0][i] - camera.target[i]); // what was at the target, from the new one
      const [x, y, z] = [0, 4, 8].map((row) => moved.reduce((sum, at, i) => sum + view[row + i] * at, 0));
      const slopes = [x * projection[0], y * projection[5]].map((at) => (at / (camera.distance - z)) * 50);
      assert.deepEqual([slopes.map((at) => at.toFixed(6)), camera.azimuth], [["-10.000000", "-25.000000"], azimuth]);
    }
});

test("however far a hand goes, up stays up", () => {
  for (const [below, steepest] of [
    [1000, 89],
    [-1000, -89],
  ]) {
    const { camera, pointer } = held();
    pointer("down", 1, 0, 0);
    pointer("move", 1, 0, below);
    assert.ok(Math.abs(camera.elevation - (steepest / 180) * Math.PI) < 1e-12);
  }
});

test("a wheel zooms by its notches, in pixels or in lines", () => {
  for (const given of [{ deltaY: -100 }, { deltaY: -100 / 33, deltaMode: 1 }]) {
    const { camera, wheel } = held();
    wheel(given);
    assert.ok(Math.abs(camera.distance - 4 / 1.15) < 1e-9);
  }
});

test("shift and each arrow turn as a drag that way does", () => {
  const turns = [];
  const avatar = { turn: (...by) => turns.push(by) };
  const keyed = (key, more) =>
    pressed(Object.assign(eventOf("keydown", { key, shiftKey: true, composedPath: () => [{}] }), more), avatar);
  for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"]) assert.equal(keyed(key), true);
  assert.deepEqual(turns, [
    [-20, 0],
    [20, 0],
    [0, -20],
    [0, 20],
  ]);
  for (const other of ["ctrlKey", "metaKey", "altKey"]) assert.equal(keyed("ArrowUp", { [other]: true }), false);
  assert.equal(turns.length, 4);
});

test("arrows alone go a frame back and on", () => {
  const steps = [];
  for (const key of ["ArrowLeft", "ArrowRight"])
    pressed(eventOf("keydown", { key, composedPath: () => [{}] }), { step: (frames) => steps.push(frames) });
  assert.deepEqual(steps, [-1, 1]);
});

test("plus goes nearer, with and without the shift key, and minus farther", () => {
  const zooms = [];
  for (const key of ["+", "=", "-"])
    pressed(eventOf("keydown", { key, composedPath: () => [{}] }), { zoom: (notches) => zooms.push(notches) });
  assert.deepEqual(zooms, [1, 1, -1]);
});

test("a list or a field that has the focus keeps its letters", () => {
  for (const kind of ["select", "input", "textarea"]) {
    const focus = Object.assign(new HTMLElement(), { matches: (names) => names.split(", ").includes(kind) });
    const event = eventOf("keydown", { key: "c", composedPath: () => [focus] });
    assert.equal(pressed(event, { nextClip: () => assert.fail(kind) }), false);
  }
});

test("files that are dropped are shown, and the mark of dropping goes with them", () => {
  const marks = new Set();
  const classList = { toggle: (name, is) => void (is ? marks.add(name) : marks.delete(name)) };
  const added = [];
  const avatar = Object.assign(new EventTarget(), { classList, add: (...files) => added.push(files) });
  acceptFiles(avatar);
  const over = eventOf("dragover", { dataTransfer: { types: ["Files"] } });
  avatar.dispatchEvent(over);
  assert.deepEqual([[...marks], over.defaultPrevented], [["dropping"], true]);
  const drop = eventOf("drop", { dataTransfer: { files: ["a", "b"] } });
  avatar.dispatchEvent(drop);
  assert.deepEqual(
    [[...marks], added, drop.defaultPrevented],
    [[], [["a", "b"]], true],
    "else the browser opens the file",
  );
  const text = eventOf("dragover", { dataTransfer: { types: ["text/plain"] } });
  avatar.dispatchEvent(text);
  assert.deepEqual([marks.size, text.defaultPrevented], [0, false]);
  avatar.dispatchEvent(over);
  avatar.dispatchEvent(eventOf("dragleave", {}));
  assert.equal(marks.size, 0);
});
