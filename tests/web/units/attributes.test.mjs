// What an element's attributes ask of its player.

import assert from "node:assert/strict";
import { test } from "node:test";
import { ASKABLE, adopt, levelNamed, numberOf } from "../../../python/mua/web/attributes.js";
import { FakeElement, fakePlayer } from "./page.mjs";

const ALL = { splats: false, geometry: false, template: false, skeleton: false, shadow: false };

/** The player after an attribute with this value, or without it. */
function asked(name, value, player = fakePlayer()) {
  adopt(player, new FakeElement(value === null ? {} : { [name]: value }), name);
  return player;
}

for (const [name, value, wanted] of [
  ["clip", "wave", "wave"],
  ["clip", "nobody's", "walk"],
  ["clip", null, "walk"],
  ["speed", "0.5", 0.5],
  ["speed", "0", 0],
  ["speed", null, 1],
  ["level", "full", "full"],
  ["level", "384", 384],
  ["level", "auto", "auto"],
  ["level", null, "auto"],
  ["budget", "20000", 20000],
  ["level", "", "auto"],
  ["budget", null, null],
  ["stereo", "", true],
  ["stereo", null, false],
  ["follow", "", true],
  ["follow", null, false],
  ["show", "template, shadow", { ...ALL, template: true, shadow: true }],
  ["show", "", ALL],
])
  test(`${name}=${value === null ? "(none)" : `"${value}"`} asks for ${JSON.stringify(wanted)}`, () => {
    assert.ok(ASKABLE.includes(name));
    assert.deepEqual(asked(name, value)[name], wanted);
  });

for (const [name, value, said] of [
  ["speed", "fast", 'speed="fast": expected a number.'],
  ["level", "high", 'level="high": expected auto, full or texels along a side.'],
  ["budget", "many", 'budget="many": expected a number of splats.'],
])
  test(`${name}="${value}" is said to be wrong, and changes nothing`, () => {
    const player = { ...fakePlayer(), [name]: 3 };
    assert.throws(() => asked(name, value, player), { name: "AvatarError", message: said });
    assert.equal(player[name], 3);
  });

test("framebudget asks for the milliseconds of a picture", () => {
  assert.equal(asked("framebudget", "11.1").frameBudget, 11.1);
  assert.equal(asked("framebudget", null).frameBudget, null);
  assert.throws(() => asked("framebudget", "fast"), {
    message: 'framebudget="fast": expected a number of milliseconds.',
  });
});

test("without show, what is shown stays", () => {
  const player = { ...fakePlayer(), show: { splats: true, template: true } };
  assert.deepEqual(asked("show", null, player).show, { splats: true, template: true });
});

test("an attribute that asks nothing of a player changes nothing", () => {
  const player = fakePlayer();
  const before = structuredClone({ ...player, frameAll: null });
  assert.deepEqual({ ...asked("controls", "", player), frameAll: null }, before);
});

test("a number that is left out or none is the other one", () => {
  const element = new FakeElement({ orbit: "-3.5", azimuth: "left", elevation: "0" });
  assert.equal(numberOf(element, "orbit", 7), -3.5);
  assert.equal(numberOf(element, "azimuth", 7), 7);
  assert.equal(numberOf(element, "elevation", 7), 0);
  assert.equal(numberOf(element, "speed", 7), 7);
});

test("a level is a number of texels, the finest, or by the distance", () => {
  assert.deepEqual(["full", "192", "auto", "", null].map(levelNamed), ["full", 192, "auto", "auto", "auto"]);
});
