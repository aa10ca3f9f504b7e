// A progressive load into an engine, part by part.

import assert from "node:assert/strict";
import { test } from "node:test";
import { AvatarError } from "../../../python/mua/web/error.js";
import { ProgressiveLoad } from "../../../python/mua/web/progressive.js";

const settled = () => new Promise((done) => setTimeout(done));

/** An engine that notes what is put into it, and a progressive load that lists its parts. */
function arriving({ projecting = Promise.resolve(), put = async () => {} } = {}) {
  const noted = [];
  const engine = {
    entries: [],
    renderer: { projecting },
    async put(avatar, entry, whole) {
      noted.push([avatar, whole]);
      await put(avatar);
      const shown = entry ?? { handle: { remove: () => noted.push("removed") } };
      if (!entry) engine.entries.push(shown);
      return shown;
    },
  };
  const reported = [];
  const progressive = new ProgressiveLoad(engine, (handle) => reported.push(handle));
  return { progressive, engine, noted, reported };
}

test("each part takes the place of the one before, the whole one the last", async () => {
  const { progressive, engine, noted, reported } = arriving();
  for (const part of ["mesh", "coarse"]) {
    progressive.show(part);
    await settled();
  }
  const handle = await progressive.complete("all");
  assert.deepEqual(noted, [
    ["mesh", false],
    ["coarse", false],
    ["all", true],
  ]);
  assert.deepEqual([engine.entries.length, reported], [1, [handle, handle]]);
});

test("of parts that came before the device can draw, the newest is shown", async () => {
  let ready;
  const { progressive, noted } = arriving({ projecting: new Promise((done) => (ready = done)) });
  for (const part of ["mesh", "coarse", "fine"]) progressive.show(part);
  await settled();
  assert.deepEqual(noted, []);
  ready();
  await settled();
  assert.deepEqual(noted, [["fine", false]]);
});

test("a part that waits is left out once all of it is there", async () => {
  let ready;
  const { progressive, noted } = arriving({ projecting: new Promise((done) => (ready = done)) });
  progressive.show("mesh");
  const whole = progressive.complete("all");
  ready();
  await whole;
  assert.deepEqual(noted, [["all", true]]);
});

test("the whole avatar waits for the part that is being shown, and takes its place", async () => {
  let shown;
  const { progressive, engine, noted } = arriving({
    put: (avatar) => avatar === "mesh" && new Promise((done) => (shown = done)),
  });
  progressive.show("mesh");
  await settled();
  const whole = progressive.complete("all");
  await settled();
  assert.deepEqual(noted, [["mesh", false]]);
  shown();
  await whole;
  assert.deepEqual([noted.at(-1), engine.entries.length], [["all", true], 1]);
});

test("a download that fails takes away what was shown of it, also where a part is on its way", async () => {
  const { progressive, noted } = arriving();
  progressive.show("mesh");
  await settled();
  progressive.show("coarse");
  await progressive.fail();
  assert.deepEqual(noted, [["mesh", false], "removed"]);
  const early = arriving();
  await early.progressive.fail();
  assert.deepEqual(early.noted, []);
  let ready;
  const waiting = arriving({ projecting: new Promise((done) => (ready = done)) });
  waiting.progressive.show("mesh");
  const failing = waiting.progressive.fail();
  ready();
  await failing;
  assert.deepEqual(waiting.noted, []);
});

test("a part that was removed meanwhile is not reported", async () => {
  const { progressive, engine, reported } = arriving({ put: async () => void (engine.removing = true) });
  engine.entries.push = () => {};
  progressive.show("mesh");
  await settled();
  assert.deepEqual(reported, []);
});

test("kernels that do not compile are reported by the whole avatar, not by its parts", async () => {
  const refused = async () => {
    throw new AvatarError("The graphics device refused.");
  };
  const { progressive, reported } = arriving({ projecting: Promise.reject(new Error("compile")), put: refused });
  progressive.show("mesh");
  await settled();
  await assert.rejects(progressive.complete("all"), /refused/);
  assert.deepEqual(reported, []);
});

test("a part that breaks for another reason fails the whole", async () => {
  const { progressive } = arriving({
    put: async () => {
      throw new TypeError("a fault of ours");
    },
  });
  progressive.show("mesh");
  await assert.rejects(progressive.complete("all"), /a fault of ours/);
  await progressive.fail(); // and takes nothing away
});
