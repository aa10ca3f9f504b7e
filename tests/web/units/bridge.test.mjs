// Poses from a socket: which avatar is given which, and that each is answered once it has been drawn.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { follow } from "../../../python/mua/web/bridge.js";

let frames; // that were asked of the display
globalThis.requestAnimationFrame = (draws) => frames.push(draws);
const show = () => frames.splice(0).forEach((draws) => draws());

beforeEach(() => (frames = []));

class FakeSocket extends EventTarget {
  readyState = 1;
  sent = [];

  send(text) {
    this.sent.push(text);
  }

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
  const [socket, avatars] = [new FakeSocket(), [posed(), posed()]];
  follow({ avatars }, socket);
  socket.bring(1, pose(0.1), pose(0.2));
  assert.deepEqual(avatars[0].asked, [pose(0.1)]);
  assert.deepEqual(avatars[1].asked, [pose(0.2)]);
});

test("an avatar that is not there yet is given the poses that come after it", () => {
  const [socket, second] = [new FakeSocket(), posed()];
  const element = { avatars: [] };
  follow(element, socket);
  socket.bring(1, pose(0.1), pose(0.2));
  element.avatars = [posed(), second];
  socket.bring(2, pose(0.3), pose(0.4));
  assert.deepEqual(second.asked, [pose(0.4)]);
});

test("a pose is answered after the display has shown it, unless the socket has closed", () => {
  const socket = new FakeSocket();
  follow({ avatars: [posed()] }, socket);
  socket.bring(7, pose(0.1));
  show();
  assert.deepEqual(socket.sent, []);
  show();
  assert.deepEqual(socket.sent, ["7"]);
  socket.bring(8, pose(0.1));
  socket.readyState = 3;
  show();
  show();
  assert.deepEqual(socket.sent, ["7"]);
});
