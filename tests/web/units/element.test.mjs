// <mua-avatar> from its attributes to its player: a page, a device and files are stand-ins, the engine is the player's own.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { checkbox, display, page, part, place, settled, told } from "./dom.mjs";

const { Engine } = await import("../../../python/mua/web/engine.js");
const { Renderer } = await import("../../../python/mua/web/renderer.js");
const { read } = await import("../../../python/mua/web/format/read.js");
const { MuaAvatar } = await import("../../../python/mua/web/element.js");

const content = readFileSync(new URL("../../golden/expressions.muaavatar", import.meta.url));
const golden = await read(Uint8Array.from(content).buffer);
const [wave] = golden.clips;
const [RATE, FRAMES] = [24, 5]; // of the file's clip, as it plays
const DEGREE = Math.PI / 180;

/** A device that has drawn as soon as it is asked to. */
class FakeRenderer {
  ready = true;
  closed = new AbortController();
  timing = { milliseconds: {} };
  device = {
    name: "none",
    since: 0,
    whenLost() {},
    gpu: Object.assign(new EventTarget(), { queue: { async onSubmittedWorkDone() {} } }),
  };
  async add() {
    return { frame: { outside: 0.4 }, memory: {} };
  }
  draw() {
    pictures += 1;
  }
  displays() {}
  lookAhead() {}
  remove() {}
  destroy() {
    destroyed += 1;
  }
}

let pictures, destroyed;
Renderer.open = async () => new FakeRenderer();
Engine.prototype.load = async function (source) {
  const name = String(source.name ?? source)
    .split("/")
    .at(-1);
  const avatar = { ...golden, name, clips: ["wave", "bow"].map((each) => ({ ...wave, name: each })) };
  return (await this.put(avatar, null, true)).handle;
};

/** Wait until an element shows so many avatars. */
async function loaded(element, count) {
  for (let i = 0; i < 100 && !(element.loaded && element.avatars.length === count); i++) await settled();
  for (let i = 0; i < 5; i++) await settled(); // and has drawn them
  assert.equal(element.avatars.length, count);
}

/** An element in the page, and its events. */
async function shown(attributes = { src: "a" }, before = () => {}) {
  const element = new MuaAvatar();
  const events = [];
  for (const kind of ["load", "picture", "play", "pause", "error"])
    element.addEventListener(kind, ({ detail }) => events.push(kind === "error" ? detail.message : kind));
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  before(element);
  place(element, true);
  await loaded(element, (element.getAttribute("src") ?? "").split(" ").filter(Boolean).length);
  return Object.assign(element, { events });
}

const frameOf = ({ player }) => Math.floor(player.time * RATE + 1e-6);

beforeEach(() => {
  [pictures, destroyed, page.lessMotion] = [0, 0, false];
  page.rest(); // elements of other tests
});

test("it plays as soon as it is loaded where autoplay says so, and the reader wants motion", async () => {
  for (const [lessMotion, attributes, plays] of [
    [false, { src: "a", autoplay: "" }, true],
    [true, { src: "a", autoplay: "" }, false],
    [false, { src: "a" }, false],
  ]) {
    page.lessMotion = lessMotion;
    const { player, events } = await shown(attributes);
    assert.deepEqual([player.playing, events.includes("play")], [plays, plays]);
  }
});

test("each avatar is told of, the first picture once, and the poster goes with it", async () => {
  const element = await shown({ src: "a b", poster: "p.png" });
  assert.deepEqual(element.events.toSorted(), ["load", "load", "picture"]);
  const poster = part(element, ".poster");
  assert.deepEqual([poster.src, poster.hidden], ["p.png", true]);
  const empty = await shown({});
  empty.poster = "q.png";
  assert.deepEqual([part(empty, ".poster").src, part(empty, ".poster").hidden], ["q.png", false]);
  const first = element.firstPicture;
  await element.add("c");
  assert.equal(element.firstPicture, first);
  assert.equal(element.events.filter((kind) => kind === "picture").length, 1);
});

test("what attributes and the page ask before an avatar is there counts when it is", async () => {
  const asks = { clip: "bow", speed: "0.5", level: "16", stereo: "", budget: "9", azimuth: "30", elevation: "10" };
  const element = await shown({ src: "a", show: "splats,skeleton", ...asks }, (element) => {
    element.seek(2 / RATE);
    element.setExpressions({ jawOpen: 0.25 });
    element.setExpressions({ eyeBlinkLeft: 0.75 });
  });
  const { player } = element;
  assert.deepEqual(
    [player.clip, player.speed, player.level, player.stereo, player.budget, frameOf(element), player.playing],
    ["bow", 0.5, 16, true, 9, 2, false],
  );
  assert.deepEqual(element.show, "splats,skeleton");
  assert.deepEqual([player.camera.azimuth, player.camera.elevation], [30 * DEGREE, 10 * DEGREE]);
  assert.deepEqual([...player.entries[0].weights].slice(0, 2), [0.25, 0.75]);
});

test("a reader who paused is not made to watch by another avatar, and stays where he is", async () => {
  const element = await shown({ src: "a", autoplay: "" }, (element) => element.seek(0.1));
  assert.equal(element.player.playing, false);
  element.seek(3 / RATE);
  await element.add("b");
  assert.deepEqual([element.player.playing, frameOf(element)], [false, 3]);
});

test("frames go round at both ends of a clip, clips and levels after the last", async () => {
  const element = await shown();
  for (const [frames, wanted] of [
    [-1, FRAMES - 1],
    [1, 0],
    [1, 1],
    [-2, FRAMES - 1],
  ]) {
    element.step(frames);
    assert.equal(frameOf(element), wanted);
  }
  const clips = [0, 1].map(() => (element.nextClip(), element.clip));
  assert.deepEqual(clips, ["bow", "wave"]);
  const levels = [0, 1, 2, 3].map(() => (element.nextLevel(), element.player.level));
  assert.deepEqual(levels, ["full", 16, 8, "auto"]);
});

test("a page learns where an avatar is", async () => {
  const [{ bounds, levels, splats }] = (await shown()).avatars;
  assert.deepEqual(
    bounds,
    [golden.bounds.slice(0, 3), golden.bounds.slice(3)].map((corner) => Array.from(corner)),
  );
  assert.deepEqual([levels, splats], [[32, 16, 8], golden.texels.texels.length]);
});

test("seeking pauses, and the clip that plays starts over where it is chosen again", async () => {
  const element = await shown({ src: "a", autoplay: "" });
  element.seek(3 / RATE);
  assert.deepEqual([frameOf(element), element.player.playing], [3, false]);
  element.clip = "wave";
  assert.equal(element.player.time, 0);
});

test("each view is shown or hidden for itself", async () => {
  const element = await shown();
  element.toggle("template");
  assert.equal(element.show, "splats,template,shadow");
  element.toggle("splats");
  assert.deepEqual([element.show, element.player.show.splats], ["template,shadow", false]);
});

test("where one avatar is taken away, the other one stands in the middle", async () => {
  const element = await shown({ src: "a b" });
  assert.notEqual(element.avatars[1].place[0], 0);
  element.dismiss(element.avatars[0]);
  assert.deepEqual(
    element.avatars.map(({ name, place }) => [name, place]),
    [["b", [0, 0, 0]]],
  );
  assert.equal(part(element, ".avatars").children.length, 1);
});

test("an element that is moved keeps its player, one that leaves gives it back and loads again when it returns", async () => {
  const element = await shown();
  const { player } = element;
  place(element, false);
  for (let i = 0; i < 9; i++) await null; // as pages are that libraries put together again
  place(element, true);
  await settled();
  assert.deepEqual([element.player, destroyed], [player, 0]);
  place(element, false);
  await settled();
  assert.deepEqual([element.player, destroyed], [null, 1]);
  place(element, true);
  await loaded(element, 1);
});

test("another src takes the place of the first", async () => {
  const element = await shown();
  element.src = "b c";
  await loaded(element, 2);
  assert.deepEqual([element.avatars.map(({ name }) => name), destroyed], [["b", "c"], 1]);
});

test("attributes from which the camera looks count afterwards too", async () => {
  const element = await shown();
  for (const name of ["azimuth", "elevation"]) {
    element[name] = 20;
    assert.equal(element.player.camera[name], 20 * DEGREE);
  }
});

test("it goes round while it plays, and not where less motion is wanted", async () => {
  const element = await shown({ src: "a", orbit: "90" });
  element.play();
  for (const [lessMotion, turns] of [
    [true, false],
    [false, true],
  ]) {
    page.lessMotion = lessMotion;
    const before = element.player.camera.azimuth;
    await display(3, 50);
    assert.equal(element.player.camera.azimuth > before, turns);
  }
  element.pause();
  element.setPose({}); // which moves it, though no clip plays
  const { azimuth } = element.player.camera;
  await display(3, 50);
  assert.equal(element.player.camera.azimuth, azimuth);
});

test("the canvas has the pixels of the screen, two a side at most", async () => {
  const { width, height } = part(await shown(), "canvas");
  assert.deepEqual([width, height], [200, 100]);
});

test("properties are those of attributes, none where they are left out, and may be set before the class is known", async () => {
  const element = await shown({}, (element) =>
    Object.defineProperty(element, "src", { value: "b", configurable: true, writable: true }),
  );
  assert.deepEqual([element.getAttribute("src"), element.avatars[0].name], ["b", "b"]);
  element.src = "c"; // through the class again
  assert.equal(element.getAttribute("src"), "c");
  assert.deepEqual([element.budget, element.framebudget, element.orbit, element.stereo], [null, null, 0, false]);
  Object.assign(element, { budget: 5, stereo: true });
  assert.deepEqual([element.getAttribute("budget"), element.getAttribute("stereo")], ["5", ""]);
  Object.assign(element, { budget: null, stereo: false });
  assert.deepEqual([element.hasAttribute("budget"), element.hasAttribute("stereo")], [false, false]);
});

test("a clip that is not there is a sentence", async () => {
  const { events } = await shown({ src: "a", clip: "jump" });
  assert.ok(events.includes('clip="jump": a has no such clip, only wave, bow.'));
});

test("the controls play, seek, choose and say what is shown", async () => {
  const element = await shown({ src: "a", controls: "", alt: "A dancer" });
  const { player } = element;
  const use = (name, kind, value) => told(Object.assign(part(element, name), { value }), kind);
  use(".play", "click");
  assert.deepEqual([player.playing, part(element, ".play").getAttribute("aria-label")], [true, "Pause"]);
  use(".scrub", "input", "0.125");
  assert.deepEqual([player.time.toFixed(6), player.playing], ["0.125000", false]);
  assert.equal(part(element, ".clock").textContent, "0.1 / 0.2 s");
  assert.deepEqual(
    [part(element, ".scrub").max, part(element, ".scrub").value],
    [String(FRAMES / RATE), String(player.time)],
  );
  for (const [name, field, value, wanted] of [
    [".clips", "clip", "bow", "bow"],
    [".speed", "speed", "0.25", 0.25],
    [".level", "level", "16", 16],
  ]) {
    use(name, "change", value);
    assert.deepEqual([player[field], part(element, name).value], [wanted, value]);
  }
  player.speed = 1.5;
  element.toggleStereo();
  assert.deepEqual([part(element, ".speed").value, part(element, ".stereo").checked], ["1.5", true]);
  told(checkbox(element, "template"), "change");
  assert.equal(player.show.template, true);
  assert.equal(part(element, "canvas").getAttribute("aria-label"), "A dancer");
  assert.equal(part(element, ".outside").textContent, "Outside of training: 40 %");
});

test("all files that are chosen or dropped are shown, and may be chosen again", async () => {
  const element = await shown({});
  const files = ["c", "d"].map((name) => new File([], name));
  const chosen = Object.assign(part(element, ".file"), { files, value: "c" });
  told(chosen, "change");
  await loaded(element, 2);
  told(element, "drop", { dataTransfer: { files: [new File([], "e"), new File([], "f")] } });
  await loaded(element, 4);
  assert.deepEqual([element.avatars.map(({ name }) => name), chosen.value], [["c", "d", "e", "f"], ""]);
});

test("escape closes the panel and gives the focus back", async () => {
  const element = await shown();
  const panel = part(element, ".panel");
  panel.hidden = true;
  part(element, ".settings").click();
  assert.equal(panel.hidden, false);
  told(panel, "keydown", { key: "Escape" });
  assert.deepEqual([panel.hidden, document.activeElement], [true, part(element, ".settings")]);
});

test("a picture is saved under the avatar's name", async () => {
  const element = await shown();
  element.player.screenshot = async () => new Blob([]);
  const { make } = page;
  const links = [];
  page.make = () => links[links.push(make()) - 1];
  globalThis.setTimeout = (
    (later) => (act, wait) =>
      wait ? 0 : later(act)
  )(setTimeout);
  await element.savePicture();
  page.make = make;
  assert.equal(links[0].download, "a.png");
});

test("a paused avatar is drawn again where something changes, and only then", async () => {
  const element = await shown();
  await display(3);
  const before = pictures;
  await display(3);
  assert.equal(pictures, before);
  element.turn(10, 0);
  await display(3);
  assert.equal(pictures, before + 1);
});
