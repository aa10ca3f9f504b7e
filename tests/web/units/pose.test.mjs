// What a page says of poses and expressions, and the sentence where it is wrong.

import assert from "node:assert/strict";
import { test } from "node:test";
import { outward, poseFrom, skeletonInfo, weighted } from "../../../python/mua/web/pose.js";

const skeleton = {
  names: ["Hips", "Spine"],
  parents: Int32Array.from([-1, 0]),
  root: 0,
  bindRotations: Float64Array.from([1, 0, 0, 0, 0.5, 0.5, 0.5, 0.5]),
  bindTranslations: Float64Array.from([0, 1, 0, 0, 0.2, 0]),
};
const avatar = { skeleton, expressions: ["blink", "smile"] };
const list = (values) => Array.from(values);
const bind = { rotations: list(skeleton.bindRotations), translations: list(skeleton.bindTranslations) };

function found(given) {
  const { rotations, translations, expressions } = poseFrom(avatar, given);
  return {
    rotations: list(rotations),
    translations: list(translations),
    expressions: expressions && list(expressions),
  };
}

test("a skeleton's quaternions are x, y, z, w", () => {
  const { names, parents, root, rotations, translations } = skeletonInfo(skeleton);
  assert.deepEqual([names, parents, root], [["Hips", "Spine"], [-1, 0], 0]);
  assert.deepEqual(list(rotations), [0, 0, 0, 1, 0.5, 0.5, 0.5, 0.5]);
  assert.deepEqual(list(translations), [0, 1, 0, 0, 0.2, 0].map(Math.fround));
});

test("what is left out of a pose is as in the bind pose", () => {
  assert.deepEqual(found({}), { ...bind, expressions: undefined });
});

test("a pose is given for all joints, or for some by name", () => {
  const turned = [0, 0, 1, 0, 0.8, 0, 0, 0.6];
  const wanted = [0, 0, 0, 1, 0.6, 0.8, 0, 0];
  assert.deepEqual(found({ rotations: turned }).rotations, wanted);
  assert.deepEqual(found({ rotations: Float64Array.from(turned) }).rotations, wanted);
  const named = { rotations: { Spine: [0.8, 0, 0, 0.6] }, translations: { Hips: [1, 2, 3] } };
  assert.deepEqual(found(named).rotations, [1, 0, 0, 0, 0.6, 0.8, 0, 0]);
  assert.deepEqual(found(named).translations, [1, 2, 3, 0, 0.2, 0]);
  assert.deepEqual(found({ translations: [1, 2, 3, 4, 5, 6] }).translations, [1, 2, 3, 4, 5, 6]);
});

test("quaternions are brought to unit length", () => {
  const { rotations } = found({ rotations: { Spine: [8, 0, 0, 6] } });
  assert.ok(Math.abs(Math.hypot(...rotations.slice(4)) - 1) < 1e-15);
});

test("what a skeleton says of its bind pose is a pose", () => {
  const { rotations, translations } = skeletonInfo(skeleton);
  assert.deepEqual(found({ rotations, translations }).rotations, bind.rotations);
});

for (const [given, message] of [
  [{ rotations: [0, 0, 0, 1] }, "rotations holds 4 numbers, expected 8: 4 of each of 2 joints"],
  [{ rotations: [0, 0, 0, 1, 0, NaN, 0, 1] }, "rotations: expected finite numbers, found NaN"],
  [{ rotations: [0, 0, 0, 1, 0, 0, 0, 0] }, "rotations: Spine is 0 0 0 0, expected a rotation"],
  [{ rotations: { Chest: [0, 0, 0, 1] } }, 'rotations: the avatar has no joint "Chest", only Hips, Spine'],
  [{ rotations: { Spine: [0, 0, 1] } }, "rotations: Spine holds 3 numbers, expected 4: x, y, z, w"],
  [{ rotations: { Spine: null } }, "rotations: Spine holds no numbers, expected 4: x, y, z, w"],
  [{ translations: { Hips: [0, Infinity, 0] } }, "translations: Hips: expected finite numbers, found Infinity"],
  [{ translations: [1, 2, 3] }, "translations holds 3 numbers, expected 6: 3 of each of 2 joints"],
  [{ expressions: [1] }, "expressions holds 1 numbers, expected 2: one of each expression of the avatar"],
  [{ expressions: [1, NaN] }, "expressions: expected finite numbers, found NaN"],
])
  test(`a pose that is wrong is a sentence: ${message}`, () => {
    assert.throws(() => poseFrom(avatar, given), { name: "AvatarError", message: `setPose: ${message}.` });
  });

test("weights that are set stand over those of the pose, where there are any", () => {
  const set = Float32Array.from([Number.NaN, 0.25]);
  const pose = { ...bind, expressions: Float32Array.from([0.5, 1]) };
  assert.deepEqual(list(weighted(pose, set).expressions), [0.5, 0.25]);
  assert.deepEqual(list(weighted(bind, set).expressions), [0, 0.25], "of a pose without any");
  assert.equal(weighted(pose, null), pose);
});

test("weights are held to 0 to 1", () => {
  assert.deepEqual(found({ expressions: [-1, 2] }).expressions, [0, 1]);
});

test("quaternions go out as they came in", () => {
  assert.deepEqual(list(outward([1, 2, 3, 4])), [2, 3, 4, 1]);
});
