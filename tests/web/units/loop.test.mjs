// When pictures are drawn, with a player that notes it and a display that shows a frame when the test says so.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Loop } from "../../../python/mua/web/loop.js";

const settled = () => new Promise((done) => setTimeout(done));

let frames; // that were asked of the display
globalThis.requestAnimationFrame = (draws) => frames.push(draws);

async function show(now) {
  for (const draws of frames.splice(0)) draws(now);
  await settled();
}

beforeEach(() => (frames = []));

/** A loop of an element with one avatar, and what it does. */
function begun(more = {}) {
  const reported = { drawn: 0, ticks: [], failed: [] };
  const player = {
    playing: false,
    going: false,
    start: () => (player.going = true),
    stop: () => (player.going = false),
    get moving() {
      return player.playing;
    },
    draw: async () => void (reported.drawn += 1),
    ...more,
  };
  const avatar = { player, avatars: ["one"] };
  const asks = {
    tick: (seconds) => reported.ticks.push(seconds),
    drawn() {},
    fail: (error) => reported.failed.push(error.message),
  };
  return { loop: new Loop(avatar, asks), avatar, player, reported };
}

test("an avatar that nobody sees rests, and plays on when it is seen", async () => {
  const { loop, player, reported } = begun({ playing: true });
  loop.pace();
  loop.setVisible(false);
  await show(performance.now());
  assert.deepEqual([player.going, player.playing, reported.ticks.length, frames.length], [false, true, 0, 0]);
  loop.setVisible(true);
  await show(performance.now());
  assert.deepEqual([player.going, reported.ticks.length, frames.length], [true, 1, 1]);
});

test("a display that showed nothing for an hour is one short step", async () => {
  const { loop, reported } = begun({ playing: true });
  loop.pace();
  await show(performance.now() + 3_600_000);
  await show(performance.now());
  assert.deepEqual(reported.ticks, [0.25, 0]);
});

test("what changes is drawn once, however often it is asked for", async () => {
  const { loop, reported } = begun();
  for (let i = 0; i < 3; i++) loop.redraw();
  assert.equal(frames.length, 1);
  await show(0);
  assert.deepEqual([reported.drawn, frames.length], [1, 0]);
});

test("a picture that fails is reported; one of a player that was given back meanwhile is not", async () => {
  for (const [given, wanted] of [
    [false, ["broken"]],
    [true, []],
  ]) {
    const { loop, avatar, reported } = begun({
      draw: async () => (await settled(), Promise.reject(new Error("broken"))),
    });
    loop.redraw();
    const shown = show(0);
    if (given) avatar.player = null;
    await shown;
    await settled();
    assert.deepEqual(reported.failed, wanted);
  }
});

test("in another window it plays and draws by the frames of that one, also what the first one owes", async () => {
  for (const playing of [true, false]) {
    frames = [];
    const { loop, avatar, player, reported } = begun({ playing });
    loop.pace();
    loop.redraw();
    const owed = frames.splice(0);
    const view = {
      requestAnimationFrame: (draws) => frames.push(draws),
      performance: { timeOrigin: performance.timeOrigin + 5000 },
    };
    avatar.ownerDocument = { defaultView: view };
    loop.move();
    assert.deepEqual([owed.length, frames.length, player.going], [1, 1, playing]);
    await show(performance.now() - 5000 + 100); // by that window's clock
    for (const draws of owed) draws(performance.now()); // of a page that comes back
    await settled();
    if (playing) assert.ok(reported.ticks.length === 1 && reported.ticks[0] >= 0.1, String(reported.ticks));
    assert.equal(reported.drawn, playing ? 0 : 1);
  }
});
