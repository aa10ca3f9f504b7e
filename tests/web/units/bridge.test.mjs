// Poses from a stream of events: which avatar is given which, and that each is answered once it has been drawn.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { follow } from "../../../python/mua/web/bridge.js";

let frames; // that were asked of the display
globalThis.requestAnimationFrame = (draws) => frames.push(draws);
const show = () => frames.splice(0).forEach((draws) => draws());

beforeEach(() => (frames = []));

class FakeSource extends EventTarget {
  url = "http://127.0.0.1/live";

  bring(id, ...avatars) {
    this.dispatchEvent(Object.assign(new Event("message"), { data: JSON.stringify({ id, avatars }) }));
  }
}

/** An avatar that notes what it is asked for. */
function posed() {
  const asked = [];
  return { asked, setPose: (pose) => asked.push(pose) };
}

const pose = (turn) => ({ rotations: [turn, 0, 0, 1], translations: [0, turn, 0], expressions: [turn] });

test("each avatar is given its own pose", () => {
  const [source, avatars] = [new FakeSource(), [posed(), posed()]];
  follow({ avatars }, source);
  source.bring(1, pose(0.1), pose(0.2));
  assert.deepEqual(avatars[0].asked, [pose(0.1)]);
  assert.deepEqual(avatars[1].asked, [pose(0.2)]);
});

test("an avatar that is not there yet is given the poses that come after it", () => {
  const [source, second] = [new FakeSource(), posed()];
  const element = { avatars: [] };
  follow(element, source);
  source.bring(1, pose(0.1), pose(0.2));
  element.avatars = [posed(), second];
  source.bring(2, pose(0.3), pose(0.4));
  assert.deepEqual(second.asked, [pose(0.4)]);
});

test("a pose is answered after the display has shown it, and a server that has ended is no error", async () => {
  const sent = [];
  globalThis.fetch = (address, { method, body }) => {
    sent.push(`${method} ${address} ${body}`);
    return Promise.reject(new TypeError());
  };
  const source = new FakeSource();
  follow({ avatars: [posed()] }, source);
  source.bring(7, pose(0.1));
  show();
  assert.deepEqual(sent, []);
  show();
  assert.deepEqual(sent, ["POST http://127.0.0.1/live 7"]);
  await Promise.resolve();
});
