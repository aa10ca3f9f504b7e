// What <mua-avatar> does for a page and its reader, with a player that notes what it is asked for.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { page, settled, shown } from "./dom.mjs";
import { box } from "./page.mjs";

const { MuaAvatar } = await import("../../../python/mua/web/element.js");
const { Engine } = await import("../../../python/mua/web/engine.js");
const { KEYS, pressed } = await import("../../../python/mua/web/keys.js");

const CLIPS = [
  { name: "walk", frames: 4, seconds: 0.4 },
  { name: "wave", frames: 2, seconds: 0.2 },
];
let players; // that were opened
let refused; // addresses that cannot be loaded

class FakePlayer {
  avatars = [];
  clips = [];
  clip = "walk";
  time = 0;
  playing = true;
  speed = 1;
  level = "auto";
  budget = null;
  stereo = false;
  follow = false;
  vr = false;
  show = {};
  camera = { azimuth: 0, elevation: 0, distance: 1, target: [0, 0, 0], fov: 0.5 };
  milliseconds = {};
  adapter = "";
  drawn = 0;
  framed = [];
  disposed = false;

  async load(source) {
    if (refused.some((end) => String(source).endsWith(end))) throw new Error("no such file");
    const handle = {
      name: String(source).split("/").at(-1),
      notes: "",
      clips: CLIPS,
      splats: 5,
      bounds: box(1),
      levels: [64, 32, 16],
      outsideTraining: 0.25,
    };
    handle.remove = () => (this.avatars = this.avatars.filter((each) => each !== handle));
    this.avatars.push(handle);
    this.clips = CLIPS;
    return handle;
  }

  frameAll(chosen) {
    this.framed.push(chosen);
    this.camera.distance = 4;
  }

  async draw() {
    this.drawn += 1;
  }

  start() {}

  stop() {}

  dispose() {
    this.disposed = true;
  }
}

beforeEach(() => {
  [players, refused, page.frames, page.lessMotion] = [[], [], [], false];
  Engine.create = async () => players[players.push(new FakePlayer()) - 1];
});

/** An element with these attributes in the page, once all that it names is loaded. */
async function begun(attributes = { src: "a" }, before = () => {}) {
  const element = new MuaAvatar();
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  before(element);
  connect(element);
  for (let i = 0; i < 5; i++) await settled();
  return { element, player: players.at(-1), part: (selector) => element.parts.get(selector) };
}

function connect(element) {
  element.isConnected = true;
  element.connectedCallback();
}

function disconnect(element) {
  element.isConnected = false;
  element.disconnectedCallback();
}

test("an element that is moved in the page keeps its player, one that is taken out gives it back", async () => {
  const { element, player } = await begun();
  disconnect(element);
  connect(element);
  await settled();
  assert.deepEqual([player.disposed, element.player, players.length], [false, player, 1]);
  disconnect(element);
  await settled();
  assert.deepEqual([player.disposed, element.player], [true, null]);
  connect(element);
  for (let i = 0; i < 3; i++) await settled();
  assert.deepEqual([players.length, element.avatars.length], [2, 1]);
});

test("another src takes the place of the first, also where it is set before the element is in the page", async () => {
  const { element, player } = await begun({ src: "a" }, (one) => one.setAttribute("src", "b"));
  assert.deepEqual(
    player.avatars.map(({ name }) => name),
    ["b"],
  );
  element.src = "c";
  for (let i = 0; i < 5; i++) await settled();
  assert.deepEqual([player.disposed, element.avatars.map(({ name }) => name)], [true, ["c"]]);
});

for (const [asked, less, playing] of [
  [{ autoplay: "" }, false, true],
  [{ autoplay: "" }, true, false],
  [{}, false, false],
])
  test(`${"autoplay" in asked ? "autoplay" : "without it"}${less ? ", less motion wanted" : ""}: ${playing ? "plays" : "rests"}`, async () => {
    page.lessMotion = less;
    const { player } = await begun({ src: "a", ...asked });
    assert.equal(player.playing, playing);
  });

test("who wants less motion is not led round, others are", async () => {
  for (const less of [true, false]) {
    const { element, player } = await begun({ src: "a", orbit: "90" });
    page.lessMotion = less;
    element.play();
    await shown();
    await shown();
    assert.equal(player.camera.azimuth === 0, less);
    element.pause();
  }
});

test("what is asked before an avatar is there is done once it is", async () => {
  const early = await begun({ src: "a", autoplay: "" }, (element) => element.seek(0.3));
  assert.deepEqual([early.player.time, early.player.playing], [0.3, false]);
  const playing = await begun({ src: "a" }, (element) => element.play());
  assert.equal(playing.player.playing, true);
  await playing.element.add("b");
  assert.equal(playing.player.playing, true);
});

test("attributes that are there when an avatar comes count", async () => {
  const given = {
    clip: "wave",
    speed: "0.5",
    level: "32",
    budget: "900",
    stereo: "",
    follow: "",
    show: "template",
    azimuth: "90",
    elevation: "-45",
  };
  const { element, player } = await begun({ src: "a", ...given });
  const { clip, speed, level, budget, stereo, follow, show } = player;
  assert.deepEqual(
    { clip, speed, level, budget, stereo, follow },
    { clip: "wave", speed: 0.5, level: 32, budget: 900, stereo: true, follow: true },
  );
  assert.deepEqual(
    Object.keys(show).filter((name) => show[name]),
    ["template"],
  );
  assert.deepEqual([player.camera.azimuth, player.camera.elevation], [Math.PI / 2, -Math.PI / 4]);
  assert.deepEqual([element.clip, element.speed, element.level, element.show], ["wave", 0.5, 32, "template"]);
});

test("attributes that change later count at once and are drawn", async () => {
  const { element, player } = await begun();
  const changes = [
    ["clip", "wave"],
    ["speed", "2"],
    ["level", "full"],
    ["budget", "7"],
    ["stereo", ""],
    ["follow", ""],
  ];
  for (const [name, value] of changes) {
    const before = player.drawn;
    element.setAttribute(name, value);
    await shown();
    assert.equal(player.drawn, before + 1, name);
  }
  assert.deepEqual(
    [player.clip, player.speed, player.level, player.budget, player.stereo, player.follow],
    ["wave", 2, "full", 7, true, true],
  );
  element.setAttribute("azimuth", "180");
  element.setAttribute("elevation", "45");
  assert.deepEqual([player.camera.azimuth, player.camera.elevation], [Math.PI, Math.PI / 4]);
  element.removeAttribute("stereo");
  assert.equal(player.stereo, false);
});

test("what cannot be shown is said, and what is shown stays", async () => {
  const { element, player, part } = await begun();
  element.show = "splats,aura";
  assert.deepEqual([player.show.splats, player.show.shadow], [true, true]);
  assert.match(part(".says p").textContent, /aura.*cannot be shown/);
});

test("frames go round at both ends of a clip, and stepping pauses", async () => {
  const { element, player } = await begun();
  element.play();
  const frame = () => Math.round(player.time * 10);
  element.step(-1);
  assert.deepEqual([frame(), player.playing], [3, false]);
  element.step(1);
  assert.equal(frame(), 0);
  element.step(2);
  assert.equal(frame(), 2);
});

test("clips and levels come in turn and begin again after the last", async () => {
  const { element, player } = await begun();
  const turns = (act, read) => Array.from({ length: 5 }, () => (act(), read()));
  assert.deepEqual(
    turns(
      () => element.nextClip(),
      () => player.clip,
    ),
    ["wave", "walk", "wave", "walk", "wave"],
  );
  assert.deepEqual(
    turns(
      () => element.nextLevel(),
      () => player.level,
    ),
    ["full", 32, 16, "auto", "full"],
  );
});

test("the clip that plays begins anew where it is chosen again", async () => {
  const { element, player } = await begun();
  player.time = 0.3;
  element.clip = "walk";
  assert.equal(player.time, 0);
});

test("an avatar that is taken away leaves the others in the middle", async () => {
  const { element, player } = await begun({ src: "a b" });
  assert.deepEqual(
    player.avatars.map(({ place }) => place[0]),
    [-0.575, 0.575],
  );
  element.dismiss(player.avatars[0]);
  assert.deepEqual(
    player.avatars.map(({ name, place }) => [name, place]),
    [["b", [0, 0, 0]]],
  );
});

test("the poster is there until the first picture, which is reported once, as each avatar is", async () => {
  const reported = [];
  const { element, part } = await begun({ src: "a", poster: "p.png" }, (one) => {
    for (const kind of ["load", "picture", "error"]) one.addEventListener(kind, () => reported.push(kind));
    assert.deepEqual([one.parts.get(".poster").hidden, one.parts.get(".poster").src], [false, "p.png"]);
  });
  assert.equal(part(".poster").hidden, true);
  assert.ok(element.firstPicture > 0);
  refused.push("c");
  await element.add("b", "c");
  assert.deepEqual(reported, ["picture", "load", "load", "error"]);
});

test("a part can be shown and hidden", async () => {
  const { element } = await begun();
  assert.equal(element.show, "splats,shadow");
  element.toggle("skeleton");
  element.toggle("splats");
  assert.equal(element.show, "skeleton,shadow");
});

test("properties are attributes, and null, undefined and false take them away", () => {
  const element = new MuaAvatar();
  const numbers = ["budget", "azimuth", "elevation", "orbit", "speed"];
  const flags = ["autoplay", "controls", "stereo", "follow"];
  for (const [names, value, text] of [
    [numbers, 2.5, "2.5"],
    [["poster", "alt", "clip"], "x", "x"],
    [flags, true, ""],
  ])
    for (const name of names) {
      element[name] = value;
      assert.deepEqual([element.getAttribute(name), element[name]], [text, value], name);
      element[name] = value === true ? false : null;
      assert.equal(element.hasAttribute(name), false, name);
    }
  assert.deepEqual(
    [element.budget, element.azimuth, element.speed, element.stereo, element.alt],
    [null, 0, 1, false, ""],
  );
});

test("what was set before the browser knew the element counts", async () => {
  const { element, player } = await begun({}, (one) => {
    for (const [name, value] of [
      ["src", "a"],
      ["speed", 0.25],
      ["stereo", true],
    ])
      Object.defineProperty(one, name, { value, writable: true, configurable: true, enumerable: true });
  });
  assert.deepEqual([player.avatars.length, player.speed, player.stereo], [1, 0.25, true]);
  element.speed = 2;
  assert.equal(player.speed, 2);
});

/** A key that is pressed while a control has the focus; whether the element took it. */
function press(element, key, { focus = {}, ...held } = {}) {
  const event = Object.assign(new Event("keydown", { cancelable: true }), {
    key,
    ...held,
    composedPath: () => [focus],
  });
  return pressed(event, element) && event.defaultPrevented;
}

test("keys do what the panel says", async () => {
  const { element, player } = await begun({ src: "a b" });
  for (const [key, read, wanted] of [
    [" ", () => player.playing, true],
    ["ArrowLeft", () => [Math.round(10 * player.time), player.playing].join(), "3,false"],
    ["ArrowRight", () => Math.round(10 * player.time), 0],
    ["1", () => player.show.splats, false],
    ["2", () => player.show.geometry, true],
    ["3", () => player.show.template, true],
    ["4", () => player.show.skeleton, true],
    ["5", () => player.show.shadow, false],
    ["a", () => player.framed.at(-1)[0].name, "a"],
    ["s", () => player.stereo, true],
    ["f", () => player.follow, true],
    ["l", () => player.level, "full"],
    ["c", () => player.clip, "wave"],
    ["+", () => player.camera.distance < 4, true],
    ["r", () => player.camera.distance, 4],
    ["=", () => player.camera.distance < 4, true],
    ["-", () => Math.round(1000 * player.camera.distance), 4000],
  ]) {
    assert.equal(press(element, key), true, key);
    assert.equal(read(), wanted, `after ${key}`);
  }
  assert.deepEqual(
    Object.keys(KEYS).filter((key) => press(element, key, { ctrlKey: true })),
    [],
  );
});

test("shift and arrows turn as a drag does", async () => {
  const { element, player } = await begun();
  const turned = (key) => (
    press(element, key, { shiftKey: true }), [player.camera.azimuth, player.camera.elevation].map(Math.sign).join()
  );
  assert.equal(turned("ArrowLeft"), "1,0");
  assert.equal(turned("ArrowDown"), "1,1");
  assert.deepEqual([turned("ArrowRight"), turned("ArrowUp")], ["0,1", "0,0"]);
});

test("a control that has the focus keeps its keys", async () => {
  const { element } = await begun();
  const control = (tag, type) => Object.assign(type ? new HTMLInputElement() : new HTMLElement(), { tag, type });
  for (const [focus, kept, left] of [
    [control("input", "range"), ["ArrowLeft", "ArrowRight"], ["c", " "]],
    [control("input", "checkbox"), [" "], ["c", "ArrowLeft"]],
    [control("button"), [" "], ["c"]],
    [control("select"), ["c", " ", "ArrowLeft"], []],
    [Object.assign(control("p"), { isContentEditable: true }), ["c"], []],
    [control("p"), [], ["c", " "]],
  ]) {
    assert.deepEqual(
      kept.filter((key) => press(element, key, { focus })),
      [],
      focus.tag,
    );
    assert.deepEqual(
      left.filter((key) => !press(element, key, { focus })),
      [],
      focus.tag,
    );
  }
});

test("the controls do what they say", async () => {
  const { element, player, part } = await begun({ src: "a", controls: "" });
  const change = (selector, more) => Object.assign(part(selector), more).dispatchEvent(new Event("change"));
  assert.equal(part(".bar").hidden, false);
  part(".play").click();
  assert.equal(player.playing, true);
  part(".scrub").value = "0.2";
  part(".scrub").dispatchEvent(new Event("input"));
  assert.deepEqual([player.time, player.playing], [0.2, false]);
  change(".clips", { value: "wave" });
  change(".speed", { value: "0.5" });
  change(".level", { value: "32" });
  change(".stereo");
  change(".follow");
  assert.deepEqual(
    [player.clip, player.speed, player.level, player.stereo, player.follow],
    ["wave", 0.5, 32, true, true],
  );
  const template = element.toggles.find(({ name }) => name === "template");
  template.dispatchEvent(new Event("change"));
  assert.equal(player.show.template, true);
  part(".reset").click();
  assert.equal(player.framed.length, 2);
});

test("the controls show what is shown and how it plays", async () => {
  const { element, player, part } = await begun();
  Object.assign(player, { speed: 0.5, clip: "wave", level: 32, stereo: true, follow: true, time: 0.1 });
  element.play();
  assert.deepEqual(
    [".speed", ".clips", ".level", ".scrub", ".scrub"].map((name, i) => part(name)[i === 4 ? "max" : "value"]),
    ["0.5", "wave", "32", "0.1", "0.2"],
  );
  assert.deepEqual(
    [part(".stereo").checked, part(".follow").checked, part(".play").getAttribute("aria-label")],
    [true, true, "Pause"],
  );
  assert.deepEqual(
    part(".clips").options.map(({ value }) => value),
    ["walk", "wave"],
  );
  assert.deepEqual(
    element.toggles.filter(({ checked }) => checked).map(({ name }) => name),
    ["splats", "shadow"],
  );
  assert.deepEqual(
    [part(".clock").textContent, part(".outside").textContent],
    ["0.1 / 0.2 s", "Outside of training: 25 %"],
  );
  assert.equal(part(".bar").hidden, true);
});

test("the picture is described to those who cannot see it", async () => {
  const { element, part } = await begun({ src: "a b" });
  const label = () => part("canvas").getAttribute("aria-label");
  assert.equal(label(), "a, b");
  element.alt = "Two dancers";
  assert.equal(label(), "Two dancers");
});

test("a file that was chosen is shown and may be chosen again; the list takes it away", async () => {
  const { element, part } = await begun();
  Object.assign(part(".file"), { files: ["chosen"], value: "chosen" }).dispatchEvent(new Event("change"));
  for (let i = 0; i < 3; i++) await settled();
  assert.deepEqual([element.avatars.map(({ name }) => name), part(".file").value], [["a", "chosen"], ""]);
  const [item] = part(".avatars").children;
  item.children[1].click();
  assert.deepEqual([element.avatars.map(({ name }) => name), part(".avatars").children.length], [["chosen"], 1]);
});

test("a file that fails is said beside what is shown, and the sentence can be closed", async () => {
  const { element, part } = await begun();
  refused.push("b");
  await element.add("b");
  assert.equal(part(".says p").textContent, "The avatar cannot be shown: no such file.");
  assert.deepEqual([part(".says").hidden, part(".close").hidden, part(".again").hidden], [false, false, true]);
  part(".close").click();
  assert.equal(part(".says").hidden, true);
});

test("a file that fails alone can be tried again", async () => {
  refused.push("a");
  const { element, part } = await begun();
  assert.deepEqual([part(".again").hidden, element.avatars], [false, []]);
  refused.length = 0;
  part(".again").click();
  for (let i = 0; i < 5; i++) await settled();
  assert.deepEqual([element.avatars.length, part(".says").hidden], [1, true]);
});

test("the panel opens by its button and closes by Escape, which gives the button the focus", async () => {
  const { part } = await begun();
  part(".panel").hidden = true;
  part(".settings").click();
  assert.deepEqual([part(".panel").hidden, part(".settings").getAttribute("aria-expanded")], [false, "true"]);
  part(".panel").dispatchEvent(Object.assign(new Event("keydown"), { key: "Escape" }));
  assert.deepEqual([part(".panel").hidden, part(".settings").focused], [true, true]);
});
