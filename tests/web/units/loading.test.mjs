// How avatars come into an element, with a player that loads what the test says.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Engine } from "../../../python/mua/web/engine.js";
import { AvatarError } from "../../../python/mua/web/error.js";
import { Loading } from "../../../python/mua/web/loading.js";
import { FakeElement } from "./page.mjs";

Object.defineProperty(globalThis, "navigator", { value: { gpu: {} }, configurable: true });
globalThis.document = { baseURI: "http://host/folder/page.html" };

const settled = () => new Promise((done) => setTimeout(done));

let players; // that were opened
let opens; // what the next players come from: a promise or an error
let answers; // of the player to each source, by its name: what it does with the handle

class FakePlayer {
  avatars = [];
  playing = true;
  stopped = false;
  disposed = false;
  loaded = [];

  async load(source, { onProgress, onPart, signal }) {
    this.loaded.push(source);
    this.signal = signal;
    const handle = { splats: 5, remove: () => (this.avatars = this.avatars.filter((each) => each !== handle)) };
    const show = () => this.avatars.includes(handle) || this.avatars.push(handle);
    const part = (splats = 5) => (show(), onPart({ ...handle, splats }));
    try {
      await answers[String(source).split("/").at(-1)]?.({ onProgress, part });
    } catch (error) {
      handle.remove();
      throw error;
    }
    show();
    return handle;
  }

  stop() {
    this.stopped = true;
  }

  dispose() {
    this.disposed = true;
  }
}

/** A loading in an element, and all that it does to element, controls and page. */
function begun(attributes = {}) {
  const done = [];
  const say =
    (name) =>
    (...given) =>
      void done.push([name, ...given]);
  const element = new FakeElement(attributes);
  for (const name of ["load", "error", "progress"])
    element.addEventListener(name, ({ detail }) =>
      done.push([name, detail.message ?? detail.totalProgress ?? "handle"]),
    );
  const controls = Object.fromEntries(["load", "hush", "update", "say"].map((name) => [name, say(`controls.${name}`)]));
  Object.assign(controls, { canvas: {}, poster: { hidden: true } });
  const asks = {
    opened: say("opened"),
    show: async (first) => say("show")(first),
    withdraw: async () => say("withdraw")(),
    emptied: say("emptied"),
  };
  const loading = new Loading(element, controls, asks);
  Object.defineProperty(element, "player", { get: () => loading.player });
  const named = (name) => done.filter(([each]) => each === name).map(([, ...given]) => given);
  return { loading, element, controls, done, named };
}

beforeEach(() => {
  [players, answers, opens] = [[], {}, null];
  Engine.create = async () => {
    const made = new FakePlayer();
    players.push(made);
    await opens;
    return made;
  };
});

test("what src names is loaded one after the other, from where the page is", async () => {
  const { loading, named } = begun({ src: " a.muaavatar  ../b.muaavatar " });
  assert.equal(loading.begun, false);
  const loads = loading.reload();
  assert.equal(loading.begun, true);
  await loads;
  assert.deepEqual(
    players.map(({ loaded }) => loaded),
    [["http://host/folder/a.muaavatar", "http://host/b.muaavatar"]],
  );
  assert.equal(players[0].playing, false);
  assert.deepEqual([named("opened").length, named("load").length, named("controls.hush").length], [1, 2, 2]);
  assert.deepEqual(named("show"), [[true], [true]]);
});

test("the controls follow an avatar before the page hears of it", async () => {
  const { loading, done } = begun({ src: "a" });
  await loading.reload();
  assert.deepEqual(
    done.slice(-3).map(([name]) => name),
    ["controls.hush", "controls.update", "load"],
  );
});

test("an element whose src is taken away is empty and quiet", async () => {
  const { loading, element, named } = begun({ src: "a" });
  await loading.reload();
  delete element.attributes.src;
  await loading.reload();
  await settled();
  assert.equal(loading.player, null);
  assert.equal(players[0].disposed, true);
  assert.equal(named("controls.hush").length, 2);
});

test("files that a reader chose come back with another src, addresses do not", async () => {
  const { loading } = begun({ src: "a" });
  const file = { toString: () => "file" };
  await loading.add(["b", file]);
  await loading.reload();
  assert.deepEqual(players.at(-1).loaded, ["http://host/folder/a", file]);
});

test("a file that failed does not come back", async () => {
  const { loading } = begun({ src: "a" });
  const [good, bad] = ["good", "bad"].map((name) => ({ toString: () => name }));
  answers.bad = () => Promise.reject(new AvatarError("no"));
  await loading.add([good]);
  await loading.add([bad]);
  await loading.reload();
  assert.deepEqual(players.at(-1).loaded, ["http://host/folder/a", good]);
});

test("parts are drawn as they come, the first of them as the first", async () => {
  const { loading, named } = begun();
  answers.a = async ({ part }) => (part(), await settled(), part(), await settled());
  await loading.add(["a"]);
  assert.deepEqual(named("show"), [[true], [false], [false]]);
});

test("a mesh without splats does not take the place of a poster", async () => {
  const { loading, controls, named } = begun();
  answers.a = async ({ part }) => (part(0), await settled(), part(3), await settled());
  controls.poster.hidden = false;
  await loading.add(["a"]);
  assert.deepEqual(named("show"), [[true], [false]]);
  const bare = begun();
  await bare.loading.add(["a"]);
  assert.deepEqual(bare.named("show"), [[true], [false], [false]]);
});

test("an avatar of which a part was shown is withdrawn where the rest is damaged", async () => {
  const { loading, named } = begun();
  answers.a = async ({ part }) => (part(), await settled(), Promise.reject(new AvatarError("damaged")));
  await loading.add(["a"]);
  assert.deepEqual([named("withdraw").length, named("error")], [1, [["damaged"]]]);
});

test("where nothing was shown, nothing is withdrawn", async () => {
  const { loading, named } = begun();
  answers.a = () => Promise.reject(new AvatarError("damaged"));
  await loading.add(["a"]);
  assert.deepEqual([named("withdraw"), named("error")], [[], [["damaged"]]]);
});

test("an avatar that comes when another src was set goes again, unseen", async () => {
  const { loading, element, named } = begun({ src: "a" });
  let release;
  answers.a = async ({ onProgress, part }) => {
    await new Promise((done) => (release = done));
    onProgress(0.5, "late");
    part();
  };
  const first = loading.reload();
  await settled();
  element.attributes.src = "b";
  await loading.reload();
  const before = named("show").length;
  release();
  await first;
  await settled();
  assert.deepEqual(players[0].avatars, []);
  assert.equal(named("show").length, before);
  assert.equal(
    named("controls.load").some(([, sentence]) => sentence === "late"),
    false,
  );
  assert.deepEqual(named("load").length, 1);
});

test("what follows in a src that was changed is not loaded", async () => {
  const { loading, element } = begun({ src: "a b" });
  answers.a = async () => {
    delete answers.a;
    element.attributes.src = "c";
    void loading.reload();
  };
  await loading.reload();
  await settled();
  assert.deepEqual(
    players.flatMap(({ loaded }) => loaded).map((each) => each.at(-1)),
    ["a", "c"],
  );
});

test("what fails after another src was set is not said", async () => {
  const { loading, element, named } = begun({ src: "a" });
  answers.a = async () => {
    element.attributes.src = "b";
    await loading.reload();
    throw new AvatarError("too late");
  };
  await loading.reload();
  assert.deepEqual(named("error"), []);
});

test("a failure is said with a way to try again where the page named the file and nothing is shown", async () => {
  for (const [attributes, shown, wanted] of [
    [{ src: "a" }, false, { again: true, close: false }],
    [{}, false, { again: false, close: false }],
    [{ src: "b" }, true, { again: false, close: true }],
  ]) {
    const { loading, named } = begun(attributes);
    answers.a = () => Promise.reject(new Error("it broke"));
    if (shown) await loading.reload();
    await loading.add(["a"]);
    assert.deepEqual(named("controls.say"), [["The avatar cannot be shown: it broke.", wanted]]);
  }
});

test("what goes wrong while nobody waits stops the player and can be tried again", async () => {
  const { loading, named } = begun({ src: "a" });
  await loading.reload();
  players[0].onerror(new AvatarError("The device is lost."));
  assert.equal(players[0].stopped, true);
  assert.deepEqual(named("controls.say"), [["The device is lost.", { again: true, close: false }]]);
});

test("a failed file leaves those that play alone", async () => {
  const { loading } = begun({ src: "a" });
  await loading.reload();
  answers.b = () => Promise.reject(new AvatarError("no"));
  await loading.add(["b"]);
  assert.equal(players[0].stopped, false);
});

test("a player that did not open is opened anew when it is asked for again", async () => {
  const { loading, named } = begun({ src: "a" });
  opens = Promise.reject(new AvatarError("No device."));
  await loading.reload();
  assert.equal(loading.begun, false);
  opens = null;
  await loading.add(["a"]);
  assert.equal(players.length, 2);
  assert.deepEqual([named("error"), named("load").length], [[["No device."]], 1]);
});

test("a player that opens after the element has gone is given back", async () => {
  const { loading, named } = begun({ src: "a" });
  let release;
  opens = new Promise((done) => (release = done));
  const loads = loading.reload();
  await settled();
  loading.dispose();
  release();
  await loads;
  await settled();
  assert.deepEqual([players[0].disposed, loading.player, named("opened")], [true, null, []]);
});

test("a canvas has one player at a time, and those that nobody waits for are not made", async () => {
  const { loading, element, named } = begun({ src: "a" });
  let release;
  opens = new Promise((done) => (release = done));
  const loads = [loading.reload()];
  await settled();
  opens = null;
  for (const src of ["b", "c"]) {
    element.attributes.src = src;
    loads.push(loading.reload());
    await settled();
  }
  assert.equal(players.length, 1, "the first has not given the canvas back");
  release();
  await Promise.all(loads);
  assert.deepEqual(
    players.map(({ disposed, loaded }) => [disposed, loaded]),
    [
      [true, []],
      [false, ["http://host/folder/c"]],
    ],
  );
  assert.deepEqual([named("load").length, named("error")], [1, []]);
});

test("how far all of src is, and whether it is there, is reported", async () => {
  const { loading, named } = begun({ src: "a b" });
  answers.a = ({ onProgress }) => onProgress(0.5, "half");
  answers.b = ({ onProgress }) => (assert.equal(loading.done, false), onProgress(1, "Ready"));
  const loads = loading.reload();
  assert.equal(loading.done, false);
  await loads;
  assert.deepEqual([named("progress"), loading.done], [[[0.25], [1]], true]);
});

test("what failed is no longer waited for, nor what should have followed it", async () => {
  const { loading } = begun({ src: "a b" });
  answers.a = () => Promise.reject(new AvatarError("damaged"));
  await loading.reload();
  assert.deepEqual([players[0].loaded.length, loading.done], [1, true]);
});

test("a download that nobody waits for any more ends", async () => {
  const { loading, element } = begun({ src: "a" });
  let go;
  answers.a = () => new Promise((done) => (go = done));
  const loads = loading.reload();
  await settled();
  const { signal } = players[0];
  assert.equal(signal.aborted, false);
  element.attributes.src = "b";
  const others = loading.reload();
  assert.equal(signal.aborted, true);
  go();
  await Promise.all([loads, others]);
  assert.deepEqual([players[1].signal.aborted, loading.done], [false, true]);
});
